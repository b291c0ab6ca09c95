//! `tem00 list`: the names that scenes can use.

use std::io::Write;

use tem00_report::{
    digits::rounded,
    failure::Failure,
    report::{Cell, Column, Table},
};
use tem00_scene::MATERIALS;
use tem00_tracer::{FinishingProcess, Metal, TracerError};

use crate::args::{ListArgs, Listed};

/// Prints the requested list, with its sources.
///
/// # Errors
///
/// Returns a failure if a metal was not measured at the wavelength, or standard output cannot be
/// written.
pub(crate) fn run(args: &ListArgs, out: &mut impl Write) -> Result<(), Failure> {
    let (table, note) = match args.what {
        Listed::Metals => (metals(args.wavelength)?, METALS),
        Listed::Materials => (materials(), MATERIALS_NOTE),
        Listed::Surfaces => (surfaces(), SURFACES),
    };
    table
        .write_text(out)
        .and_then(|()| writeln!(out, "\n{note}"))
        .map_err(|error| Failure::stdout(&error))
}

const METALS: &str = "\
In a scene: conductor.metal = \"gold\", or mirror.metal = \"gold\". Reflectance at normal incidence, from n
and k, which were measured on clean, smooth surfaces, mostly films.";

fn metals(wavelength: f64) -> Result<Table, Failure> {
    let mut table = headed(["metal", "n", "k", "reflectance", "source"]);
    for (name, metal) in Metal::NAMED {
        let refused = |error: TracerError| Failure::input(error.to_string(), "--wavelength 650nm");
        let (n, k) = metal.refractive_index(wavelength).map_err(refused)?;
        let reflectance = metal.normal_reflectance(wavelength).map_err(refused)?;
        let [n, k, reflectance] = [n, k, reflectance].map(|x| rounded(x, 3));
        table.row(texts([name, &n, &k, &reflectance, metal.source()]));
    }
    Ok(table)
}

const MATERIALS_NOTE: &str = "\
In a scene: lambertian.reflectance = 0.5 in [[surface]]. docs/scene_file.md has ranges and \
defaults.";

fn materials() -> Table {
    let mut table = headed(["material", "keys", "what it is"]);
    for (name, keys) in MATERIALS {
        table.row(texts([name, &keys.join(", "), what_it_is(name)]));
    }
    table
}

fn what_it_is(material: &str) -> &'static str {
    match material {
        "lambertian" => "diffuse, as paper; what a surface is without a material",
        "oren_nayar" => "rough and diffuse, as plaster, clay or a sandblasted casting",
        "conductor" => "rough metal",
        "plastic" => "a diffuse base under a clear coat, as plastic, lacquer or glaze",
        "translucent" => "a body that lets light in, as plastic, ceramic, marble or skin",
        "mirror" => "a mirror, or polished metal; makes no speckle",
        "dielectric" => "clear glass; makes no speckle",
        _ => "",
    }
}

const SURFACES: &str = "\
In a scene: conductor.finish = \"milled steel\", a process and a metal: steel (which counts as iron, with
much the same reflectance) or one of `tem00 list metals`. It sets the metal and the rms height.

Ra is a typical range and no measurement: that of average application in the chart \"Surface Roughness
Produced by Common Production Methods\", Machinery's Handbook, 25th edition, p. 708, as calqlata.com and
meadinfo.org list its numbers. The rms height is that of Gaussian heights in the geometric middle, 1.253 Ra.
`roughness`, which makes the width of the lobe, does not follow from Ra: without it, it is 0.3. The lay that
a tool leaves is not modelled. Set-ups have no finish: their reflectance is that towards the camera, which Ra
and metal do not tell.";

fn surfaces() -> Table {
    let mut table = headed(["process", "Ra, typical (µm)", "rms height (µm)"]);
    for process in FinishingProcess::ALL {
        let [min, max] = process.mean_deviation.map(|ra| rounded(1e6 * ra, 3));
        let height = rounded(1e6 * process.rms_height(), 3);
        table.row(texts([process.name, &format!("{min} … {max}"), &height]));
    }
    table
}

/// Starts a table with the headings of its columns.
fn headed<const N: usize>(headings: [&str; N]) -> Table {
    Table::new("", headings.map(Column::shown))
}

fn texts<const N: usize>(cells: [&str; N]) -> [Cell; N] {
    cells.map(Cell::from)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn nothing_is_listed_without_words() {
        for (name, _) in MATERIALS {
            assert!(!what_it_is(name).is_empty(), "{name}");
        }
    }
}
