use tem00_numerics::cast::to_f32;

use super::path::PathLaw;
use crate::{Pupil, SlicePath, SpeckleError};

impl SlicePath {
    /// Returns the overlaps of the pupils of each slice with slice 0 and with the next slice, up to the
    /// first slice that has none with slice 0.
    ///
    /// A kernel turns them and a correlation into a coordinate u, as
    /// [`SpeckleStack::coordinate_of`](crate::SpeckleStack::coordinate_of) does.
    ///
    /// # Errors
    ///
    /// Returns an error where [`check`](Self::check) or [`Pupil::check`] does.
    ///
    /// # Examples
    ///
    /// ```
    /// use tem00_speckle::{Pupil, SlicePath};
    ///
    /// let path = SlicePath::Straight { half_period: 6, length: 3 };
    /// let overlaps = path.overlaps(&Pupil::Circle)?;
    /// // Slices are a quarter of the pupil apart, and the fourth has left it.
    /// assert_eq!(overlaps.len(), 5);
    /// assert_eq!(overlaps[1][0], overlaps[0][1]);
    /// assert_eq!(overlaps[4][0], 0.0);
    /// # Ok::<(), tem00_speckle::SpeckleError>(())
    /// ```
    pub fn overlaps(self, pupil: &Pupil) -> Result<Vec<[f32; 2]>, SpeckleError> {
        self.check()?;
        pupil.check()?;
        let law = PathLaw::new(self, pupil);
        let slices = &law.overlaps()[..=self.slice_count() / 2];
        let last = slices
            .iter()
            .position(|[first, _]| self == Self::Still || *first <= 0.0);
        let table = slices[..=last.unwrap_or(slices.len() - 1)].iter();
        Ok(table.map(|overlaps| overlaps.map(to_f32)).collect())
    }
}
