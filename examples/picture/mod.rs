//! Common to the examples: a picture in a file.

use std::{error::Error, fs, io::BufWriter, path::PathBuf};

use png::{BitDepth, ColorType, Encoder};
use tem00::numerics::Grid;

/// The intensity, in units of the mean, that is drawn as white. One sample of speckle in a hundred
/// is brighter and drawn as white, too.
const WHITE: f32 = 4.6;

/// Writes intensities to `out/<name>.png` and returns its path. More than one frame make a film of
/// ten frames per second, in PNG as well.
pub(crate) fn write(name: &str, frames: &[Grid<f32>]) -> Result<PathBuf, Box<dyn Error>> {
    let first = frames.first().ok_or("a picture has at least one frame")?;
    let [width, height] = [first.width(), first.height()];
    fs::create_dir_all("out")?;
    let path = PathBuf::from("out").join(name).with_extension("png");
    let file = BufWriter::new(fs::File::create(&path)?);

    let mut encoder = Encoder::new(file, u32::try_from(width)?, u32::try_from(height)?);
    encoder.set_color(ColorType::Grayscale);
    encoder.set_depth(BitDepth::Eight);
    if frames.len() > 1 {
        encoder.set_animated(u32::try_from(frames.len())?, 0)?;
        encoder.set_frame_delay(1, 10)?;
    }
    let mut writer = encoder.write_header()?;
    for frame in frames {
        writer.write_image_data(frame.map(|&i| grey(i)).values())?;
    }
    writer.finish()?;
    Ok(path)
}

/// A grey that screens show in proportion to the intensity, nearly.
#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "the grey lies between 0 and 255"
)]
fn grey(intensity: f32) -> u8 {
    let linear = (intensity / WHITE).clamp(0.0, 1.0);
    (255.0 * linear.powf(1.0 / 2.2)).round() as u8
}
