//! The memory of the layers: asked for before it is used.

use tem00_numerics::available_memory;

use super::layout::FilmLayout;
use crate::TracerError;

/// The layers of each laser, and those that a frame has once.
const LAYERS_PER_LASER: u64 = 5;
const COMMON_LAYERS: u64 = 7;

/// The number of layers for the results of pilot samples: two, two for neighbours, and a quarter
/// for the levels that follow.
const PILOT_LAYERS: u64 = 5;

/// Layers of the light followed from one laser, before it is added to its own: four sums in double
/// precision.
const LIGHT_LAYERS: u64 = 8;

/// Checks that the layers fit into the memory that the system says is available (Linux).
///
/// Many systems grant any memory that is asked for and end the program when it is used.
pub(super) fn check(layout: &FilmLayout<'_>) -> Result<(), TracerError> {
    check_against(needed(layout), available_memory())
}

fn check_against(needed: u64, available: Option<u64>) -> Result<(), TracerError> {
    match available {
        Some(available) if needed > available => Err(TracerError::FilmMemory { needed, available }),
        _ => Ok(()),
    }
}

/// The bytes of all layers.
fn needed(layout: &FilmLayout<'_>) -> u64 {
    let pixels = (layout.area.width as u64).saturating_mul(layout.area.height as u64);
    let lasers = layout.wavelengths.len() as u64;
    let pilot = if layout.has_pilot { PILOT_LAYERS } else { 0 };
    let light = if layout.light_traced { LIGHT_LAYERS } else { 0 };
    let layers = LAYERS_PER_LASER * lasers + COMMON_LAYERS + pilot + light;
    pixels.saturating_mul(layers * size_of::<f32>() as u64)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Crop;

    #[test]
    fn fifty_lasers_on_a_megapixel_take_a_gigabyte() {
        let layout = FilmLayout {
            wavelengths: &[650e-9; 50],
            area: Crop {
                x: 0,
                y: 0,
                width: 1024,
                height: 1024,
            },
            strips: 1,
            has_pilot: false,
            light_traced: false,
        };
        // 50 · 5 + 7 layers of 4 MiB.
        assert_eq!(needed(&layout), 257 << 22, "bytes");
        let light_traced = FilmLayout {
            light_traced: true,
            ..layout
        };
        // One laser at a time: 32 bytes of sums.
        assert_eq!(needed(&light_traced), (257 << 22) + (32 << 20), "bytes");
    }

    #[test]
    fn more_than_what_is_available_is_refused() {
        let room = Some(20_001 * 1024);
        assert!(check_against(20_001 * 1024, room).is_ok(), "all of it");
        let error = check_against(20_001 * 1024 + 1, room).unwrap_err();
        assert_eq!(
            error.to_string(),
            "the layers of a frame need 20481025 bytes of memory, and 20481024 are available",
            "one byte more"
        );
        assert!(check_against(u64::MAX, None).is_ok(), "nothing is known");
    }
}
