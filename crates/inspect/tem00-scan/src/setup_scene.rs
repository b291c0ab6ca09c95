use glam::DVec3;
use tem00_beam::{FanGeometry, FocusCurve, LineProfile};
use tem00_geometry::{Rectangle, Shape};
use tem00_tracer::{BeamShape, Laser, LaserDescription, Material, Scene, Surface, TracerError};
use tem00_triangulation::{Setup, TriangulationError};

use crate::ScanError;

/// Returns the scene of a set-up with a flat plate at a height, in metres.
///
/// The laser stands straight above the line, as far from it as the camera; its line is of uniform
/// power along it and has its waist on the reference plane.
///
/// # Errors
///
/// Returns an error if the set-up has no scene: its line is longer than any fan is wide.
pub fn setup_scene(setup: &Setup, height: f64) -> Result<Scene, ScanError> {
    let half = setup
        .description()
        .laser
        .line_length
        .max(setup.field_width());
    let plate = Rectangle::new(height * DVec3::Z, half * DVec3::X, half * DVec3::Y)?;
    let reflectance = setup.description().surface.reflectance;
    let material = Material::lambertian(reflectance)?;
    let mut surface = Surface::new("plate", Shape::Rectangle(plate), material);
    surface.relief = setup.description().surface.relief;
    Ok(Scene {
        lasers: vec![laser(setup)?],
        surfaces: vec![surface],
        ..Scene::new(*setup.camera())
    })
}

fn laser(setup: &Setup) -> Result<Laser, ScanError> {
    let description = setup.description();
    let data = &description.laser;
    let light = &data.light;
    let spectrum = light.spectrum().map_err(TriangulationError::from)?;
    let extent = light.extent().map_err(TriangulationError::from)?;
    let distance = description.camera.distance;
    let position = description.laser_point_at(distance).with_z(distance);
    let look_at = description.laser_point_at(0.0);
    let focus_distance = position.distance(look_at);
    let half_fan = libm::atan(0.5 * data.line_length / distance);
    let laser = Laser::new(LaserDescription {
        spectrum,
        power: data.power,
        position,
        look_at,
        line_direction: DVec3::X,
        shape: BeamShape::Line {
            waist_radius: 0.5 * data.line_thickness,
            m_squared: 1.0,
            fan: FanGeometry {
                fan_angle: 2.0 * half_fan,
                // A lens that receives a round beam fans it out from a point where it would be this
                // wide.
                apex_offset: description.line_beam()?.radius_at(focus_distance) / half_fan.tan(),
                focus_distance,
                focus_curve: FocusCurve::default(),
            },
            profile: LineProfile::UniformTan,
        },
    });
    let laser = laser.map_err(TracerError::from)?;
    Ok(laser.with_source_extent(extent))
}
