use core::fmt;

use tem00_speckle::PupilField;
use wgpu::Buffer;

use crate::{
    Gpu, GpuError,
    kernel::{download, storage},
    transform::{Finish, Transform},
};

/// A speckle pattern on the card: intensity with mean 1 on W × H samples, row after row, periodic
/// in both axes.
///
/// It is the [`pattern_at`](PupilField::pattern_at) of the library from the same seed, to the
/// rounding of `f32`.
///
/// # Examples
///
/// ```no_run
/// use tem00_gpu::{Gpu, GpuPattern};
/// use tem00_speckle::PupilField;
///
/// let gpu = Gpu::new()?;
/// let field = PupilField::new(1024, 512, 7)?;
/// let pattern = GpuPattern::generate(&gpu, &field, [0.25, 0.0], 0.0)?;
/// let values = pattern.values()?;
/// assert_eq!(values.len(), 1024 * 1024);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone)]
pub struct GpuPattern {
    gpu: Gpu,
    buffer: Buffer,
    size: [usize; 2],
    transform: Transform,
}

impl fmt::Debug for GpuPattern {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("GpuPattern")
            .field("gpu", &self.gpu.name())
            .field("size", &self.size)
            .finish_non_exhaustive()
    }
}

impl GpuPattern {
    /// Generates the intensity behind the pupil displaced by `offset` diameters and out of focus by
    /// `defocus`.
    ///
    /// # Errors
    ///
    /// Returns an error if a side of the pattern has a prime factor above 5, if it is too large for
    /// a buffer of the device, or if the device fails.
    ///
    /// # Panics
    ///
    /// Panics unless `offset` and `defocus` are finite.
    pub fn generate(
        gpu: &Gpu,
        field: &PupilField,
        offset: [f64; 2],
        defocus: f64,
    ) -> Result<Self, GpuError> {
        let size = field.size();
        gpu.guarded(|| {
            let buffer = storage(gpu, "the pattern", 4 * (size[0] * size[1]) as u64)?;
            let aperture = field.aperture(offset, defocus);
            let transform = Transform::new(gpu, field, &aperture)?;
            transform.run(gpu, [(aperture, Finish::Intensity)], &buffer);
            Ok(Self {
                gpu: gpu.clone(),
                buffer,
                size,
                transform,
            })
        })
    }

    /// Generates another pattern in the same buffer and, where the pupil fills the same box, with
    /// the same memory for the transform. A field of another size gets a buffer of its own.
    ///
    /// # Errors
    ///
    /// As [`generate`](Self::generate).
    ///
    /// # Panics
    ///
    /// Panics unless `offset` and `defocus` are finite.
    pub fn refill(
        &mut self,
        field: &PupilField,
        offset: [f64; 2],
        defocus: f64,
    ) -> Result<(), GpuError> {
        if field.size() != self.size {
            *self = Self::generate(&self.gpu, field, offset, defocus)?;
            return Ok(());
        }
        let gpu = &self.gpu;
        gpu.guarded(|| {
            let aperture = field.aperture(offset, defocus);
            self.transform.renew(gpu, field, &aperture)?;
            let last = [(aperture, Finish::Intensity)];
            self.transform.run(gpu, last, &self.buffer);
            Ok(())
        })
    }

    /// Returns the width and the height, which are the periods, in samples.
    pub const fn size(&self) -> [usize; 2] {
        self.size
    }

    /// Returns the storage buffer of the intensities, one `f32` each.
    pub const fn buffer(&self) -> &Buffer {
        &self.buffer
    }

    /// Copies the intensities from the device.
    ///
    /// # Errors
    ///
    /// Returns an error if the device fails.
    pub fn values(&self) -> Result<Vec<f32>, GpuError> {
        let bytes = 4 * (self.size[0] * self.size[1]) as u64;
        self.gpu
            .guarded(|| download(&self.gpu, &self.buffer, bytes))
    }
}
