//! The record of a finished frame, which lets a later run skip the frame.

use std::{
    collections::HashSet,
    fmt::{self, Debug},
    fs,
    io::{self, Read, Write},
    path::{Path, PathBuf},
    sync::Arc,
};

use serde::{Deserialize, Serialize};
use tem00_config::{MAX_TEXT_BYTES, open_input, read_input};
use tem00_geometry::{Shape, TriangleMesh};
use tem00_report::{failure::Failure, output};
use tem00_tracer::Scene;

use crate::summary::{Exposure, FrameSummary};

/// A number that distinguishes renders: it changes with the scene, with each file that belongs to
/// it, with the choices on the command line and with the version of the program.
///
/// It is the 64-bit FNV-1a hash of all of these. Two renders share it by chance once in 10¹⁹ pairs.
#[derive(Clone, Debug, Deserialize, PartialEq, Eq, Serialize)]
pub(super) struct Fingerprint(String);

impl Fingerprint {
    /// Takes the fingerprint of a render of a scene, read from `files`, with `choices`.
    pub(super) fn of(
        scene: &Scene,
        files: &[PathBuf],
        choices: &impl Debug,
    ) -> Result<Self, Failure> {
        let mut hash = Fnv::default();
        hash.add(concat!("tem00 ", env!("CARGO_PKG_VERSION")).as_bytes());
        hash.add(format!("{choices:?}").as_bytes());
        for path in files {
            hash.add_file(path).map_err(|error| {
                Failure::running(format!("cannot read {}: {error}", path.display()))
            })?;
        }
        // Mesh files can name further files, which are missing from the list of files.
        let mut known = HashSet::new();
        for mesh in meshes(scene) {
            if known.insert(Arc::as_ptr(mesh)) {
                hash.add_mesh(mesh);
            }
        }
        Ok(Self(hash.text()))
    }
}

/// Returns the hash of the bytes of a file and of their number.
pub(super) fn hash_of_file(path: &Path) -> io::Result<String> {
    let mut hash = Fnv::default();
    hash.add_file(path)?;
    Ok(hash.text())
}

fn meshes(scene: &Scene) -> impl Iterator<Item = &Arc<TriangleMesh>> {
    scene
        .surfaces
        .iter()
        .filter_map(|surface| match &surface.shape {
            Shape::Mesh(instance) => Some(instance.mesh()),
            _ => None,
        })
}

/// Fowler, Noll and Vo's hash, variant 1a, of 64 bits.
struct Fnv(u64);

impl Default for Fnv {
    fn default() -> Self {
        Self(0xcbf2_9ce4_8422_2325)
    }
}

impl Fnv {
    fn bytes(&mut self, bytes: &[u8]) {
        for &byte in bytes {
            self.0 = (self.0 ^ u64::from(byte)).wrapping_mul(0x0100_0000_01b3);
        }
    }

    /// Adds bytes and their number, which separates them from the bytes that follow.
    fn add(&mut self, bytes: &[u8]) {
        self.bytes(bytes);
        self.bytes(&(bytes.len() as u64).to_le_bytes());
    }

    fn text(&self) -> String {
        format!("{:016x}", self.0)
    }

    fn add_mesh(&mut self, mesh: &TriangleMesh) {
        for vector in mesh.vertices().iter().chain(mesh.normals()) {
            for component in vector.to_array() {
                self.bytes(&component.to_le_bytes());
            }
        }
        for index in mesh.triangles().iter().flatten() {
            self.bytes(&index.to_le_bytes());
        }
    }

    fn add_file(&mut self, path: &Path) -> io::Result<()> {
        let (mut file, mut length) = (open_input(path, u64::MAX)?, 0_u64);
        let mut buffer = vec![0; 1 << 16];
        loop {
            match file.read(&mut buffer)? {
                0 => break,
                read => {
                    self.bytes(&buffer[..read]);
                    length += read as u64;
                }
            }
        }
        self.bytes(&length.to_le_bytes());
        Ok(())
    }
}

/// The record of finished frames. The summary of a render holds the same keys and more.
#[derive(Debug, Deserialize, Serialize)]
pub(super) struct Record {
    pub(super) fingerprint: Fingerprint,
    pub(super) exposure: Exposure,
    pub(super) frames: Vec<FrameSummary>,
}

/// The content of the file of a record.
#[derive(Debug)]
pub(super) enum Found {
    /// A record of the same render.
    Ours {
        exposure: Exposure,
        frame: FrameSummary,
    },
    /// A record of another render.
    Foreign,
    /// No record that can be read.
    Nothing,
}

impl Record {
    /// Reads the record of frame `number`, and tells whether it belongs to the render
    /// `fingerprint`.
    pub(super) fn find(path: &Path, number: u32, fingerprint: &Fingerprint) -> Found {
        let Ok(text) = read_input(path, MAX_TEXT_BYTES) else {
            return Found::Nothing;
        };
        let Ok(record) = serde_json::from_slice::<Self>(&text) else {
            return Found::Nothing;
        };
        if record.fingerprint != *fingerprint {
            return Found::Foreign;
        }
        let mut frames = record.frames.into_iter();
        match frames.find(|frame| frame.number == number) {
            Some(frame) => Found::Ours {
                exposure: record.exposure,
                frame,
            },
            None => Found::Nothing,
        }
    }

    /// Writes the record, the last step in finishing a frame.
    pub(super) fn write(&self, path: &Path) -> Result<(), Failure> {
        output::save(path, |file| {
            serde_json::to_writer_pretty(&mut *file, self)?;
            writeln!(file)
        })
    }
}

/// Removes the record of a frame that is about to change.
pub(super) fn forget(path: &Path) -> Result<(), Failure> {
    match fs::remove_file(path) {
        Err(error) if error.kind() != io::ErrorKind::NotFound => Err(Failure::writing(path, error)),
        _ => Ok(()),
    }
}

impl fmt::Display for Fingerprint {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.0)
    }
}

#[cfg(test)]
mod tests {
    use glam::DVec3;
    use tem00_scene::parse_scene;

    use super::*;

    fn fnv(text: &str) -> u64 {
        let mut hash = Fnv::default();
        hash.bytes(text.as_bytes());
        hash.0
    }

    #[test]
    fn the_hash_is_that_of_its_authors() {
        // The first three test vectors of draft-eastlake-fnv, appendix C.
        assert_eq!(fnv(""), 0xcbf2_9ce4_8422_2325);
        assert_eq!(fnv("a"), 0xaf63_dc4c_8601_ec8c);
        assert_eq!(fnv("foobar"), 0x8594_4171_f739_67e8);
    }

    fn scene() -> Scene {
        let text = "[camera]\nposition = [0, 0, 1]\n[[laser]]\nwavelength = 650e-9\npower = 1\n\
                    position = [0, 1, 1]\nspot.waist_radius = 1e-3\n[[surface]]\n\
                    sphere.radius = 1e-2\n";
        parse_scene(text, Path::new(".")).expect("a scene")
    }

    #[test]
    fn the_fingerprint_sees_every_corner_of_a_mesh() {
        let with_corner = |x: f64| {
            let corners = vec![DVec3::ZERO, x * DVec3::X, DVec3::Y];
            let mesh = TriangleMesh::new(corners, vec![[0, 1, 2]]).expect("a mesh");
            let mut scene = scene();
            scene.surfaces[0].shape = mesh.into();
            Fingerprint::of(&scene, &[], &1).expect("no files")
        };
        assert_eq!(with_corner(1.0), with_corner(1.0), "the same again");
        assert_ne!(with_corner(1.0), with_corner(1.0 + f64::EPSILON), "one bit");
    }

    #[test]
    fn each_part_changes_the_fingerprint() {
        let folder = tempfile::tempdir().expect("a temporary folder");
        let path = |name: &str| folder.path().join(name);
        let contents = [
            ("a", "xy"),
            ("b", "z"),
            ("c", "x"),
            ("d", "yz"),
            ("e", "xY"),
        ];
        for (name, content) in contents {
            fs::write(path(name), content).expect("written");
        }
        let of = |names: &[&str], choice: u32| {
            let files: Vec<PathBuf> = names.iter().map(|name| path(name)).collect();
            Fingerprint::of(&scene(), &files, &choice).expect("the files can be read")
        };
        let first = of(&["a", "b"], 1);
        assert_eq!(first, of(&["a", "b"], 1), "the same again");
        assert_ne!(first, of(&["a", "b"], 2), "another choice");
        assert_ne!(first, of(&["c", "d"], 1), "the same bytes in other files");
        assert_ne!(first, of(&["e", "b"], 1), "one bit");
        assert_ne!(first, of(&["a"], 1), "a file less");
        let missing = Fingerprint::of(&scene(), &[path("f")], &1);
        assert!(missing.is_err(), "a missing file");
    }

    #[test]
    fn records_are_found_by_render_and_number() {
        let folder = tempfile::tempdir().expect("a temporary folder");
        let path = folder.path().join("a_0003.json");
        let fingerprint = Fingerprint("12".into());
        let frame = FrameSummary {
            number: 3,
            preview: "a.png".into(),
            layers: "a.exr".into(),
            preview_fnv1a: String::new(),
            layers_fnv1a: String::new(),
            lasers: Vec::new(),
            samples: 7,
            rays: 14,
            seconds: 0.1,
        };
        let record = Record {
            fingerprint: fingerprint.clone(),
            // A number whose shortest decimal form is long.
            exposure: Exposure::for_all_light(0.1 + f32::EPSILON),
            frames: vec![frame],
        };
        let find = |number, fingerprint: &Fingerprint| Record::find(&path, number, fingerprint);
        assert!(matches!(find(3, &fingerprint), Found::Nothing), "no file");
        record.write(&path).expect("written");
        let Found::Ours { exposure, frame } = find(3, &fingerprint) else {
            panic!("the record is found");
        };
        assert_eq!(
            exposure.white_level.to_bits(),
            record.exposure.white_level.to_bits(),
            "the exposure keeps its bits"
        );
        assert_eq!(frame.samples, 7);
        assert!(matches!(find(4, &fingerprint), Found::Nothing), "another");
        let other = Fingerprint("13".into());
        assert!(matches!(find(3, &other), Found::Foreign), "foreign");
        fs::write(&path, "{").expect("written");
        assert!(matches!(find(3, &fingerprint), Found::Nothing), "broken");
        forget(&path).expect("removed");
        forget(&path).expect("nothing to remove is no failure");
    }
}
