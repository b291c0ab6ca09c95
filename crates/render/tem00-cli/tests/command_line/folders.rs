//! Folders that several processes write into, and what killed ones leave there.

use std::{fs, path::Path, process::Child, process::Stdio, thread::sleep, time::Duration};

use super::{assert_code, files, message, run, scene_folder, sequence, tem00};

/// A process that is killed when the test is done with it, or fails.
struct Running(Child);

impl Drop for Running {
    fn drop(&mut self) {
        // The process may have ended.
        let _ = self.0.kill();
        let _ = self.0.wait();
    }
}

/// Starts a command and waits until `there` exists.
fn start(folder: &Path, line: &str, there: &str) -> Running {
    let mut command = tem00(folder, line);
    command.stdout(Stdio::null()).stderr(Stdio::null());
    let running = Running(command.spawn().expect("the program starts"));
    let started = (0..6_000).any(|_| {
        sleep(Duration::from_millis(5));
        folder.join(there).exists()
    });
    assert!(started, "{line} has written {there}");
    running
}

#[test]
fn a_folder_that_another_process_writes_into_is_refused() {
    let folder = scene_folder();
    let path = folder.path();
    let mut first = start(path, "render a.toml -o out --spp 100000", "out/.tem00.lock");
    let process = format!("process {}", first.0.id());
    for line in [
        "render a.toml -o out",
        "render a.toml -o out --resume",
        "render a.toml -o out --frames 0",
    ] {
        let output = run(path, line);
        assert_code(&output, 2);
        let said = message(&output);
        assert!(
            said.contains(&process) && said.contains("folder out"),
            "{line}: {said}"
        );
        assert_eq!(files(&path.join("out")), [".tem00.lock"], "{line}");
    }
    assert!(
        matches!(first.0.try_wait(), Ok(None)),
        "the first render goes on"
    );
    // A process that is killed leaves nothing that hinders the next.
    drop(first);
    let output = run(path, "render a.toml -o out");
    assert_code(&output, 0);
    let hidden = files(&path.join("out")).into_iter();
    assert_eq!(hidden.filter(|name| name.starts_with('.')).count(), 0);
}

#[test]
fn parts_of_one_render_may_share_a_folder() {
    let folder = sequence::moving_folder(4, 1_000);
    let path = folder.path();
    let line = "render a.toml -o out --frames 1..999";
    let mut first = start(path, line, "out/a_0001.json");
    assert_code(&run(path, "render a.toml -o out --frames 0"), 0);
    for other in ["--frames 0 --seed 1", "--resume", ""] {
        let output = run(path, &format!("render a.toml -o out {other}"));
        assert_code(&output, 2);
        let said = message(&output);
        assert!(said.contains("another tem00"), "{other}: {said}");
    }
    assert!(
        matches!(first.0.try_wait(), Ok(None)),
        "the first render goes on"
    );
}

#[test]
fn frames_whose_files_do_not_belong_together_are_rendered_again() {
    let folder = sequence::moving_folder(4, sequence::FRAMES);
    let path = folder.path();
    assert_code(&run(path, "render a.toml -o whole"), 0);
    assert_code(&run(path, "render a.toml -o other --seed 1"), 0);
    assert_code(&run(path, "render a.toml -o mixed"), 0);
    // What two processes in one folder left: each frame has a file of the other.
    for name in ["a_0000.png", "a_0002.exr"] {
        let [from, to] = ["other", "mixed"].map(|folder| path.join(folder).join(name));
        fs::copy(from, to).expect("copied");
    }
    assert_code(&run(path, "render a.toml -o mixed --resume"), 0);
    let [whole, mixed] = ["whole", "mixed"].map(|name| sequence::images(&path.join(name)));
    assert!(whole == mixed, "the images differ");
}

#[test]
fn what_a_killed_process_was_writing_is_removed() {
    let folder = scene_folder();
    let path = folder.path();
    assert_code(&run(path, "render a.toml -o out"), 0);
    for (line, beside) in [
        ("render a.toml -o out --resume", "out"),
        ("pattern -o a.png --size 64", "."),
    ] {
        let left = path.join(beside).join(".tem00-8zIFJM.part");
        fs::write(&left, "half of an image").expect("written");
        assert_code(&run(path, line), 0);
        assert!(!left.exists(), "{line}");
    }
}
