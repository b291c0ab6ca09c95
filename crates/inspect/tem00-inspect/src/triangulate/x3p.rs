//! Height maps as X3P (ISO 25178-72): a ZIP archive of a description in XML and the heights in
//! metres.

use std::io::{self, Write};

use flate2::{Compression, write::DeflateEncoder};
use rawzip::{CompressionMethod, ZipArchiveWriter};
use tem00_numerics::Grid;

/// The squares of the part under the cells of a height map.
#[derive(Clone, Copy, Debug)]
pub(super) struct Lattice {
    /// The lower edges of the first cell along both axes, in metres.
    pub(super) origin: [f64; 2],
    /// The side of a cell, in metres.
    pub(super) pitch: f64,
}

/// Returns the archive of a surface, whose points are the middles of the cells; NaN is a point that
/// was not measured.
///
/// The optional record of dates and instruments is left out, so that the same map has the same
/// bytes.
pub(super) fn x3p(heights: &Grid<f32>, lattice: Lattice) -> io::Result<Vec<u8>> {
    let points: Vec<u8> = heights
        .values()
        .iter()
        .flat_map(|height| height.to_le_bytes())
        .collect();
    let size = [heights.width(), heights.height()];
    let description = description(size, lattice, &format!("{:x}", md5::compute(&points)));
    let checksum = format!("{:x} *main.xml\n", md5::compute(&description));
    archive([
        ("main.xml", description.as_bytes()),
        ("bindata/data.bin", &points),
        ("md5checksum.hex", checksum.as_bytes()),
    ])
    .map_err(io::Error::other)
}

/// Packs files by their names.
fn archive<const N: usize>(files: [(&str, &[u8]); N]) -> Result<Vec<u8>, rawzip::Error> {
    let mut packed = Vec::new();
    let mut archive = ZipArchiveWriter::new(&mut packed);
    for (name, content) in files {
        let file = archive.new_file(name);
        let (mut entry, config) = file
            .compression_method(CompressionMethod::DEFLATE)
            .start()?;
        let encoder = DeflateEncoder::new(&mut entry, Compression::default());
        let mut writer = config.wrap(encoder);
        writer.write_all(content)?;
        let (encoder, descriptor) = writer.finish()?;
        encoder.finish()?;
        entry.finish(descriptor)?;
    }
    archive.finish()?;
    Ok(packed)
}

/// The document `main.xml`.
fn description([columns, rows]: [usize; 2], lattice: Lattice, checksum: &str) -> String {
    let Lattice { origin, pitch } = lattice;
    let [x, y] = origin.map(|edge| edge + 0.5 * pitch);
    let axis = |kind: &str, number: &str, [increment, offset]: [f64; 2]| {
        format!(
            "<AxisType>{kind}</AxisType><DataType>{number}</DataType>\
             <Increment>{increment:e}</Increment><Offset>{offset:e}</Offset>"
        )
    };
    let [x, y] = [x, y].map(|offset| axis("I", "D", [pitch, offset]));
    let z = axis("A", "F", [1.0, 0.0]);
    format!(
        r#"<?xml version="1.0" encoding="UTF-8"?>
<p:ISO5436_2 xmlns:p="http://www.opengps.eu/2008/ISO5436_2">
  <Record1>
    <Revision>ISO5436 - 2000</Revision>
    <FeatureType>SUR</FeatureType>
    <Axes>
      <CX>{x}</CX>
      <CY>{y}</CY>
      <CZ>{z}</CZ>
    </Axes>
  </Record1>
  <Record3>
    <MatrixDimension><SizeX>{columns}</SizeX><SizeY>{rows}</SizeY><SizeZ>1</SizeZ></MatrixDimension>
    <DataLink>
      <PointDataLink>bindata/data.bin</PointDataLink>
      <MD5ChecksumPointData>{checksum}</MD5ChecksumPointData>
    </DataLink>
  </Record3>
  <Record4><ChecksumFile>md5checksum.hex</ChecksumFile></Record4>
</p:ISO5436_2>
"#
    )
}
