//! Light that has met several rough surfaces, and what its speckle has in common with the speckle
//! of light that has met one.

mod cell_grid;
mod light;
mod sums;

use std::collections::BTreeMap;

use glam::DVec2;

pub(crate) use self::{
    cell_grid::CellGrid,
    light::MultipleLight,
    sums::{MultiplePath, MultipleSums},
};

/// The key of light: the laser and the surface.
pub(crate) type LightKey = (usize, usize);

/// The fraction of the brightest light of a laser below which light is faint.
const FAINT: f64 = 0.02;

/// The multiple light over the image, on a grid of cells.
#[derive(Clone, Debug)]
pub(crate) struct MultipleMap {
    layers: BTreeMap<LightKey, MultipleLayer>,
}

/// The multiple light of a laser on a surface.
#[derive(Clone, Debug)]
pub(crate) struct MultipleLayer {
    grid: CellGrid,
    /// The light that was found in cells, and for each cell the index of its light in this list.
    lights: Vec<MultipleLight>,
    cells: Vec<Option<u32>>,
    /// The mean over the image.
    overall: MultipleLight,
    /// The radiance below which light is faint compared with the brightest light of the laser, in
    /// W/(m² sr).
    pub(super) faint: f64,
}

/// The weight of the image-wide mean when a cell is smoothed, in cells; it matters only where
/// neighbouring cells have found almost nothing.
const PART_OF_ALL: f64 = 0.1;

impl MultipleMap {
    /// Smooths the sums of the cells, row by row.
    pub(crate) fn new(grid: CellGrid, sums: &[BTreeMap<LightKey, MultipleSums>]) -> Option<Self> {
        let mut all = BTreeMap::<LightKey, MultipleSums>::new();
        for (key, sums) in sums.iter().flatten() {
            let total = all.entry(*key);
            total
                .or_insert_with(|| MultipleSums::new(sums.point))
                .add_scaled(sums, 1.0);
        }
        let mut layers: BTreeMap<_, _> = all
            .iter()
            .filter_map(|(key, total)| {
                let of_key = |cell: usize| sums[cell].get(key);
                Some((*key, MultipleLayer::new(grid, total, of_key)?))
            })
            .collect();
        let brightest = brightest(&layers);
        for ((laser, _), layer) in &mut layers {
            layer.faint = FAINT * brightest[laser];
        }
        (!layers.is_empty()).then_some(Self { layers })
    }

    /// Returns the light of the cells that is not faint.
    pub(super) fn bright(&self) -> impl Iterator<Item = (LightKey, &MultipleLight)> {
        let layers = self.layers.iter();
        layers.flat_map(|(key, layer)| {
            let lights = layer.lights.iter();
            let bright = lights.filter(|light| light.radiance + light.single > layer.faint);
            bright.map(|light| (*key, light))
        })
    }

    /// Returns the light of a laser on a surface; nothing where none was found.
    pub(crate) fn layer(&self, key: LightKey) -> Option<&MultipleLayer> {
        self.layers.get(&key)
    }

    /// Returns, for each laser and surface, the greatest squared contrast that the speckle of the
    /// lit surfaces adds where the light is not faint.
    pub(crate) fn strongest_cascades(&self) -> BTreeMap<LightKey, f64> {
        let mut strongest = BTreeMap::new();
        for (key, light) in self.bright() {
            let fraction = light.fraction_beside(light.single);
            let added = 2.0 * fraction * fraction * light.cascade;
            let max: &mut f64 = strongest.entry(key).or_default();
            *max = max.max(added);
        }
        strongest
    }
}

/// The greatest radiance of each laser.
fn brightest(layers: &BTreeMap<LightKey, MultipleLayer>) -> BTreeMap<usize, f64> {
    let mut brightest = BTreeMap::new();
    for ((laser, _), layer) in layers {
        let radiances = layer.lights.iter();
        let max: &mut f64 = brightest.entry(*laser).or_default();
        *max = radiances.fold(*max, |max, light| max.max(light.radiance + light.single));
    }
    brightest
}

impl MultipleLayer {
    fn new<'s>(
        grid: CellGrid,
        total: &MultipleSums,
        sums: impl Fn(usize) -> Option<&'s MultipleSums>,
    ) -> Option<Self> {
        let mut lights = Vec::new();
        let cells = (0..grid.columns * grid.rows).map(|index| {
            let own = sums(index)?;
            let mut mean = MultipleSums::new(own.point);
            for other in grid.neighbours(index).filter_map(&sums) {
                mean.add_scaled(other, 1.0);
            }
            mean.add_scaled(total, PART_OF_ALL * own.samples / total.samples);
            lights.push(mean.light()?);
            u32::try_from(lights.len() - 1).ok()
        });
        let cells = cells.collect();
        Some(Self {
            grid,
            cells,
            lights,
            overall: total.light()?,
            faint: 0.0,
        })
    }

    /// Returns the light at an image point, in pixels.
    pub(crate) fn at(&self, pixel: DVec2) -> MultipleLight {
        let mut mean: Option<(MultipleLight, f64)> = None;
        for (cell, weight) in self.grid.around(pixel) {
            let Some(light) = self.cells[cell].map(|index| &self.lights[index as usize]) else {
                continue;
            };
            mean = Some(match mean {
                None => (*light, weight),
                Some((sum, total)) => (sum.mixed(light, weight / (total + weight)), total + weight),
            });
        }
        mean.map_or(self.overall, |(light, _)| light)
    }
}
