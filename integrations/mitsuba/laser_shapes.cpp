#include "laser_shapes.hpp"

#include <cmath>

#include "properties.hpp"

namespace mitsuba {

namespace {

constexpr double PI = 3.141592653589793;

/// In the order of `tem00_line_profile`.
constexpr std::array<std::string_view, 6> PROFILES{ "gaussian", "gaussian_angle", "gaussian_sin",
                                                    "uniform",  "uniform_angle",  "powell" };

/// In the order of `tem00_focus_curve`.
constexpr std::array<std::string_view, 2> FOCUS_CURVES{ "distance", "plane" };

/// The scene's unit of length, and watts per square metre in one watt per squared unit.
constexpr std::array<std::string_view, 4> UNITS{ "m", "cm", "mm", "um" };
constexpr std::array<double, 4> PER_SQUARE_METRE{ 1.0, 1e4, 1e6, 1e12 };

/// The library's names of what stands in `to_world`, and of other properties.
Names with_placement(Names names) {
    for (const char *part : { "origin", "direction", "fan_axis" })
        names.emplace(part, "to_world");
    return names;
}

/// Makes a light, or throws under the name of the property.
template <typename Description>
tem00::light make(const Description &description, const Names &names) {
    return named("laser", with_placement(names), [&] { return tem00::light(description); });
}

/// A round beam with the values of one axis.
tem00::light round_light(const Spot &spot, int axis, const Source &source,
                         const tem00_placement &placement, const Names &names) {
    tem00_spot_description description{};
    description.placement      = placement;
    description.wavelength     = source.wavelength;
    description.power          = source.power;
    description.waist_radius   = spot.waist_radius[axis];
    description.waist_distance = spot.waist_distance[axis];
    description.m_squared      = spot.m_squared[axis];
    return make(description, names);
}

void expose(TraversalCallback *callback, const char *name, double &value) {
    callback->put(name, value, ParamFlags::NonDifferentiable);
}

} // namespace

Source::Source(const Properties &props)
    : wavelength(props.get<double>("wavelength")), power(props.get<double>("power")),
      per_square_metre(PER_SQUARE_METRE[choice(props, "unit", UNITS)]) {}

void Source::traverse(TraversalCallback *callback) {
    expose(callback, "wavelength", wavelength);
    expose(callback, "power", power);
}

Spot::Spot(const Properties &props)
    : waist_radius{ props.get<double>("waist_radius"), 0.0 },
      waist_distance{ props.get<double>("waist_distance", 0.0), 0.0 },
      m_squared{ props.get<double>("m_squared", 1.0), 0.0 } {
    const auto radius   = optional_number(props, "waist_radius_y");
    const auto distance = optional_number(props, "waist_distance_y");
    const auto quality  = optional_number(props, "m_squared_y");
    elliptic            = radius || distance || quality;
    waist_radius[1]     = radius.value_or(waist_radius[0]);
    waist_distance[1]   = distance.value_or(waist_distance[0]);
    m_squared[1]        = quality.value_or(m_squared[0]);
}

tem00::light Spot::light(const Source &source, const tem00_placement &placement) const {
    auto first = round_light(*this, 0, source, placement, {});
    if (!elliptic)
        return first;
    // Alone, a bad value of the second axis is told from one of the first.
    round_light(*this, 1, source, placement,
                { { "waist_radius", "waist_radius_y" },
                  { "waist_distance", "waist_distance_y" },
                  { "m_squared", "m_squared_y" } });
    tem00_elliptic_description description{};
    description.placement  = placement;
    description.wavelength = source.wavelength;
    description.power      = source.power;
    for (int axis = 0; axis < 2; ++axis) {
        description.waist_radius[axis]   = waist_radius[axis];
        description.waist_distance[axis] = waist_distance[axis];
        description.m_squared[axis]      = m_squared[axis];
    }
    return make(description, {});
}

void Spot::traverse(TraversalCallback *callback) {
    expose(callback, "waist_radius", waist_radius[0]);
    expose(callback, "waist_distance", waist_distance[0]);
    expose(callback, "m_squared", m_squared[0]);
    if (!elliptic)
        return;
    expose(callback, "waist_radius_y", waist_radius[1]);
    expose(callback, "waist_distance_y", waist_distance[1]);
    expose(callback, "m_squared_y", m_squared[1]);
}

Line::Line(const Properties &props)
    : fan_angle(props.get<double>("fan_angle")), thickness(props.get<double>("thickness")),
      focus_distance(props.get<double>("focus_distance")),
      apex_offset(optional_number(props, "apex_offset")),
      focus_curve((uint32_t) choice(props, "focus_curve", FOCUS_CURVES)),
      profile((uint32_t) choice(props, "profile", PROFILES)),
      // Other profiles have no edge: the property is then unknown.
      edge(profile == TEM00_LINE_PROFILE_POWELL ? props.get<double>("edge", 0.05) : 0.0),
      m_squared(props.get<double>("m_squared", 1.0)) {}

tem00::light Line::light(const Source &source, const tem00_placement &placement) const {
    tem00_line_description description{};
    description.placement      = placement;
    description.wavelength     = source.wavelength;
    description.power          = source.power;
    description.waist_radius   = thickness / 2;
    description.m_squared      = m_squared;
    description.fan_angle      = fan_angle * PI / 180;
    description.apex_offset    = apex_offset.value_or(default_apex_offset(source.wavelength));
    description.focus_distance = focus_distance;
    description.focus_curve    = focus_curve;
    description.profile        = profile;
    description.edge           = edge;
    return make(description, { { "waist_radius", "thickness" } });
}

void Line::traverse(TraversalCallback *callback) {
    expose(callback, "fan_angle", fan_angle);
    expose(callback, "thickness", thickness);
    expose(callback, "focus_distance", focus_distance);
    expose(callback, "m_squared", m_squared);
    if (apex_offset)
        expose(callback, "apex_offset", *apex_offset);
    if (profile == TEM00_LINE_PROFILE_POWELL)
        expose(callback, "edge", edge);
}

double Line::default_apex_offset(double wavelength) const {
    const double waist_radius   = thickness / 2;
    const double rayleigh_range = PI * waist_radius * waist_radius / (m_squared * wavelength);
    const double radius_on_lens = waist_radius * std::hypot(1.0, focus_distance / rayleigh_range);
    return radius_on_lens / std::tan(fan_angle * PI / 360);
}

} // namespace mitsuba
