//! Stacks as NumPy files.

use std::io::{self, Read, Write};

use num_complex::Complex;
use tem00_numerics::Grid;

use super::{
    CHUNK, NpyError, NpyReader, check_finite, element::Element, grid, header::Header,
    spline::SplineFilter, write_values,
};
use crate::{PupilField, SlicePath, SpeckleStack, StackOptions, complex::to_c64};

/// What the mean square of a slice may be: that of few Gaussian phasors strays from 1.
const BRIGHTNESS: core::ops::RangeInclusive<f64> = 0.1..=10.0;

impl SpeckleStack {
    /// Writes the amplitude at the samples of all slices as a NumPy file (NPY) of `complex64`, of the
    /// shape (slices, height, width).
    ///
    /// In NumPy `abs(array[i])**2` is the intensity of slice i, of mean 1: the pattern that
    /// [`PupilField::pattern_at`] has at this slice's [`offset`](Self::offset). The file does not say
    /// what pupil and path it was made with; [`write_to`](Self::write_to) does.
    ///
    /// # Errors
    ///
    /// Returns an error if the writer does.
    ///
    /// # Examples
    ///
    /// ```
    /// use tem00_speckle::{PupilField, SlicePath, SpeckleStack, StackOptions};
    ///
    /// let field = PupilField::new(64, 16, 7)?;
    /// let path = SlicePath::Circle { half_period: 2 };
    /// let stack = SpeckleStack::generate(&field, path)?;
    ///
    /// let mut file = Vec::new();
    /// stack.write_npy(&mut file)?;
    /// let options = StackOptions::default();
    /// let same = SpeckleStack::read_npy(file.as_slice(), &field, path, options)?;
    ///
    /// let [before, after] = [stack, same].map(|stack| stack.intensity_at(10.3, 7.9, 0.5));
    /// assert!((before - after).abs() < 1e-5);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn write_npy(&self, mut writer: impl Write) -> io::Result<()> {
        let [width, height] = self.size();
        let shape = [self.slice_count(), height, width];
        writer.write_all(&Header::bytes_of(Complex::<f32>::WRITTEN, &shape))?;
        let mut filter = SplineFilter::of(self.size(), self.interpolation());
        for slice in &self.slices {
            match &mut filter {
                None => write_values(&slice.coefficients, &mut writer)?,
                Some(filter) => {
                    let mut samples = slice.coefficients.clone();
                    filter.samples(&mut samples);
                    write_values(&samples, &mut writer)?;
                }
            }
        }
        writer.flush()
    }

    /// Reads the slices of a stack from a NumPy file of complex numbers of the shape (slices, height,
    /// width): one that [`write_npy`](Self::write_npy) has written, or that was computed elsewhere.
    ///
    /// `field` and `path` say what the slices are: seen through this pupil, along this path. The
    /// amplitude is taken as it is, centred on zero frequency and of a mean square near 1, as
    /// [`PupilField::speckle`] has it.
    ///
    /// Look-ups of the nearest sample and bilinear ones have the same bits as in the stack that was
    /// written. Those of the cubic spline agree to some 10⁻⁶ of the mean: the file holds the amplitude,
    /// and its coefficients are computed anew. A stack that was written with
    /// [`write_to`](Self::write_to) keeps its bits.
    ///
    /// # Errors
    ///
    /// Returns an error if the reader does, if the file is none of NumPy's or cut short, if its values
    /// are not complex and finite, if the shape is not that of `path` and `field`, if a slice is
    /// neither dark nor of a mean square between 0.1 and 10, if the path is not possible or if the
    /// memory is over the limit of `options` or refused.
    pub fn read_npy(
        reader: impl Read,
        field: &PupilField,
        path: SlicePath,
        options: StackOptions,
    ) -> Result<Self, NpyError> {
        path.check()?;
        let array = NpyReader::new(reader)?;
        let [width, height] = field.size();
        let needed = [path.slice_count(), height, width];
        if !needed.map(|side| side as u64).iter().eq(array.shape()) {
            let shape = array.header.shape;
            return Err(NpyError::Slices { shape, needed });
        }
        let mut slices = array.into_slices(needed, options.memory_limit)?;
        for (index, slice) in slices.iter().enumerate() {
            check_finite(slice, Some(index))?;
            check_brightness(slice, index)?;
        }
        if let Some(mut filter) = SplineFilter::of(field.size(), options.interpolation) {
            slices
                .iter_mut()
                .for_each(|slice| filter.coefficients(slice));
        }
        let field = path.close(field);
        Ok(Self::assemble(field, path, options.interpolation, slices))
    }
}

impl<R: Read> NpyReader<R> {
    /// The slices of an array of that shape.
    fn into_slices(
        mut self,
        [slices, height, width]: [usize; 3],
        memory_limit: u64,
    ) -> Result<Vec<Grid<Complex<f32>>>, NpyError> {
        let (bytes_each, decode) = self.decoder()?;
        let count = self.count_within::<Complex<f32>>(memory_limit)?;
        let area = height.saturating_mul(width);
        let mut buffer = vec![0; CHUNK];
        if !self.header.columns_first {
            let mut slice = |_| {
                let values = self.values(area, bytes_each, &decode, &mut buffer)?;
                grid(width, height, values)
            };
            return (0..slices).map(&mut slice).collect();
        }
        let values = self.values(count, bytes_each, &decode, &mut buffer)?;
        let slice =
            |i: usize| Grid::from_fn(width, height, |x, y| values[i + slices * (y + height * x)]);
        Ok((0..slices).map(slice).collect())
    }
}

fn check_brightness(slice: &Grid<Complex<f32>>, index: usize) -> Result<(), NpyError> {
    let square = |z: &Complex<f32>| to_c64(*z).norm_sqr();
    let sum: f64 = slice.values().iter().map(square).sum();
    let mean = sum / slice.values().len() as f64;
    // A pupil that sees nothing of a field from outside makes a dark slice.
    if sum > 0.0 && !BRIGHTNESS.contains(&mean) {
        return Err(NpyError::Brightness { slice: index, mean });
    }
    Ok(())
}
