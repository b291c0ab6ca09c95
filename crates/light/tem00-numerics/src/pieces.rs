/// The number of values in a piece.
const PIECE: usize = 1 << 14;

/// Returns `map(start, piece)` for every piece of 2¹⁴ values, in order; with the feature
/// `parallel`, the threads of the current rayon pool share the pieces.
///
/// The sum of the results has the same bits for any number of threads.
///
/// # Examples
///
/// ```
/// use tem00_numerics::map_pieces;
///
/// let values = vec![1.0_f32; 100_000];
/// let sums = map_pieces(&values, |_, piece| piece.iter().map(|&x| f64::from(x)).sum::<f64>());
/// assert_eq!(sums.len(), 7);
/// assert_eq!(sums.iter().sum::<f64>(), 100_000.0);
/// ```
pub fn map_pieces<T: Sync, R: Send>(values: &[T], map: impl Fn(usize, &[T]) -> R + Sync) -> Vec<R> {
    let map = |(index, piece)| map(index * PIECE, piece);
    #[cfg(feature = "parallel")]
    {
        use rayon::prelude::*;
        values.par_chunks(PIECE).enumerate().map(map).collect()
    }
    #[cfg(not(feature = "parallel"))]
    values.chunks(PIECE).enumerate().map(map).collect()
}
