//! Frequently evaluated functions as piecewise polynomials.

use core::{array::from_fn, cell::OnceCell, f64::consts::PI};

/// Returns a Chebyshev node of `N` on [−1, 1].
pub(crate) fn node<const N: usize>(k: usize) -> f64 {
    (PI * (k as f64 + 0.5) / N as f64).cos()
}

/// Returns the first `N` Chebyshev polynomials.
pub(crate) fn polynomials<const N: usize>(x: f64) -> [f64; N] {
    let [mut before, mut value] = [x, 1.0];
    from_fn(|_| {
        let this = value;
        (before, value) = (value, 2.0 * x * value - before);
        this
    })
}

/// Returns the coefficients of the polynomials for these values at the nodes.
pub(crate) fn coefficients<const N: usize>(values: [f64; N]) -> [f64; N] {
    let mut sums = [0.0; N];
    for (k, value) in values.into_iter().enumerate() {
        for (sum, polynomial) in sums.iter_mut().zip(polynomials::<N>(node::<N>(k))) {
            *sum += value * polynomial * 2.0 / N as f64;
        }
    }
    sums[0] *= 0.5;
    sums
}

/// Returns the panel between breaks in which a value lies, and its position there from −1 to 1.
pub(crate) fn place(breaks: &[f64], value: f64) -> Option<(usize, f64)> {
    let panel = breaks.partition_point(|end| *end <= value).checked_sub(1)?;
    let (start, end) = (breaks[panel], *breaks.get(panel + 1)?);
    Some((panel, (2.0 * value - start - end) / (end - start)))
}

/// Returns the value at a position, from −1 to 1, of a panel from `start` to `end`.
pub(crate) fn at_place([start, end]: [f64; 2], place: f64) -> f64 {
    0.5 * (start + end) + 0.5 * (end - start) * place
}

/// A function that is smooth between breaks, evaluated at the nodes of a panel when a value in the
/// panel is first needed.
pub(crate) struct Tabulated<F> {
    function: F,
    breaks: Vec<f64>,
    panels: Vec<OnceCell<[f64; 16]>>,
}

impl<F: Fn(f64) -> f64> Tabulated<F> {
    pub(crate) fn new(breaks: Vec<f64>, function: F) -> Self {
        let panels = vec![OnceCell::new(); breaks.len()];
        Self {
            function,
            breaks,
            panels,
        }
    }

    /// Returns the value; beyond the breaks the function itself is evaluated.
    pub(crate) fn at(&self, x: f64) -> f64 {
        let Some((panel, place)) = place(&self.breaks, x) else {
            return (self.function)(x);
        };
        let ends = [self.breaks[panel], self.breaks[panel + 1]];
        let fitted = self.panels[panel].get_or_init(|| {
            coefficients(from_fn(|k| (self.function)(at_place(ends, node::<16>(k)))))
        });
        let terms = fitted.iter().zip(polynomials::<16>(place));
        terms.map(|(c, t)| c * t).sum()
    }
}

/// The nodes of each side of a cell of a [`Grid`].
pub(crate) const SIDE: usize = 8;

/// Coefficients of the polynomials on a cell, of the first argument first.
pub(crate) type CellFit = [[f64; SIDE]; SIDE];

/// A function of two numbers that is smooth between breaks, evaluated at the nodes of a cell when a
/// value in the cell is first needed.
#[derive(Clone, Debug)]
pub(crate) struct Grid {
    breaks: [Vec<f64>; 2],
    cells: Vec<OnceCell<CellFit>>,
}

impl Grid {
    pub(crate) fn new(first: Vec<f64>, second: Vec<f64>) -> Self {
        let cells = vec![OnceCell::new(); (first.len() - 1) * (second.len() - 1)];
        let breaks = [first, second];
        Self { breaks, cells }
    }

    /// The breaks of both arguments.
    #[cfg(test)]
    pub(crate) const fn breaks(&self) -> &[Vec<f64>; 2] {
        &self.breaks
    }

    /// Returns the value of a function, 0 beyond the breaks.
    pub(crate) fn at(&self, x: [f64; 2], function: impl Fn(f64, f64) -> f64) -> f64 {
        let ends = |breaks: &[f64], at: usize| [breaks[at], breaks[at + 1]];
        let [first, second] = &self.breaks;
        self.at_nodes(x, |(i, k), (j, l)| {
            let x = at_place(ends(first, i), node::<SIDE>(k));
            function(x, at_place(ends(second, j), node::<SIDE>(l)))
        })
    }

    /// Interpolates from values that are given by panel and node of both arguments.
    pub(crate) fn at_nodes(
        &self,
        x: [f64; 2],
        value: impl Fn((usize, usize), (usize, usize)) -> f64,
    ) -> f64 {
        let [first, second] = &self.breaks;
        let (Some((i, u)), Some((j, v))) = (place(first, x[0]), place(second, x[1])) else {
            return 0.0;
        };
        let cell = self.cells[i * (second.len() - 1) + j]
            .get_or_init(|| fitted(|k, l| value((i, k), (j, l))));
        let [of_first, of_second] = [u, v].map(polynomials::<SIDE>);
        let row = |row: &[f64; SIDE]| row.iter().zip(of_second).map(|(c, t)| c * t).sum::<f64>();
        let rows = cell.iter().zip(of_first);
        rows.map(|(coefficients, t)| t * row(coefficients)).sum()
    }
}

/// Returns the coefficients of the polynomials for these values at the nodes of a cell.
fn fitted(value: impl Fn(usize, usize) -> f64) -> CellFit {
    let of_first: CellFit = from_fn(|l| coefficients(from_fn(|k| value(k, l))));
    from_fn(|m| coefficients(from_fn(|l| of_first[l][m])))
}
