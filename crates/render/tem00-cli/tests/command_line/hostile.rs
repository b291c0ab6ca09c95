//! Input that means harm, or that no person would write.

use std::{
    fs,
    io::Write,
    path::Path,
    process::{Child, Command, Output, Stdio},
};

use super::{
    SCENE, assert_code, done, files, folder, message, refused, run, scene_folder, start, tem00,
    text, wait_until, write,
};

/// The scene with a mesh in the place of its rectangle.
pub(crate) fn with_mesh(file: &str) -> String {
    let mesh = format!("mesh = {{ file = \"{file}\" }}\n#");
    SCENE.replacen("rectangle = { centre", &mesh, 1)
}

fn including(file: &str) -> String {
    format!("include = [\"{file}\"]\n{SCENE}")
}

/// Waits until a command has ended; it is killed if it does not.
#[track_caller]
fn ended(mut child: Child, line: &str) -> Output {
    let mut patience = 12_000;
    wait_until(line, || {
        patience -= 1;
        if patience == 1 {
            child.kill().expect("it can be killed");
        }
        !matches!(child.try_wait(), Ok(None))
    });
    child.wait_with_output().expect("the program has ended")
}

#[cfg(unix)]
#[test]
fn devices_and_pipes_are_no_files() {
    let folder = scene_folder();
    let path = folder.path();
    let mut pipe = Command::new("mkfifo");
    let pipe = pipe.current_dir(path).args(["pipe", "pipe.png"]).status();
    assert!(pipe.expect("mkfifo").success(), "the pipes are made");
    for (name, target) in [
        ("zero.toml", "/dev/zero"),
        ("zero.exr", "/dev/zero"),
        ("zero.npy", "/dev/zero"),
        ("zero.obj", "/dev/zero"),
        ("pipe.toml", "pipe"),
        ("pipe.stl", "pipe"),
    ] {
        std::os::unix::fs::symlink(target, path.join(name)).expect("a link");
    }
    for name in ["zero.obj", "pipe.stl"] {
        write(path, &format!("{name}.toml"), with_mesh(name));
    }
    for name in ["zero.toml", "pipe.toml"] {
        write(path, &format!("with_{name}"), including(name));
    }
    for line in [
        "render zero.toml --allow-outside",
        "render pipe.toml",
        "render zero.obj.toml",
        "render pipe.stl.toml",
        "render with_zero.toml --allow-outside",
        "render with_pipe.toml",
        "stats pipe.png",
        "stats zero.exr",
        "stats zero.npy",
        "pattern -o a.png --field zero.npy",
    ] {
        let output = ended(start(path, line), line);
        assert_code(&output, 2);
        let said = message(&output);
        assert!(said.contains("not a regular file"), "{line}: {said}");
    }
}

#[test]
fn a_text_has_at_most_16_mebibytes() {
    let folder = scene_folder();
    let path = folder.path();
    let scene = |bytes: usize| format!("{SCENE}\n#{}", " ".repeat(bytes - SCENE.len() - 2));
    write(path, "long.toml", scene(16 << 20));
    done(path, "render long.toml --spp 1");
    write(path, "long.toml", scene((16 << 20) + 1));
    write(path, "b.toml", including("long.toml"));
    for line in ["render long.toml", "render b.toml"] {
        refused(path, line, &["exceeds the maximum of 16 MiB"]);
    }
}

/// Starts a command that reads a scene from standard input.
fn reading(folder: &Path, line: &str) -> Child {
    let mut command = tem00(folder, line);
    command.stdin(Stdio::piped());
    command.stdout(Stdio::piped()).stderr(Stdio::piped());
    command.spawn().expect("the program starts")
}

#[test]
fn a_scene_may_come_from_standard_input() {
    let folder = scene_folder();
    let path = folder.path();
    done(path, "render a.toml -o file");
    let render = |scene: &str, line: &str| {
        let mut child = reading(path, line);
        let mut input = child.stdin.take().expect("a pipe");
        input.write_all(scene.as_bytes()).expect("it reads all");
        drop(input);
        ended(child, line)
    };
    assert_code(&render(SCENE, "render - -o piped"), 0);
    let names = ["json", "exr", "png"].map(|end| format!("standard_input.{end}"));
    for name in &names {
        assert!(files(&path.join("piped")).contains(name), "{name}");
    }
    let [one, other] = ["file/a.exr", "piped/standard_input.exr"].map(|name| path.join(name));
    let [one, other] = [one, other].map(|path| fs::read(path).expect("an image"));
    assert!(one == other, "the images are the same");

    let resumed = render(SCENE, "render - -o piped --resume");
    assert_code(&resumed, 0);
    let told = message(&resumed);
    assert!(told.contains("nothing to do"), "the same scene: {told}");
    let changed = SCENE.replace("5 mW", "6 mW");
    assert_code(&render(&changed, "render - -o piped --resume"), 2);
}

#[cfg(unix)]
#[test]
fn signals_end_a_command_that_waits_for_input() {
    for signal in ["INT", "TERM", "HUP"] {
        let folder = folder();
        let mut child = reading(folder.path(), "render -");
        let input = child.stdin.as_mut().expect("a pipe");
        // More than a pipe holds: when it is written, the program reads.
        input
            .write_all("# nothing yet\n".repeat(100_000).as_bytes())
            .expect("it reads");
        let kill = format!("kill -{signal} {}", child.id());
        let sent = Command::new("sh").args(["-c", &kill]).status();
        assert!(sent.expect("a shell").success(), "the signal is sent");
        let input = child.stdin.take();
        let output = ended(child, signal);
        drop(input);
        assert_code(&output, 130);
        assert_eq!(text(&output.stderr), "tem00: interrupted\n");
    }
}

const SECRET: &str = "root:x:0:0:s3cr3t";

/// A folder `scenes` beside a folder `other`.
fn two_folders() -> tempfile::TempDir {
    let folder = folder();
    for name in ["scenes/parts", "other"] {
        fs::create_dir_all(folder.path().join(name)).expect("made");
    }
    let surface = "[[surface]]\nsphere.radius = \"1 mm\"\n";
    for (name, content) in [
        ("other/secret", SECRET),
        (
            "other/secret.toml",
            "[[surface]]\nsphere.radius = \"s3cr3t\"\n",
        ),
        ("other/keys.toml", "s3cr3t = 1\n"),
        ("other/secret.obj", "v 0 0 s3cr3t\n"),
        ("other/surface.toml", surface),
        ("scenes/parts/surface.toml", surface),
    ] {
        write(folder.path(), name, content);
    }
    folder
}

#[test]
fn includes_stay_in_the_folder_of_the_scene() {
    let folder = two_folders();
    let path = folder.path();
    let absolute = path.join("other/surface.toml");
    let mut outside = vec![
        "../other/surface.toml".to_owned(),
        "parts/../../other/surface.toml".to_owned(),
        absolute.display().to_string(),
    ];
    #[cfg(unix)]
    {
        std::os::unix::fs::symlink(&absolute, path.join("scenes/link.toml")).expect("a link");
        outside.push("link.toml".to_owned());
    }
    for include in outside {
        write(path, "scenes/a.toml", including(&include));
        // Both from where the scene lies and from elsewhere.
        for (from, line) in [("", "render scenes/a.toml"), ("scenes", "render a.toml")] {
            let words = ["outside of the folder", "--allow-"];
            refused(&path.join(from), line, &words);
        }
        let line = "render scenes/a.toml --allow-outside --spp 1 -o out";
        done(path, line);
    }
    write(path, "scenes/a.toml", including("parts/surface.toml"));
    done(path, "render scenes/a.toml --spp 1 -o out");
}

#[test]
fn files_from_outside_are_never_quoted() {
    let folder = two_folders();
    let path = folder.path();
    for include in ["secret", "secret.toml", "keys.toml"] {
        let scene = including(&format!("../other/{include}"));
        write(path, "scenes/a.toml", scene);
        for (options, told) in [("", "outside of the folder"), ("--allow-outside", "line ")] {
            let line = format!("render scenes/a.toml {options}");
            let said = refused(path, &line, &[told]);
            for part in ["root", "s3cr3t"] {
                assert!(!said.contains(part), "{include} {options}: {said}");
            }
        }
    }
    write(path, "scenes/a.toml", with_mesh("../other/secret.obj"));
    let said = refused(path, "render scenes/a.toml", &["line 1"]);
    assert!(!said.contains("s3cr3t"), "{said}");
}

/// A glTF file of one triangle whose data is in a file.
fn gltf(uri: &str) -> String {
    format!(
        r#"{{"asset": {{"version": "2.0"}}, "scene": 0, "scenes": [{{"nodes": [0]}}],
        "nodes": [{{"mesh": 0}}], "meshes": [{{"primitives": [{{"attributes": {{"POSITION": 0}}}}]}}],
        "accessors": [{{"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3",
        "min": [0, 0, 0], "max": [1, 1, 0]}}],
        "bufferViews": [{{"buffer": 0, "byteLength": 36}}],
        "buffers": [{{"byteLength": 36, "uri": "{uri}"}}]}}"#
    )
}

#[test]
fn the_data_of_a_gltf_file_stays_in_its_folder() {
    let folder = two_folders();
    let path = folder.path();
    let corners = [0.0_f32, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0].map(f32::to_le_bytes);
    for name in ["other/a b.bin", "scenes/parts/a b.bin"] {
        write(path, name, corners.concat());
    }
    write(path, "scenes/a.toml", with_mesh("a.gltf"));
    let absolute = path.join("other/a b.bin").display().to_string();
    for (uri, inside) in [
        ("../other/a%20b.bin", false),
        ("parts/%2e%2E/../other/a b.bin", false),
        (&*absolute, false),
        ("parts/a%20b.bin", true),
    ] {
        write(path, "scenes/a.gltf", gltf(uri));
        let output = run(path, "render scenes/a.toml --spp 1 -o out");
        assert_code(&output, if inside { 0 } else { 2 });
        let said = message(&output);
        assert_eq!(said.contains("outside of the folder"), !inside, "{said}");
        let line = "render scenes/a.toml --spp 1 -o out --allow-outside";
        done(path, line);
    }
}

/// What a terminal obeys: colour, title, clearing the screen, a control character of one byte in
/// Latin-1, and the end of a line that the next text overwrites.
const ESCAPES: &str = "\u{1b}[31m\u{1b}]0;title\u{7}\u{9b}2J\u{202e}\r";

#[track_caller]
fn assert_harmless(what: &str, bytes: &[u8]) {
    let shown = text(bytes);
    let bad = |c: char| (c.is_control() && !matches!(c, '\n' | '\t')) || c == '\u{202e}';
    assert!(!shown.contains(bad), "{what}: {shown:?}");
}

#[test]
fn what_a_terminal_obeys_is_never_printed() {
    let folder = folder();
    let path = folder.path();
    let quoted = ESCAPES.chars().map(|c| format!("\\u{:04x}", u32::from(c)));
    let quoted: String = quoted.collect();
    // A surface without light, whose name is told.
    let away = SCENE.replace("centre = [0, 0, 0]", "centre = [\"70 mm\", 0, 0]");
    let named = format!(
        "{away}\n[[surface]]\nname = \"{quoted}\"\n\
         sphere = {{ radius = 1e-3, centre = [0, 0, -1] }}\n"
    );
    for (name, content) in [
        ("key.toml", format!("\"{quoted}\" = 1\n")),
        ("value.toml", SCENE.replace("5 mW", &quoted)),
        ("raw.toml", format!("{ESCAPES} = # {ESCAPES}\n")),
        (
            "comment.toml",
            SCENE.replace("f_number = 8", "f_number = 0 # \u{9b}2J\u{202e}"),
        ),
        ("name.toml", named),
        ("mesh.obj", format!("v 0 0 {ESCAPES}x\n")),
        ("mesh.toml", with_mesh("mesh.obj")),
    ] {
        write(path, name, content);
    }
    let header = format!("{{'descr': '{ESCAPES}', 'fortran_order': False, 'shape': (9, 9), }}");
    let length = u16::try_from(header.len()).expect("short");
    let array = [
        &b"\x93NUMPY\x01\x00"[..],
        &length.to_le_bytes(),
        header.as_bytes(),
    ]
    .concat();
    write(path, "type.npy", array);
    done(path, "pattern -o frame.png --size 64");
    let strange = "frame\u{1b}[31m\u{9b}.png";
    fs::copy(path.join("frame.png"), path.join(strange)).expect("copied");
    for line in [
        "render key.toml",
        "render value.toml",
        "render raw.toml",
        "render comment.toml",
        "render name.toml --spp 1",
        "render mesh.toml",
        "stats type.npy",
        &format!("stats {strange}"),
        &format!("stats {strange} --json"),
        &format!("stats no{strange}"),
        &format!("render a.toml {strange}"),
        &format!("render a.toml --{strange}"),
        &format!("render a.toml --spp {strange}"),
        &format!("pattern -o {strange}.png --size 64"),
    ] {
        let output = run(path, line);
        assert!(output.status.code().is_some_and(|code| code <= 2), "{line}");
        let told = output.stdout.len() + output.stderr.len();
        assert!(told > 10, "{line}: nothing is told");
        assert_harmless(line, &output.stdout);
        assert_harmless(line, &output.stderr);
    }
    let printed = run(path, &format!("stats {strange} --json"));
    let printed: serde_json::Value = serde_json::from_slice(&printed.stdout).expect("JSON");
    assert_eq!(printed["image"], strange, "the name survives");
}

#[test]
fn messages_are_short_however_long_the_line() {
    let folder = folder();
    let path = folder.path();
    let long = "x".repeat(1 << 18);
    let many = "\"a.toml\",\n".repeat(25_000);
    let of_lens = |line: &str| SCENE.replace("f_number = 8", &line.replace('?', &long));
    write(path, "mesh.obj", format!("v 0 0 {long}\nf {long}\n"));
    for content in [
        format!("{long} = 1\n"),
        format!("\"{long}\" = 1\n"),
        SCENE.replace("5 mW", &long),
        of_lens("f_number = 0 # ?"),
        of_lens("# ?\nf_number = 0"),
        long.clone(),
        format!("a = \"{long}\" {long}\n"),
        format!("include = [{many}1]\n"),
        with_mesh("mesh.obj"),
    ] {
        write(path, "a.toml", &content);
        let output = run(path, "render a.toml");
        assert_code(&output, 2);
        let told = output.stderr.len();
        assert!(told < 8_000, "{told} bytes: {}", &content[..20]);
    }
}
