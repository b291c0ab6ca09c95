use tem00_numerics::cast::to_signed;

use crate::{
    Aperture, PupilField, SliceLaw, SlicePath, SpeckleError, StackOptions,
    interpolation::spline::prefilters,
    stack::{check_limit, join_all},
};

/// Source of the slices of a stack with their closed forms, for stacks that are generated
/// elsewhere, as on a graphics card.
///
/// # Examples
///
/// ```
/// use tem00_speckle::{PupilField, SlicePath, SpeckleStack, StackOptions, StackSource};
///
/// let (field, path) = (PupilField::new(64, 16, 7)?, SlicePath::Circle { half_period: 4 });
/// let source = StackSource::new(&field, path, StackOptions::default())?;
/// let stack = SpeckleStack::generate(&field, path)?;
///
/// assert_eq!(source.laws()[3], stack.slice_law(3));
/// assert_eq!(source.slice(0).start(), [0, -8]); // half a diameter on, half a diameter back
/// # Ok::<(), tem00_speckle::SpeckleError>(())
/// ```
#[derive(Clone, Debug)]
pub struct StackSource {
    field: PupilField,
    path: SlicePath,
    filters: [Vec<f32>; 2],
}

impl StackSource {
    /// Prepares the slices of `field` along `path`.
    ///
    /// # Errors
    ///
    /// Returns an error if the half period or the length of `path` is out of range, or if the
    /// slices take more than the memory limit.
    pub fn new(
        field: &PupilField,
        path: SlicePath,
        options: StackOptions,
    ) -> Result<Self, SpeckleError> {
        path.check()?;
        check_limit(path.memory_bytes(field.size()), options.memory_limit)?;
        let field = path.close(field);
        let filters = prefilters(&field);
        Ok(Self {
            field,
            path,
            filters,
        })
    }

    /// Returns the field from which the slices are cut. For a straight path the field closes on
    /// itself after the length of the path.
    pub const fn field(&self) -> &PupilField {
        &self.field
    }

    pub(crate) fn into_field(self) -> PupilField {
        self.field
    }

    /// Returns the path of the pupil.
    pub const fn path(&self) -> SlicePath {
        self.path
    }

    /// Returns the aperture of slice `index`, prefiltered for the interpolation: the amplitudes of
    /// its transform are the coefficients of the stack.
    pub fn slice(&self, index: usize) -> Aperture<'_> {
        let centre = self.path.centre(to_signed(index), &self.field);
        self.field.aperture_of_point(centre, Some(&self.filters))
    }

    /// Returns the closed forms of all slices and of their joins.
    pub fn laws(&self) -> Vec<SliceLaw> {
        let slices = vec![(); self.path.slice_count()];
        let (slices, _) = join_all(&self.field, self.path, slices);
        slices.iter().map(SliceLaw::of).collect()
    }
}
