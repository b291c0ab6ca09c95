//! Helpers of the tests of the functions.

use core::{ffi::CStr, fmt::Debug};

use crate::status::{Status, tem00_last_error_parameter};

/// The parameter that the last failure of this thread named.
pub(crate) fn last_parameter() -> String {
    // SAFETY: the text is that of this thread, and no call fails meanwhile.
    let text = unsafe { CStr::from_ptr(tem00_last_error_parameter()) };
    text.to_str().unwrap().to_owned()
}

/// What a call of the interface that must succeed writes over `result`.
#[track_caller]
pub(crate) fn answer<R>(mut result: R, question: impl FnOnce(*mut R) -> Status) -> R {
    assert_eq!(
        question(&raw mut result),
        Status::Ok,
        "{}",
        last_parameter()
    );
    result
}

/// The status of a call that has just failed, and the parameter that it refused.
pub(crate) fn refusal(status: Status) -> (Status, String) {
    (status, last_parameter())
}

/// Checks that a call has just refused the number of this name.
#[track_caller]
pub(crate) fn number_is_refused(name: &str, status: Status) {
    let expected = (Status::InvalidArgument, name.to_owned());
    assert_eq!(refusal(status), expected, "the number {name}");
}

/// Checks that a call has just refused the pointer of this name.
#[track_caller]
pub(crate) fn pointer_is_refused(name: &str, status: Status) {
    let expected = (Status::InvalidPointer, name.to_owned());
    assert_eq!(refusal(status), expected, "the pointer {name}");
}

/// A change that makes what was good wrong, and the name of what is wrong then.
type Change<D> = (&'static str, fn(&mut D));

/// Checks that what was good is refused after each of these changes, by the name beside it.
pub(crate) fn each_is_refused<D: Copy + Debug, const N: usize>(
    good: D,
    changes: [Change<D>; N],
    call: impl Fn(&D) -> Status,
) {
    for (name, change) in changes {
        let mut wrong = good;
        change(&mut wrong);
        let expected = (Status::InvalidArgument, name.to_owned());
        assert_eq!(refusal(call(&wrong)), expected, "{wrong:?}");
    }
}
