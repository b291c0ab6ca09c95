// The shapes of the emitter `laser`: from properties to a light of the library.

#pragma once

#include <mitsuba/core/object.h>
#include <mitsuba/core/properties.h>

#include <tem00.hpp>

#include <optional>

namespace mitsuba {

// `traverse` exposes the numbers under the names of the properties, to be changed.

/// What lasers of all shapes have.
struct Source {
    explicit Source(const Properties &props);

    void traverse(TraversalCallback *callback);

    /// In the scene's unit of length.
    double wavelength;
    /// In watts.
    double power;
    /// Watts per square metre in one watt per squared unit of length of the scene.
    double per_square_metre;
};

/// A round or elliptic Gaussian beam; lengths in the scene's unit.
struct Spot {
    explicit Spot(const Properties &props);

    tem00::light light(const Source &source, const tem00_placement &placement) const;
    void traverse(TraversalCallback *callback);

    /// An elliptic beam has second values of its own.
    bool elliptic;
    double waist_radius[2];
    double waist_distance[2];
    double m_squared[2];
};

/// A laser line; lengths in the scene's unit, the angle in degrees.
struct Line {
    explicit Line(const Properties &props);

    tem00::light light(const Source &source, const tem00_placement &placement) const;
    void traverse(TraversalCallback *callback);

    double fan_angle;
    double thickness;
    double focus_distance;
    /// Left out, the fan leaves the lens as wide along the line as the beam is across it.
    std::optional<double> apex_offset;
    uint32_t focus_curve;
    uint32_t profile;
    double edge;
    double m_squared;

private:
    double default_apex_offset(double wavelength) const;
};

} // namespace mitsuba
