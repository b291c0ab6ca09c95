use glam::DVec2;

/// A rectangle: in the image in perspective, in pixels with y down, or in the pupil.
#[derive(Clone, Copy, Debug)]
pub(in crate::speckle) struct Region {
    pub low: DVec2,
    pub high: DVec2,
}

impl Region {
    pub(super) const NONE: Self = Self {
        low: DVec2::INFINITY,
        high: DVec2::NEG_INFINITY,
    };

    pub(super) const fn of(point: DVec2) -> Self {
        Self {
            low: point,
            high: point,
        }
    }

    /// Returns the smallest and the largest component along a unit vector.
    pub(in crate::speckle) fn along(&self, axis: DVec2) -> [f64; 2] {
        let middle = self.middle().dot(axis);
        let half = 0.5 * self.size().dot(axis.abs());
        [middle - half, middle + half]
    }

    pub(in crate::speckle) fn middle(&self) -> DVec2 {
        0.5 * (self.low + self.high)
    }

    pub(super) fn joined(self, other: Self) -> Self {
        Self {
            low: self.low.min(other.low),
            high: self.high.max(other.high),
        }
    }

    pub(in crate::speckle) fn size(&self) -> DVec2 {
        self.high - self.low
    }
}
