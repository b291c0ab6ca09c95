//! The linewidth of a laser in reports.

use serde_json::json;
use tem00_triangulation::{BandwidthEffect, Setup};

use crate::report::{
    Cell,
    units::{NANOMETRES, NUMBER},
};

/// Returns what the linewidth does to speckle: which number counts for what.
pub(crate) fn bandwidth(setup: &Setup) -> Cell {
    let (light, effect) = (&setup.description().laser.light, setup.line().bandwidth);
    let data = json!({
        "linewidth": light.linewidth,
        "contrast_ratio": effect.contrast,
        "line_noise_ratio": effect.line_noise.sqrt(),
        "spot_noise_ratio": effect.spot_noise.sqrt(),
    });
    if effect == BandwidthEffect::NONE {
        return Cell::new(data, "none: light of one wavelength".to_owned());
    }
    let ratio = |value: f64| NUMBER.with_digits(3).text(value);
    let words = format!(
        "{}: it leaves {} of the noise of the line, which counts for the uncertainty, and {} of the contrast, which \
         counts for what is seen and for bright grains",
        NANOMETRES.text(light.linewidth),
        ratio(effect.line_noise.sqrt()),
        ratio(effect.contrast),
    );
    Cell::new(data, words)
}
