//! The functions of a stack against the library that they call.
#![expect(clippy::float_cmp, reason = "the same bits are asked for")]

mod look_ups;
mod made;
mod refusals;

use core::ptr;

use super::*;
use crate::{
    status::Status,
    testing::{
        answer, each_is_refused, last_parameter, number_is_refused, pointer_is_refused, refusal,
    },
};

const DESCRIPTION: StackDescription = StackDescription {
    width: 64,
    height: 48,
    diameter: 0,
    speckle_size: 3.0,
    seed: 11,
    path: SlicePath::Straight as u32,
    half_period: 6,
    length: 3,
    memory_limit: 1 << 20,
    threads: 1,
};

const NEEDS: StackNeeds = StackNeeds {
    image: [60.0, 40.0],
    region: [80.0, 40.0],
    speckle_size: 1.5,
    changes: 1,
    motion: 0.7,
    frames: 5,
    memory_limit: 4 << 20,
};

/// A stack that frees itself.
struct Owned(*mut Stack);

impl Drop for Owned {
    fn drop(&mut self) {
        // SAFETY: it was created by the interface and is not used again.
        unsafe { tem00_stack_destroy(self.0) };
    }
}

impl Owned {
    fn new(description: &StackDescription) -> Self {
        let mut stack = ptr::null_mut();
        // SAFETY: the pointers are valid.
        let status = unsafe { tem00_stack_create(description, &raw mut stack) };
        assert_eq!(status, Status::Ok, "{}", last_parameter());
        Self(stack)
    }

    fn library(&self) -> &SpeckleStack {
        // SAFETY: the stack lives as long as this.
        unsafe { &(*self.0).0 }
    }
}

#[test]
fn threads_may_share_a_stack() {
    fn is_shared<T: Send + Sync>() {}
    is_shared::<Stack>();
}
