/* Reads a light and points from standard input, and prints the light's answers.
 *
 * The first word is `spot` or `line`, then come the numbers of the light in the order
 * of memory, then points up to the end. Each point gives one line: the irradiance, then the members
 * of the next event. The word `layout` alone prints the offset of every member and the size of
 * every struct.
 *
 * With SINGLE defined everything is in float, else in double.
 */
#include "tem00_beam.h"
#include "tem00_beam.h" /* twice, to see that it may be */

#include <stddef.h>
#include <stdio.h>
#include <string.h>

#ifdef SINGLE
typedef float Real;
#define TYPE(name) Tem00##name##F32
#define FN(name) tem00_##name##_f32
#else
typedef double Real;
#define TYPE(name) Tem00##name##F64
#define FN(name) tem00_##name##_f64
#endif

/* One of the two, filled number by number. */
typedef union {
    TYPE(SpotLight) spot;
    TYPE(LineLight) line;
    Real numbers[28];
} Light;

static int read_reals(Real *reals, size_t count) {
    for (size_t i = 0; i < count; ++i) {
        double number;
        if (scanf("%lf", &number) != 1) {
            return 0;
        }
        reals[i] = (Real)number;
    }
    return 1;
}

static void print_answer(Real irradiance, TYPE(NextEvent) event) {
    const Real numbers[9] = {irradiance,     event.point[0], event.point[1],
                             event.point[2], event.distance, event.wi[0],
                             event.wi[1],    event.wi[2],    event.e_perp};
    for (int i = 0; i < 9; ++i) {
        printf("%.17g%c", (double)numbers[i], i < 8 ? ' ' : '\n');
    }
}

/* Answers the points with the light that is in the member `kind` of the union. */
#define ANSWER(kind)                                                                      \
    do {                                                                                  \
        if (!read_reals(light.numbers, sizeof light.kind / sizeof(Real))) {               \
            return 1;                                                                     \
        }                                                                                 \
        while (read_reals(p, 3)) {                                                        \
            print_answer(FN(kind##_irradiance)(&light.kind, p),                           \
                         FN(kind##_next_event)(&light.kind, p));                          \
        }                                                                                 \
    } while (0)

static int answer(const char *kind) {
    Light light;
    Real p[3];
    if (strcmp(kind, "spot") == 0) {
        ANSWER(spot);
    } else {
        ANSWER(line);
    }
    return 0;
}

#define MEMBER(type, member) printf("%s %d\n", #member, (int)offsetof(TYPE(type), member))
#define SIZE(type) printf("%s %d\n", #type, (int)sizeof(TYPE(type)))

static void print_layout(void) {
    MEMBER(Axis, w0_sq), MEMBER(Axis, theta_sq), MEMBER(Axis, z0), MEMBER(Axis, pad);
    SIZE(Axis);
    MEMBER(SpotLight, origin), MEMBER(SpotLight, power), MEMBER(SpotLight, ex);
    MEMBER(SpotLight, cutoff), MEMBER(SpotLight, ey), MEMBER(SpotLight, wavelength);
    MEMBER(SpotLight, ez), MEMBER(SpotLight, pad_ez), MEMBER(SpotLight, x), MEMBER(SpotLight, y);
    SIZE(SpotLight);
    MEMBER(NextEvent, point), MEMBER(NextEvent, distance), MEMBER(NextEvent, wi);
    MEMBER(NextEvent, e_perp);
    SIZE(NextEvent);
    MEMBER(LineLight, origin), MEMBER(LineLight, power), MEMBER(LineLight, ex);
    MEMBER(LineLight, cutoff), MEMBER(LineLight, ey), MEMBER(LineLight, apex_offset);
    MEMBER(LineLight, ez), MEMBER(LineLight, source_radius), MEMBER(LineLight, y);
    MEMBER(LineLight, flat), MEMBER(LineLight, sigma), MEMBER(LineLight, variable);
    MEMBER(LineLight, mass), MEMBER(LineLight, half_slope), MEMBER(LineLight, focus_on_plane);
    MEMBER(LineLight, wavelength), MEMBER(LineLight, pad);
    SIZE(LineLight);
}

int main(void) {
    char word[16];
    if (scanf("%15s", word) != 1) {
        return 1;
    }
    if (strcmp(word, "layout") == 0) {
        print_layout();
        return 0;
    }
    return answer(word);
}
