use numpy::ndarray::{ArrayViewD, IxDyn, iter::Iter};
use pyo3::PyResult;

use super::columns::Column;
use crate::error::refused;

/// Elements that are worked on at a time: they stay in the cache.
pub(super) const BLOCK: usize = 4096;

/// Elements of one argument in the common shape.
pub(super) enum Walk<'a> {
    /// Array of the common shape, read in place.
    Whole(&'a [f64]),
    /// Single number, repeated over a block.
    Same(Vec<f64>),
    /// Array that repeats along some axes.
    Spread(Iter<'a, f64, IxDyn>, Vec<f64>),
}

impl<'a> Walk<'a> {
    /// Nothing is ever read of a column without a view: there are no elements then.
    pub(super) fn new(wide: Option<&'a ArrayViewD<'a, f64>>, length: usize) -> Self {
        let Some(wide) = wide else {
            return Self::Whole(&[]);
        };
        if let Some(whole) = wide.as_slice() {
            return Self::Whole(whole);
        }
        match wide.first() {
            Some(&first) if wide.strides().iter().all(|&stride| stride == 0) => {
                Self::Same(vec![first; length.min(BLOCK)])
            }
            _ => Self::Spread(wide.iter(), Vec::with_capacity(length.min(BLOCK))),
        }
    }

    /// Returns the next elements.
    pub(super) fn next(&mut self, count: usize) -> &[f64] {
        match self {
            Self::Whole(rest) => {
                let (block, after) = rest.split_at(count);
                *rest = after;
                block
            }
            Self::Same(block) => &block[..count],
            Self::Spread(values, block) => {
                block.clear();
                block.extend(values.by_ref().take(count));
                block
            }
        }
    }
}

/// The shape that all arguments broadcast to, by NumPy's rule.
pub(super) fn common_shape(columns: &[Column<'_>]) -> PyResult<Vec<usize>> {
    let mut common: Vec<usize> = Vec::new();
    for Column { name, values, .. } in columns {
        let shape = values.shape();
        let longer = shape.len().saturating_sub(common.len());
        common.splice(0..0, core::iter::repeat_n(1, longer));
        let skipped = common.len() - shape.len();
        for (side, &own) in common[skipped..].iter_mut().zip(shape) {
            if *side == 1 {
                *side = own;
            } else if own != 1 && own != *side {
                let message = format!(
                    "{name} has the shape {shape:?}, which does not broadcast with the arguments \
                     before it"
                );
                return Err(refused(name, message));
            }
        }
    }
    Ok(common)
}
