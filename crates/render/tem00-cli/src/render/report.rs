//! The notes of a render on standard error.

use tem00_engine::RoughnessNote;
use tem00_report::{colour::xyz_of_wavelength, output::note};
use tem00_tracer::{LaserEvents, Scene};

use crate::summary::FrameSummary;

/// Warns about lasers of invisible light.
pub(super) fn note_invisible_lasers(scene: &Scene) {
    for (index, laser) in scene.lasers.iter().enumerate() {
        if xyz_of_wavelength(laser.wavelength()).is_none() {
            note(&format!(
                "preview: laser {index}: light of {:.1} nm is invisible and shown in grey",
                1e9 * laser.wavelength()
            ));
        }
    }
}

/// Warns about surfaces that are too smooth for the theory of speckle; of many, it names the first
/// few.
pub(super) fn note_roughness(notes: &[RoughnessNote]) {
    const TOLD: usize = 8;
    for line in notes.iter().take(TOLD) {
        note(&format!("speckle: {line}"));
    }
    if notes.len() > TOLD {
        note(&format!("speckle: and so are {} more", notes.len() - TOLD));
    }
}

/// Warns about light that neither method finds.
pub(super) fn note_missing_light(scene: &Scene) {
    if scene.has_specular_surfaces() && scene.render.laser_events == LaserEvents::Beam {
        note(
            "mirrors and glass: laser light that meets them both before and behind a rough surface \
             is left out; laser_events = \"sampled\" finds it, with more noise",
        );
    }
}

/// Returns the power and the contrast of each laser in each frame, in words.
pub(super) fn of_frames(frames: &[FrameSummary]) -> Vec<String> {
    let mut lines = Vec::new();
    for frame in frames {
        for (index, laser) in frame.lasers.iter().enumerate() {
            let ratio = 100.0 * laser.power_ratio;
            let error = laser.power_ratio_error;
            let error = error.map_or(String::new(), |error| format!(" ± {:.2}", 100.0 * error));
            let watts = laser.power_on_target;
            let found = if watts > 0.0 {
                format!("{watts:.4e} W on target, {ratio:.2}{error} % of its power")
            } else {
                "no light on target".into()
            };
            lines.push(format!("{}: laser {index}: {found}", frame.preview));
            lines.extend(laser.contrast.map(|contrast| {
                format!(
                    "{}: laser {index}: speckle contrast {:.3} ± {:.3}, expected {:.3}",
                    frame.preview, contrast.measured, contrast.standard_error, contrast.expected
                )
            }));
        }
    }
    lines
}
