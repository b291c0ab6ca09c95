use tem00::wave::Estimate;

/// A contrast by waves beside that of the law.
pub(crate) struct Comparison {
    pub what: String,
    pub waves: Estimate,
    pub law: f64,
}

impl Comparison {
    fn deviation(&self) -> f64 {
        (self.waves.value / self.law - 1.0).abs()
    }

    /// The median of many deviations is below 1 %, and the worst below 3 %.
    pub(crate) fn assert_all(mut all: Vec<Self>) {
        all.sort_by(|a, b| a.deviation().total_cmp(&b.deviation()));
        let (median, worst) = (&all[all.len() / 2], &all[all.len() - 1]);
        assert!(
            median.deviation() < 0.01 && worst.deviation() < 0.03,
            "median {:.4}; worst: waves {:?}, law {:.4}, {}",
            median.deviation(),
            worst.waves,
            worst.law,
            worst.what
        );
    }
}
