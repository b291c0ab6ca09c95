//! Laws of speckle in space.

pub(crate) mod objective;
pub(crate) mod second_order;
pub(crate) mod spatial;
