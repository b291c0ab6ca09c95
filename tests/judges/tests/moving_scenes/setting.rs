use tem00::{
    decorrelation::{
        CameraFrame, Configuration, ConfigurationData, DVec2, DVec3, Illumination, ImagingGeometry,
        LensData, SpeckleMotion,
    },
    numerics::Grid,
    statistics::pearson_correlation,
    tracer::Scene,
};

use crate::{renders, wave_judges_decorrelation::scene::States};

/// A plate at the origin that faces a camera 0.3 m away.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Setting {
    pub(crate) lens: LensData,
    /// The direction from the plate to the laser.
    pub(crate) to_laser: DVec3,
    /// The distance of the laser, which lights as a point source does, or `None` for plane waves.
    pub(crate) distance: Option<f64>,
}

/// A lens behind which a speckle spans 6.6 pixels, so that pixels hardly average over it.
pub(crate) const LENS: LensData = LensData {
    wavelength: 650e-9,
    focal_length: 25e-3,
    f_number: 8.0,
    surface_to_pupil: 0.3,
    pixel_pitch: 3.45e-6 / 4.0,
};

/// Where the camera stands.
pub(crate) const EYE: DVec3 = DVec3::new(0.0, 0.0, 0.3);

/// Columns and rows of the images.
pub(crate) const SIDE: usize = 256;

impl Setting {
    /// The scene with two frames, in which nothing moves.
    pub(crate) fn scene(&self) -> Scene {
        let LensData {
            wavelength,
            focal_length,
            f_number,
            surface_to_pupil,
            pixel_pitch,
        } = self.lens;
        let laser = self.to_laser.normalize() * self.distance.unwrap_or(0.2);
        // A spot as small as 2 µm lights as a point does; the waist of a wide one is plane.
        let spot = match self.distance {
            Some(_) => "waist_radius = \"2 um\", waist_distance = 0",
            None => "waist_radius = \"4 mm\"",
        };
        renders::scene(&format!(
            r#"
            [render]
            frames = 2
            [camera]
            position = [0, 0, 0.3]
            look_at = [0, 0, 0]
            focal_length = {focal_length}
            focus_distance = {surface_to_pupil}
            f_number = {f_number}
            pixel_pitch = {pixel_pitch}
            resolution = [{SIDE}, {SIDE}]

            [[laser]]
            wavelength = {wavelength}
            power = "1 mW"
            position = [{}, {}, {}]
            spot = {{ {spot} }}

            [[surface]]
            rectangle = {{ size = [0.04, 0.04] }}
            "#,
            laser.x, laser.y, laser.z
        ))
    }

    /// The scene with two frames, in which bodies move.
    pub(crate) fn moving(&self, states: &States) -> Scene {
        let mut scene = self.scene();
        scene.surfaces[0].trajectory = states.surface.trajectory();
        scene.camera_trajectory = states.camera.trajectory();
        let laser = scene.lasers[0].clone();
        scene.lasers[0] = laser.with_trajectory(states.source.trajectory());
        scene
    }

    pub(crate) fn geometry(&self) -> ImagingGeometry {
        ImagingGeometry::from_lens(self.lens).expect("a lens")
    }

    /// The law of finite motions for the point in the middle of the plate.
    pub(crate) fn law(&self, states: &States) -> SpeckleMotion {
        let illumination = match self.distance {
            Some(distance) => Illumination::point_source(self.to_laser.normalize() * distance),
            None => Illumination::collimated(self.to_laser),
        };
        let before = Configuration::new(ConfigurationData {
            wavelength: self.lens.wavelength,
            point: DVec3::ZERO,
            normal: DVec3::Z,
            illumination: illumination.expect("a light"),
            camera: CameraFrame::look_at(EYE, DVec3::ZERO, DVec3::Y).expect("a camera"),
            pupil: EYE,
        });
        let before = before.expect("a point before the camera");
        let after = before
            .moved(&states.motions())
            .expect("a point before the camera");
        SpeckleMotion::between(&self.geometry(), &before, &after)
    }
}

/// The speckle layers of some frames of a scene.
pub(crate) fn speckle(scene: &Scene, frames: &[u32], seed: u64) -> Vec<Grid<f32>> {
    let (options, model) = (renders::options(4, seed), renders::speckle(scene, seed));
    let render = |&frame: &u32| {
        let mut rendered = renders::frame(scene, Some(&model), frame, &options);
        rendered.lasers.remove(0).speckle
    };
    frames.iter().map(render).collect()
}

/// The correlation of two frames where the surface has moved by so many pixels to the right and up.
pub(crate) fn correlation([before, after]: [&Grid<f32>; 2], [right, up]: [i32; 2]) -> f64 {
    let pixels = |way: i32| usize::try_from(way.max(0)).expect("few pixels");
    let size = [right, up].map(|way| SIDE - pixels(way.abs()));
    // Rows count downwards.
    let before = part(before, [pixels(-right), pixels(up)], size);
    let after = part(after, [pixels(right), pixels(-up)], size);
    pearson_correlation(&before, &after).expect("bright frames")
}

/// Asserts that two frames correlate as expected where the surface has moved by so many pixels,
/// with speckles of `size` pixels.
#[track_caller]
pub(crate) fn assert_correlation(
    name: &str,
    frames: [&Grid<f32>; 2],
    way: [i32; 2],
    (expected, size): (f64, f64),
) {
    let found = correlation(frames, way);
    let [width, height] = way.map(|way| SIDE as f64 - f64::from(way.abs()));
    let allowed = tolerance(width * height, size);
    let is_close = (found - expected).abs() < allowed;
    assert!(is_close, "{name}: {found} | {expected} ± {allowed}");
}

/// A part of an image.
pub(crate) fn part(
    image: &Grid<f32>,
    [x0, y0]: [usize; 2],
    [width, height]: [usize; 2],
) -> Grid<f32> {
    Grid::from_fn(width, height, |x, y| image[(x0 + x, y0 + y)])
}

/// The displacement in speckles, with y up.
pub(crate) fn in_speckles(pixels: DVec2, geometry: &ImagingGeometry) -> DVec2 {
    DVec2::new(pixels.x, -pixels.y) / geometry.speckle_size_in_pixels()
}

/// Four standard errors of the correlation of two images of `area` pixels with speckles of `size`
/// pixels.
///
/// The variance is 0.585 h²/A for independent patterns of the area A. For correlated ones it is of
/// the same size, at most 1.5² times as large (found for γ = 0.5, where it is largest).
pub(crate) fn tolerance(area: f64, size: f64) -> f64 {
    4.0 * 1.5 * 0.585_f64.sqrt() * size / area.sqrt()
}
