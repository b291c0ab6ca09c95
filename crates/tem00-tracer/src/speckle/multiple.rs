//! Light that has met several rough surfaces: what its speckle has in common with that of the light which has met one.

use std::collections::BTreeMap;

use glam::{DVec2, DVec3};
use tem00_coherence::{DelayedLight, PathPairs, SpectralLine};
use tem00_decorrelation::{ImagingGeometry, equivalent_pupil_shift, pupil_overlap_correlation};
use tem00_numerics::cast::to_usize;

use super::{
    SpecklePoint,
    change::{Change, SpeckleShift},
};

/// Light at a place of the image that has met several rough surfaces.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct MultipleLight {
    /// The mean radiance, in W/(m² sr).
    pub radiance: f64,
    /// That of the light which has met one rough surface.
    pub single: f64,
    /// The mutual coherence in the line of the laser: with itself, and with the single light.
    pub within: f64,
    pub with_single: f64,
    /// What the motion since the reference frame leaves of its fields, squared, but for the displacement of the pupil:
    /// of its own, and of the product with that of the single light.
    pub kept: f64,
    pub kept_with_single: f64,
    /// The degree of polarisation.
    pub polarisation: f64,
    /// The relative variance over a resolution cell of the speckle that the lit surfaces send there.
    pub cascade: f64,
    /// A point where it is seen.
    pub point: SpecklePoint,
}

/// Sums over pairs of light paths to a place of the image.
#[derive(Clone, Copy, Debug)]
pub(crate) struct MultipleSums {
    samples: f64,
    radiance: f64,
    /// Σ E².
    squares: f64,
    single: f64,
    polarised: f64,
    paths: PathPairs,
    /// Σ E E' cos k(δ − δ') and Σ E E' over pairs of paths whose lengths have changed by δ.
    kept: [f64; 2],
    /// Σ E cos k(δ − δ₁), with the change δ₁ of the single light.
    kept_with_single: f64,
    /// Σ E E' chat² of the displacement of the pupil between the directions of two paths.
    cascade: f64,
    point: SpecklePoint,
}

/// A path over several rough surfaces.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct MultiplePath {
    /// In W/(m² sr).
    pub radiance: f64,
    /// The optical path beyond that of the single light, in metres, and what motion has added to it.
    pub delay: f64,
    pub added: f64,
    pub polarisation: f64,
    /// Where in the pupil a change of the direction from which it arrives moves the field, in pupil diameters.
    pub pupil: DVec3,
}

impl MultipleSums {
    fn new(point: SpecklePoint) -> Self {
        Self {
            samples: 0.0,
            radiance: 0.0,
            squares: 0.0,
            single: 0.0,
            polarised: 0.0,
            paths: PathPairs::default(),
            kept: [0.0; 2],
            kept_with_single: 0.0,
            cascade: 0.0,
            point,
        }
    }

    /// Sums over the pairs of two independent groups, of so many paths each, to a point that has the radiance `single` of
    /// light which has met its surface only.
    pub(crate) fn of_groups(
        line: &SpectralLine,
        (point, single): (SpecklePoint, f64),
        groups: [&[MultiplePath]; 2],
        paths: usize,
    ) -> Self {
        let samples = 2.0 * paths as f64;
        let mut sums = Self {
            samples,
            single: samples * single,
            ..Self::new(point)
        };
        let delayed = groups.map(|group| -> Vec<_> {
            let delayed = |path: &MultiplePath| DelayedLight {
                weight: path.radiance,
                delay: path.delay,
            };
            group.iter().map(delayed).collect()
        });
        let [first, second] = &delayed;
        sums.paths.add(line, first, second);
        sums.paths.add(line, second, first);
        let phase = |path: f64| (line.wave_number() * path).cos();
        for path in groups.into_iter().flatten() {
            sums.radiance += path.radiance;
            sums.squares += path.radiance * path.radiance;
            sums.polarised += path.radiance * path.polarisation;
            sums.kept_with_single += path.radiance * phase(path.added);
        }
        for path in groups[0] {
            for other in groups[1] {
                let energy = path.radiance * other.radiance;
                sums.kept[0] += energy * phase(path.added - other.added);
                sums.kept[1] += energy;
                let shift = path.pupil.distance(other.pupil);
                sums.cascade += energy * pupil_overlap_correlation(shift);
            }
        }
        sums
    }

    /// Returns the number of paths of equal light that would tell as much.
    pub(crate) fn effective_paths(&self) -> f64 {
        if self.squares > 0.0 {
            self.radiance * self.radiance / self.squares
        } else {
            0.0
        }
    }

    fn add_scaled(&mut self, other: &Self, factor: f64) {
        self.samples += factor * other.samples;
        self.radiance += factor * other.radiance;
        self.single += factor * other.single;
        self.polarised += factor * other.polarised;
        self.paths.add_scaled(&other.paths, factor);
        for (sum, value) in self.kept.iter_mut().zip(other.kept) {
            *sum += factor * value;
        }
        self.kept_with_single += factor * other.kept_with_single;
        self.cascade += factor * other.cascade;
    }

    /// Returns what the sums say of the light, if there is any.
    fn light(&self) -> Option<MultipleLight> {
        let ratio = |part: f64, whole: f64| (whole > 0.0).then(|| part / whole);
        Some(MultipleLight {
            radiance: ratio(self.radiance, self.samples)?,
            single: ratio(self.single, self.samples)?,
            within: self.paths.self_coherence()?.clamp(0.0, 1.0),
            with_single: self.paths.coherence_with_single()?.clamp(0.0, 1.0),
            // Of few pairs the means may lie beyond.
            kept: ratio(self.kept[0], self.kept[1])?.clamp(0.0, 1.0),
            kept_with_single: ratio(self.kept_with_single, self.radiance)?.clamp(-1.0, 1.0),
            polarisation: ratio(self.polarised, self.radiance)?.clamp(0.0, 1.0),
            cascade: ratio(self.cascade, self.kept[1])?,
            point: self.point,
        })
    }
}

/// The laser and the surface whose light is meant.
pub(crate) type LightKey = (usize, usize);

/// The part of the brightest light of a laser below which light is faint.
const FAINT: f64 = 0.02;

/// The multiple light over the image, on a lattice of cells.
#[derive(Clone, Debug)]
pub(crate) struct MultipleMap {
    layers: BTreeMap<LightKey, MultipleLayer>,
}

/// The multiple light of a laser on a surface.
#[derive(Clone, Debug)]
pub(crate) struct MultipleLayer {
    lattice: Lattice,
    /// The light that was found in cells, and for each cell its number among it.
    lights: Vec<MultipleLight>,
    cells: Vec<Option<u32>>,
    /// The mean over the image.
    overall: MultipleLight,
    /// The radiance below which light is faint beside the brightest of the laser, in W/(m² sr).
    pub(super) faint: f64,
}

/// Square cells over an image.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Lattice {
    pub columns: usize,
    pub rows: usize,
    /// The side of a cell, in pixels.
    pub side: usize,
}

/// The reach of the mean over neighbouring cells, and the part that the mean over the whole image has in it, in cells:
/// what decides only where the neighbourhood has found next to nothing.
const NEIGHBOURS: usize = 2;
const PART_OF_ALL: f64 = 0.1;

impl MultipleMap {
    /// Smooths the sums of the cells, row by row.
    pub(crate) fn new(lattice: Lattice, sums: &[BTreeMap<LightKey, MultipleSums>]) -> Option<Self> {
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
                Some((*key, MultipleLayer::new(lattice, total, of_key)?))
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

    /// Returns, for each laser and surface, the greatest squared contrast that the speckle of the lit surfaces adds where
    /// the light is not faint.
    pub(crate) fn strongest_cascades(&self) -> BTreeMap<LightKey, f64> {
        let mut strongest = BTreeMap::new();
        for (key, light) in self.bright() {
            let fraction = light.fraction_beside(light.single);
            let added = 2.0 * fraction * fraction * light.cascade;
            let most: &mut f64 = strongest.entry(key).or_default();
            *most = most.max(added);
        }
        strongest
    }
}

/// The greatest radiance of each laser.
fn brightest(layers: &BTreeMap<LightKey, MultipleLayer>) -> BTreeMap<usize, f64> {
    let mut brightest = BTreeMap::new();
    for ((laser, _), layer) in layers {
        let radiances = layer.lights.iter();
        let most: &mut f64 = brightest.entry(*laser).or_default();
        *most = radiances.fold(*most, |most, light| most.max(light.radiance + light.single));
    }
    brightest
}

impl MultipleLayer {
    fn new<'s>(
        lattice: Lattice,
        total: &MultipleSums,
        sums: impl Fn(usize) -> Option<&'s MultipleSums>,
    ) -> Option<Self> {
        let mut lights = Vec::new();
        let cells = (0..lattice.columns * lattice.rows).map(|index| {
            let own = sums(index)?;
            let mut mean = MultipleSums::new(own.point);
            for other in lattice.neighbours(index).filter_map(&sums) {
                mean.add_scaled(other, 1.0);
            }
            mean.add_scaled(total, PART_OF_ALL * own.samples / total.samples);
            lights.push(mean.light()?);
            u32::try_from(lights.len() - 1).ok()
        });
        let cells = cells.collect();
        Some(Self {
            lattice,
            cells,
            lights,
            overall: total.light()?,
            faint: 0.0,
        })
    }

    /// Returns the light at an image point, in pixels.
    pub(crate) fn at(&self, pixel: DVec2) -> MultipleLight {
        let mut mean: Option<(MultipleLight, f64)> = None;
        for (cell, weight) in self.lattice.around(pixel) {
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

impl MultipleLight {
    /// Returns what has become of the speckle of single and multiple light together, of which this is the given
    /// `fraction`, at a point.
    ///
    /// ```text
    /// γ = |f₁ chat(s₁) + f₂ chat(s₂) ⟨e^{ik(δ − δ₁)}⟩|²
    /// ```
    ///
    /// s₁ is the displacement of the pupil over the speckle of the single light; s₂ that without the source, which other
    /// surfaces take the place of: their paths change by δ, over which the mean is taken.
    pub(super) fn shift(
        &self,
        change: &Change,
        (laser, geometry): (usize, &ImagingGeometry),
        point: &SpecklePoint,
        fraction: f64,
    ) -> SpeckleShift {
        let single = change.speckle_shift(laser, geometry, point);
        if change.is_reference() {
            return single;
        }
        let Some(multiple) = change.shift_without_source(laser, geometry, point) else {
            return single;
        };
        let [f1, f2] = [1.0 - fraction, fraction];
        let [c1, c2] = [single, multiple].map(|shift| pupil_overlap_correlation(shift.pupil));
        let cross = 2.0 * f1 * f2 * (c1 * c2).sqrt() * self.kept_with_single;
        let correlation = f1 * f1 * c1 + cross + f2 * f2 * c2 * self.kept;
        let pupil = equivalent_pupil_shift(correlation.clamp(0.0, 1.0));
        SpeckleShift {
            displacement: f1 * single.displacement + f2 * multiple.displacement,
            pupil: if pupil < 1.0 {
                pupil
            } else {
                pupil.max(f1 * single.pupil + f2 * multiple.pupil)
            },
        }
    }

    /// Tells whether it makes one pattern with single light of this degree of polarisation.
    pub(super) fn is_coherent(&self, polarisation: f64) -> bool {
        let is_same_state = (self.polarisation - polarisation).abs() < 1e-9;
        self.within >= 1.0 && self.with_single >= 1.0 && is_same_state
    }

    /// Returns the fraction of the multiple light beside single light of a radiance.
    pub(super) fn fraction_beside(&self, single: f64) -> f64 {
        let all = self.radiance + single;
        if all > 0.0 { self.radiance / all } else { 0.0 }
    }

    /// The mean of two, with the fraction of the other.
    fn mixed(&self, other: &Self, fraction: f64) -> Self {
        let mean = |a: f64, b: f64| a + fraction * (b - a);
        Self {
            radiance: mean(self.radiance, other.radiance),
            single: mean(self.single, other.single),
            within: mean(self.within, other.within),
            with_single: mean(self.with_single, other.with_single),
            kept: mean(self.kept, other.kept),
            kept_with_single: mean(self.kept_with_single, other.kept_with_single),
            polarisation: mean(self.polarisation, other.polarisation),
            cascade: mean(self.cascade, other.cascade),
            point: self.point,
        }
    }
}

impl Lattice {
    /// Divides an image into at most so many cells along its longer side.
    pub(crate) fn over([width, height]: [usize; 2], cells: usize) -> Self {
        const MIN_SIDE: usize = 4;
        let side = width.max(height).div_ceil(cells).max(MIN_SIDE);
        Self {
            columns: width.div_ceil(side),
            rows: height.div_ceil(side),
            side,
        }
    }

    /// The cells about one, itself among them.
    fn neighbours(self, index: usize) -> impl Iterator<Item = usize> {
        let (row, column) = (index / self.columns, index % self.columns);
        let around = |middle: usize, count: usize| {
            middle.saturating_sub(NEIGHBOURS)..count.min(middle + NEIGHBOURS + 1)
        };
        let columns = around(column, self.columns);
        around(row, self.rows).flat_map(move |row| {
            columns
                .clone()
                .map(move |column| row * self.columns + column)
        })
    }

    /// The four cells whose middles surround an image point, with the weights of bilinear interpolation.
    fn around(self, pixel: DVec2) -> impl Iterator<Item = (usize, f64)> {
        let axis = |position: f64, count: usize| {
            let last = (count - 1) as f64;
            let position = (position / self.side as f64 - 0.5).clamp(0.0, last);
            let first = to_usize(position).min(count.saturating_sub(2));
            let fraction = position - first as f64;
            [
                (first, 1.0 - fraction),
                ((first + 1).min(count - 1), fraction),
            ]
        };
        let columns = axis(pixel.x, self.columns);
        axis(pixel.y, self.rows)
            .into_iter()
            .flat_map(move |(row, v)| {
                columns.map(|(column, u)| (row * self.columns + column, u * v))
            })
            .filter(|(_, weight)| *weight > 0.0)
    }
}
