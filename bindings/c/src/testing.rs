//! Tables of calls for the tests: answers beside those of the library, and refusals by name.

use core::{
    ffi::CStr,
    fmt::Debug,
    mem::MaybeUninit,
    ops::Deref,
    ptr::{dangling_mut, null_mut},
};

use crate::status::{Status, tem00_last_error, tem00_last_error_parameter};

/// Message and parameter of the last failure of this thread.
pub(crate) fn last() -> [String; 2] {
    [tem00_last_error(), tem00_last_error_parameter()].map(|text| {
        // SAFETY: the text is that of this thread, and no call fails meanwhile.
        unsafe { CStr::from_ptr(text) }.to_str().unwrap().to_owned()
    })
}

/// The answer of a call that must succeed. All its bytes must be allowed to be 0.
#[track_caller]
pub(crate) fn answer<R>(question: impl FnOnce(*mut R) -> Status) -> R {
    let mut result = MaybeUninit::zeroed();
    let status = question(result.as_mut_ptr());
    assert_eq!(status, Status::Ok, "{}", last()[0]);
    // SAFETY: it was zeros, and it is what the call has written.
    unsafe { result.assume_init() }
}

/// Room for an answer as a pointer to its parts.
pub(crate) fn parts<R, T>(room: *mut R) -> *mut T {
    assert_eq!(size_of::<R>() % size_of::<T>(), 0, "of the parts");
    room.cast()
}

/// The answer of a function to all its arguments but the last, which is the room for it.
macro_rules! ask {
    ($function:ident($($argument:expr),*)) => {
        $crate::testing::answer(|out| {
            // SAFETY: the handles and the pointers are valid.
            unsafe { $function($($argument,)* $crate::testing::parts(out)) }
        })
    };
}

/// Checks that functions give the bits of the library.
macro_rules! agree {
    ($context:expr; $($function:ident($($argument:expr),*) = $expected:expr;)*) => {$(
        let name = stringify!($function);
        $crate::testing::same(ask!($function($($argument),*)), $expected, &(name, &$context));
    )*};
}

#[track_caller]
pub(crate) fn same<R: PartialEq + Debug>(found: R, expected: R, context: &dyn Debug) {
    assert_eq!(found, expected, "{context:?}");
}

/// Checks that each call is refused by the name of what is wrong, with the status above it.
macro_rules! refused {
    ($($status:ident { $($name:literal $function:ident($($argument:expr),*);)* })*) => {$($(
        // SAFETY: the handles and the pointers are valid, or wrong in a way that is refused.
        let status = unsafe { $function($($argument),*) };
        $crate::testing::refuses($name, $crate::status::Status::$status, status);
    )*)*};
}

#[track_caller]
pub(crate) fn refuses(name: &str, expected: Status, found: Status) {
    let [message, parameter] = last();
    assert_eq!((found, parameter.as_str()), (expected, name), "{message}");
}

/// A change that makes what was good wrong, and the name of what is wrong then.
type Change<D> = (&'static str, fn(&mut D));

/// Checks that no handle is made after each of these changes, and that each is refused by its name.
pub(crate) fn each_is_refused<D: Copy + Debug, T, const N: usize>(
    good: D,
    changes: [Change<D>; N],
    create: impl Fn(*const D, *mut *mut T) -> Status,
) {
    for (name, change) in changes {
        let mut wrong = good;
        change(&mut wrong);
        let mut handle = dangling_mut();
        refuses(
            name,
            Status::InvalidArgument,
            create(&raw const wrong, &raw mut handle),
        );
        assert!(handle.is_null(), "{wrong:?} made something");
    }
}

type Create<D, T> = unsafe extern "C" fn(*const D, *mut *mut T) -> Status;

/// A handle that frees itself.
pub(crate) struct Owned<T> {
    pub(crate) handle: *mut T,
    pub(crate) destroy: unsafe extern "C" fn(*mut T),
}

impl<T> Owned<T> {
    /// The handle that a function makes of a description.
    pub(crate) fn new<D>(
        create: Create<D, T>,
        description: &D,
        destroy: unsafe extern "C" fn(*mut T),
    ) -> Self {
        let handle = ask!(create(description));
        Self { handle, destroy }
    }
}

impl<T> Deref for Owned<T> {
    type Target = T;

    fn deref(&self) -> &T {
        // SAFETY: the handle lives as long as this, and never changes.
        unsafe { &*self.handle }
    }
}

impl<T> Drop for Owned<T> {
    fn drop(&mut self) {
        // SAFETY: it was made by the interface and is not used again.
        unsafe { (self.destroy)(self.handle) };
        // SAFETY: null is allowed.
        unsafe { (self.destroy)(null_mut()) };
    }
}

#[test]
fn threads_may_share_every_handle() {
    use crate::{Bandwidth, Camera, Imaging, Light, Speckle, SpeckleFrame, Stack};
    fn is_shared<T: Send + Sync>() {}
    is_shared::<(
        Bandwidth,
        Camera,
        Imaging,
        Light,
        Speckle,
        SpeckleFrame,
        Stack,
    )>();
}
