// Emitter `laser`: a Gaussian beam or a laser line.

#include <mitsuba/core/properties.h>
#include <mitsuba/render/emitter.h>
#include <mitsuba/render/medium.h>

#include <optional>
#include <variant>

#include "coherent.hpp"
#include "laser_shapes.hpp"
#include "properties.hpp"

namespace mitsuba {

/// A laser that lights surfaces from the one direction of its mean energy flow, and whose rays for
/// light tracing are drawn from its phase-space density.
class Laser final : public Emitter<float, Color<float, 3>> {
public:
    using Float    = float;
    using Spectrum = Color<float, 3>;
    MI_IMPORT_BASE(Emitter, m_flags, m_to_world)
    MI_IMPORT_TYPES()

    explicit Laser(const Properties &props)
        : Base(props), m_source(props), m_shape(shape_of(props)), m_color(color_of(props)) {
        // No ray from a surface finds the laser.
        m_flags = +EmitterFlags::DeltaPosition | COHERENT;
        place();
    }

    std::pair<DirectionSample3f, Spectrum> sample_direction(const Interaction3f &it,
                                                            const Point2f &,
                                                            Mask) const override {
        const auto event     = event_at(it.p);
        DirectionSample3f ds = dr::zeros<DirectionSample3f>();
        ds.time              = it.time;
        ds.delta             = true;
        ds.emitter           = this;
        ds.n                 = Normal3f(axis());
        if (!event) {
            // Nothing arrives: with a density of 0 no shadow ray is sent.
            ds.p    = m_to_world.value().translation();
            ds.d    = -axis();
            ds.dist = dr::norm(ds.p - it.p);
            return { ds, 0.f };
        }
        ds.p    = Point3f(vector(event->point));
        ds.d    = vector(event->wi);
        ds.dist = (Float) event->distance;
        ds.pdf  = 1.f;
        return { ds, m_color * per_square_metre(event->e_perp) };
    }

    Float pdf_direction(const Interaction3f &, const DirectionSample3f &, Mask) const override {
        return 0.f;
    }

    Spectrum eval_direction(const Interaction3f &it, const DirectionSample3f &,
                            Mask) const override {
        const auto event = event_at(it.p);
        return event ? m_color * per_square_metre(event->e_perp) : Spectrum(0.f);
    }

    std::pair<Ray3f, Spectrum> sample_ray(Float time, Float, const Point2f &slope,
                                          const Point2f &position, Mask) const override {
        const tem00_ray_sample ray =
            m_light->sample_ray({ position.x(), position.y(), slope.x(), slope.y() });
        return { Ray3f(Point3f(vector(ray.origin)), vector(ray.direction), time, Wavelength()),
                 m_color * per_square_metre(ray.flux) };
    }

    std::pair<PositionSample3f, Float> sample_position(Float time, const Point2f &,
                                                       Mask) const override {
        return { PositionSample3f(m_to_world.value().translation(), Normal3f(axis()), Point2f(0.f),
                                  time, 1.f, true),
                 1.f };
    }

    std::pair<Wavelength, Spectrum> sample_wavelengths(const SurfaceInteraction3f &, Float,
                                                       Mask) const override {
        return { Wavelength(), m_color };
    }

    Spectrum eval(const SurfaceInteraction3f &, Mask) const override { return 0.f; }

    ScalarBoundingBox3f bbox() const override {
        const ScalarPoint3f centre = m_to_world.scalar().translation();
        return ScalarBoundingBox3f(centre, centre);
    }

    void traverse(TraversalCallback *callback) override {
        Base::traverse(callback);
        callback->put("color", m_color, ParamFlags::NonDifferentiable);
        callback->put("to_world", m_to_world, ParamFlags::NonDifferentiable);
        m_source.traverse(callback);
        std::visit([&](auto &shape) { shape.traverse(callback); }, m_shape);
    }

    void parameters_changed(const std::vector<std::string> &keys) override {
        place();
        Base::parameters_changed(keys);
    }

    std::string to_string() const override {
        return tfm::format("Laser[\n  shape = %s,\n  wavelength = %g,\n  power = %g,\n"
                           "  color = %s,\n  to_world = %s\n]",
                           std::holds_alternative<Spot>(m_shape) ? "spot" : "line",
                           m_source.wavelength, m_source.power, m_color,
                           string::indent(m_to_world, 13));
    }

    MI_DECLARE_CLASS(Laser)

private:
    using LaserShape = std::variant<Spot, Line>;

    static LaserShape shape_of(const Properties &props) {
        constexpr std::array<std::string_view, 2> shapes{ "spot", "line" };
        if (choice(props, "shape", shapes) == 0)
            return Spot(props);
        return Line(props);
    }

    static Spectrum color_of(const Properties &props) {
        const ScalarColor3f color = props.get<ScalarColor3f>("color", ScalarColor3f(1.f));
        if (!dr::all(dr::isfinite(color) && color >= 0.f))
            refuse(props, "color", tfm::format("must be finite and not negative, got %s", color));
        return color;
    }

    static Vector3f vector(const double (&v)[3]) {
        return Vector3f((Float) v[0], (Float) v[1], (Float) v[2]);
    }

    /// Light per squared unit of length of the scene, per square metre.
    Float per_square_metre(double light) const {
        return (Float) (light * m_source.per_square_metre);
    }

    /// The direction of travel.
    Vector3f axis() const { return m_to_world.value() * Vector3f(0.f, 0.f, 1.f); }

    std::optional<tem00_next_event> event_at(const Point3f &p) const {
        return m_light->next_event({ p.x(), p.y(), p.z() });
    }

    /// Prepares the light for where `to_world` puts it.
    void place() {
        const auto &frame = m_to_world.scalar();
        check_rotation(frame);
        const ScalarPoint3f origin = frame.translation();
        const ScalarVector3f x     = frame * ScalarVector3f(1.f, 0.f, 0.f);
        const ScalarVector3f z     = frame * ScalarVector3f(0.f, 0.f, 1.f);
        tem00_placement placement{};
        for (size_t i = 0; i < 3; ++i) {
            placement.origin[i]    = origin[i];
            placement.direction[i] = z[i];
            placement.fan_axis[i]  = x[i];
        }
        auto light = std::visit(
            [&](const auto &shape) { return shape.light(m_source, placement); }, m_shape);
        // Mitsuba computes in single precision, which cannot carry every light.
        named("laser", { { "single_precision", "power" } }, [&] { return light.plain_data(); });
        m_light = std::move(light);
    }

    /// Lengths are not scaled with the frame, so that it has to leave them as they are.
    static void check_rotation(const ScalarAffineTransform4f &frame) {
        // The rounding of angles and look-at points in single precision stays below this.
        constexpr float tolerance = 1e-4f;
        for (int i = 0; i < 3; ++i) {
            for (int j = 0; j <= i; ++j) {
                ScalarVector3f a(0.f), b(0.f);
                a[i] = b[j]       = 1.f;
                const float error = dr::dot(frame * a, frame * b) - (i == j ? 1.f : 0.f);
                if (!(std::abs(error) <= tolerance))
                    Throw("laser: to_world: must be a rotation and a translation, got %s", frame);
            }
        }
    }

    Source m_source;
    LaserShape m_shape;
    Spectrum m_color;
    std::optional<tem00::light> m_light;
};

} // namespace mitsuba

extern "C" MI_EXPORT void init_plugin(std::string_view name, mitsuba::PluginRegisterFn add) {
    using namespace mitsuba;
    add(name, "scalar_rgb", ObjectType::Emitter,
        [](void *, const Properties &props) -> ref<Object> { return new Laser(props); });
}
