//! Folders that several processes write into, and what killed ones leave there.

use std::{fs, path::Path, process::Child};

use super::{done, files, refused, scene_folder, sequence, start, wait_until};

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
fn running(folder: &Path, line: &str, there: &str) -> Running {
    let running = Running(start(folder, line));
    wait_until(line, || folder.join(there).exists());
    running
}

#[test]
fn a_folder_that_another_process_writes_into_is_refused() {
    let folder = scene_folder();
    let path = folder.path();
    let mut first = running(
        path,
        "render a.toml -o out --spp 100000 --threads 1",
        "out/.tem00.lock",
    );
    let process = format!("process {}", first.0.id());
    for line in [
        "render a.toml -o out",
        "render a.toml -o out --resume",
        "render a.toml -o out --frames 0",
    ] {
        refused(path, line, &[&process, "folder out"]);
        assert_eq!(files(&path.join("out")), [".tem00.lock"], "{line}");
    }
    let state = first.0.try_wait();
    assert!(matches!(state, Ok(None)), "the first render goes on");
    // A process that is killed leaves nothing that hinders the next.
    drop(first);
    done(path, "render a.toml -o out");
    let hidden = files(&path.join("out")).into_iter();
    assert_eq!(hidden.filter(|name| name.starts_with('.')).count(), 0);
}

#[test]
fn parts_of_one_render_may_share_a_folder() {
    let folder = sequence::moving_folder(40, 200);
    let path = folder.path();
    let line = "render a.toml -o out --frames 1..199 --threads 1";
    let mut first = running(path, line, "out/a_0001.json");
    done(path, "render a.toml -o out --frames 0");
    for other in ["--frames 0 --seed 1", "--resume", ""] {
        let line = format!("render a.toml -o out {other}");
        refused(path, &line, &["another tem00"]);
    }
    let state = first.0.try_wait();
    assert!(matches!(state, Ok(None)), "the first render goes on");
}

#[test]
fn frames_whose_files_do_not_belong_together_are_rendered_again() {
    let folder = sequence::moving_folder(4, sequence::FRAMES);
    let path = folder.path();
    done(path, "render a.toml -o whole");
    done(path, "render a.toml -o other --seed 1");
    done(path, "render a.toml -o mixed");
    // What two processes in one folder left: each frame has a file of the other.
    for name in ["a_0000.png", "a_0002.exr"] {
        let [from, to] = ["other", "mixed"].map(|folder| path.join(folder).join(name));
        fs::copy(from, to).expect("copied");
    }
    done(path, "render a.toml -o mixed --resume");
    let [whole, mixed] = ["whole", "mixed"].map(|name| sequence::images(&path.join(name)));
    assert!(whole == mixed, "the images differ");
}

#[test]
fn what_a_killed_process_was_writing_is_removed() {
    let folder = scene_folder();
    let path = folder.path();
    done(path, "render a.toml -o out");
    for (line, beside) in [
        ("render a.toml -o out --resume", "out"),
        ("pattern -o a.png --size 64", "."),
    ] {
        let left = path.join(beside).join(".tem00-8zIFJM.part");
        fs::write(&left, "half of an image").expect("written");
        done(path, line);
        assert!(!left.exists(), "{line}");
    }
}
