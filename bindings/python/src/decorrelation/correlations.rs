use tem00_decorrelation::{self as physics, CorrelationLaw};

functions! {
    /// Return the intensity correlation left when the speckle slides across a circular pupil.
    ///
    /// Parameters
    /// ----------
    /// shift : float or array_like
    ///     Pupil displacement in pupil diameters.
    map pupil_overlap_correlation(shift);

    /// Return the intensity correlation left when the surface moves along the optical axis.
    ///
    /// Parameters
    /// ----------
    /// shift : float or array_like
    ///     Axial displacement in axial decorrelation lengths.
    map axial_correlation(shift);

    /// Return the intensity correlation left at the peak of the cross-correlation, which defocus
    /// moves.
    ///
    /// Parameters
    /// ----------
    /// pupil_shift : float or array_like
    ///     Displacement across the pupil in pupil diameters.
    /// axial_shift : float or array_like
    ///     Displacement along the axis in axial decorrelation lengths.
    map correlation_at_peak(pupil_shift, axial_shift) =
        CorrelationLaw::AtPeak.correlation(pupil_shift, axial_shift);

    /// Return the intensity correlation left at the displacement of the projected surface point.
    ///
    /// Parameters
    /// ----------
    /// pupil_shift : float or array_like
    ///     Displacement across the pupil in pupil diameters.
    /// axial_shift : float or array_like
    ///     Displacement along the axis in axial decorrelation lengths.
    map correlation_at_image_displacement(pupil_shift, axial_shift) =
        CorrelationLaw::AtImageDisplacement.correlation(pupil_shift, axial_shift);

    /// Return the pupil displacement, in pupil diameters, that alone would leave a correlation.
    ///
    /// Parameters
    /// ----------
    /// correlation : float or array_like
    ///     Intensity correlation, from 0 to 1.
    try_map equivalent_pupil_shift(correlation);

    /// Return the axial displacement, in axial decorrelation lengths, that alone leaves a
    /// correlation.
    ///
    /// Parameters
    /// ----------
    /// correlation : float or array_like
    ///     Intensity correlation, from 0 to 1.
    try_map equivalent_axial_shift(correlation);
}
