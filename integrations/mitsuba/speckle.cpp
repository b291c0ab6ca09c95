// Integrator `speckle`: path tracing in which the direct light of lasers carries speckle.

#include <mitsuba/core/properties.h>
#include <mitsuba/render/bsdf.h>
#include <mitsuba/render/emitter.h>
#include <mitsuba/render/film.h>
#include <mitsuba/render/imageblock.h>
#include <mitsuba/render/integrator.h>
#include <mitsuba/render/sampler.h>
#include <mitsuba/render/scene.h>
#include <mitsuba/render/sensor.h>

#include <drjit/morton.h>

#include <algorithm>

#include "coherent.hpp"
#include "patterns.hpp"

namespace mitsuba {

/// Path tracing from the camera. The light of a coherent emitter at the first rough surface of a
/// path is multiplied by the speckle at the film position of the sample.
class Speckle final : public MonteCarloIntegrator<float, Color<float, 3>> {
public:
    using Float    = float;
    using Spectrum = Color<float, 3>;
    MI_IMPORT_BASE(MonteCarloIntegrator, m_max_depth, m_rr_depth, m_hide_emitters, should_stop)
    MI_IMPORT_TYPES(Scene, Sensor, Sampler, Film, ImageBlock, Medium, Emitter, BSDF)
    using Base::render;

    explicit Speckle(const Properties &props) : Base(props), m_patterns(props) {}

    TensorXf render(Scene *scene, Sensor *sensor, UInt32 seed, uint32_t spp, bool develop,
                    bool evaluate) override {
        if (m_patterns.settings().speckle)
            m_patterns.prepare(*scene, *sensor);
        const auto &emitters = scene->emitters();
        m_light_is_met = std::any_of(emitters.begin(), emitters.end(), [](const auto &emitter) {
            return !has_flag(emitter->flags(), EmitterFlags::Delta);
        });
        return Base::render(scene, sensor, seed, spp, develop, evaluate);
    }

    std::pair<Spectrum, Mask> sample(const Scene *scene, Sampler *sampler,
                                     const RayDifferential3f &ray, const Medium *, Float *,
                                     Mask) const override {
        if (m_patterns.settings().speckle)
            Throw("speckle: this integrator must render the image itself; another integrator "
                  "that asks for single rays gives it no film position");
        return trace(scene, sampler, ray, {});
    }

    void traverse(TraversalCallback *callback) override {
        Base::traverse(callback);
        m_patterns.settings().traverse(callback);
    }

    void parameters_changed(const std::vector<std::string> &keys) override {
        m_patterns.settings().check_motion();
        Base::parameters_changed(keys);
    }

    std::string to_string() const override {
        return tfm::format("Speckle[\n  max_depth = %i,\n  rr_depth = %u,\n  %s\n]",
                           (int) m_max_depth, m_rr_depth, m_patterns.settings().to_string());
    }

    MI_DECLARE_CLASS(Speckle)

protected:
    void render_block(const Scene *scene, const Sensor *sensor, Sampler *sampler,
                      ImageBlock *block, Float *channels, uint32_t sample_count, UInt32 seed,
                      uint32_t block_id, uint32_t block_size) const override {
        const uint32_t pixel_count = block_size * block_size;
        // Each pixel has a stream of its own, whatever thread renders it.
        const uint32_t first_stream = seed + block_id * pixel_count;
        block->clear();
        for (uint32_t i = 0; i < pixel_count && !should_stop(); ++i) {
            sampler->seed(first_stream + i);
            const Point2u place = dr::morton_decode<Point2u>(i);
            if (dr::any(place >= block->size()))
                continue;
            const Point2i pixel = Point2i(place) + block->offset();
            for (uint32_t j = 0; j < sample_count && !should_stop(); ++j) {
                add_sample(scene, sensor, sampler, block, channels, pixel,
                           dr::rsqrt((Float) sample_count));
                sampler->advance();
            }
        }
    }

private:
    /// A walk from the camera through the scene.
    struct Walk {
        explicit Walk(const Ray3f &ray) : ray(ray) {}

        Ray3f ray;
        Spectrum throughput = 1.f;
        Spectrum radiance   = 0.f;
        /// The relative refractive index of where the walk is.
        Float eta = 1.f;
        /// The number of surfaces met.
        uint32_t depth = 0;
        /// Whether one of them was rough.
        bool rough = false;
        /// Whether the camera sees anything but hidden light sources.
        bool seen = false;
        /// The surface that the ray comes from, and the density of its direction.
        Interaction3f origin = dr::zeros<Interaction3f>();
        Float direction_pdf  = 1.f;
        bool specular        = true;
    };

    /// Light that arrives from a sampled emitter.
    struct DirectLight {
        DirectionSample3f direction = dr::zeros<DirectionSample3f>();
        Spectrum weight             = 0.f;
        Vector3f wo                 = 0.f;
    };

    /// Takes a sample of a pixel and adds it to the block.
    void add_sample(const Scene *scene, const Sensor *sensor, Sampler *sampler, ImageBlock *block,
                    Float *channels, const Point2i &pixel, Float differential_scale) const {
        const Film *film     = sensor->film();
        const Point2f within = sampler->next_2d();
        auto [ray, weight]   = camera_ray(sensor, sampler, Point2f(pixel) + within);
        if (ray.has_differentials)
            ray.scale_differential(differential_scale);
        const FilmPosition position{ (double) pixel.x() + within.x(),
                                     (double) pixel.y() + within.y() };
        auto [radiance, seen] = trace(scene, sampler, ray, position);
        write(film, weight * radiance, seen, ray.wavelengths, channels);
        // A box filter takes the sample wherever it lies in the pixel.
        const bool box = film->rfilter()->is_box_filter();
        block->put(box ? Point2f(pixel) : Point2f(pixel) + within, channels);
    }

    std::pair<RayDifferential3f, Spectrum> camera_ray(const Sensor *sensor, Sampler *sampler,
                                                      const Point2f &position) const {
        const Film *film = sensor->film();
        const Point2f relative =
            (position - Point2f(film->crop_offset())) / Vector2f(film->crop_size());
        const Point2f lens = sensor->needs_aperture_sample() ? sampler->next_2d() : Point2f(.5f);
        Float time         = sensor->shutter_open();
        if (sensor->shutter_open_time() > 0.f)
            time += sampler->next_1d() * sensor->shutter_open_time();
        return sensor->sample_ray_differential(time, 0.f, relative, lens);
    }

    /// Writes a sample into the channels that the film asks for.
    static void write(const Film *film, const Spectrum &value, bool seen,
                      const Wavelength &wavelengths, Float *channels) {
        const Float alpha = seen ? 1.f : 0.f;
        if (has_flag(film->flags(), FilmFlags::Special)) {
            film->prepare_sample(value, wavelengths, channels, 1.f, alpha, seen);
            return;
        }
        for (size_t i = 0; i < 3; ++i)
            *channels++ = value[i];
        if (has_flag(film->flags(), FilmFlags::Alpha))
            *channels++ = alpha;
        *channels = 1.f;
    }

    /// Returns the radiance along a ray, and whether it met anything.
    std::pair<Spectrum, bool> trace(const Scene *scene, Sampler *sampler, const Ray3f &ray,
                                    const FilmPosition &position) const {
        if (m_max_depth == 0)
            return { 0.f, false };
        Walk walk(ray);
        walk.seen = !m_hide_emitters && scene->environment();
        while (step(scene, sampler, position, walk)) {
        }
        return { walk.seen ? walk.radiance : Spectrum(0.f), walk.seen };
    }

    /// Follows the ray to the next surface, and returns whether the walk goes on.
    bool step(const Scene *scene, Sampler *sampler, const FilmPosition &position,
              Walk &walk) const {
        SurfaceInteraction3f si = arrive(scene, walk);
        take_emission(scene, si, walk);
        if (!si.is_valid() || walk.depth + 1 >= m_max_depth)
            return false;
        const BSDF *bsdf = si.bsdf(walk.ray);
        const bool rough = has_flag(bsdf->flags(), BSDFFlags::Smooth);
        const auto light = rough ? draw_light(scene, si, sampler) : DirectLight();
        if (is_last(bsdf, walk)) {
            const auto [value, pdf] = bsdf->eval_pdf(BSDFContext(), si, light.wo);
            walk.radiance += walk.throughput * direct(light, value, pdf, position, walk.rough);
            walk.seen = true;
            return false;
        }
        // Two numbers for the direction, and one for the end of the path whether it is used or not.
        const Float lobe      = sampler->next_1d();
        const Point2f toward  = sampler->next_2d();
        const auto [value, pdf, scattered, weight] =
            bsdf->eval_pdf_sample(BSDFContext(), si, light.wo, lobe, toward);
        walk.radiance += walk.throughput * direct(light, value, pdf, position, walk.rough);
        walk.rough |= rough;
        scatter(si, scattered, weight, walk);
        return survives(sampler->next_1d(), walk);
    }

    /// Whether nothing is to be found beyond this surface.
    bool is_last(const BSDF *bsdf, const Walk &walk) const {
        return walk.depth + 2 == m_max_depth && !m_light_is_met &&
               !has_flag(bsdf->flags(), BSDFFlags::Null);
    }

    SurfaceInteraction3f arrive(const Scene *scene, const Walk &walk) const {
        if (m_hide_emitters && walk.depth == 0)
            return Base::skip_area_emitters(scene, walk.ray, true)
                .compute_surface_interaction(walk.ray, +RayFlags::All);
        return scene->ray_intersect(walk.ray, +RayFlags::All, walk.depth == 0);
    }

    /// Adds the light of an emitter that the ray has met by chance.
    static void take_emission(const Scene *scene, const SurfaceInteraction3f &si, Walk &walk) {
        const Emitter *emitter = si.emitter(scene);
        if (!emitter)
            return;
        walk.seen |= si.is_valid();
        const DirectionSample3f ds(scene, si, walk.origin);
        const Float pdf = walk.specular ? 0.f : scene->pdf_emitter_direction(walk.origin, ds);
        walk.radiance +=
            walk.throughput * emitter->eval(si) * power_heuristic(walk.direction_pdf, pdf);
    }

    static DirectLight draw_light(const Scene *scene, const SurfaceInteraction3f &si,
                                  Sampler *sampler) {
        auto [ds, weight] = scene->sample_emitter_direction(si, sampler->next_2d());
        return { ds, weight, si.to_local(ds.d) };
    }

    /// Returns the light that a surface reflects from a sampled emitter.
    Spectrum direct(const DirectLight &light, const Spectrum &bsdf, Float bsdf_pdf,
                    const FilmPosition &position, bool rough_before) const {
        const auto &ds = light.direction;
        if (ds.pdf == 0.f)
            return 0.f;
        const Float mis = ds.delta ? 1.f : power_heuristic(ds.pdf, bsdf_pdf);
        const Spectrum reflected = bsdf * light.weight * mis;
        // Light that two rough surfaces have scattered has lost its coherence.
        if (!m_patterns.settings().speckle || rough_before || !is_coherent(ds.emitter))
            return reflected;
        return reflected * (Float) m_patterns.factor(ds.emitter, position);
    }

    /// Turns the walk into the direction that its surface has scattered it to.
    static void scatter(const SurfaceInteraction3f &si, const BSDFSample3f &scattered,
                        const Spectrum &weight, Walk &walk) {
        walk.ray = si.spawn_ray(si.to_world(scattered.wo));
        walk.throughput *= weight;
        walk.eta *= scattered.eta;
        walk.seen |= !has_flag(scattered.sampled_type, BSDFFlags::Null);
        walk.origin        = si;
        walk.direction_pdf = scattered.pdf;
        walk.specular      = has_flag(scattered.sampled_type, BSDFFlags::Delta);
        ++walk.depth;
    }

    /// Ends weak walks by chance, and makes the others stronger for it.
    bool survives(Float chance, Walk &walk) const {
        const Float strongest = dr::max(walk.throughput);
        if (walk.depth < m_rr_depth)
            return strongest != 0.f;
        const Float probability = std::min(strongest * dr::square(walk.eta), .95f);
        if (!(chance < probability))
            return false;
        walk.throughput /= probability;
        return true;
    }

    static Float power_heuristic(Float pdf, Float other) {
        return pdf > 0.f ? dr::rcp(1.f + dr::square(other / pdf)) : 0.f;
    }

    Patterns m_patterns;
    /// Whether rays can meet an emitter by chance.
    bool m_light_is_met = true;
};

} // namespace mitsuba

extern "C" MI_EXPORT void init_plugin(std::string_view name, mitsuba::PluginRegisterFn add) {
    using namespace mitsuba;
    add(name, "scalar_rgb", ObjectType::Integrator,
        [](void *, const Properties &props) -> ref<Object> { return new Speckle(props); });
}
