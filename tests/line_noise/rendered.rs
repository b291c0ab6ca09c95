use tem00::statistics::{SpeckledLine, line_centroid_deviation};

use crate::line_frames::LineFrames;

const LINE: LineFrames = LineFrames {
    thickness: 1e-3,
    f_number: 8.0,
    pixel_pitch: 3.45e-6,
    angle: 0.0,
    samples_per_pixel: 8,
    length: 512,
    lines: 5,
    seed: 1,
};

/// Holds the noise to both closed forms.
fn judge(frames: LineFrames) {
    let noise = frames.noise().expect("frames");
    let line = SpeckledLine::new(noise.radius, noise.row_height).expect("a line");
    let first_order = noise.deviation / line.centroid_deviation();
    let law = noise.deviation / line_centroid_deviation(noise.radius, noise.row_height);
    // A column's own power fluctuates: it scatters by up to 0.11 h/w less than first order says. Of
    // samples and of pixels as coarse as a quarter of a line's half-width there is 1 % more.
    let chance = 3.3 * noise.error;
    let allowed = 0.99 - 0.11 / noise.radius - chance..1.01 + chance;
    assert!(
        allowed.contains(&first_order),
        "{frames:?}: {noise:?}, {first_order:.4} of first order, allowed {allowed:?}"
    );
    assert!(
        (law - 1.0).abs() < 0.05,
        "{frames:?}: {noise:?}, {law:.4} of the law"
    );
}

#[test]
fn wider_lines_scatter_more() {
    for thickness in [0.6e-3, 1e-3, 2e-3] {
        judge(LineFrames { thickness, ..LINE });
    }
}

#[test]
fn smaller_pupils_scatter_lines_more() {
    judge(LineFrames {
        f_number: 4.0,
        samples_per_pixel: 16,
        ..LINE
    });
    judge(LineFrames {
        f_number: 12.0,
        ..LINE
    });
}

#[test]
fn higher_rows_scatter_less() {
    judge(LineFrames {
        pixel_pitch: 6.9e-6,
        samples_per_pixel: 16,
        ..LINE
    });
    judge(LineFrames {
        pixel_pitch: 13.8e-6,
        thickness: 2e-3,
        samples_per_pixel: 64,
        length: 1024,
        ..LINE
    });
}

#[test]
fn lines_seen_at_an_angle_are_narrower_in_the_image() {
    judge(LineFrames {
        angle: 40.0,
        ..LINE
    });
}
