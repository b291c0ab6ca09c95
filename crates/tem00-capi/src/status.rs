use std::{
    any::Any,
    cell::RefCell,
    ffi::{CStr, CString, c_char},
    fmt::Display,
    panic::{AssertUnwindSafe, catch_unwind},
};

use tem00_beam::BeamError;
use tem00_decorrelation::DecorrelationError;
use tem00_speckle::{SpeckleError, StackFileError};

/// Whether a call succeeded and, if not, why. The message is that of `tem00_last_error`.
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
    /// A file could not be opened, read or written.
    Io = 4,
    /// A file is no speckle stack, or damaged, cut short or from a newer version.
    File = 5,
    /// The library failed: a bug, to be reported with its message.
    Panic = 6,
}

/// Why a call fails.
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

impl From<BeamError> for Failure {
    fn from(error: BeamError) -> Self {
        Self::argument(error.parameter(), error)
    }
}

impl From<DecorrelationError> for Failure {
    fn from(error: DecorrelationError) -> Self {
        Self::argument(error.parameter(), error)
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

impl From<StackFileError> for Failure {
    fn from(error: StackFileError) -> Self {
        match error {
            StackFileError::Stack(error) => {
                let status = Self::from(error).status;
                let status = match status {
                    Status::Memory => Status::Memory,
                    _ => Status::File,
                };
                Self::new(
                    status,
                    error.parameter(),
                    format!("stack in the file: {error}"),
                )
            }
            StackFileError::Io(_) => Self::new(Status::Io, "path", error),
            _ => Self::new(Status::File, "path", error),
        }
    }
}

/// The last failure of a thread, as C reads it.
#[derive(Default)]
struct LastError {
    message: CString,
    parameter: CString,
}

thread_local! {
    static LAST_ERROR: RefCell<LastError> = RefCell::default();
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
    let text = |text: &str| CString::new(text.replace('\0', " ")).unwrap_or_default();
    let last = LastError {
        message: text(&failure.message),
        parameter: text(&failure.parameter),
    };
    // A thread on its way out has no place for the text left, but still returns the status.
    let _ = LAST_ERROR.try_with(|place| place.replace(last));
    failure.status
}

/// A pointer into the thread's last error, or to an empty string on a thread on its way out.
fn text_of(part: impl Fn(&LastError) -> &CStr) -> *const c_char {
    LAST_ERROR
        .try_with(|last| part(&last.borrow()).as_ptr())
        .unwrap_or(c"".as_ptr())
}

/// Returns why the last call that failed on this thread failed, in UTF-8, with the parameter, its
/// value and what is allowed; empty if none has failed.
///
/// Valid until the next call that fails on this thread, and until the thread ends. Not to be freed.
#[unsafe(no_mangle)]
pub extern "C" fn tem00_last_error() -> *const c_char {
    text_of(|last| &last.message)
}

/// Returns the name of the parameter that the last call that failed on this thread refused; empty
/// if it was none.
///
/// Valid until the next call that fails on this thread, and until the thread ends. Not to be freed.
#[unsafe(no_mangle)]
pub extern "C" fn tem00_last_error_parameter() -> *const c_char {
    text_of(|last| &last.parameter)
}

#[cfg(test)]
mod tests;
