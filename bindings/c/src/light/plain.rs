use super::{Light, Placed};
use crate::{pointers::borrow, status::Status};

/// The kinds of lights, and the structs of `tem00_beam.h` whose fields they are.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum LightKind {
    /// `Tem00SpotLightF32`: a round or elliptic beam, 24 fields.
    Spot = 0,
    /// `Tem00LineLightF32`: a laser line, 28 fields.
    Line = 1,
    /// `Tem00LineLightF32` without its table, so that the closed forms leave it dark: 28 fields.
    TabulatedLine = 2,
}

/// A light as plain numbers in single precision: what a kernel that cannot call a library
/// evaluates.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LightData {
    /// Struct of `tem00_beam.h` or `tem00_beam.wgsl` that the fields belong to.
    pub kind: LightKind,
    /// Number of fields, 24 or 28.
    pub count: u32,
    /// The fields in the order of memory, then zeros.
    pub fields: [f32; 28],
}

impl LightData {
    fn new(light: &Light) -> Self {
        match &light.placed {
            Placed::Spot(light) => Self::of_rows(LightKind::Spot, &light.to_rows_f32()),
            Placed::Line(light) => Self::of_rows(LightKind::Line, &light.to_rows_f32()),
            Placed::Tabulated(light, _) => {
                Self::of_rows(LightKind::TabulatedLine, &light.to_rows_f32())
            }
        }
    }

    fn of_rows<const N: usize>(kind: LightKind, rows: &[[f32; 4]; N]) -> Self {
        let mut data = Self {
            kind,
            count: 0,
            fields: [0.0; 28],
        };
        for (field, value) in data.fields.iter_mut().zip(rows.as_flattened()) {
            *field = *value;
            data.count += 1;
        }
        data
    }
}

/// Copies a light as plain numbers in single precision, to be uploaded to a GPU or evaluated by
/// `tem00_beam.h`.
///
/// # Safety
///
/// The pointers are null or valid.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn tem00_light_plain_data(
    light: *const Light,
    data: *mut LightData,
) -> Status {
    answer!(light: borrow => data: LightData::new(light))
}
