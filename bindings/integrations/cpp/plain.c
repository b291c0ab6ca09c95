/*
 * The header in C99: a light from its description, a batch, a linewidth, a refusal and its message,
 * and the plain numbers of the light in the closed forms of tem00_beam.h.
 */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "tem00.h"
#include "tem00_beam.h"

enum { COUNT = 5 };

static const tem00_line_description line = {
    .placement = {{0.1, -0.2, 0.3}, {0.3, -0.5, 0.8}, {1, 0.2, 0.1}},
    .wavelength = 650e-9,
    .power = 5e-3,
    .waist_radius = 80e-6,
    .m_squared = 1.2,
    .fan_angle = 0.5,
    .apex_offset = 2e-3,
    .focus_distance = 0.25,
    .focus_curve = TEM00_FOCUS_CURVE_EQUAL_PLANE,
    .profile = TEM00_LINE_PROFILE_POWELL,
    .edge = 0.1,
};

static int failures = 0;

static void expect(int holds, const char *what) {
    printf("%-52s %s\n", what, holds ? "yes" : "NO");
    failures += !holds;
}

/* Points on rays of the light, each 0.2 m from the lens. */
static tem00_status lit_points(const tem00_light *light, double x[], double y[], double z[]) {
    for (int i = 0; i < COUNT; ++i) {
        const double u[4] = {0.1 + 0.2 * i, 0.5, 0.3, 0.6};
        tem00_ray_sample ray;
        const tem00_status status = tem00_light_sample_ray(light, u, &ray);
        if (status != TEM00_STATUS_OK) {
            return status;
        }
        x[i] = ray.origin[0] + 0.2 * ray.direction[0];
        y[i] = ray.origin[1] + 0.2 * ray.direction[1];
        z[i] = ray.origin[2] + 0.2 * ray.direction[2];
    }
    return TEM00_STATUS_OK;
}

/* Single precision carries coordinates of half a metre to 3e-8 m, and the line is 1e-4 m thick: its
 * irradiance errs by a few parts in a thousand. */
static int closed_form_agrees(const tem00_light *light, const double p[3], double e_perp) {
    tem00_light_data data;
    if (tem00_light_plain_data(light, &data) != TEM00_STATUS_OK ||
        data.kind != TEM00_LIGHT_KIND_LINE || sizeof(Tem00LineLightF32) != sizeof data.fields) {
        return 0;
    }
    Tem00LineLightF32 plain;
    memcpy(&plain, data.fields, sizeof plain);
    const float single[3] = {(float)p[0], (float)p[1], (float)p[2]};
    const Tem00NextEventF32 event = tem00_line_next_event_f32(&plain, single);
    return fabs((double)event.e_perp / e_perp - 1) < 5e-3;
}

static void ask(const tem00_light *light) {
    double x[COUNT], y[COUNT], z[COUNT], wi[3][COUNT], distance[COUNT], e_perp[COUNT];
    expect(lit_points(light, x, y, z) == TEM00_STATUS_OK, "rays are drawn");
    const tem00_next_event_columns columns = {wi[0], wi[1], wi[2], distance, e_perp};
    expect(tem00_light_next_event_batch(light, x, y, z, COUNT, &columns) == TEM00_STATUS_OK,
           "a batch is answered");
    int same = 1, lit = 1, closed = 1;
    for (int i = 0; i < COUNT; ++i) {
        const double p[3] = {x[i], y[i], z[i]};
        tem00_next_event event;
        same &= tem00_light_next_event(light, p, &event) == TEM00_STATUS_OK;
        same &= event.distance == distance[i] && event.e_perp == e_perp[i];
        lit &= e_perp[i] > 0;
        closed &= closed_form_agrees(light, p, e_perp[i]);
    }
    expect(lit, "points on rays are lit");
    expect(same, "single calls have the bits of the batch");
    expect(closed, "the closed form agrees in single precision");
}

/* A superluminescent diode, head-on, seen under 30 degrees. */
static void broaden(void) {
    const tem00_bandwidth_description diode = {
        .wavelength = 450e-9,
        .linewidth = 20e-9,
        .shape = TEM00_PEAK_SHAPE_GAUSSIAN,
        .to_source = {0, 0, 1},
        .to_pupil = {0.5, 0, sqrt(0.75)},
        .normal = {0, 0, 1},
        .sin_aperture = 0.025,
    };
    tem00_bandwidth *light = NULL;
    tem00_bandwidth_info info;
    tem00_wave first, last;
    double noise = 0;
    expect(tem00_bandwidth_create(&diode, &light) == TEM00_STATUS_OK &&
               tem00_bandwidth_describe(light, &info) == TEM00_STATUS_OK &&
               tem00_bandwidth_line_noise_ratio(light, 0, &noise) == TEM00_STATUS_OK &&
               tem00_bandwidth_draw(light, 0.1, &first) == TEM00_STATUS_OK &&
               tem00_bandwidth_draw(light, 0.9, &last) == TEM00_STATUS_OK,
           "a linewidth is answered");
    expect(fabs(info.contrast - 0.731) < 1e-3, "20 nm leave 0.731 of the contrast");
    expect(fabs(noise - 0.809) < 1e-3, "and 0.809 of the noise of a line");
    expect(fabs(first.pupil_shift + last.pupil_shift) < 1e-6 && last.pupil_shift > 0.1,
           "waves see the pupil displaced to either side");
    expect(info.pattern_count == 1 && info.patterns[0] == 1 && info.height_count == 1,
           "without a relief one stack stands for all");
    tem00_bandwidth_destroy(light);
}

static void refuse(void) {
    tem00_line_description wrong = line;
    wrong.fan_angle = 4;
    tem00_light *light = NULL;
    const tem00_status status = tem00_light_create_line(&wrong, &light);
    expect(status == TEM00_STATUS_INVALID_ARGUMENT, "a fan of 4 rad is refused");
    expect(light == NULL, "and no light is made");
    expect(strcmp(tem00_last_error_parameter(), "fan_angle") == 0, "the parameter is named");
    printf("    %s\n", tem00_last_error());
    tem00_light_destroy(NULL);
    expect(tem00_light_irradiance(NULL, NULL, NULL) == TEM00_STATUS_INVALID_POINTER,
           "null is refused");
}

int main(void) {
    tem00_light *light = NULL;
    expect(strcmp(tem00_version(), TEM00_VERSION) == 0, "header and library are of one version");
    if (tem00_light_create_line(&line, &light) != TEM00_STATUS_OK) {
        fprintf(stderr, "%s\n", tem00_last_error());
        return 1;
    }
    ask(light);
    tem00_light_destroy(light);
    broaden();
    refuse();
    return failures != 0;
}
