//! Speckle: a stack is made from a description, then looked up.

mod description;
mod look_up;

pub use description::*;
pub use look_up::*;

use tem00_speckle::SpeckleStack;

use crate::pointers;

/// Speckle that moves and decorrelates. It never changes: any number of threads may look it up at
/// once.
#[derive(Debug)]
pub struct Stack(SpeckleStack);

/// Frees a stack; null is allowed. No thread may be using it, and it must not be used again.
///
/// # Safety
///
/// `stack` is null, or came from one of the functions that create stacks and was not destroyed.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn tem00_stack_destroy(stack: *mut Stack) {
    // SAFETY: by the contract of this function.
    unsafe { pointers::destroy(stack) };
}

#[cfg(test)]
mod tests;
