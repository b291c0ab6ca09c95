// A plane under a laser spot slides by 0.1 mm: how much of its speckle is left, by the law and as
// found.
#include <cmath>
#include <cstdio>

#include "tem00.hpp"

int main() {
    // Position, look at, up; focal length, f-number, focus, pixel pitch, resolution; a plain
    // sensor.
    const tem00_camera_description lens = {{0, 0, 0.3}, {0, 0, 0}, {0, 1, 0}, 25e-3, 8, 0.3,
                                           3.45e-6, {640, 480}, {}, {}, {}};
    // Origin, direction and fan axis; wavelength, power, waist radius and distance, beam quality.
    const tem00_spot_description spot = {{{0.2, 0, 0.4}, {-0.2, 0, -0.4}, {1, 0, 0}},
                                         650e-9, 5e-3, 3e-3, 0.447, 1};
    const tem00::light laser(spot);
    tem00_body_motion slid = {};  // from the reference state to now: all 0 is no motion
    slid.surface.translation[0] = 1e-4;
    // Seed, motions, points of interest, memory, looks, polarisation, threads.
    const tem00_speckle_description wanted = {1, &slid, 1, nullptr, nullptr, 0, 64 << 20, 1, 1, 0};
    const tem00::speckle speckle(tem00::camera(lens), laser, wanted);
    std::puts(speckle.info().summary);  // what it chose and why
    const auto before = speckle.frame(), after = speckle.frame(slid);  // once per body and frame

    // Per hit: L = factor * f |n . wi| V e_perp, the last by the next event of the laser.
    const tem00::vec3 normal = {0, 0, 1};
    const auto shift = after.shift({0, 0, 0}, normal);
    const double pixel = 3.45e-6 * (0.3 - 25e-3) / 25e-3;  // on the plane, in metres
    const double dx = shift.displacement[0] * pixel, dy = -shift.displacement[1] * pixel;
    double n = 0, a = 0, b = 0, aa = 0, ab = 0, bb = 0;
    for (double y = -6e-3; y < 6e-3; y += 2 * pixel) {
        for (double x = -8e-3; x < 8e-3; x += 2 * pixel, ++n) {
            const double f = before.factor({x, y, 0}, normal);
            const double g = after.factor({x + dx, y + dy, 0}, normal);
            a += f, b += g, aa += f * f, ab += f * g, bb += g * g;
        }
    }
    const double found = (n * ab - a * b) / std::sqrt((n * aa - a * a) * (n * bb - b * b));
    std::printf("correlation %.3f, by the law %.3f\n", found, shift.correlation);
    return std::abs(found - shift.correlation) < 0.02 ? 0 : 1;
}
