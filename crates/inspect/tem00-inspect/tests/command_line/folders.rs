//! Folders that several processes write into.

use std::{fs, path::Path, process::Child, process::Stdio, thread::sleep, time::Duration};

use super::{assert_code, design::SETUP, files, folder, message, run, tem00, triangulate};

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
    let folder = folder();
    let path = folder.path();
    fs::write(path.join("setup.toml"), SETUP).expect("written");
    fs::write(path.join("scene.toml"), triangulate::SCAN).expect("written");
    super::images::write_line(&path.join("frame.png"));
    let mut first = start(
        path,
        "triangulate scene.toml -o out --spp 100000",
        "out/.tem00.lock",
    );
    let process = format!("process {}", first.0.id());
    for line in [
        "triangulate scene.toml -o out",
        "lines frame.png -o out",
        "budget setup.toml -o out --trials 0",
        "design setup.toml -o out",
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
        "the first measurement goes on"
    );
    // A process that is killed leaves nothing that hinders the next.
    drop(first);
    let output = run(path, "budget setup.toml -o out --trials 0");
    assert_code(&output, 0);
    let hidden = files(&path.join("out")).into_iter();
    assert_eq!(hidden.filter(|name| name.starts_with('.')).count(), 0);
}

#[test]
fn a_folder_without_permission_is_refused_in_words() {
    let folder = folder();
    fs::write(folder.path().join("setup.toml"), SETUP).expect("written");
    fs::create_dir_all(folder.path().join("out/.tem00.lock")).expect("a folder in the way");
    let output = run(folder.path(), "budget setup.toml -o out");
    assert_code(&output, 2);
    let said = message(&output);
    assert!(said.contains("cannot write into the folder out"), "{said}");
}

#[test]
fn the_same_run_writes_the_same_bytes() {
    let folder = folder();
    let path = folder.path();
    fs::write(path.join("setup.toml"), SETUP).expect("written");
    fs::write(path.join("scene.toml"), triangulate::SCAN).expect("written");
    for command in [
        "design setup.toml",
        "budget setup.toml --trials 20",
        "triangulate scene.toml",
    ] {
        for (run_number, threads) in [(0, 1), (1, 3)] {
            let line = format!("{command} -o {run_number} --threads {threads}");
            assert_code(&run(path, &line), 0);
        }
        let [first, second] = ["0", "1"].map(|folder| path.join(folder));
        let names = files(&first);
        assert_eq!(names, files(&second), "{command}");
        for name in names {
            let [one, other] = [&first, &second].map(|folder| fs::read(folder.join(&name)));
            let same = one.expect("a file") == other.expect("a file");
            assert!(same, "{command}: {name} differs");
        }
        for folder in [first, second] {
            fs::remove_dir_all(folder).expect("removed");
        }
    }
}
