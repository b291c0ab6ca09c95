/*
 * tem00 for C++17: handles that free themselves, and exceptions in place of statuses.
 *
 * Header only, on top of tem00.h, whose structs it uses and whose comments hold: units, shapes,
 * what is allowed. Every function that can fail throws tem00::error.
 *
 *     tem00_spot_description description = {};
 *     description.placement = {{0, 0, 0.3}, {0, 0, -1}, {1, 0, 0}};
 *     description.wavelength = 650e-9;
 *     description.power = 5e-3;
 *     description.waist_radius = 0.1e-3;
 *     description.waist_distance = 0.3;
 *     description.m_squared = 1;
 *     const tem00::light laser(description);
 *     if (const auto event = laser.next_event({0, 0, 0})) {
 *         // L = f |n . wi| V e_perp
 *     }
 */
#ifndef TEM00_HPP
#define TEM00_HPP

#include <array>
#include <complex>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>

#include "tem00.h"

namespace tem00 {

using vec2 = std::array<double, 2>;
using vec3 = std::array<double, 3>;

/** Why a call failed: what() has the parameter, its value and what is allowed. */
class error : public std::runtime_error {
public:
    explicit error(tem00_status status)
        : std::runtime_error(tem00_last_error()),
          status_(status),
          parameter_(tem00_last_error_parameter()) {}

    /** The kind of failure. */
    tem00_status status() const noexcept { return status_; }

    /** The name of the parameter that was refused, empty if it was none. */
    const std::string &parameter() const noexcept { return parameter_; }

private:
    tem00_status status_;
    std::string parameter_;
};

/** Throws what a status stands for. */
inline void check(tem00_status status) {
    if (status != TEM00_STATUS_OK) {
        throw error(status);
    }
}

/** A laser in a scene. Any number of threads may ask it at once. */
class light {
public:
    explicit light(const tem00_spot_description &spot)
        : handle_(made(tem00_light_create_spot, spot)) {}

    explicit light(const tem00_elliptic_description &elliptic)
        : handle_(made(tem00_light_create_elliptic, elliptic)) {}

    explicit light(const tem00_line_description &line)
        : handle_(made(tem00_light_create_line, line)) {}

    /** Irradiance, in W/m², of a plane through `point` at right angles to the axis. */
    double irradiance(const vec3 &point) const {
        double irradiance = 0;
        check(tem00_light_irradiance(get(), point.data(), &irradiance));
        return irradiance;
    }

    /** Energy-flow vector at `point`, in W/m². */
    vec3 flux(const vec3 &point) const {
        vec3 flux{};
        check(tem00_light_flux(get(), point.data(), flux.data()));
        return flux;
    }

    /** The light at `point` as one direction, a delta light; nothing where it is dark. */
    std::optional<tem00_next_event> next_event(const vec3 &point) const {
        tem00_next_event event;
        check(tem00_light_next_event(get(), point.data(), &event));
        return event.e_perp > 0 ? std::optional(event) : std::nullopt;
    }

    /** A direction drawn from the light at `point` with two random numbers; nothing where dark. */
    std::optional<tem00_sampled_event> next_event_sampled(const vec3 &point, const vec2 &u) const {
        tem00_sampled_event event;
        check(tem00_light_next_event_sampled(get(), point.data(), u.data(), &event));
        return event.pdf > 0 ? std::optional(event) : std::nullopt;
    }

    /** Density, per steradian, of a sampled event in the direction `wi`. */
    double next_event_pdf(const vec3 &point, const vec3 &wi) const {
        double pdf = 0;
        check(tem00_light_next_event_pdf(get(), point.data(), wi.data(), &pdf));
        return pdf;
    }

    /** A ray that leaves the aperture, drawn with four random numbers. */
    tem00_ray_sample sample_ray(const std::array<double, 4> &u) const {
        tem00_ray_sample ray;
        check(tem00_light_sample_ray(get(), u.data(), &ray));
        return ray;
    }

    /** Densities of a given ray. */
    tem00_ray_pdf ray_pdf(const vec3 &origin, const vec3 &direction) const {
        tem00_ray_pdf pdf;
        check(tem00_light_ray_pdf(get(), origin.data(), direction.data(), &pdf));
        return pdf;
    }

    /** Radiance, in W/(m² sr), of a given ray. */
    double radiance(const vec3 &origin, const vec3 &direction) const {
        double radiance = 0;
        check(tem00_light_radiance(get(), origin.data(), direction.data(), &radiance));
        return radiance;
    }

    /** The light that a ray from `point` along `wi` meets; nothing where it meets none. */
    std::optional<tem00_aperture_hit> hit(const vec3 &point, const vec3 &wi) const {
        tem00_aperture_hit hit;
        check(tem00_light_hit(get(), point.data(), wi.data(), &hit));
        return hit.radiance > 0 ? std::optional(hit) : std::nullopt;
    }

    /** Bound of the power, in watts, that reaches a box. */
    double power_bound(const vec3 &min, const vec3 &max) const {
        double bound = 0;
        check(tem00_light_power_bound(get(), min.data(), max.data(), &bound));
        return bound;
    }

    /** What the light was made with. */
    tem00_light_info describe() const {
        tem00_light_info info;
        check(tem00_light_describe(get(), &info));
        return info;
    }

    /** Bounds from the aperture to `distance`, in metres, along the axis. */
    tem00_bounds bounds(double distance) const {
        tem00_bounds bounds;
        check(tem00_light_bounds(get(), distance, &bounds));
        return bounds;
    }

    /** Irradiances at `count` points. */
    void irradiance(const double *x, const double *y, const double *z, std::size_t count,
                    double *irradiance) const {
        check(tem00_light_irradiance_batch(get(), x, y, z, count, irradiance));
    }

    /** Irradiances at `count` points in single precision. */
    void irradiance(const float *x, const float *y, const float *z, std::size_t count,
                    float *irradiance) const {
        check(tem00_light_irradiance_batch_f32(get(), x, y, z, count, irradiance));
    }

    /** Next events at `count` points; all 0 where it is dark. */
    void next_event(const double *x, const double *y, const double *z, std::size_t count,
                    const tem00_next_event_columns &events) const {
        check(tem00_light_next_event_batch(get(), x, y, z, count, &events));
    }

    /** Next events at `count` points in single precision; all 0 where it is dark. */
    void next_event(const float *x, const float *y, const float *z, std::size_t count,
                    const tem00_next_event_columns_f32 &events) const {
        check(tem00_light_next_event_batch_f32(get(), x, y, z, count, &events));
    }

    /**
     * Sampled events at `count` points of x, y, z, with two random numbers for each; all 0 where
     * dark.
     */
    void next_event_sampled(const double *points, const double *u, std::size_t count,
                            tem00_sampled_event *events) const {
        check(tem00_light_next_event_sampled_batch(get(), points, u, count, events));
    }

    /** Rays that leave the aperture, `count` of them, drawn with four random numbers for each. */
    void sample_ray(const double *u, std::size_t count, tem00_ray_sample *rays) const {
        check(tem00_light_sample_ray_batch(get(), u, count, rays));
    }

    /** The light as plain numbers in single precision, for a GPU or tem00_beam.h. */
    tem00_light_data plain_data() const {
        tem00_light_data data;
        check(tem00_light_plain_data(get(), &data));
        return data;
    }

    /** The handle, for what is called in C. */
    const tem00_light *get() const noexcept { return handle_.get(); }

private:
    struct destroy {
        void operator()(tem00_light *handle) const noexcept { tem00_light_destroy(handle); }
    };

    template <typename Description>
    static tem00_light *made(tem00_status (*create)(const Description *, tem00_light **),
                             const Description &description) {
        tem00_light *handle = nullptr;
        check(create(&description, &handle));
        return handle;
    }

    std::unique_ptr<tem00_light, destroy> handle_;
};

/** A camera, whose image the speckle is in. Any number of threads may ask it at once. */
class camera {
public:
    explicit camera(const tem00_camera_description &description) {
        tem00_camera *handle = nullptr;
        check(tem00_camera_create(&description, &handle));
        handle_.reset(handle);
    }

    /** Where in the image `point` is seen, in pixels with y down. */
    vec2 project(const vec3 &point) const {
        vec2 pixel{};
        check(tem00_camera_project(get(), point.data(), pixel.data()));
        return pixel;
    }

    /** The handle, for what is called in C. */
    const tem00_camera *get() const noexcept { return handle_.get(); }

private:
    struct destroy {
        void operator()(tem00_camera *handle) const noexcept { tem00_camera_destroy(handle); }
    };

    std::unique_ptr<tem00_camera, destroy> handle_;
};

/** The speckle of one body in one frame. Any number of threads may ask it at once. */
class speckle_frame {
public:
    /** Factor, with mean 1, of the radiance that a point sends to the camera. */
    double factor(const vec3 &point, const vec3 &normal) const {
        double factor = 0;
        check(tem00_speckle_frame_factor(get(), point.data(), normal.data(), &factor));
        return factor;
    }

    /** Factor at a point that a camera sample sees at an image point, in pixels with y down. */
    double factor_at(const vec2 &pixel, const vec3 &point, const vec3 &normal) const {
        double factor = 0;
        check(tem00_speckle_frame_factor_at(get(), pixel.data(), point.data(), normal.data(),
                                            &factor));
        return factor;
    }

    /** Factors at `count` points of x, y, z, with their normals. */
    void factors(const double *points, const double *normals, std::size_t count,
                 double *factors) const {
        check(tem00_speckle_frame_factors(get(), points, normals, count, factors));
    }

    /** Mean factor over the pixel about the image of a point. */
    double average(const vec3 &point, const vec3 &normal) const {
        double average = 0;
        check(tem00_speckle_frame_average(get(), point.data(), normal.data(), &average));
        return average;
    }

    /** What has become of the speckle at a point since the reference state. */
    tem00_speckle_shift shift(const vec3 &point, const vec3 &normal) const {
        tem00_speckle_shift shift;
        check(tem00_speckle_frame_shift(get(), point.data(), normal.data(), &shift));
        return shift;
    }

    /** The handle, for what is called in C. */
    const tem00_speckle_frame *get() const noexcept { return handle_.get(); }

private:
    friend class speckle;

    struct destroy {
        void operator()(tem00_speckle_frame *handle) const noexcept {
            tem00_speckle_frame_destroy(handle);
        }
    };

    explicit speckle_frame(tem00_speckle_frame *handle) noexcept : handle_(handle) {}

    std::unique_ptr<tem00_speckle_frame, destroy> handle_;
};

/** The speckle of a light in the image of a camera. Any number of threads may ask it at once. */
class speckle {
public:
    speckle(const camera &camera, const light &light,
            const tem00_speckle_description &description) {
        tem00_speckle *handle = nullptr;
        check(tem00_speckle_create(camera.get(), light.get(), &description, &handle));
        handle_.reset(handle);
    }

    /** What was chosen; its text belongs to this object. */
    tem00_speckle_info info() const {
        tem00_speckle_info info;
        check(tem00_speckle_describe(get(), &info));
        return info;
    }

    /**
     * The speckle of a body in a frame, which outlives this; without a motion that of the reference
     * state.
     */
    speckle_frame frame(const tem00_body_motion &motion = {}) const {
        tem00_speckle_frame *handle = nullptr;
        check(tem00_speckle_frame_create(get(), &motion, &handle));
        return speckle_frame(handle);
    }

    /**
     * Factors at `count` points that stood at `previous` in the reference state, from buffers of an
     * image.
     */
    void factors_since(const double *previous, const double *points, const double *normals,
                       std::size_t count, double *factors) const {
        check(tem00_speckle_factors_since(get(), previous, points, normals, count, factors));
    }

    /** The handle, for what is called in C. */
    const tem00_speckle *get() const noexcept { return handle_.get(); }

private:
    struct destroy {
        void operator()(tem00_speckle *handle) const noexcept { tem00_speckle_destroy(handle); }
    };

    std::unique_ptr<tem00_speckle, destroy> handle_;
};

/** Chooses a stack that repeats nothing in the region, with the seed 0. */
inline tem00_stack_description plan(const tem00_stack_needs &needs) {
    tem00_stack_description description;
    check(tem00_stack_plan(&needs, &description));
    return description;
}

/** Speckle that moves and decorrelates. Any number of threads may look it up at once. */
class stack {
public:
    explicit stack(const tem00_stack_description &description) {
        tem00_stack *handle = nullptr;
        check(tem00_stack_create(&description, &handle));
        handle_.reset(handle);
    }

    /** What the stack is. */
    tem00_stack_info info() const {
        tem00_stack_info info;
        check(tem00_stack_describe(get(), &info));
        return info;
    }

    /** Intensity, with mean 1, at (x, y) in samples and u in slices. */
    double intensity(double x, double y, double u) const {
        double intensity = 0;
        check(tem00_stack_intensity(get(), x, y, u, &intensity));
        return intensity;
    }

    /** Intensities at `count` points. */
    void intensity(const double *x, const double *y, const double *u, std::size_t count,
                   double *intensity) const {
        check(tem00_stack_intensity_batch(get(), x, y, u, count, intensity));
    }

    /** Intensities at `count` points in single precision. */
    void intensity(const float *x, const float *y, const float *u, std::size_t count,
                   float *intensity) const {
        check(tem00_stack_intensity_batch_f32(get(), x, y, u, count, intensity));
    }

    /** Means of the intensity over boxes of `size` samples about `count` points. */
    void average(const float *x, const float *y, const vec2 &size, const float *u,
                 std::size_t count, float *average) const {
        check(tem00_stack_average_batch_f32(get(), x, y, size.data(), u, count, average));
    }

    /** Amplitude whose squared magnitude is the intensity, for light whose fields add. */
    std::complex<double> amplitude(double x, double y, double u) const {
        vec2 amplitude{};
        check(tem00_stack_amplitude(get(), x, y, u, amplitude.data()));
        return {amplitude[0], amplitude[1]};
    }

    /** Mean of the intensity over a box of `size` samples about `centre`. */
    double average(const vec2 &centre, const vec2 &size, double u) const {
        double average = 0;
        check(tem00_stack_average(get(), centre.data(), size.data(), u, &average));
        return average;
    }

    /** The coordinate u at which the intensity has a given `correlation` to that at u = 0. */
    double coordinate_of(double correlation) const {
        double u = 0;
        check(tem00_stack_coordinate_of(get(), correlation, &u));
        return u;
    }

    /** Correlation of the intensities at u = 0 and u = `distance`. */
    double correlation_at(double distance) const {
        double correlation = 0;
        check(tem00_stack_correlation_at(get(), distance, &correlation));
        return correlation;
    }

    /** Correlation of the intensities at two coordinates u and v, on slices or between, exactly. */
    double correlation_between(double u, double v) const {
        double correlation = 0;
        check(tem00_stack_correlation_between(get(), u, v, &correlation));
        return correlation;
    }

    /** The complex coefficients of a slice, which belong to the stack: real, imaginary, real, … */
    const float *coefficients(std::size_t slice) const {
        const float *coefficients = nullptr;
        check(tem00_stack_coefficients(get(), slice, &coefficients));
        return coefficients;
    }

    /** Place of the pupil of a slice, in its diameters. */
    vec2 offset(std::size_t slice) const {
        vec2 offset{};
        check(tem00_stack_offset(get(), slice, offset.data()));
        return offset;
    }

    /** The handle, for what is called in C. */
    const tem00_stack *get() const noexcept { return handle_.get(); }

private:
    struct destroy {
        void operator()(tem00_stack *handle) const noexcept { tem00_stack_destroy(handle); }
    };

    explicit stack(tem00_stack *handle) noexcept : handle_(handle) {}

    std::unique_ptr<tem00_stack, destroy> handle_;
};

/**
 * The light of a laser with a linewidth in one resolution cell. Any number of threads may ask it at
 * once.
 */
class bandwidth {
public:
    explicit bandwidth(const tem00_bandwidth_description &description) {
        tem00_bandwidth *handle = nullptr;
        check(tem00_bandwidth_create(&description, &handle));
        handle_.reset(handle);
    }

    /**
     * What the linewidth makes of speckle, and what stands for it; pointers belong to this object.
     */
    tem00_bandwidth_info info() const {
        tem00_bandwidth_info info;
        check(tem00_bandwidth_describe(get(), &info));
        return info;
    }

    /** A wave number drawn with a random number. */
    tem00_wave draw(double uniform) const {
        tem00_wave wave;
        check(tem00_bandwidth_draw(get(), uniform, &wave));
        return wave;
    }

    /** Covariance of two frames, after a motion in pupil diameters along the tilt and across it. */
    double covariance(const vec2 &displacement) const {
        double covariance = 0;
        check(tem00_bandwidth_covariance(get(), displacement.data(), &covariance));
        return covariance;
    }

    /** Deviation of the position of a line over that in light of one wavelength. */
    double line_noise_ratio(double row_height) const {
        double ratio = 0;
        check(tem00_bandwidth_line_noise_ratio(get(), row_height, &ratio));
        return ratio;
    }

    /** The handle, for what is called in C. */
    const tem00_bandwidth *get() const noexcept { return handle_.get(); }

private:
    struct destroy {
        void operator()(tem00_bandwidth *handle) const noexcept { tem00_bandwidth_destroy(handle); }
    };

    std::unique_ptr<tem00_bandwidth, destroy> handle_;
};

/** A camera focused on a surface. Any number of threads may ask it at once. */
class imaging {
public:
    explicit imaging(const tem00_lens_description &lens) {
        tem00_imaging *handle = nullptr;
        check(tem00_imaging_create_lens(&lens, &handle));
        handle_.reset(handle);
    }

    explicit imaging(const tem00_pupil_distances &distances) {
        tem00_imaging *handle = nullptr;
        check(tem00_imaging_create_distances(&distances, &handle));
        handle_.reset(handle);
    }

    /** What the camera is: among others, the size of its speckle. */
    tem00_imaging_info info() const {
        tem00_imaging_info info;
        check(tem00_imaging_describe(get(), &info));
        return info;
    }

    /** Where in a speckle pattern a pixel lies, in pattern samples. */
    vec2 pattern_coordinate(const vec2 &pixel, const vec2 &displacement,
                            double pattern_speckle_size) const {
        vec2 coordinate{};
        check(tem00_imaging_pattern_coordinate(get(), pixel.data(), displacement.data(),
                                               pattern_speckle_size, coordinate.data()));
        return coordinate;
    }

    /** The handle, for what is called in C. */
    const tem00_imaging *get() const noexcept { return handle_.get(); }

private:
    struct destroy {
        void operator()(tem00_imaging *handle) const noexcept { tem00_imaging_destroy(handle); }
    };

    std::unique_ptr<tem00_imaging, destroy> handle_;
};

/**
 * Intensity correlation at the peak, after a displacement in pupil diameters and in axial lengths.
 */
inline double correlation(double pupil_shift, double axial_shift) {
    double correlation = 0;
    check(tem00_correlation(pupil_shift, axial_shift, &correlation));
    return correlation;
}

} // namespace tem00

#endif
