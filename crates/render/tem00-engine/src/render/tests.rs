use core::sync::atomic::AtomicBool;

use glam::DVec3;
use tem00_statistics::{Moments, t_test_mean};
use tem00_tracer::RenderOptions;

use crate::{render_frame, testing};

#[test]
fn the_error_of_the_power_is_its_scatter_from_seed_to_seed() {
    // A spot of an eighth of a pixel, which one or none of 16 samples meets.
    let camera = testing::camera(DVec3::new(0.0, 0.0, 0.3), [8, 8]);
    let laser = testing::spot(DVec3::new(0.1, 0.0, 0.3), 5e-6);
    let plate = testing::plate(DVec3::ZERO, DVec3::Z, [0.02, 0.02]);
    let scene = testing::scene(camera, &[laser], plate);
    let render = |seed| {
        let options = RenderOptions {
            samples_per_pixel: 16,
            seed,
            ..scene.render
        };
        let frame = render_frame(&scene, None, 0, &options, &|_| (), &AtomicBool::new(false));
        frame.unwrap().lasers.remove(0)
    };
    let layers: Vec<_> = (0..2000).map(render).collect();
    let powers: Vec<f64> = layers.iter().map(|l| l.power_on_target / 1e-3).collect();
    let variances = layers.iter().map(|l| (l.power_error / 1e-3).powi(2));
    let stated = (variances.sum::<f64>() / layers.len() as f64).sqrt();
    let seen = Moments::from_samples(&powers).unwrap().standard_deviation();
    assert!(t_test_mean(&powers, 1.0).unwrap().p_value > 1e-3);
    // Samples that keep apart meet it somewhat more evenly than independent ones.
    assert!(
        (1.0..1.25).contains(&(stated / seen)),
        "{stated}, seen {seen}"
    );
}
