//! Patterns from one seed, of the library and of the card, and what is refused.

use tem00_gpu::{Gpu, GpuError, GpuPattern, GpuStack, wgpu};
use tem00_numerics::Grid;
use tem00_speckle::{
    Complex, Phasors, Pupil, PupilField, SlicePath, SpeckleError, StackOptions, Transmission,
};

/// The rms and the largest deviation of one pattern from the other, of the mean.
fn deviations(card: &[f32], library: &[f32]) -> [f64; 2] {
    assert_eq!(card.len(), library.len(), "samples");
    let errors = card
        .iter()
        .zip(library)
        .map(|(a, b)| (f64::from(*a) - f64::from(*b)).abs());
    let [square, worst] = errors.fold([0.0_f64; 2], |[square, worst], error| {
        [square + error * error, worst.max(error)]
    });
    [(square / card.len() as f64).sqrt(), worst]
}

fn assert_agree(gpu: &Gpu, name: &str, field: &PupilField, offset: [f64; 2], defocus: f64) {
    let card = GpuPattern::generate(gpu, field, offset, defocus).expect(name);
    let card = card.values().expect(name);
    let library = field.pattern_at(offset, defocus);
    let [rms, worst] = deviations(&card, library.values().values());
    assert!(
        rms < 3e-6 && worst < 3e-5,
        "{name}: {rms:e} rms, {worst:e} at worst"
    );
}

#[test]
fn patterns_of_the_planners_sizes_agree() {
    let gpu = Gpu::new().expect("an adapter");
    // Twice the smooth multiples of 8; one stage along an axis, and every radix.
    for (size, speckle_size) in [
        ([16, 16], 2.0),
        ([64, 64], 2.0),
        ([80, 144], 3.3),
        ([240, 1_600], 2.0),
        ([1_296, 400], 4.0),
        ([486, 250], 2.5),
        ([2_048, 2_048], 2.0),
        ([32_768, 64], 2.0),
        ([40, 24_000], 2.5),
    ] {
        let field = PupilField::from_speckle_size(size, speckle_size, 11).expect("a field");
        assert_agree(&gpu, &format!("{size:?}"), &field, [0.0; 2], 0.0);
    }
}

/// A device whose workgroups have so many bytes of memory.
fn with_workgroup_memory(bytes: u32) -> Gpu {
    let instance = wgpu::Instance::new(wgpu::InstanceDescriptor::new_without_display_handle());
    let adapter =
        pollster::block_on(instance.request_adapter(&<_>::default())).expect("an adapter");
    let device = pollster::block_on(adapter.request_device(&wgpu::DeviceDescriptor {
        required_limits: wgpu::Limits {
            max_compute_workgroup_storage_size: bytes,
            ..<_>::default()
        },
        ..<_>::default()
    }));
    let (device, queue) = device.expect("a device");
    Gpu::of(device, queue, format!("{bytes} bytes"))
}

/// What browsers promise, and one butterfly at a time, which a browser without a card runs fastest.
#[test]
fn patterns_agree_on_devices_with_little_memory() {
    for bytes in [16 << 10, 128] {
        let gpu = with_workgroup_memory(bytes);
        for size in [[2_048, 486], [4_096, 2_048], [64, 24_000]] {
            let field = PupilField::from_speckle_size(size, 2.4, 11).expect("a field");
            let name = format!("{size:?}, {bytes} bytes");
            assert_agree(&gpu, &name, &field, [0.1, 0.0], 0.0);
        }
    }
}

/// Memory that is filled again holds the bits of memory that is new: of another seed, place, pupil
/// and size, made on the card or by the library.
#[test]
fn patterns_and_stacks_are_refilled() {
    let gpu = Gpu::new().expect("an adapter");
    let field =
        |size: [usize; 2], seed| PupilField::from_speckle_size(size, 2.4, seed).expect("a field");
    let annulus = field([180, 128], 3)
        .with_pupil(Pupil::Annulus { inner: 0.4 })
        .expect("a pupil");
    let sampled = field([180, 128], 3)
        .with_pupil(aberrated())
        .expect("a pupil");
    let fields = [
        field([180, 128], 4),
        annulus,
        sampled,
        field([64, 64], 3),
        field([64, 64], 5),
    ];
    let mut pattern =
        GpuPattern::generate(&gpu, &field([180, 128], 3), [0.0; 2], 0.0).expect("a pattern");
    let path = SlicePath::Straight {
        half_period: 2,
        length: 2,
    };
    let mut stack = GpuStack::generate(&gpu, &field([180, 128], 3), path).expect("a stack");
    let points = [[3.5, 60.25, 0.0], [17.0, 8.75, 2.5]];
    for field in fields {
        let before = pattern.buffer().clone();
        let is_kept = pattern.size() == field.size();
        pattern.refill(&field, [0.3, 0.1], 0.5).expect("a pattern");
        assert_eq!(*pattern.buffer() == before, is_kept);
        let new = GpuPattern::generate(&gpu, &field, [0.3, 0.1], 0.5).expect("a pattern");
        assert_eq!(pattern.values(), new.values());
        let group = stack.bind_group().clone();
        stack
            .refill(&field, path, StackOptions::default())
            .expect("a stack");
        assert_eq!(*stack.bind_group() == group, is_kept);
        let new = GpuStack::generate(&gpu, &field, path).expect("a stack");
        assert_eq!(stack.intensities(&points), new.intensities(&points));
    }
}

/// A pupil without symmetry, with aberrations.
fn aberrated() -> Pupil {
    let grid = Grid::from_fn(37, 53, |x, y| {
        let place = (2 * x + y * y % 31) as f32;
        Complex::from_polar(1.0 / (1.0 + 0.01 * place), 0.1 * place)
    });
    Pupil::Sampled(Transmission::from_complex(grid).expect("a transmission"))
}

#[test]
fn patterns_behind_every_pupil_agree() {
    let gpu = Gpu::new().expect("an adapter");
    for pupil in [
        Pupil::Circle,
        Pupil::Annulus { inner: 0.4 },
        Pupil::Rectangle { height: 0.6 },
        Pupil::Gaussian { radius: 0.3 },
        aberrated(),
    ] {
        for phasors in [Phasors::Unit, Phasors::Gaussian] {
            let field = PupilField::from_speckle_size([180, 128], 2.4, 3)
                .and_then(|field| field.with_pupil(pupil.clone()))
                .expect("a field")
                .with_phasors(phasors);
            // On the lattice and between, far along it, before its origin and where words begin
            // anew.
            for (offset, defocus) in [
                ([0.0; 2], 0.0),
                ([0.31, -0.77], 0.0),
                ([-4.0, 1e5], 0.4),
                ([(1_u64 << 31) as f64 / 75.0, 1e12], -3.0),
            ] {
                let name = format!("{pupil:?}, {phasors:?} at {offset:?}, {defocus}");
                assert_agree(&gpu, &name, &field, offset, defocus);
            }
        }
    }
}

#[test]
fn patterns_of_external_samples_agree() {
    let gpu = Gpu::new().expect("an adapter");
    let samples = Grid::from_fn(70, 61, |x, y| {
        Complex::from_polar(1e-20 * (1 + x % 7) as f32, (x * x + 3 * y * x) as f32)
    });
    let field = PupilField::from_samples(samples, [160, 128], 2.5).expect("a field");
    for (offset, defocus) in [([0.0; 2], 0.0), ([0.4, -0.25], 0.7), ([9.0, 0.0], 0.0)] {
        assert_agree(&gpu, &format!("{offset:?}"), &field, offset, defocus);
    }
}

#[test]
fn what_does_not_fit_is_refused_with_what_would() {
    let gpu = Gpu::new().expect("an adapter");
    let field = |size, diameter| PupilField::new(size, diameter, 1).expect("a field");
    let pattern = |field| GpuPattern::generate(&gpu, &field, [0.0; 2], 0.0).expect_err("a pattern");
    let refused = pattern(field(2 * 77, 64));
    assert_eq!(refused, GpuError::Size(154));
    assert_eq!(
        refused.to_string(),
        "size must have no prime factor above 5 on a graphics card and be at most 32768, got 154: \
         160 is the next"
    );
    let refused = pattern(field(PupilField::MAX_SIZE, 8));
    let GpuError::TooLarge {
        needed, allowed, ..
    } = refused
    else {
        panic!("{refused}");
    };
    assert!(needed > allowed && allowed >= 1 << 27, "{refused}");

    let circle = |half_period| SlicePath::Circle { half_period };
    let frugal = StackOptions {
        memory_limit: 65_535,
    };
    let stack = |field, path, options| {
        GpuStack::generate_with(&gpu, &field, path, options).expect_err("a stack")
    };
    let [needed, limit] = [65_536, 65_535];
    let expected = GpuError::from(SpeckleError::MemoryLimit { needed, limit });
    assert_eq!(stack(field(64, 32), circle(1), frugal), expected);
    let refused = stack(field(64, 32), circle(0), StackOptions::default());
    assert!(
        refused.to_string().starts_with("half_period must be"),
        "{refused}"
    );
    // More than any device has: 4 TiB.
    let path = circle(1 << 14);
    let refused = stack(field(4096, 1024), path, StackOptions::default());
    let bytes = path.memory_bytes([4096; 2]);
    assert!(
        matches!(refused, GpuError::TooLarge { what: "the stack", needed, .. } if needed == bytes),
        "{refused}"
    );
}
