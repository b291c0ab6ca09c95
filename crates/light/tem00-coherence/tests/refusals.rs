//! Arguments that constructors refuse, by name.

use tem00_coherence::{
    CellGeometry, DVec3, LaserLight, MixedLight, PeakShape, PolychromaticSpeckle, Relief,
    ResolutionCell, SourceExtent, Spectrum, SpectrumForm, cascade_variance,
};
use tem00_testkit::refuses;

const NAN: f64 = f64::NAN;
const INFINITE: f64 = f64::INFINITY;
const RED: f64 = 650e-9;
const Z: DVec3 = DVec3::Z;

#[test]
fn spectra() {
    let shape = PeakShape::Gaussian;
    refuses!(wavelength = RED, linewidth = 0.1 * RED
        => Spectrum::new(wavelength, linewidth, shape);
        wavelength: [0.0, -1.0, NAN, INFINITE],
        linewidth: [-1e-9, NAN, INFINITE, 66e-9],
    );
    refuses!(wavelength = RED, span = 1e-9, peaks = 256
        => Spectrum::comb(wavelength, span, peaks);
        wavelength: [0.0, NAN],
        span: [-1e-9, NAN, INFINITE, 66e-9],
        peaks: [0, 257, usize::MAX],
    );
    refuses!(peaks = vec![[RED, 1e6], [RED + 1e-9, 1.0]] => Spectrum::from_peaks(&peaks);
        peaks: [vec![], vec![[RED, 1.0]; 257]],
        peaks as "power": [vec![[RED, 0.0]], vec![[RED, NAN]], vec![[RED, INFINITE]]],
        // A faint peak on either side, 13 and 14 % from the mean.
        peaks as "wavelength": [
            vec![[RED, 1e6], [750e-9, 1.0]],
            vec![[RED, 1e6], [570e-9, 1.0]],
            vec![[0.0, 1.0]],
            vec![[NAN, 1.0]],
        ],
    );
    let light = LaserLight {
        wavelength: 450e-9,
        linewidth: 1e-9,
        form: SpectrumForm::default(),
        source_half_angle: 0.0,
    };
    refuses!(light = light.clone() => light.spectrum();
        light.wavelength: [NAN, 0.0],
        light.linewidth: [50e-9],
        light.form as "lines": [SpectrumForm::Comb(0)],
        light.form as "wavelength": [SpectrumForm::Peaks(vec![[448e-9, 1.0], [453e-9, 3.0]])],
    );
    let wide = LaserLight {
        form: SpectrumForm::Comb(3),
        ..light
    };
    refuses!(light = wide.clone() => light.spectrum(); light.linewidth: [50e-9]);
    refuses!(light = wide.clone() => light.extent(); light.source_half_angle: [0.4, -0.1, NAN]);
}

#[test]
fn cells() {
    let geometry = CellGeometry {
        to_source: Z,
        to_pupil: DVec3::new(0.5, 0.0, 0.75_f64.sqrt()),
        normal: Z,
        sin_aperture: 1.0,
        wavelength: 450e-9,
    };
    refuses!(geometry = geometry => ResolutionCell::new(geometry);
        geometry.normal: [DVec3::ZERO, DVec3::NAN],
        geometry.to_source: [-Z, DVec3::X, DVec3::X - 0.01 * Z, DVec3::ZERO],
        geometry.to_pupil: [-Z, DVec3::NAN],
        geometry.sin_aperture: [0.0, -0.1, 1.1, NAN],
        geometry.wavelength: [0.0, -1.0, NAN, INFINITE],
    );
    let cell = ResolutionCell::new(geometry).unwrap();
    refuses!(relief = Relief::default() => cell.clone().with_relief(relief);
        relief.rms_height: [-1e-6, NAN, INFINITE],
        relief.correlation_length: [-1e-6, NAN, INFINITE],
    );
    refuses!(defocus = -1e-3 => cell.clone().with_defocus(defocus);
        defocus: [NAN, INFINITE, -INFINITE]);
    let mono = |wavelength| Spectrum::monochromatic(wavelength).unwrap();
    let contrast = |spectrum: &Spectrum| {
        let speckle = PolychromaticSpeckle::new(spectrum, &cell);
        speckle.map(|speckle| speckle.contrast())
    };
    refuses!(spectrum = mono(454e-9) => contrast(&spectrum);
        spectrum: [mono(455e-9), mono(445e-9), mono(650e-9)]);
}

#[test]
fn sources_and_mixed_light() {
    refuses!(source_half_angle = 0.3 => SourceExtent::disc(source_half_angle);
        source_half_angle: [-0.1, 0.4, NAN]);
    refuses!(standard_deviation = 0.0 => SourceExtent::gaussian(standard_deviation);
        standard_deviation: [-0.1, 0.4, NAN]);
    refuses!(list = vec![(Z, 2.0), (Z, 0.0)] => SourceExtent::directions(&list);
        list as "share": [
            vec![],
            vec![(Z, 0.0); 2],
            vec![(Z, 2.0), (Z, -1.0)],
            vec![(Z, NAN)],
            vec![(Z, INFINITE)],
        ],
        list as "direction": [vec![(DVec3::ZERO, 1.0)]],
        list as "directions": [vec![(Z, 1.0); 101]],
    );
    refuses!(light = MixedLight::default() => light.contrast();
        light.multiple: [1.1, -0.1, NAN],
        light.within_single: [1.1, NAN],
        light.with_single: [1.1, NAN],
        light.within_multiple: [1.1, NAN],
        light.polarisation: [[1.0, -0.1], [NAN, 1.0]],
    );
    refuses!(relative_aperture = 0.0 => cascade_variance(relative_aperture);
        relative_aperture: [-1.0, NAN]);
}
