//! `--set`: values that take the place of those in the file.

use std::fs;

use super::*;

fn replaced(text: &str, from: &str, to: &str) -> String {
    assert!(text.contains(from), "{from} is in the file");
    text.replacen(from, to, 1)
}

#[test]
fn a_changed_scene_is_rendered_as_if_its_file_said_so() {
    let pixels = |scene: &str, changes: &[&str]| {
        let folder = folder();
        write(folder.path(), "a.toml", scene);
        let mut command = tem00(folder.path(), "render a.toml -o . --spp 1");
        for change in changes {
            command.args(["--set", change]);
        }
        assert_code(&command.output().expect("the program starts"), 0);
        fs::read(folder.path().join("a.exr")).expect("the layers")
    };
    let changes = [
        "camera.f_number=16",
        "laser[0].power=2 mW",
        "surface[0].lambertian.reflectance=0.3",
        "render.seed=5",
    ];
    let edited = replaced(SCENE, "f_number = 8", "f_number = 16");
    let edited = replaced(&edited, "\"5 mW\"", "\"2 mW\"");
    let edited = replaced(
        &edited,
        "rectangle",
        "lambertian.reflectance = 0.3\nrectangle",
    );
    let edited = replaced(&edited, "[render]", "[render]\nseed = 5");
    let by_option = pixels(SCENE, &changes);
    assert!(by_option == pixels(&edited, &[]), "the option is the file");
    assert!(
        by_option != pixels(SCENE, &changes[1..]),
        "each change counts"
    );
}

#[test]
fn a_render_of_other_values_is_another_render() {
    let folder = folder();
    write(folder.path(), "a.toml", format!("{SCENE}frames = 2\n"));
    let with = |more: &str| format!("render a.toml -o . --spp 1 --set render.seed={more}");
    done(folder.path(), &with("1 --frames 0"));
    refused(
        folder.path(),
        &with("2 --resume"),
        &["belongs to another render"],
    );
    done(folder.path(), &with("1 --resume"));
}
