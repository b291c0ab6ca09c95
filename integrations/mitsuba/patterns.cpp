#include "patterns.hpp"

#include <mitsuba/core/filesystem.h>
#include <mitsuba/core/fresolver.h>
#include <mitsuba/render/film.h>

#include <cmath>

#include "coherent.hpp"
#include "properties.hpp"

namespace mitsuba {

namespace {

/// In the order of `tem00_slice_path`.
constexpr std::array<std::string_view, 3> PATHS{ "still", "circle", "straight" };

/// What the stacks of all lasers may take together.
constexpr uint64_t MEMORY_BYTES = uint64_t(1) << 30;

/// Keeps the seeds of the lasers apart.
constexpr uint64_t SEED_STEP = 0x9e3779b97f4a7c15;

/// Refuses a coordinate beyond 1e9; up to there it is exact to far less than a sample.
void check_coordinate(std::string_view name, double value) {
    if (!(std::abs(value) <= 1e9))
        Throw("speckle: %s: must be from -1e9 to 1e9, got %g", name, value);
}

uint64_t count(const Properties &props, std::string_view name, int64_t otherwise, int64_t least,
               int64_t most) {
    const int64_t value = props.get<int64_t>(name, otherwise);
    if (value < least || value > most)
        refuse(props, name, tfm::format("must be from %i to %i, got %i", least, most, value));
    return (uint64_t) value;
}

uint64_t optional_count(const Properties &props, std::string_view name, int64_t least,
                        int64_t most) {
    return props.has_property(name) ? count(props, name, 0, least, most) : 0;
}

std::optional<double> positive(const Properties &props, std::string_view name) {
    const auto value = optional_number(props, name);
    if (value && !(*value > 0.0 && std::isfinite(*value)))
        refuse(props, name, tfm::format("must be positive and finite, got %g", *value));
    return value;
}

/// Returns the name of a stack file that exists, or nothing if none is asked for.
std::string stack_file(const Properties &props) {
    if (!props.has_property("file"))
        return "";
    // The file says what it holds.
    for (const char *name :
         { "pattern_size", "pattern_diameter", "path", "half_period", "length", "seed" }) {
        if (props.has_property(name))
            refuse(props, name, "must not be given together with file");
    }
    const auto path = file_resolver()->resolve(props.get<std::string>("file"));
    if (!fs::exists(path))
        refuse(props, "file", "there is no file \"" + path.string() + "\"");
    return path.string();
}

/// Returns the speckle size that a laser and the lens of a sensor make, in pixels.
double lens_speckle_size(const Patterns::Sensor &sensor, const Patterns::Emitter *laser) {
    const auto radius     = ParameterReader::read(&sensor, "aperture_radius");
    const auto angle      = ParameterReader::read(&sensor, "x_fov");
    const auto wavelength = ParameterReader::read(laser, "wavelength");
    if (!radius || !angle || !wavelength)
        Throw("speckle: speckle_size: must be given, as the %s tells no %s",
              wavelength ? "sensor" : "laser", wavelength ? "aperture" : "wavelength");
    constexpr double radians = 3.141592653589793 / 180;
    const double half_width  = sensor.film()->size().x() / 2.0;
    // The distance from the lens to the image, in pixels.
    const double distance = half_width / std::tan(*angle / 2 * radians);
    return *wavelength * distance / (2 * *radius);
}

std::vector<const Patterns::Emitter *> lasers_of(const Patterns::Scene &scene) {
    std::vector<const Patterns::Emitter *> lasers;
    for (const auto &emitter : scene.emitters()) {
        if (is_coherent(emitter.get()))
            lasers.push_back(emitter.get());
    }
    return lasers;
}

/// Returns the place of a laser in a stack that all share, in periods: the points of the sequence of
/// Roberts (2018), far apart from each other.
Patterns::Place shared_place(size_t laser) {
    // The root of x³ = x + 1.
    constexpr double plastic = 1.324717957244746;
    const double number      = (double) laser;
    double whole;
    return { std::modf(number / plastic, &whole), std::modf(number / (plastic * plastic), &whole) };
}

} // namespace

Settings::Settings(const Properties &props)
    : speckle(props.get<bool>("speckle", true)), speckle_size(positive(props, "speckle_size")),
      seed(count(props, "seed", 0, 0, INT64_MAX)),
      pattern_size(optional_count(props, "pattern_size", 16, 1 << 15)),
      pattern_diameter(optional_count(props, "pattern_diameter", 8, 1 << 14)),
      path((uint32_t) choice(props, "path", PATHS)),
      half_period(count(props, "half_period", 64, 1, 1 << 15)),
      length(count(props, "length", 2, 2, 1 << 14)), u(props.get<double>("u", 0.0)),
      shift_x(props.get<double>("shift_x", 0.0)), shift_y(props.get<double>("shift_y", 0.0)),
      file(stack_file(props)) {
    if (pattern_size && pattern_diameter > pattern_size / 2)
        refuse(props, "pattern_diameter",
               tfm::format("must be at most half the pattern_size %i, got %i", pattern_size,
                           pattern_diameter));
    check_motion();
}

void Settings::traverse(TraversalCallback *callback) {
    callback->put("u", u, ParamFlags::NonDifferentiable);
    callback->put("shift_x", shift_x, ParamFlags::NonDifferentiable);
    callback->put("shift_y", shift_y, ParamFlags::NonDifferentiable);
}

void Settings::check_motion() const {
    check_coordinate("u", u);
    check_coordinate("shift_x", shift_x);
    check_coordinate("shift_y", shift_y);
}

std::array<uint64_t, 2> Settings::square() const {
    const uint64_t size = pattern_size ? pattern_size : 2 * pattern_diameter;
    return { size, pattern_diameter ? pattern_diameter : size / 2 };
}

std::string Settings::to_string() const {
    if (!speckle)
        return "speckle = false";
    const std::string size = speckle_size ? tfm::format("%g", *speckle_size) : "that of the lens";
    return tfm::format("speckle_size = %s,\n  seed = %i,\n  path = %s,\n  u = %g,\n"
                       "  shift = [%g, %g]",
                       size, seed, PATHS[path], u, shift_x, shift_y);
}

void Patterns::prepare(const Scene &scene, const Sensor &sensor) {
    const auto lasers = lasers_of(scene);
    const auto &film  = sensor.film()->size();
    Purpose purpose{ { (double) film.x(), (double) film.y() }, {} };
    for (const Emitter *laser : lasers)
        purpose.speckle_sizes.push_back(m_settings.speckle_size
                                            ? *m_settings.speckle_size
                                            : lens_speckle_size(sensor, laser));
    if (!(m_purpose == purpose)) {
        const bool shared = !m_settings.file.empty();
        const Stack file  = shared ? read() : Stack();
        m_purpose.reset();
        m_patterns.clear();
        for (size_t i = 0; i < lasers.size(); ++i)
            m_patterns.push_back(shared ? pattern(file, purpose.speckle_sizes[i], shared_place(i))
                                        : pattern(generate(purpose, i), purpose.speckle_sizes[i]));
        m_purpose = purpose;
    }
    for (size_t i = 0; i < lasers.size(); ++i)
        m_patterns[i].laser = lasers[i];
}

double Patterns::factor(const Emitter *laser, const FilmPosition &position) const {
    for (const Pattern &pattern : m_patterns) {
        if (pattern.laser != laser)
            continue;
        const double x = pattern.samples_per_pixel * (position.x - m_settings.shift_x);
        // In the pattern y points up.
        const double y = -pattern.samples_per_pixel * (position.y - m_settings.shift_y);
        return pattern.stack->intensity(pattern.origin[0] + x, pattern.origin[1] + y,
                                        m_settings.u);
    }
    Throw("speckle: a laser has come into the scene while it is rendered");
}

Patterns::Pattern Patterns::pattern(Stack stack, double speckle_size, const Place &place) {
    const tem00_stack_info info = stack->info();
    return { nullptr, std::move(stack), info.speckle_size / speckle_size,
             { place[0] * (double) info.width, place[1] * (double) info.height } };
}

Patterns::Stack Patterns::generate(const Purpose &purpose, size_t laser) const {
    const char *too_many = m_settings.path ? "half_period" : "pattern_size";
    return named("speckle", { { "memory_limit", too_many } }, [&] {
        return std::make_shared<tem00::stack>(describe(purpose, laser));
    });
}

tem00_stack_description Patterns::describe(const Purpose &purpose, size_t laser) const {
    const uint64_t memory = MEMORY_BYTES / purpose.speckle_sizes.size();
    tem00_stack_description description{};
    if (m_settings.pattern_size || m_settings.pattern_diameter) {
        const auto [size, diameter] = m_settings.square();
        description.width = description.height = size;
        description.speckle_size               = (double) size / (double) diameter;
    } else {
        tem00_stack_needs needs{};
        for (size_t axis = 0; axis < 2; ++axis)
            needs.image[axis] = needs.region[axis] = purpose.film_size[axis];
        needs.speckle_size = purpose.speckle_sizes[laser];
        needs.frames       = 1;
        needs.memory_limit = memory;
        description = named("speckle", { { "memory_limit", "speckle_size" } },
                            [&] { return tem00::plan(needs); });
    }
    description.seed          = m_settings.seed + (laser + 1) * SEED_STEP;
    description.path          = m_settings.path;
    description.half_period   = m_settings.half_period;
    description.length        = m_settings.length;
    description.interpolation = TEM00_INTERPOLATION_CUBIC_SPLINE;
    description.memory_limit  = memory;
    return description;
}

Patterns::Stack Patterns::read() const {
    return named("speckle", { { "path", "file" } }, [&] {
        return std::make_shared<tem00::stack>(tem00::stack::read(m_settings.file, UINT64_MAX));
    });
}

} // namespace mitsuba
