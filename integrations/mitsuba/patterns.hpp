// The speckle patterns of the integrator `speckle`: from properties to a factor at a film position.

#pragma once

#include <mitsuba/render/emitter.h>
#include <mitsuba/render/scene.h>
#include <mitsuba/render/sensor.h>

#include <tem00.hpp>

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace mitsuba {

/// A point of the whole film, in pixels: x to the right, y down, pixel centres at one half.
struct FilmPosition {
    double x = 0.0, y = 0.0;
};

/// What the properties ask for.
struct Settings {
    explicit Settings(const Properties &props);

    /// Returns the side of the square pattern that is asked for, and its diameter, in samples.
    std::array<uint64_t, 2> square() const;

    /// Exposes what may change between two images.
    void traverse(TraversalCallback *callback);

    /// Throws if what was changed is out of range.
    void check_motion() const;

    std::string to_string() const;

    /// Whether there is any speckle.
    bool speckle;
    /// On the sensor, in pixels; left out, that of the lens.
    std::optional<double> speckle_size;
    uint64_t seed;
    /// Side of a square pattern in samples, and diameter of its pupil; 0 to let the library choose.
    uint64_t pattern_size, pattern_diameter;
    /// A `tem00_slice_path` and its numbers.
    uint32_t path;
    uint64_t half_period, length;
    /// Slice coordinate of the whole image.
    double u;
    /// Motion of the patterns in the image, in pixels: x to the right, y down.
    double shift_x, shift_y;
    /// A stack file, or empty.
    std::string file;
};

/// A pattern for each laser of a scene.
class Patterns {
public:
    using Scene   = mitsuba::Scene<float, Color<float, 3>>;
    using Sensor  = mitsuba::Sensor<float, Color<float, 3>>;
    using Emitter = mitsuba::Emitter<float, Color<float, 3>>;
    /// Of a pattern in its stack, in periods.
    using Place = std::array<double, 2>;

    explicit Patterns(const Properties &props) : m_settings(props) {}

    const Settings &settings() const { return m_settings; }
    Settings &settings() { return m_settings; }

    /// Makes what an image of the scene needs, unless it is there already.
    void prepare(const Scene &scene, const Sensor &sensor);

    /// Returns the factor of a laser's light, with mean 1. Threads may share it.
    double factor(const Emitter *laser, const FilmPosition &position) const;

private:
    using Stack = std::shared_ptr<const tem00::stack>;

    struct Pattern {
        const Emitter *laser;
        Stack stack;
        double samples_per_pixel;
        /// Where it starts in its stack, in samples.
        std::array<double, 2> origin;
    };

    /// What the stacks depend on, besides the settings.
    struct Purpose {
        std::array<double, 2> film_size;
        /// That of each laser, in pixels.
        std::vector<double> speckle_sizes;

        bool operator==(const Purpose &other) const {
            return film_size == other.film_size && speckle_sizes == other.speckle_sizes;
        }
    };

    static Pattern pattern(Stack stack, double speckle_size, const Place &place = { 0.0, 0.0 });
    Stack generate(const Purpose &purpose, size_t laser) const;
    tem00_stack_description describe(const Purpose &purpose, size_t laser) const;
    Stack read() const;

    Settings m_settings;
    std::optional<Purpose> m_purpose;
    std::vector<Pattern> m_patterns;
};

} // namespace mitsuba
