/// The correlation of a line's position over columns, for each number of frames between.
#[derive(Clone, Debug, PartialEq)]
pub struct FrameCorrelation {
    /// Correlations by number of frames, then by columns, from −reach to reach.
    tables: Vec<Vec<f64>>,
}

impl FrameCorrelation {
    /// Keeps correlations: for each number of frames, the correlations of columns from −n to n
    /// apart.
    ///
    /// # Panics
    ///
    /// Panics unless each table has an odd length.
    pub fn new(tables: Vec<Vec<f64>>) -> Self {
        assert!(
            tables.iter().all(|table| table.len() % 2 == 1),
            "a table of columns from −n to n has an odd length"
        );
        Self { tables }
    }

    /// Returns the number of profiles of independent speckle that a mean over `frames` frames is
    /// worth: from 1 to their number.
    ///
    /// ```text
    /// N_eff = N² / Σ max(0, ρ(|a − b|))
    /// ```
    ///
    /// As in a [mean](crate::mean_point), no gain is counted from frames that err the
    /// opposite way.
    pub fn effective_frames(&self, frames: u32) -> f64 {
        let pairs = (1..frames).map(|later| {
            let pairs = f64::from(frames - later);
            2.0 * pairs * self.between(0, later).max(0.0)
        });
        let sum = f64::from(frames) * self.between(0, 0) + pairs.sum::<f64>();
        f64::from(frames) * f64::from(frames) / sum.max(1.0)
    }

    /// Returns the correlation of the positions in columns that lie `columns` apart, the second in
    /// the frame `later` frames after the first.
    pub fn between(&self, columns: i64, later: u32) -> f64 {
        let table = usize::try_from(later).ok().and_then(|n| self.tables.get(n));
        let Some(table) = table else { return 0.0 };
        let middle = i64::try_from(table.len() / 2).unwrap_or(i64::MAX);
        let index = usize::try_from(columns.saturating_add(middle)).ok();
        index.and_then(|i| table.get(i)).copied().unwrap_or(0.0)
    }
}
