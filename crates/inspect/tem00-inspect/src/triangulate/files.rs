//! The files of a measurement.

use std::{
    fs,
    io::{self, Write},
    path::PathBuf,
};

use tem00_report::npy::write_real_npy;
use tem00_report::{
    failure::Failure,
    folder_lock::FolderLock,
    image::{GreyFrame, write_raw},
    output,
};
use tem00_scan::{
    HeightMap, MeasuredFrame, MeasuredPoint, QuantisedGrid, Raster, RawFormat, write_pcd, write_ply,
};
use tem00_triangulation::{DVec3, RawFrame};

use super::x3p::{Lattice, x3p};

/// The folder and the formats of the files of a measurement.
pub(super) struct Files {
    pub(super) folder: PathBuf,
    raw: RawFormat,
    _lock: FolderLock,
}

/// An image of a height map in 16 bits.
pub(super) struct MapImage {
    /// Its name, and the name of its file without the ending.
    pub(super) name: &'static str,
    /// The unit of its values.
    pub(super) unit: &'static str,
    pub(super) values: QuantisedGrid,
}

/// Returns the images of a map; none where it has only holes.
pub(super) fn images(map: &HeightMap) -> impl Iterator<Item = MapImage> {
    let grids = [
        ("height", "m", &map.heights),
        ("reflectance", "DN", &map.reflectances),
        ("width", "px", &map.widths),
    ];
    grids.into_iter().filter_map(|(name, unit, grid)| {
        let values = QuantisedGrid::new(grid)?;
        Some(MapImage { name, unit, values })
    })
}

/// The columns of a profile.
const HEADINGS: &str = "column,line,x_pixel,y_pixel,width_pixel,intensity_dn,validity,\
                        x_m,y_m,z_m,height_m,u_x_m,u_y_m,u_z_m,u_height_m,u_position_pixel,\
                        u_speckle_pixel,u_shot_pixel,u_dark_pixel,u_quantisation_pixel,\
                        u_prnu_pixel,u_dsnu_pixel,u_calibration_height_m,u_indirect_pixel,\
                        indirect_fraction";

impl Files {
    /// Checks, before the work starts, that files can be written.
    pub(super) fn new(folder: PathBuf, raw: RawFormat) -> Result<Self, Failure> {
        let lock = output::prepare(&folder)?;
        Ok(Self {
            folder,
            raw,
            _lock: lock,
        })
    }

    /// Returns the path of a file by its name.
    pub(super) fn path(&self, name: &str) -> PathBuf {
        self.folder.join(name)
    }

    /// Writes the frame of the camera and returns the name of the file.
    pub(super) fn write_raw(&self, frame: &MeasuredFrame, scene: &str) -> Result<String, Failure> {
        let name = format!("raw_{:04}.{}", frame.frame, self.extension());
        let text = [("Description", format!("{scene}, frame {}", frame.frame))];
        let path = self.path(&name);
        write_raw(&path, grey(&frame.raw), &text)
            .map_err(|error| Failure::writing(&path, error))?;
        Ok(name)
    }

    /// Writes the photographs of a board, in ordinary light and under the laser.
    pub(super) fn write_board(&self, number: usize, pair: &[RawFrame; 2]) -> Result<(), Failure> {
        let folder = output::subfolder(&self.folder, "boards")?;
        for (kind, frame) in ["board", "line"].iter().zip(pair) {
            let path = folder.join(format!("{kind}_{number:02}.{}", self.extension()));
            write_raw(&path, grey(frame), &[]).map_err(|error| Failure::writing(&path, error))?;
        }
        Ok(())
    }

    /// Writes each profile as a table.
    pub(super) fn write_profiles(
        &self,
        profiles: &[Vec<MeasuredPoint>],
        height: DVec3,
    ) -> Result<(), Failure> {
        for (number, profile) in profiles.iter().enumerate() {
            self.write(&format!("profile_{number:04}.csv"), |file| {
                writeln!(file, "{HEADINGS}")?;
                profile
                    .iter()
                    .try_for_each(|point| writeln!(file, "{}", row(point, height)))
            })?;
        }
        Ok(())
    }

    /// Writes the points of all profiles.
    pub(super) fn write_point_clouds(
        &self,
        profiles: &[Vec<MeasuredPoint>],
    ) -> Result<(), Failure> {
        self.write("points.ply", |file| write_ply(profiles, file))?;
        self.write("points.pcd", |file| write_pcd(profiles, file))
    }

    /// Writes a map: its heights and their uncertainties in metres, all its images in 16 bits, and
    /// a file of surface metrology where its cells have a size.
    ///
    /// If there is no map, or a map with only holes, the files of an earlier run are removed.
    pub(super) fn write_height_map(&self, map: Option<&HeightMap>) -> Result<(), Failure> {
        let names = ["height", "height_uncertainty", "reflectance", "width"];
        output::remove(&self.folder, &names, &["npy", "x3p", self.extension()])?;
        let Some(map) = map else {
            return Ok(());
        };
        for image in images(map) {
            self.write_image(&image)?;
        }
        if map.range().is_none() {
            return Ok(());
        }
        if let Raster::Part { origin, pitch } = map.raster {
            let archive = x3p(&map.heights, Lattice { origin, pitch });
            self.write("height.x3p", |file| file.write_all(&archive?))?;
        }
        self.write("height.npy", |file| write_real_npy(&map.heights, file))?;
        self.write("height_uncertainty.npy", |file| {
            write_real_npy(&map.uncertainties, file)
        })
    }

    fn write_image(&self, image: &MapImage) -> Result<(), Failure> {
        let QuantisedGrid {
            integers,
            offset,
            scale,
        } = &image.values;
        let MapImage { name, unit, .. } = image;
        let text = [
            ("offset", format!("{offset:e} {unit}")),
            ("scale", format!("{scale:e} {unit}")),
            (
                "Description",
                format!(
                    "{name} = offset + scale * value; 0 is a hole; the first row is the first \
                     profile"
                ),
            ),
        ];
        let path = self.path(&format!("{name}.{}", self.extension()));
        let picture = GreyFrame {
            values: integers,
            bit_depth: 16,
        };
        write_raw(&path, picture, &text).map_err(|error| Failure::writing(&path, error))
    }

    /// Returns the ending of raw frames and height maps.
    pub(super) const fn extension(&self) -> &'static str {
        match self.raw {
            RawFormat::Png => "png",
            RawFormat::Tiff => "tiff",
        }
    }

    fn write(
        &self,
        name: &str,
        write: impl FnOnce(&mut io::BufWriter<fs::File>) -> io::Result<()>,
    ) -> Result<(), Failure> {
        output::save(&self.path(name), write)
    }
}

/// Returns a row of a profile.
fn row(point: &MeasuredPoint, height: DVec3) -> String {
    let (seen, noise) = (&point.seen, &point.noise);
    let uncertainty = point.uncertainty();
    let lengths = point.position.to_array().into_iter();
    let lengths = lengths
        .chain([point.position.dot(height)])
        .chain(uncertainty.to_array())
        .chain([point.uncertainty_along(height)]);
    let places = [
        point.position_uncertainty().powi(2),
        noise.speckle,
        noise.shot,
        noise.dark,
        noise.quantisation,
        noise.prnu,
        noise.dsnu,
    ];
    let numbers: Vec<String> = lengths
        .map(|length| format!("{length:.9e}"))
        .chain(places.map(|variance| format!("{:.4e}", variance.sqrt())))
        .chain(
            [
                point.calibration_uncertainty_along(height),
                point.indirect.shift.abs(),
                point.indirect.fraction,
            ]
            .map(|number| format!("{number:.4e}")),
        )
        .collect();
    format!(
        "{},{},{:.4},{:.5},{:.4},{:.2},{},{}",
        seen.column,
        seen.line,
        seen.pixel.x,
        seen.pixel.y,
        seen.width,
        seen.reflectance,
        seen.validity.name(),
        numbers.join(",")
    )
}

/// Returns the ranges along the columns and rows of a map, in metres where they are lengths.
pub(super) fn ranges(map: &HeightMap) -> [(f64, f64); 2] {
    let [columns, rows] = [map.heights.width(), map.heights.height()].map(|cells| cells as f64);
    match map.raster {
        Raster::Image { columns: averaged } => [(0.0, columns * averaged as f64), (0.0, rows)],
        Raster::Part { origin, pitch } => {
            let end = |axis: usize, cells: f64| origin[axis] + cells * pitch;
            [(origin[0], end(0, columns)), (origin[1], end(1, rows))]
        }
    }
}

const fn grey(frame: &RawFrame) -> GreyFrame<'_> {
    GreyFrame {
        values: &frame.values,
        bit_depth: frame.bit_depth,
    }
}
