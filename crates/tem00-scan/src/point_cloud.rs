use std::io::{self, Write};

use tem00_numerics::cast::to_f32;

use crate::frame::MeasuredPoint;

/// Writes the valid points of profiles as a binary PLY file.
///
/// Each vertex has its coordinates `x`, `y`, `z` in metres, the standard uncertainties of these, `sigma_x`,
/// `sigma_y`, `sigma_z`, the standard uncertainty along the trace of the line of sight in the laser plane,
/// `sigma`, all in metres, the grey values of the line, summed, `intensity`, and the `frame` as the index
/// of its profile.
///
/// # Errors
///
/// Returns the errors of `out`.
pub fn write_point_cloud(profiles: &[Vec<MeasuredPoint>], out: &mut impl Write) -> io::Result<()> {
    let points = || {
        let numbered = profiles.iter().zip(0_i32..);
        numbered
            .flat_map(|(profile, frame)| profile.iter().map(move |point| (frame, point)))
            .filter(|(_, point)| point.is_valid())
    };
    writeln!(out, "ply\nformat binary_little_endian 1.0")?;
    writeln!(
        out,
        "comment coordinates and standard uncertainties in metres"
    )?;
    writeln!(out, "element vertex {}", points().count())?;
    for name in ["x", "y", "z"] {
        writeln!(out, "property double {name}")?;
    }
    for name in ["sigma_x", "sigma_y", "sigma_z", "sigma", "intensity"] {
        writeln!(out, "property float {name}")?;
    }
    writeln!(out, "property int frame\nend_header")?;
    points().try_for_each(|(frame, point)| write_vertex(frame, point, out))
}

fn write_vertex(frame: i32, point: &MeasuredPoint, out: &mut impl Write) -> io::Result<()> {
    for coordinate in point.position.to_array() {
        out.write_all(&coordinate.to_le_bytes())?;
    }
    let [x, y, z] = point.uncertainty().to_array();
    let along = point.noise.total().sqrt() * point.per_pixel.length();
    for value in [x, y, z, along, point.seen.reflectance] {
        out.write_all(&to_f32(value).to_le_bytes())?;
    }
    out.write_all(&frame.to_le_bytes())
}
