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
#[derive(Clone, Debug)]
pub struct GpuPattern {
    gpu: Gpu,
    buffer: Buffer,
    size: [usize; 2],
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
        let aperture = field.aperture(offset, defocus);
        let size = field.size();
        let buffer = gpu.guarded(|| {
            let buffer = storage(gpu, "the pattern", 4 * (size[0] * size[1]) as u64)?;
            let transform = Transform::new(gpu, field, &aperture)?;
            transform.run(gpu, &aperture, Finish::Intensity, &buffer);
            Ok(buffer)
        })?;
        Ok(Self {
            gpu: gpu.clone(),
            buffer,
            size,
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
