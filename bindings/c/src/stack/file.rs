use core::ffi::{CStr, c_char};
use std::{
    fs::File,
    io::{self, BufReader},
    path::Path,
};

use tem00_speckle::SpeckleStack;

use super::Stack;
use crate::{
    pointers::{borrow, create},
    status::{Failure, Status, call},
    threads::on_threads,
};

/// Reads the name of a file, in UTF-8.
///
/// # Safety
///
/// The pointer is null, or points to a string that ends with a zero and stays during `'a`.
unsafe fn file_name<'a>(path: *const c_char) -> Result<&'a str, Failure> {
    // SAFETY: by the contract of this function.
    let first = unsafe { borrow("path", path) }?;
    // SAFETY: not null, and ends with a zero by the contract of this function.
    let text = unsafe { CStr::from_ptr(first) };
    text.to_str()
        .map_err(|_| Failure::argument("path", format!("path must be UTF-8, got {text:?}")))
}

fn file_failure(path: &str, error: &io::Error) -> Failure {
    Failure::new(Status::Io, "path", format!("path {path:?}: {error}"))
}

fn read(path: &str, memory_limit: u64, threads: u32) -> Result<Stack, Failure> {
    let file = File::open(path).map_err(|error| file_failure(path, &error))?;
    let stack = on_threads(threads, || {
        SpeckleStack::read_from(BufReader::new(file), memory_limit)
    })?;
    Ok(Stack(stack?))
}

fn save(stack: &Stack, path: &str) -> Result<(), Failure> {
    let saved = stack.0.save(Path::new(path));
    saved.map_err(|error| file_failure(path, &error))
}

/// Reads a stack that `tem00_stack_write` or the library in another language has written, if its
/// slices take no more than `memory_limit` bytes.
///
/// `path` is a file name in UTF-8, `threads` the number of threads as in `tem00_stack_description`. On
/// failure `*stack` is null.
///
/// # Safety
///
/// The pointers are null or valid, `path` for a string that ends with a zero.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn tem00_stack_read(
    path: *const c_char,
    memory_limit: u64,
    threads: u32,
    stack: *mut *mut Stack,
) -> Status {
    // SAFETY: by the contract of this function.
    call(|| unsafe {
        create("stack", stack, || {
            read(file_name(path)?, memory_limit, threads)
        })
    })
}

/// Writes a stack as a file, which keeps its bits.
///
/// `path` is a file name in UTF-8; a file of that name is replaced once all is written.
///
/// # Safety
///
/// The pointers are null or valid, `path` for a string that ends with a zero.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn tem00_stack_write(stack: *const Stack, path: *const c_char) -> Status {
    call(|| {
        // SAFETY: by the contract of this function.
        let (stack, path) = unsafe { (borrow("stack", stack)?, file_name(path)?) };
        save(stack, path)
    })
}
