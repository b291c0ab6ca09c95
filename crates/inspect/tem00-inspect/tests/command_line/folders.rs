//! Folders that several processes write into.

use std::{fs, process::Child, process::Stdio, thread::sleep, time::Duration};

use super::*;

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

/// A folder with a set-up to search from, which has a budget as well, and a scene.
fn with_scene() -> tempfile::TempDir {
    let folder = written(DESIGN);
    fs::write(folder.path().join("scene.toml"), SCAN).expect("written");
    folder
}

#[test]
fn a_folder_that_another_process_writes_into_is_refused() {
    let folder = with_scene();
    let path = folder.path();
    images::write_line(&path.join("frame.png"));
    let line = "triangulate scene.toml -o out --spp 100000 --threads 1";
    let mut first = start(path, line, "out/.tem00.lock");
    let process = format!("process {}", first.0.id());
    for line in [
        "triangulate scene.toml -o out",
        "lines frame.png -o out",
        "budget a.toml -o out --trials 0",
        "design a.toml -o out",
    ] {
        assert_has(&said(path, line, 2).told, &[&process, "folder out"]);
        assert_eq!(files(&path.join("out")), [".tem00.lock"], "{line}");
    }
    let waiting = first.0.try_wait();
    assert!(matches!(waiting, Ok(None)), "the first measurement goes on");
    // A process that is killed leaves nothing that hinders the next.
    drop(first);
    said(path, "budget a.toml -o out --trials 0", 0);
    let hidden = files(&path.join("out")).into_iter();
    assert_eq!(hidden.filter(|name| name.starts_with('.')).count(), 0);
    // A folder in the way of the lock.
    fs::create_dir_all(path.join("b/.tem00.lock")).expect("a folder");
    let told = said(path, "budget a.toml -o b", 2).told;
    assert_has(&told, &["cannot write into the folder b"]);
}

#[test]
fn the_same_run_writes_the_same_bytes() {
    let folder = with_scene();
    let path = folder.path();
    for command in [
        "design a.toml",
        "budget a.toml --trials 20",
        "triangulate scene.toml",
    ] {
        let runs = [(0, 1), (1, 3)].map(|(run, threads)| {
            said(path, &format!("{command} -o {run} --threads {threads}"), 0);
            let results = path.join(run.to_string());
            let bytes = |name: String| (fs::read(results.join(&name)).expect("a file"), name);
            let all: Vec<_> = files(&results).into_iter().map(bytes).collect();
            fs::remove_dir_all(results).expect("removed");
            all
        });
        for (one, other) in runs[0].iter().zip(&runs[1]) {
            assert!(one == other, "{command}: {} or {} differs", one.1, other.1);
        }
        assert_eq!(runs[0].len(), runs[1].len(), "{command}");
    }
}
