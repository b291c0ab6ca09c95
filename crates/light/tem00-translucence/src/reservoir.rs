/// One of many items, drawn in proportion to their weights by a single uniform number.
#[derive(Clone, Debug, Default)]
pub(crate) struct Reservoir<I> {
    /// The item that is drawn so far, and the weight of all.
    pub(crate) item: I,
    pub(crate) weight: f64,
    uniform: f64,
}

impl<I: Default> Reservoir<I> {
    pub(crate) fn new(uniform: f64) -> Self {
        Self {
            uniform,
            ..Self::default()
        }
    }

    pub(crate) fn add(&mut self, item: I, weight: f64) {
        if weight <= 0.0 {
            return;
        }
        self.weight += weight;
        // One number serves all choices: the remainder is uniform again.
        let chance = weight / self.weight;
        if self.uniform < chance {
            self.uniform /= chance;
            self.item = item;
        } else {
            self.uniform = (self.uniform - chance) / (1.0 - chance);
        }
    }
}
