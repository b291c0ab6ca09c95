use tem00_coherence::{self as physics, PeakShape};

use crate::{
    arrays::LIMIT,
    error::{OrRaise, refused},
};

class! {
    /// The spectrum of a laser or of another narrow source: by default one Gaussian peak.
    ///
    /// Parameters
    /// ----------
    /// wavelength : float
    ///     Central wavelength in metres.
    /// linewidth : float
    ///     Full width at half maximum in metres, at most a tenth of the wavelength; 0 for light of
    ///     one wavelength.
    "tem00.coherence" Spectrum(physics::Spectrum)
}

methods! {
    impl Spectrum as this: this.0;

    #[new]
    #[pyo3(signature = (wavelength, linewidth=0.0))]
    build new(_py; wavelength: f64, linewidth: f64) = {
        let line = physics::Spectrum::new(wavelength, linewidth, PeakShape::Gaussian);
        Ok(Self(line.or_raise()?))
    };

    /// Return a Lorentzian line: long wings, as of a single mode of a diode.
    make lorentzian(wavelength: f64, linewidth: f64) =
        physics::Spectrum::new(wavelength, linewidth, PeakShape::Lorentzian);

    /// Return a rectangular line, as of a wavelength that is swept during the exposure.
    make rectangular(wavelength: f64, linewidth: f64) =
        physics::Spectrum::new(wavelength, linewidth, PeakShape::Rectangular);

    /// Return ``count`` equal peaks without a width, the first and the last ``span`` apart, in
    /// metres.
    make comb(wavelength: f64, span: f64, count: usize) =
        physics::Spectrum::comb(wavelength, span, count).or_raise_renamed(&["peaks"], "count");

    /// Return peaks without a width.
    ///
    /// Parameters
    /// ----------
    /// wavelengths : array_like, shape (n,)
    ///     Wavelengths in metres.
    /// powers : array_like, shape (n,)
    ///     The power of each, in any unit.
    make from_peaks(wavelengths: Vec<f64>, powers: Vec<f64>) = {
        let (wanted, given) = (wavelengths.len(), powers.len());
        if given != wanted {
            let message = format!("powers must be as many as wavelengths, {wanted}, got {given}");
            return Err(refused("powers", message));
        }
        let peaks: Vec<_> = wavelengths.into_iter().zip(powers).map(<[f64; 2]>::from).collect();
        physics::Spectrum::from_peaks(&peaks).or_raise_renamed(&["power"], "powers")
    };

    /// Wavelength of the mean wave number, in metres.
    get wavelength -> f64;

    /// Coherence length in metres; infinite for peaks without a width.
    get coherence_length -> f64;

    /// Return the squared degree of coherence.
    ///
    /// Parameters
    /// ----------
    /// path : float or array_like
    ///     Path difference in metres.
    map squared_coherence(path);

    /// Standard deviation, in rad/m, of a Gaussian line that is as wide between the quantiles where
    /// that has half its maximum.
    get effective_spread -> f64;

    /// Return the difference between a wave number drawn from the line and the mean one, in rad/m.
    ///
    /// Parameters
    /// ----------
    /// uniform : float or array_like
    ///     Random numbers from 0 to 1.
    map draw(uniform);

    shown wavelength, coherence_length;
}
