use std::io::{self, Write};

use tem00_numerics::cast::to_f32;

use crate::frame::MeasuredPoint;

/// The single-precision properties of a point, after its coordinates.
const PROPERTIES: [&str; 5] = ["sigma_x", "sigma_y", "sigma_z", "sigma", "intensity"];

/// Writes the valid points of profiles as a binary PLY file.
///
/// Each vertex has its coordinates `x`, `y`, `z` in metres (`double`), the standard uncertainties
/// of these, `sigma_x`, `sigma_y`, `sigma_z`, the standard uncertainty along the trace of the line
/// of sight in the laser plane, `sigma`, all in metres, the grey values of the line, summed,
/// `intensity`, and the `frame` as the index of its profile.
///
/// # Errors
///
/// Returns the errors of `out`.
pub fn write_ply(profiles: &[Vec<MeasuredPoint>], out: &mut impl Write) -> io::Result<()> {
    writeln!(out, "ply\nformat binary_little_endian 1.0")?;
    writeln!(
        out,
        "comment coordinates and standard uncertainties in metres"
    )?;
    writeln!(out, "element vertex {}", points(profiles).count())?;
    for name in ["x", "y", "z"] {
        writeln!(out, "property double {name}")?;
    }
    for name in PROPERTIES {
        writeln!(out, "property float {name}")?;
    }
    writeln!(out, "property int frame\nend_header")?;
    points(profiles).try_for_each(|(frame, point)| {
        let coordinates = point.position.to_array().map(f64::to_le_bytes);
        out.write_all(coordinates.as_flattened())?;
        write_properties(frame, point, out)
    })
}

/// Writes the valid points of profiles as a binary PCD file, version 0.7.
///
/// The fields are the same as in [`write_ply`], but coordinates are in single precision: they are
/// rounded by up to 6e-8 of their value. The Point Cloud Library reads no others.
///
/// # Errors
///
/// Returns the errors of `out`.
pub fn write_pcd(profiles: &[Vec<MeasuredPoint>], out: &mut impl Write) -> io::Result<()> {
    let count = points(profiles).count();
    writeln!(
        out,
        "# .PCD v0.7 - coordinates and standard uncertainties in metres\n\
         VERSION 0.7\n\
         FIELDS x y z {} frame\n\
         SIZE 4 4 4 4 4 4 4 4 4\n\
         TYPE F F F F F F F F I\n\
         COUNT 1 1 1 1 1 1 1 1 1\n\
         WIDTH {count}\n\
         HEIGHT 1\n\
         VIEWPOINT 0 0 0 1 0 0 0\n\
         POINTS {count}\n\
         DATA binary",
        PROPERTIES.join(" ")
    )?;
    points(profiles).try_for_each(|(frame, point)| {
        let coordinates = point.position.to_array();
        let coordinates = coordinates.map(|length| to_f32(length).to_le_bytes());
        out.write_all(coordinates.as_flattened())?;
        write_properties(frame, point, out)
    })
}

/// The valid points, each with the index of its profile.
fn points(profiles: &[Vec<MeasuredPoint>]) -> impl Iterator<Item = (i32, &MeasuredPoint)> {
    let numbered = profiles.iter().zip(0_i32..);
    numbered
        .flat_map(|(profile, frame)| profile.iter().map(move |point| (frame, point)))
        .filter(|(_, point)| point.is_valid())
}

/// Writes what follows the coordinates of a point.
fn write_properties(frame: i32, point: &MeasuredPoint, out: &mut impl Write) -> io::Result<()> {
    let [x, y, z] = point.uncertainty().to_array();
    let along = point.position_uncertainty() * point.per_pixel.length();
    let properties: [f64; PROPERTIES.len()] = [x, y, z, along, point.seen.reflectance];
    out.write_all(
        properties
            .map(|value| to_f32(value).to_le_bytes())
            .as_flattened(),
    )?;
    out.write_all(&frame.to_le_bytes())
}
