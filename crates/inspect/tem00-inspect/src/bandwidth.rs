//! The linewidth of a laser and the extent of its source in reports.

use serde_json::json;
use tem00_report::report::{
    Cell,
    units::{MILLIRADIANS, NANOMETRES, NUMBER},
};
use tem00_triangulation::{BandwidthEffect, Setup};

/// Returns the effect of linewidth and extent on speckle, and which number applies to what.
pub(crate) fn bandwidth(setup: &Setup) -> Cell {
    let (light, effect) = (&setup.description().laser.light, setup.line().bandwidth);
    let data = json!({
        "linewidth": light.linewidth,
        "source_half_angle": light.source_half_angle,
        "contrast_ratio": effect.contrast,
        "line_noise_ratio": effect.line_noise_ratio,
        "spot_noise_ratio": effect.spot_noise_ratio,
    });
    if effect == BandwidthEffect::NONE {
        return Cell::new(
            data,
            "none: light of one wavelength from a point".to_owned(),
        );
    }
    let ratio = |value: f64| NUMBER.with_digits(3).text(value);
    let source = match (light.linewidth > 0.0, light.source_half_angle > 0.0) {
        (_, false) => NANOMETRES.text(light.linewidth),
        (false, true) => MILLIRADIANS.text(light.source_half_angle),
        (true, true) => format!(
            "{} and {}",
            NANOMETRES.text(light.linewidth),
            MILLIRADIANS.text(light.source_half_angle)
        ),
    };
    let words = format!(
        "{source}: line noise × {} (enters the uncertainty), speckle contrast × {} (enters \
         saturation)",
        ratio(effect.line_noise_ratio),
        ratio(effect.contrast),
    );
    Cell::new(data, words)
}
