use core::ffi::c_char;
use std::{ffi::CString, fs, path::PathBuf};

use super::*;

/// A file for one test, with its name for C.
fn file(name: &str) -> (PathBuf, CString) {
    let path = std::env::temp_dir().join(format!("tem00_{}_{name}", std::process::id()));
    let text = CString::new(path.to_str().unwrap()).unwrap();
    (path, text)
}

fn read_file(path: *const c_char, memory_limit: u64) -> (Owned, Status) {
    let mut stack = ptr::dangling_mut();
    // SAFETY: the pointers are valid.
    let status = unsafe { tem00_stack_read(path, memory_limit, 1, &raw mut stack) };
    (Owned(stack), status)
}

#[test]
fn a_file_gives_back_the_stack() {
    let stack = Owned::new(&DESCRIPTION);
    let (path, name) = file("same");
    // SAFETY: the pointers are valid.
    let written = unsafe { tem00_stack_write(stack.0, name.as_ptr()) };
    let (same, read) = read_file(name.as_ptr(), 1 << 20);
    let (_, limited) = read_file(name.as_ptr(), 1000);
    fs::write(&path, &fs::read(&path).unwrap()[..1000]).unwrap();
    let (_, short) = read_file(name.as_ptr(), 1 << 20);
    fs::remove_file(path).unwrap();
    assert_eq!([written, read], [Status::Ok; 2], "{}", last_parameter());
    assert!(same.library() == stack.library(), "the bits");
    assert_eq!(
        [limited, short],
        [Status::Memory, Status::File],
        "limited and cut short"
    );
}

#[test]
fn files_that_cannot_be_used_are_refused() {
    let stack = Owned::new(&DESCRIPTION);
    let missing = c"/nowhere/at/all".as_ptr();
    let not_utf8 = c"\xff".as_ptr();
    let expected = |status| (status, "path".to_owned());
    // SAFETY: the pointers are valid or null, which is refused.
    let write = |path| refusal(unsafe { tem00_stack_write(stack.0, path) });
    assert_eq!(write(missing), expected(Status::Io), "write");
    assert_eq!(write(not_utf8), expected(Status::InvalidArgument), "write");
    assert_eq!(
        write(ptr::null()),
        expected(Status::InvalidPointer),
        "write"
    );
    for (path, status) in [
        (missing, Status::Io),
        (not_utf8, Status::InvalidArgument),
        (ptr::null(), Status::InvalidPointer),
    ] {
        let (stack, got) = read_file(path, 0);
        assert_eq!(refusal(got), expected(status), "read");
        assert!(stack.0.is_null(), "{status:?} left a stack");
    }
}
