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
        let law = PathLaw {
            path: self,
            pupil: pupil.clone(),
        };
        let mut table = Vec::new();
        for slice in 0..=self.slice_count() / 2 {
            let here = slice as f64;
            let overlap = law.between(0.0, here);
            table.push([overlap, law.between(here, here + 1.0)].map(to_f32));
            if overlap <= 0.0 || self == Self::Still {
                break;
            }
        }
        Ok(table)
    }
}
