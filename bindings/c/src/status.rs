use std::{
    any::Any,
    cell::Cell,
    ffi::c_char,
    fmt::Display,
    panic::{AssertUnwindSafe, catch_unwind},
};

use tem00_beam::Refusal;
use tem00_shading::ShadingError;
use tem00_speckle::SpeckleError;

/// Success of a call, or the kind of its failure. The message is that of `tem00_last_error`.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Status {
    /// The call succeeded, and all its results are written.
    Ok = 0,
    /// A number is outside what is allowed; `tem00_last_error_parameter` names it.
    InvalidArgument = 1,
    /// A pointer is null or not aligned, or what is written overlaps what is read.
    InvalidPointer = 2,
    /// The memory is more than the limit, or than the machine has.
    Memory = 3,
    /// The library failed: a bug, to be reported with its message.
    Panic = 4,
}

/// Failure of a call.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct Failure {
    pub(crate) status: Status,
    pub(crate) parameter: String,
    pub(crate) message: String,
}

impl Failure {
    pub(crate) fn new(status: Status, parameter: &str, message: impl Display) -> Self {
        Self {
            status,
            parameter: parameter.to_owned(),
            message: message.to_string(),
        }
    }

    pub(crate) fn argument(parameter: &str, message: impl Display) -> Self {
        Self::new(Status::InvalidArgument, parameter, message)
    }

    fn panic(payload: &(dyn Any + Send)) -> Self {
        let text = payload.downcast_ref::<&str>().copied();
        let text = text.or_else(|| payload.downcast_ref::<String>().map(String::as_str));
        let message = format!("the library failed: {}", text.unwrap_or("no reason given"));
        Self::new(Status::Panic, "", message)
    }
}

impl From<Refusal> for Failure {
    fn from(refusal: Refusal) -> Self {
        Self::argument(refusal.parameter, refusal)
    }
}

impl From<SpeckleError> for Failure {
    fn from(error: SpeckleError) -> Self {
        let status = match error {
            SpeckleError::MemoryLimit { .. } | SpeckleError::Memory { .. } => Status::Memory,
            _ => Status::InvalidArgument,
        };
        Self::new(status, error.parameter(), error)
    }
}

impl From<ShadingError> for Failure {
    fn from(error: ShadingError) -> Self {
        match error {
            ShadingError::Speckle(SpeckleError::MemoryLimit { .. }) => {
                Self::new(Status::Memory, "memory_limit", error)
            }
            ShadingError::Speckle(error) => error.into(),
            ShadingError::Refused(refusal) if refusal.parameter == "memory" => Self::new(
                Status::Memory,
                "memory_limit",
                refusal.named("memory_limit"),
            ),
            ShadingError::BeyondPoses { .. } => {
                Self::argument("motion", format!("motion: {error}"))
            }
            _ => Self::argument(error.parameter().unwrap_or_default(), error),
        }
    }
}

/// The bytes of a message, its final zero included. Longer ones end with "…".
const MESSAGE_SIZE: usize = 2048;
/// The bytes of a parameter's name.
const PARAMETER_SIZE: usize = 64;

/// A text of a thread that stays where it is as long as the thread lives, for C to read.
struct Text<const SIZE: usize>(Cell<[u8; SIZE]>);

impl<const SIZE: usize> Text<SIZE> {
    const fn empty() -> Self {
        Self(Cell::new([0; SIZE]))
    }

    /// Replaces the text. A zero would end it.
    fn keep(&self, text: &str) {
        const CUT: &str = "…";
        let mut bytes = [0; SIZE];
        let (kept, end) = if text.len() < SIZE {
            (text.len(), "")
        } else {
            (text.floor_char_boundary(SIZE - 1 - CUT.len()), CUT)
        };
        let characters = text[..kept].bytes().chain(end.bytes());
        for (place, byte) in bytes.iter_mut().zip(characters) {
            *place = if byte == 0 { b' ' } else { byte };
        }
        self.0.set(bytes);
    }

    const fn pointer(&self) -> *const c_char {
        self.0.as_ptr().cast_const().cast()
    }
}

thread_local! {
    // Without a destructor they outlive every call that a thread makes, on its way out too.
    static MESSAGE: Text<MESSAGE_SIZE> = const { Text::empty() };
    static PARAMETER: Text<PARAMETER_SIZE> = const { Text::empty() };
}

/// Runs the body of a function of the interface: no panic leaves it, and its failure is kept for
/// `tem00_last_error`.
pub(crate) fn call(body: impl FnOnce() -> Result<(), Failure>) -> Status {
    // Handles do not change once they are made, so a panic leaves none of them half-changed.
    match catch_unwind(AssertUnwindSafe(body)) {
        Ok(Ok(())) => Status::Ok,
        Ok(Err(failure)) => keep(&failure),
        Err(payload) => keep(&Failure::panic(&*payload)),
    }
}

#[cold]
fn keep(failure: &Failure) -> Status {
    MESSAGE.with(|text| text.keep(&failure.message));
    PARAMETER.with(|text| text.keep(&failure.parameter));
    failure.status
}

/// Returns why the last call that failed on this thread failed, in UTF-8, with the parameter, its
/// value and what is allowed; empty if none has failed.
///
/// The text stays in one place for as long as the thread lives: the pointer never dangles
/// meanwhile, and after the next call that fails on this thread it has the text of that one. Copy
/// what is to be kept longer. Not to be freed. Messages are cut off after 2047 bytes.
#[unsafe(no_mangle)]
pub extern "C" fn tem00_last_error() -> *const c_char {
    MESSAGE.with(Text::pointer)
}

/// Returns the name of the parameter that the last call that failed on this thread refused; empty
/// if it was none.
///
/// It stays in one place as the text of `tem00_last_error` does. Not to be freed.
#[unsafe(no_mangle)]
pub extern "C" fn tem00_last_error_parameter() -> *const c_char {
    PARAMETER.with(Text::pointer)
}

#[cfg(test)]
mod tests;
