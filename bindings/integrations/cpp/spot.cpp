// Renders a speckled laser spot on a plane, and compares what it measures with theory.
//
//     spot FILE.pgm
//
// A red laser falls on a diffuse plane at 60° from its normal; a camera looks at it from above,
// each pixel along the normal. Of each pixel the program asks the next event of the laser, as a
// renderer does, and multiplies it by the speckle that the pixel sees.
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <exception>
#include <fstream>
#include <vector>

#include "tem00.hpp"

namespace {

constexpr double pi = 3.14159265358979323846;

constexpr int width = 480, height = 320;
constexpr double pixel_pitch = 3.45e-6, magnification = 0.345;
constexpr double pixel = pixel_pitch / magnification;  // on the plane, in metres
constexpr double power = 5e-3;
constexpr double wavelength = 650e-9;

tem00::light laser() {
    const double angle = pi / 3, distance = 0.2;
    const double sine = std::sin(angle), cosine = std::cos(angle);
    tem00_spot_description spot = {};
    spot.placement = {{-distance * sine, 0, distance * cosine}, {sine, 0, -cosine}, {0, 1, 0}};
    spot.wavelength = wavelength;
    spot.power = power;
    spot.waist_radius = 0.25e-3;
    spot.waist_distance = distance;
    spot.m_squared = 1.1;
    return tem00::light(spot);
}

// The speckle that a lens of 25 mm at f/4 sees from above: it is about as large as a pixel.
tem00::speckle speckle(const tem00::light &light) {
    const double focal_length = 25e-3, distance = focal_length * (1 + 1 / magnification);
    tem00_camera_description lens = {};
    lens.position[2] = lens.focus_distance = distance;
    lens.up[1] = 1;
    lens.focal_length = focal_length;
    lens.f_number = 4;
    lens.pixel_pitch = pixel_pitch;
    lens.resolution[0] = width;
    lens.resolution[1] = height;
    tem00_speckle_description wanted = {};
    wanted.seed = 1;
    wanted.memory_limit = std::uint64_t{64} << 20;
    wanted.looks = 1;
    wanted.polarisation = 1;
    return tem00::speckle(tem00::camera(lens), light, wanted);
}

// What the loop over the pixels leaves.
struct picture {
    std::vector<double> irradiance;  // of the plane, in W/m²
    std::vector<double> at_centre;   // intensity of the speckle at the pixel's centre
    std::vector<double> over_pixel;  // its mean over the pixel
};

picture render(const tem00::light &light, const tem00::speckle_frame &speckle) {
    const tem00::vec3 normal = {0, 0, 1};
    picture result;
    for (int row = 0; row < height; ++row) {
        for (int column = 0; column < width; ++column) {
            const tem00::vec3 point = {(column + 0.5 - width / 2.0) * pixel,
                                       (height / 2.0 - row - 0.5) * pixel, 0};
            const auto event = light.next_event(point);
            result.irradiance.push_back(event ? event->e_perp * std::abs(event->wi[2]) : 0);
            result.at_centre.push_back(speckle.factor(point, normal));
            result.over_pixel.push_back(speckle.average(point, normal));
        }
    }
    return result;
}

double sum(const std::vector<double> &values) {
    double total = 0;
    for (const double value : values) {
        total += value;
    }
    return total;
}

double contrast(const std::vector<double> &values) {
    const double count = static_cast<double>(values.size());
    const double mean = sum(values) / count;
    double variance = 0;
    for (const double value : values) {
        variance += (value - mean) * (value - mean) / count;
    }
    return std::sqrt(variance) / mean;
}

// The amplitude correlation 2 J1(v)/v of two points, v = π r / h, by the midpoint rule over the
// angles of Bessel's integral, which is exact to rounding for so few waves.
double correlation(double distance, double speckle_size) {
    const double v = pi * distance / speckle_size;
    if (v < 1e-6) {
        return 1;
    }
    constexpr int count = 32;
    double bessel = 0;
    for (int i = 0; i < count; ++i) {
        const double angle = pi * (i + 0.5) / count;
        bessel += std::cos(angle - v * std::sin(angle)) / count;
    }
    return 2 * bessel / v;
}

// The contrast that averaging over a square pixel leaves: the mean of the squared correlation of
// two points of the pixel (Goodman 1975, §2.6), by the midpoint rule over their distance.
double pixel_contrast(double speckle_size) {
    constexpr int count = 200;
    double variance = 0;
    for (int i = 0; i < count; ++i) {
        for (int j = 0; j < count; ++j) {
            const double x = (i + 0.5) / count, y = (j + 0.5) / count;
            const double mu = correlation(std::hypot(x, y), speckle_size);
            variance += 4 * (1 - x) * (1 - y) * mu * mu / (count * count);
        }
    }
    return std::sqrt(variance);
}

// A PGM of 16 bits, the largest number first, its rows from above.
bool write(const char *path, const picture &picture) {
    std::vector<double> values;
    double largest = 0;
    for (std::size_t i = 0; i < picture.irradiance.size(); ++i) {
        values.push_back(picture.irradiance[i] * picture.over_pixel[i]);
        largest = std::fmax(largest, values.back());
    }
    std::ofstream file(path, std::ios::binary);
    file << "P5\n" << width << ' ' << height << "\n65535\n";
    for (const double value : values) {
        const auto grey = static_cast<unsigned>(std::lround(65535 * value / largest));
        file.put(static_cast<char>(grey >> 8)).put(static_cast<char>(grey & 255));
    }
    return file.good();
}

bool agree(const char *what, double measured, double theory, double tolerance) {
    const bool agrees = std::abs(measured - theory) < tolerance;
    std::printf("%-28s %10.6f | %10.6f ± %.6f %s\n", what, measured, theory, tolerance,
                agrees ? "" : "WRONG");
    return agrees;
}

bool run(const char *path) {
    const tem00::light light = laser();
    const tem00::speckle prepared = speckle(light);
    const double speckle_size = prepared.info().speckle_size;
    const picture picture = render(light, prepared.frame());

    std::puts("                               measured |     theory");
    // The spot is smooth over a pixel: the sum errs by what the cut-off leaves out.
    const double on_plane = sum(picture.irradiance) * pixel * pixel;
    bool right = agree("power on the plane, in mW", 1e3 * on_plane, 1e3 * power,
                       1e-3 * 1e3 * power);

    // The contrast of n independent exponential numbers errs by 1/√n; an intensity is correlated
    // over an area of 4 h²/π pixels. Five standard errors.
    const double independent = width * height / (4 * speckle_size * speckle_size / pi);
    const double tolerance = 5 / std::sqrt(independent);
    right &= agree("contrast at points", contrast(picture.at_centre), 1, tolerance);
    right &= agree("contrast over pixels", contrast(picture.over_pixel),
                   pixel_contrast(speckle_size), tolerance);

    const bool written = write(path, picture);
    std::printf("%s %s\n", written ? "wrote" : "could not write", path);
    return right && written;
}

}  // namespace

int main(int count, char **arguments) {
    if (count != 2) {
        std::fputs("usage: spot FILE.pgm\n", stderr);
        return 2;
    }
    try {
        return run(arguments[1]) ? 0 : 1;
    } catch (const std::exception &error) {
        std::fprintf(stderr, "%s\n", error.what());
        return 1;
    }
}
