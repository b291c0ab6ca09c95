use numpy::ndarray::{ArrayViewD, IxDyn, iter::Iter};
use pyo3::PyResult;

use super::results::element_count;
use crate::error::refused;

/// Elements that are worked on at a time: they stay in the cache.
const BLOCK: usize = 4096;

/// Arguments broadcast together, to be walked through block by block.
pub(super) struct Blocks<'a, T, const N: usize> {
    shape: Vec<usize>,
    length: usize,
    views: [ArrayViewD<'a, T>; N],
}

impl<'a, T: Copy, const N: usize> Blocks<'a, T, N> {
    /// Broadcasts the values of arguments by NumPy's rule.
    ///
    /// # Errors
    ///
    /// Refuses shapes that do not fit together, and more elements than an address counts.
    pub(super) fn new(names: [&'static str; N], views: [ArrayViewD<'a, T>; N]) -> PyResult<Self> {
        let shape = common_shape(&names, &views)?;
        Ok(Self {
            length: element_count(&shape)?,
            shape,
            views,
        })
    }

    /// Returns the common shape.
    pub(super) fn shape(&self) -> &[usize] {
        &self.shape
    }

    /// Calls `f` with the arguments as slices of equal length, from the first elements to the last.
    pub(super) fn run(&self, mut f: impl FnMut([&[T]; N])) {
        let wide = self
            .views
            .each_ref()
            .map(|view| view.broadcast(self.shape.as_slice()));
        let mut columns = wide
            .each_ref()
            .map(|view| Column::new(view.as_ref(), self.length));
        let mut left = self.length;
        while left > 0 {
            let count = left.min(BLOCK);
            f(columns.each_mut().map(|column| column.next(count)));
            left -= count;
        }
    }
}

/// One argument as the elements of the common shape.
enum Column<'a, T> {
    /// It has that shape, and is read where it lies.
    Whole(&'a [T]),
    /// It is one number, repeated over a block.
    Same(Vec<T>),
    /// It repeats along some axes.
    Spread(Iter<'a, T, IxDyn>, Vec<T>),
}

impl<'a, T: Copy> Column<'a, T> {
    /// Nothing is ever read of a column without a view: there are no elements then.
    fn new(wide: Option<&'a ArrayViewD<'a, T>>, length: usize) -> Self {
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
    fn next(&mut self, count: usize) -> &[T] {
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
fn common_shape<T, const N: usize>(
    names: &[&'static str; N],
    views: &[ArrayViewD<'_, T>; N],
) -> PyResult<Vec<usize>> {
    let mut common: Vec<usize> = Vec::new();
    for (name, view) in names.iter().zip(views) {
        let shape = view.shape();
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
