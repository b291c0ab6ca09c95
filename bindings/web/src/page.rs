//! Interface for JavaScript in a browser.

use core::fmt::Display;

use js_sys::Promise;
use tem00_gpu::Gpu;
use wasm_bindgen::prelude::{JsError, JsValue, wasm_bindgen};
use wasm_bindgen_futures::{JsFuture, future_to_promise};
use web_sys::HtmlCanvasElement;
use wgpu::{
    CommandEncoderDescriptor, DeviceDescriptor, Instance, InstanceDescriptor, MapMode,
    RequestAdapterOptions, Surface, SurfaceTarget, TextureViewDescriptor,
};

use crate::{
    Passes,
    measure::{self, SAMPLES},
    optics::{self, SENSOR},
    scene,
    settings::{self, Changes, Values},
    speckle::Speckle,
};

/// Returns all settings as JSON: name, label, min, max, start and choices of each.
#[wasm_bindgen]
pub fn settings() -> String {
    settings::as_json()
}

/// A canvas, what it shows, and the card that draws it.
#[wasm_bindgen]
#[derive(Debug)]
pub struct Page {
    gpu: Gpu,
    surface: Surface<'static>,
    passes: Passes,
    values: Values,
    /// Parts to rebuild for the next picture.
    changed: Changes,
    /// Samples along a side of a pixel of the film.
    samples: u32,
    speckle: Speckle,
}

#[wasm_bindgen]
impl Page {
    /// Opens a graphics adapter and draws on `canvas` from now on.
    ///
    /// # Errors
    ///
    /// Returns an error if there is no adapter, or it cannot draw there.
    pub async fn open(canvas: HtmlCanvasElement) -> Result<Self, JsError> {
        let instance = Instance::new(InstanceDescriptor::new_without_display_handle());
        let surface = instance.create_surface(SurfaceTarget::Canvas(canvas))?;
        let options = RequestAdapterOptions {
            compatible_surface: Some(&surface),
            ..RequestAdapterOptions::default()
        };
        let adapter = instance.request_adapter(&options).await;
        let adapter = adapter.map_err(|_| JsError::new("it finds no graphics adapter"))?;
        let device = DeviceDescriptor::default();
        let (device, queue) = adapter.request_device(&device).await?;
        device.on_uncaptured_error(std::sync::Arc::new(|error| {
            web_sys::console::error_1(&error.to_string().into());
        }));
        let gpu = Gpu::of(device, queue, adapter.get_info().name);
        let [width, height] = SENSOR;
        let config = surface
            .get_default_config(&adapter, width, height)
            .ok_or_else(|| JsError::new("the adapter cannot draw on a canvas"))?;
        surface.configure(gpu.device(), &config);

        let values = Values::default();
        let passes = Passes::new(&gpu, config.format);
        let speckle = Speckle::new(&gpu, &values).map_err(refused)?;
        Ok(Self {
            gpu,
            surface,
            passes,
            values,
            changed: Changes::Frame,
            samples: 0,
            speckle,
        })
    }

    /// Sets a value, in the unit of its label.
    ///
    /// # Errors
    ///
    /// Returns an error if there is no such setting, or the value is not in its range.
    pub fn set(&mut self, name: &str, value: f64) -> Result<(), JsError> {
        let changes = self.values.set(name, value).map_err(refused)?;
        self.changed = self.changed.max(changes);
        Ok(())
    }

    /// Draws what has changed: at once, with one sample a pixel, or finely, as it is measured.
    ///
    /// # Errors
    ///
    /// Returns an error if the settings make no light, camera or speckle, or if the card fails.
    pub fn draw(&mut self, fine: bool) -> Result<(), JsError> {
        if self.changed == Changes::Stack || !self.speckle.suffices(&self.values) {
            self.speckle = Speckle::new(&self.gpu, &self.values).map_err(refused)?;
        }
        let samples = if fine { SAMPLES } else { 1 };
        let rows = scene::rows(&self.values, &self.speckle, samples).map_err(refused)?;
        self.passes.show(&self.gpu, &rows);
        let mut encoder = self.encoder();
        if self.changed >= Changes::Frame || samples != self.samples {
            self.passes.expose(&mut encoder, &self.speckle);
        }
        let canvas = match self.surface.get_current_texture() {
            wgpu::CurrentSurfaceTexture::Success(canvas) => canvas,
            // Naming the state would bring the names of all formats of textures.
            _ => return Err(JsError::new("the canvas takes no picture now")),
        };
        let screen = canvas
            .texture
            .create_view(&TextureViewDescriptor::default());
        self.passes.project(&mut encoder, &screen);
        self.gpu.queue().submit([encoder.finish()]);
        self.gpu.queue().present(canvas);
        (self.changed, self.samples) = (Changes::View, samples);
        Ok(())
    }

    /// Promises that the card has drawn all that it was told to.
    pub fn drawn(&self) -> Promise {
        let queue = self.gpu.queue();
        Promise::new(&mut |resolve, _| {
            // A promise that is resolved twice does no harm, and no other failure is possible.
            queue.on_submitted_work_done(move || drop(resolve.call0(&JsValue::NULL)));
        })
    }

    /// Promises what is measured in the picture: a `Measured`, or `undefined` where too few pixels
    /// are lit.
    pub fn measure(&self) -> Promise {
        let film = self.film(None);
        let size = optics::geometry(&self.values).map(|geometry| geometry.speckle_size_in_pixels());
        future_to_promise(async move {
            let film = read(film).await?;
            let found = measure::measure(&film, SENSOR[0] as usize, size.map_err(refused)?);
            Ok(found.map_or(JsValue::UNDEFINED, JsValue::from))
        })
    }

    /// Promises how far the picture is from one whose stack the library has made: the root of the
    /// mean square and the largest of the differences of the speckle of lit pixels.
    ///
    /// # Errors
    ///
    /// Returns an error if the stack cannot be made.
    pub fn compare(&self) -> Result<Promise, JsError> {
        let by_library = Speckle::of_library(&self.gpu, &self.values).map_err(refused)?;
        let films = [self.film(Some(&self.speckle)), self.film(Some(&by_library))];
        Ok(future_to_promise(async move {
            let [card, library] = films;
            let found = measure::difference(&read(card).await?, &read(library).await?);
            Ok(js_sys::Array::from_iter(found.map(JsValue::from)).into())
        }))
    }
}

impl Page {
    fn encoder(&self) -> wgpu::CommandEncoder {
        let device = self.gpu.device();
        device.create_command_encoder(&CommandEncoderDescriptor::default())
    }

    /// A copy of the film, of another exposure with this speckle if there is one.
    fn film(&self, speckle: Option<&Speckle>) -> wgpu::Buffer {
        let mut encoder = self.encoder();
        if let Some(speckle) = speckle {
            self.passes.expose(&mut encoder, speckle);
        }
        let buffer = self.passes.copy(&self.gpu, &mut encoder);
        self.gpu.queue().submit([encoder.finish()]);
        buffer
    }
}

/// Waits for a copy of the film.
async fn read(film: wgpu::Buffer) -> Result<Vec<[f32; 4]>, JsValue> {
    let mapped = Promise::new(&mut |resolve, reject| {
        film.map_async(MapMode::Read, .., move |result| {
            let answer = match result {
                Ok(()) => resolve.call0(&JsValue::NULL),
                Err(error) => reject.call1(&JsValue::NULL, &refused(error).into()),
            };
            // Neither of the two can fail.
            drop(answer);
        });
    });
    JsFuture::from(mapped).await?;
    let bytes = film.get_mapped_range(..).map_err(refused)?;
    Ok(bytemuck::pod_collect_to_vec(&bytes[..]))
}

fn refused(error: impl Display) -> JsError {
    JsError::new(&error.to_string())
}
