//! The text of an inspection.

use glam::DVec3;
use tem00_engine::{LaserInspection, LightFate, LightPart};
use tem00_report::digits::rounded;
use tem00_tracer::{Crop, Scene};

/// The minimum fraction of a laser's power that is reported.
const TOLD: f64 = 0.01;

/// Says what the camera sees of a laser.
pub(super) fn seen(scene: &Scene, laser: usize, found: &LaserInspection) -> String {
    let seen: Vec<_> = (found.parts.iter())
        .filter(|part| part.fate == LightFate::Seen)
        .collect();
    let fraction: f64 = seen.iter().map(|part| part.fraction).sum();
    if seen.is_empty() {
        return format!(
            "laser {laser}: the camera sees its light in a mirror or through glass, {} of its \
             power",
            percent(found.fraction_in_image)
        );
    }
    let names = seen.iter().map(|part| name_of(scene, part.surface));
    format!(
        "laser {laser}: the camera sees {} of its light, on {}",
        percent(fraction),
        names.collect::<Vec<_>>().join(", ")
    )
}

/// Says why the camera sees no light of a laser, in `frame` if there are several.
pub(super) fn dark(
    scene: &Scene,
    laser: usize,
    frame: Option<u32>,
    found: &LaserInspection,
) -> Vec<String> {
    let frame = frame.map_or_else(String::new, |frame| format!(" in frame {frame}"));
    let mut lines = vec![format!(
        "laser {laser}: the camera sees no light of it{frame}:"
    )];
    let parts = found.parts.iter().filter(|part| part.fraction >= TOLD);
    lines.extend(parts.map(|part| format!("  {}", why(scene, part))));
    if found.fraction_of(LightFate::Misses) >= TOLD {
        lines.push("  the surfaces stand at".into());
        lines.extend(places(scene));
    }
    if let Some(part) = found.parts.iter().find(|part| is_beside(part.fate)) {
        lines.push(format!("  {}", shown(scene, part)));
    }
    lines
}

const fn is_beside(fate: LightFate) -> bool {
    matches!(fate, LightFate::OutsideImage | LightFate::BehindCamera)
}

fn why(scene: &Scene, part: &LightPart) -> String {
    let fraction = percent(part.fraction);
    let name = name_of(scene, part.surface);
    let place = millimetres(part.centre);
    let lit = format!("{fraction} lights {name} at {place}");
    match part.fate {
        LightFate::Misses => format!("{fraction} misses every surface: `look_at` aims the laser"),
        LightFate::MeetsBack => format!(
            "{fraction} meets the back of {name} at {place}, and {name} is one-sided: turn it \
             round, or leave out `one_sided`"
        ),
        LightFate::LightsFarSide => lit + " on the side away from the camera",
        LightFate::BehindCamera => lit + ", behind the camera",
        LightFate::OutsideImage => format!("{lit}, outside the image: {}", beside(scene, part)),
        LightFate::Hidden { by } if part.surface == Some(by) => {
            format!("{lit}, where {name} hides itself from the camera")
        }
        LightFate::Hidden { by } => {
            let other = name_of(scene, Some(by));
            format!("{lit}, which {other} hides from the camera")
        }
        _ => lit,
    }
}

/// Says on which pixel a spot falls, and which pixels the image has.
fn beside(scene: &Scene, part: &LightPart) -> String {
    let camera = &scene.camera;
    let [width, height] = [camera.width(), camera.height()];
    let image = match scene.render.crop {
        None => format!("the image has {width} × {height}"),
        Some(Crop {
            x,
            y,
            width,
            height,
        }) => {
            format!("{width} × {height} are rendered, from pixel ({x}, {y}) on")
        }
    };
    match part.pixel {
        Some(pixel) => format!("on pixel ({:.0}, {:.0}), and {image}", pixel.x, pixel.y),
        None => format!("on no pixel, and {image}"),
    }
}

/// Says what the image shows at the distance of a spot.
fn shown(scene: &Scene, part: &LightPart) -> String {
    let camera = &scene.camera;
    let description = camera.description();
    let depth = (camera.position() - part.centre).dot(camera.axes().z_axis);
    let distance = if depth > 0.0 {
        depth
    } else {
        description.focus_distance
    };
    let pitch = description.pixel_pitch * distance / camera.image_distance();
    let [width, height] =
        [camera.width(), camera.height()].map(|pixels| 1e3 * pitch * pixels as f64);
    let middle = camera.position() - distance * camera.axes().z_axis;
    format!(
        "at a distance of {:.1} mm the image shows {width:.1} × {height:.1} mm about {}: `look_at` \
         in [camera] aims it",
        1e3 * distance,
        millimetres(middle)
    )
}

/// Says where the surfaces stand.
fn places(scene: &Scene) -> impl Iterator<Item = String> {
    let span = |low: f64, high: f64| format!("{:.1} … {:.1} mm", 1e3 * low, 1e3 * high);
    scene.surfaces.iter().map(move |surface| {
        let (low, high) = surface.shape.bounds();
        format!(
            "    {}: x {}, y {}, z {}",
            surface.name,
            span(low.x, high.x),
            span(low.y, high.y),
            span(low.z, high.z)
        )
    })
}

fn name_of(scene: &Scene, surface: Option<usize>) -> String {
    let surface = surface.and_then(|index| scene.surfaces.get(index));
    surface.map_or_else(|| "a light".into(), |surface| format!("`{}`", surface.name))
}

fn percent(fraction: f64) -> String {
    format!("{} %", rounded(100.0 * fraction, 3))
}

fn millimetres(point: DVec3) -> String {
    // Rounding may leave a zero with a sign.
    let [x, y, z] = point.to_array().map(|x| (1e4 * x).round() / 10.0 + 0.0);
    format!("({x:.1}, {y:.1}, {z:.1}) mm")
}
