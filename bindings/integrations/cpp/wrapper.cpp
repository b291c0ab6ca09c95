// What tem00.hpp adds to the header: handles that free themselves, and exceptions.
//
//     wrapper FILE
//
// The file is written and read again.
#include <array>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <exception>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "tem00.hpp"

namespace {

int failures = 0;

void expect(bool holds, const char *what) {
    std::printf("%-60s %s\n", what, holds ? "yes" : "NO");
    failures += !holds;
}

tem00_spot_description spot() {
    tem00_spot_description spot = {};
    spot.placement = {{0, 0, 0.3}, {0, 0, -1}, {1, 0, 0}};
    spot.wavelength = 650e-9;
    spot.power = 5e-3;
    spot.waist_radius = 0.1e-3;
    spot.waist_distance = 0.3;
    spot.m_squared = 1;
    return spot;
}

tem00_stack_description stack_description() {
    tem00_stack_description description = {};
    description.width = description.height = 64;
    description.diameter = 16;
    description.seed = 7;
    description.path = TEM00_SLICE_PATH_CIRCLE;
    description.half_period = 4;
    description.memory_limit = UINT64_MAX;
    return description;
}

// The error that a call throws, or one of no status if it throws none.
template <typename Call> std::pair<tem00_status, std::string> thrown(const Call &call) {
    try {
        call();
    } catch (const tem00::error &error) {
        return {error.status(), error.parameter()};
    }
    return {TEM00_STATUS_OK, ""};
}

using refusal = std::pair<tem00_status, std::string>;

void lights() {
    tem00::light first(spot());
    const tem00::light light = std::move(first);
    // 2 P / (π w²) at the waist.
    const double peak = 2 * 5e-3 / (3.14159265358979323846 * 1e-8);
    const auto event = light.next_event({0, 0, 0});
    expect(event && std::abs(event->e_perp / peak - 1) < 1e-12, "the waist has 2 P / (pi w^2)");
    expect(event && event->wi[2] == 1, "the light comes from above");
    expect(!light.next_event({0.01, 0, 0}), "it is dark beside the beam");

    const auto drawn = light.next_event_sampled({0, 0, 0}, {0.3, 0.8});
    const tem00::vec3 wi = {drawn->wi[0], drawn->wi[1], drawn->wi[2]};
    const double pdf = light.next_event_pdf({0, 0, 0}, wi);
    expect(std::abs(pdf / drawn->pdf - 1) < 1e-9, "a sampled event has its density");
    const auto hit = light.hit({0, 0, 0}, wi);
    expect(hit && std::abs(hit->radiance / (drawn->value * hit->pdf) - 1) < 1e-9,
           "a ray towards the light hits it");
    expect(!light.hit({0, 0, 0}, {0, 0, -1}), "a ray away from the light misses it");
    expect(light.power_bound({-1, -1, -1}, {1, 1, 0}) == light.describe().power,
           "a large box has all of the power");

    const auto ray = light.sample_ray({0.2, 0.4, 0.6, 0.8});
    const tem00::vec3 origin = {ray.origin[0], ray.origin[1], ray.origin[2]};
    const tem00::vec3 way = {ray.direction[0], ray.direction[1], ray.direction[2]};
    const auto density = light.ray_pdf(origin, way);
    const double flux = light.radiance(origin, way) * ray.cos /
                        (density.position * density.direction_given_position);
    expect(std::abs(flux / 5e-3 - 1) < 1e-9, "a ray carries the power of the laser");

    const std::array<double, 8> u = {0.2, 0.4, 0.6, 0.8, 0.1, 0.3, 0.5, 0.7};
    std::array<tem00_ray_sample, 2> rays;
    light.sample_ray(u.data(), rays.size(), rays.data());
    expect(std::memcmp(&rays[0], &ray, sizeof ray) == 0, "a batch of rays has the same rays");
    std::array<tem00_sampled_event, 2> events;
    const std::array<double, 6> points = {0, 0, 0, 0.01, 0, 0};
    light.next_event_sampled(points.data(), u.data(), events.size(), events.data());
    expect(events[0].pdf > 0 && events[1].pdf == 0, "a batch of sampled events is lit where it is");

    const std::vector<float> zero(100, 0);
    std::vector<float> irradiance(100);
    light.irradiance(zero.data(), zero.data(), zero.data(), zero.size(), irradiance.data());
    expect(std::abs(irradiance[99] / peak - 1) < 1e-5, "single precision has it too");
    expect(light.bounds(0.3).max[2] >= 0.3, "the bounds hold the laser");
    expect(light.plain_data().kind == TEM00_LIGHT_KIND_SPOT, "its plain data are of a spot");
}

void refusals() {
    auto wrong = spot();
    wrong.waist_radius = -1;
    expect(thrown([&] { tem00::light light(wrong); }) ==
               refusal(TEM00_STATUS_INVALID_ARGUMENT, "waist_radius"),
           "a negative waist is refused by name");
    const tem00::light light(spot());
    expect(thrown([&] { light.irradiance({NAN, 0, 0}); }) ==
               refusal(TEM00_STATUS_INVALID_ARGUMENT, "point"),
           "a point that is not finite is refused by name");
    std::vector<double> column(8);
    expect(thrown([&] {
               light.irradiance(column.data(), column.data(), column.data(), 8, column.data());
           }) == refusal(TEM00_STATUS_INVALID_POINTER, "irradiance"),
           "results over what is read are refused");
    auto large = stack_description();
    large.memory_limit = 1000;
    expect(thrown([&] { tem00::stack stack(large); }).first == TEM00_STATUS_MEMORY,
           "a stack above the limit is refused");
}

void stacks() {
    const tem00::stack stack(stack_description());
    const double u = stack.coordinate_of(0.5);
    expect(std::abs(stack.correlation_at(u) - 0.5) < 1e-9, "half the correlation is left at u");
    const double mean = stack.average({3, 8}, {64, 64}, 0);
    expect(std::abs(mean - 1) < 1e-4, "the mean over the period is 1");
}

void linewidths() {
    const double peaks[] = {448e-9, 1, 452e-9, 1};
    tem00_bandwidth_description description = {};
    description.linewidth = 1e-9;
    description.peaks = peaks;
    description.peak_count = 2;
    description.to_source[2] = description.to_pupil[2] = description.normal[2] = 1;
    description.to_pupil[0] = 0.5;
    description.sin_aperture = 0.025;
    const tem00::bandwidth light(description);
    const double contrast = light.info().contrast;
    expect(contrast < 1 && std::abs(light.covariance({0, 0}) / (contrast * contrast) - 1) < 1e-9,
           "two frames without a motion share all of the contrast");
    expect(light.line_noise_ratio(0) > contrast,
           "the noise of a line falls less than the contrast");
    expect(light.draw(0.25).wave_number > light.draw(0.75).wave_number,
           "peaks stand in their order");
    const tem00::stack stack(stack_description());
    expect(std::abs(std::norm(stack.amplitude(3, 5, 0.5)) - stack.intensity(3, 5, 0.5)) < 1e-5,
           "an amplitude squared is the intensity");
    description.linewidth = 1e-6;
    expect(thrown([&] { tem00::bandwidth broad(description); }) ==
               refusal(TEM00_STATUS_INVALID_ARGUMENT, "linewidth"),
           "a linewidth above the wavelength is refused by name");
}

void cameras() {
    const tem00::imaging camera(tem00_pupil_distances{632.8e-9, 0.3, 75e-3, 10e-3, 3.45e-6});
    expect(std::abs(camera.info().speckle_size - 632.8e-9 * 7.5) < 1e-18,
           "speckle is wavelength times working f-number");
    // A speckle has 4 samples.
    const auto at = camera.pattern_coordinate({1, 0}, {0, 0}, 4);
    expect(std::abs(at[0] / (4 * 3.45e-6 / camera.info().speckle_size) - 1) < 1e-12 && at[1] == 0,
           "a pixel has a place in the pattern");
    expect(tem00::correlation(0.25, 0) < 0.47 && tem00::correlation(0, 0) == 1,
           "what is left is the overlap of the pupils");
}

tem00::speckle_frame moved_frame(const tem00_camera_description &lens,
                                 const tem00_body_motion &motion) {
    auto wide = spot();
    wide.waist_radius = 5e-3;
    tem00_speckle_description wanted = {};
    wanted.motions = &motion;
    wanted.motion_count = 1;
    wanted.memory_limit = 64 << 20;
    wanted.looks = 1;
    wanted.polarisation = 1;
    const tem00::speckle speckle(tem00::camera(lens), tem00::light(wide), wanted);
    expect(std::string(speckle.info().summary).find("in 2 frames") != std::string::npos,
           "speckle says what was chosen");
    const std::array<double, 3> point = {1e-4, 0, 0}, before = {0, 0, 0}, normal = {0, 0, 1};
    std::array<double, 1> factor;
    speckle.factors_since(before.data(), point.data(), normal.data(), 1, factor.data());
    expect(factor[0] == speckle.frame(motion).factor(point, normal),
           "a buffer has the bits of a hit");
    return speckle.frame(motion);
}

void speckles() {
    tem00_camera_description lens = {};
    lens.position[2] = lens.focus_distance = 0.3;
    lens.up[1] = 1;
    lens.focal_length = 25e-3;
    lens.f_number = 8;
    lens.pixel_pitch = 3.45e-6;
    lens.resolution[0] = lens.resolution[1] = 64;
    const auto middle = tem00::camera(lens).project({0, 0, 0});
    expect(middle == tem00::vec2{32, 32}, "a camera sees what it looks at in the middle");

    tem00_body_motion motion = {};
    motion.surface.translation[0] = 1e-4;
    const auto frame = moved_frame(lens, motion);  // the speckle is gone, its frame is not
    // 0.1 mm over a pupil of 25 mm / 8.
    const auto shift = frame.shift({1e-4, 0, 0}, {0, 0, 1});
    expect(std::abs(shift.pupil_shift / 0.032 - 1) < 1e-4,
           "speckle moves over the pupil with a plane");
    expect(shift.correlation == tem00::correlation(shift.pupil_shift, 0),
           "what is left is the overlap");
    const std::array<double, 6> points = {0, 0, 0, NAN, 0, 0}, normals = {0, 0, 1, 0, 0, 1};
    std::array<double, 2> factors;
    frame.factors(points.data(), normals.data(), 2, factors.data());
    expect(factors[0] == frame.factor({0, 0, 0}, {0, 0, 1}) && factors[1] == 1,
           "factors in batches are those of hits, and 1 out of sight");
    expect(frame.average({0, 0, 0}, {0, 0, 1}) > 0, "a pixel has a mean");
    motion.surface.rotation[0][0] = 2;
    expect(thrown([&] { moved_frame(lens, motion); }) ==
               refusal(TEM00_STATUS_INVALID_ARGUMENT, "motions[0].surface.rotation"),
           "a matrix that is no rotation is refused by name");
}

// Threads ask one light at once, and each has its own message.
void threads() {
    const tem00::light light(spot());
    std::vector<std::thread> all;
    std::vector<int> right(4);
    for (std::size_t i = 0; i < right.size(); ++i) {
        all.emplace_back([&light, &right, i] {
            const std::string name = i % 2 == 0 ? "point" : "distance";
            int count = 0;
            for (int j = 0; j < 200; ++j) {
                const auto refused = thrown([&] {
                    i % 2 == 0 ? (void)light.irradiance({0, INFINITY, 0}) : (void)light.bounds(-1);
                });
                count += refused.second == name && light.next_event({0, 0, 0}).has_value();
            }
            right[i] = count;
        });
    }
    for (auto &thread : all) {
        thread.join();
    }
    expect(right == std::vector<int>(4, 200), "each thread has its own message");
}

}  // namespace

int main() {
    try {
        lights();
        refusals();
        stacks();
        linewidths();
        cameras();
        speckles();
        threads();
    } catch (const std::exception &error) {
        std::fprintf(stderr, "%s\n", error.what());
        return 1;
    }
    return failures == 0 ? 0 : 1;
}
