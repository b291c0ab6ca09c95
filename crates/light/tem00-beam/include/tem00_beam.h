/*
 * Laser spots and laser lines in closed form, for renderers in C99 or C++.
 *
 * Header only: needs <math.h> and nothing else. There is everything twice, for float with the
 * suffix F32 or _f32 and for double with F64 or _f64:
 *
 *     Tem00AxisF32, Tem00NextEventF32
 *     Tem00SpotLightF32  tem00_spot_irradiance_f32  tem00_spot_next_event_f32
 *     Tem00LineLightF32  tem00_line_irradiance_f32  tem00_line_next_event_f32
 *
 * Names that end in an underscore before the suffix are not for the caller.
 *
 * The structs have the layout of the Rust structs of the same names, byte for byte. Points and
 * vectors are in world coordinates; lengths share one unit, metres unless the caller uses another
 * throughout. A surface of normal n at p reflects  f * |n.wi| * V * e_perp, with
 *
 *     Tem00NextEventF32 event = tem00_spot_next_event_f32(&light, p);
 *
 * Nothing arrives where event.e_perp is 0: behind the aperture and beyond the cut-off.
 *
 * Validity: lengths up to 1e9 units. The relative error of the irradiance is about
 * 4 eps |p - origin| / w from the rounding of the coordinates, with the beam radius w.
 *
 * The file includes itself, once for each scalar type, by the name tem00_beam.h.
 */
#ifndef TEM00_BEAM_H
#define TEM00_BEAM_H

#include <math.h>

#define TEM00_REAL float
#define TEM00_TYPE(name) Tem00##name##F32
#define TEM00_FN(name) tem00_##name##_f32
#define TEM00_MATH(name) name##f
#include "tem00_beam.h"
#undef TEM00_REAL
#undef TEM00_TYPE
#undef TEM00_FN
#undef TEM00_MATH

#define TEM00_REAL double
#define TEM00_TYPE(name) Tem00##name##F64
#define TEM00_FN(name) tem00_##name##_f64
#define TEM00_MATH(name) name
#include "tem00_beam.h"
#undef TEM00_REAL
#undef TEM00_TYPE
#undef TEM00_FN
#undef TEM00_MATH

#elif defined(TEM00_REAL)

/* Squared beam radius along one principal axis: w^2(z) = w0_sq + theta_sq (z - z0)^2. */
typedef struct {
    TEM00_REAL w0_sq;    /* squared waist radius, in m^2 */
    TEM00_REAL theta_sq; /* squared divergence half-angle, in rad^2 */
    TEM00_REAL z0;       /* position of the waist, in metres, on the coordinate the light says */
    TEM00_REAL pad;      /* unused, 0 */
} TEM00_TYPE(Axis);

/* A Gaussian beam, circular or elliptic, with its waists at z = x.z0 and z = y.z0. */
typedef struct {
    TEM00_REAL origin[3];  /* centre of the aperture, in metres */
    TEM00_REAL power;      /* in watts */
    TEM00_REAL ex[3];      /* unit vector of the local x axis */
    TEM00_REAL cutoff;     /* distance from the axis, in beam radii, beyond which it is dark */
    TEM00_REAL ey[3];      /* unit vector of the local y axis */
    TEM00_REAL wavelength; /* in the medium, in metres */
    TEM00_REAL ez[3];      /* unit vector along the direction of travel */
    TEM00_REAL pad_ez;     /* unused, 0 */
    TEM00_TYPE(Axis) x;    /* beam radius along x */
    TEM00_TYPE(Axis) y;    /* beam radius along y */
} TEM00_TYPE(SpotLight);

/* A laser line. A fan whose profile is a table is dark here: its density is not in the struct. */
typedef struct {
    TEM00_REAL origin[3];      /* centre of the lens, in metres */
    TEM00_REAL power;          /* in watts */
    TEM00_REAL ex[3];          /* unit vector along which the fan opens */
    TEM00_REAL cutoff;         /* distance from the fan plane, in beam radii, where it gets dark */
    TEM00_REAL ey[3];          /* unit vector of the normal of the fan plane */
    TEM00_REAL apex_offset;    /* distance of the virtual apex behind the lens, in metres */
    TEM00_REAL ez[3];          /* unit vector along the direction of travel */
    TEM00_REAL source_radius;  /* radius of the virtual apex, in metres */
    TEM00_TYPE(Axis) y;        /* radius across the fan, on the slant distance from the apex */
    TEM00_REAL flat;           /* half-width of the uniform part of the profile, in `variable` */
    TEM00_REAL sigma;          /* standard deviation of its Gaussian part, in `variable` */
    TEM00_REAL variable;       /* 0 slope tan(theta), 1 angle theta, 2 sin(theta), 3 a table */
    TEM00_REAL mass;           /* fraction of the profile within |theta| < pi/2 */
    TEM00_REAL half_slope;     /* slope of the nominal edge of the fan, tan(alpha/2) */
    TEM00_REAL focus_on_plane; /* 0: waists at the slant distance y.z0; 1: on the plane there */
    TEM00_REAL wavelength;     /* in the medium, in metres */
    TEM00_REAL pad;            /* unused, 0 */
} TEM00_TYPE(LineLight);

/* The light at a point, as one direction and one irradiance; all 0 where it is dark. */
typedef struct {
    TEM00_REAL point[3]; /* point of the aperture plane that the light seems to come from */
    TEM00_REAL distance; /* to that point, in metres */
    TEM00_REAL wi[3];    /* unit vector towards the light, against the mean energy flow */
    TEM00_REAL e_perp;   /* irradiance of a surface square to wi, in W/m^2 */
} TEM00_TYPE(NextEvent);

/* The energy flow `irradiance * (slope, 1)` in the frame of the light. */
typedef struct {
    TEM00_REAL slope[2];
    TEM00_REAL irradiance;
} TEM00_TYPE(Flow_);

typedef struct {
    const TEM00_REAL *origin, *ex, *ey, *ez;
} TEM00_TYPE(Frame_);

static inline TEM00_REAL TEM00_FN(dot_)(const TEM00_REAL a[3], const TEM00_REAL b[3]) {
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

/* Subtracts first, then rotates: the difference is exact where the light is near. */
static inline void TEM00_FN(local_)(TEM00_TYPE(Frame_) frame, const TEM00_REAL p[3],
                                    TEM00_REAL local[3]) {
    const TEM00_REAL *o = frame.origin;
    const TEM00_REAL d[3] = {p[0] - o[0], p[1] - o[1], p[2] - o[2]};
    local[0] = TEM00_FN(dot_)(d, frame.ex);
    local[1] = TEM00_FN(dot_)(d, frame.ey);
    local[2] = TEM00_FN(dot_)(d, frame.ez);
}

/* Keep this form: multiplied out into powers of z it loses all digits near a tight waist. */
static inline TEM00_REAL TEM00_FN(radius_sq_)(const TEM00_TYPE(Axis) *axis, TEM00_REAL z) {
    const TEM00_REAL dz = z - axis->z0;
    return axis->w0_sq + axis->theta_sq * dz * dz;
}

/* Relative growth of the radius, w'/w. */
static inline TEM00_REAL TEM00_FN(growth_)(const TEM00_TYPE(Axis) *axis, TEM00_REAL z) {
    return axis->theta_sq * (z - axis->z0) / TEM00_FN(radius_sq_)(axis, z);
}

static inline TEM00_TYPE(NextEvent)
    TEM00_FN(next_event_)(TEM00_TYPE(Frame_) frame, const TEM00_REAL local[3],
                          TEM00_TYPE(Flow_) flow) {
    TEM00_TYPE(NextEvent) event = {{0, 0, 0}, 0, {0, 0, 0}, 0};
    if (!(flow.irradiance > 0)) {
        return event;
    }
    const TEM00_REAL *s = flow.slope;
    /* Length of the ray per distance along the axis. */
    const TEM00_REAL sec = TEM00_MATH(sqrt)(1 + s[0] * s[0] + s[1] * s[1]);
    const TEM00_REAL aperture[2] = {local[0] - s[0] * local[2], local[1] - s[1] * local[2]};
    for (int i = 0; i < 3; ++i) {
        const TEM00_REAL along = frame.ex[i] * s[0] + frame.ey[i] * s[1] + frame.ez[i];
        event.wi[i] = -along / sec;
        event.point[i] =
            frame.origin[i] + (frame.ex[i] * aperture[0] + frame.ey[i] * aperture[1]);
    }
    event.distance = local[2] * sec;
    event.e_perp = flow.irradiance * sec;
    return event;
}

/* E = 2 P / (pi w_x w_y) exp(-2 (x^2/w_x^2 + y^2/w_y^2)), slope (x w_x'/w_x, y w_y'/w_y). */
static inline TEM00_TYPE(Flow_)
    TEM00_FN(spot_flow_)(const TEM00_TYPE(SpotLight) *light, const TEM00_REAL local[3]) {
    const TEM00_REAL two_over_pi = (TEM00_REAL)0.63661977236758134308;
    TEM00_TYPE(Flow_) flow = {{0, 0}, 0};
    const TEM00_REAL x = local[0], y = local[1], z = local[2];
    const TEM00_REAL wx_sq = TEM00_FN(radius_sq_)(&light->x, z);
    const TEM00_REAL wy_sq = TEM00_FN(radius_sq_)(&light->y, z);
    const TEM00_REAL rho_sq = x * x / wx_sq + y * y / wy_sq;
    if (z < 0 || rho_sq > light->cutoff * light->cutoff) {
        return flow;
    }
    const TEM00_REAL peak =
        two_over_pi * light->power / (TEM00_MATH(sqrt)(wx_sq) * TEM00_MATH(sqrt)(wy_sq));
    flow.irradiance = peak * TEM00_MATH(exp)(-2 * rho_sq);
    flow.slope[0] = x * TEM00_FN(growth_)(&light->x, z);
    flow.slope[1] = y * TEM00_FN(growth_)(&light->y, z);
    return flow;
}

/* A uniform density on [-flat, flat], convolved with a normal one of standard deviation sigma. */
static inline TEM00_REAL TEM00_FN(profile_)(TEM00_REAL flat, TEM00_REAL sigma, TEM00_REAL v) {
    const TEM00_REAL inv_sqrt_tau = (TEM00_REAL)0.39894228040143267794;
    const TEM00_REAL inv_sqrt_2 = (TEM00_REAL)0.70710678118654752440;
    if (!(sigma > 0)) {
        return 1 / (2 * flat);
    }
    if (!(flat > 0)) {
        const TEM00_REAL t = v / sigma;
        return inv_sqrt_tau / sigma * TEM00_MATH(exp)(t * t / -2);
    }
    /* The difference of complements keeps its digits in the tail. */
    const TEM00_REAL scale = inv_sqrt_2 / sigma;
    const TEM00_REAL inner = TEM00_MATH(erfc)((v - flat) * scale);
    const TEM00_REAL outer = TEM00_MATH(erfc)((v + flat) * scale);
    return (inner - outer) / (4 * flat);
}

/* Density of the power per slope u = tan(theta): that per variable v, times dv/du; 0 beyond the
 * cut-off |v| = flat + 2 cutoff sigma. */
static inline TEM00_REAL TEM00_FN(fan_density_)(const TEM00_TYPE(LineLight) *light, TEM00_REAL u) {
    const TEM00_REAL sec_sq = 1 + u * u;
    TEM00_REAL v = u, dv_du = 1;
    if (light->variable > 2) {
        return 0;
    } else if (light->variable > 1) {
        v = u / TEM00_MATH(sqrt)(sec_sq);
        dv_du = 1 / (sec_sq * TEM00_MATH(sqrt)(sec_sq));
    } else if (light->variable > 0) {
        v = TEM00_MATH(atan)(u);
        dv_du = 1 / sec_sq;
    }
    v = TEM00_MATH(fabs)(v);
    if (v > light->flat + 2 * light->cutoff * light->sigma) {
        return 0;
    }
    return TEM00_FN(profile_)(light->flat, light->sigma, v) * dv_du / light->mass;
}

/* E = P g(u) / Z sqrt(2/pi) / w exp(-2 y^2/w^2) with the distance Z from the apex, u = x/Z and
 * w = w(r) at the slant distance r = Z sqrt(1 + u^2); slope (u, y sqrt(1 + u^2) w'/w). */
static inline TEM00_TYPE(Flow_)
    TEM00_FN(line_flow_)(const TEM00_TYPE(LineLight) *light, const TEM00_REAL local[3]) {
    const TEM00_REAL sqrt_two_over_pi = (TEM00_REAL)0.79788456080286535588;
    TEM00_TYPE(Flow_) flow = {{0, 0}, 0};
    const TEM00_REAL y = local[1], z = local[2] + light->apex_offset;
    const TEM00_REAL u = local[0] / z;
    const TEM00_REAL fan = TEM00_FN(fan_density_)(light, u);
    const TEM00_REAL sec = TEM00_MATH(sqrt)(1 + u * u);
    TEM00_TYPE(Axis) axis = light->y;
    if (light->focus_on_plane > 0) {
        axis.z0 *= sec;
    }
    const TEM00_REAL w_sq = TEM00_FN(radius_sq_)(&axis, z * sec);
    const TEM00_REAL t_sq = y * y / w_sq;
    if (local[2] < 0 || !(fan > 0) || t_sq > light->cutoff * light->cutoff) {
        return flow;
    }
    const TEM00_REAL across =
        sqrt_two_over_pi / TEM00_MATH(sqrt)(w_sq) * TEM00_MATH(exp)(-2 * t_sq);
    flow.irradiance = light->power * fan / z * across;
    flow.slope[0] = u;
    flow.slope[1] = y * TEM00_FN(growth_)(&axis, z * sec) * sec;
    return flow;
}

/* Returns the irradiance, in W/m^2, of a plane through p at right angles to the axis. */
static inline TEM00_REAL TEM00_FN(spot_irradiance)(const TEM00_TYPE(SpotLight) *light,
                                                   const TEM00_REAL p[3]) {
    const TEM00_TYPE(Frame_) frame = {light->origin, light->ex, light->ey, light->ez};
    TEM00_REAL local[3];
    TEM00_FN(local_)(frame, p, local);
    return TEM00_FN(spot_flow_)(light, local).irradiance;
}

/* Returns the light at p as one direction: that of the mean energy flow. */
static inline TEM00_TYPE(NextEvent)
    TEM00_FN(spot_next_event)(const TEM00_TYPE(SpotLight) *light, const TEM00_REAL p[3]) {
    const TEM00_TYPE(Frame_) frame = {light->origin, light->ex, light->ey, light->ez};
    TEM00_REAL local[3];
    TEM00_FN(local_)(frame, p, local);
    return TEM00_FN(next_event_)(frame, local, TEM00_FN(spot_flow_)(light, local));
}

/* Returns the irradiance, in W/m^2, of a plane through p at right angles to the axis. */
static inline TEM00_REAL TEM00_FN(line_irradiance)(const TEM00_TYPE(LineLight) *light,
                                                   const TEM00_REAL p[3]) {
    const TEM00_TYPE(Frame_) frame = {light->origin, light->ex, light->ey, light->ez};
    TEM00_REAL local[3];
    TEM00_FN(local_)(frame, p, local);
    return TEM00_FN(line_flow_)(light, local).irradiance;
}

/* Returns the light at p as one direction: that of the mean energy flow. */
static inline TEM00_TYPE(NextEvent)
    TEM00_FN(line_next_event)(const TEM00_TYPE(LineLight) *light, const TEM00_REAL p[3]) {
    const TEM00_TYPE(Frame_) frame = {light->origin, light->ex, light->ey, light->ez};
    TEM00_REAL local[3];
    TEM00_FN(local_)(frame, p, local);
    return TEM00_FN(next_event_)(frame, local, TEM00_FN(line_flow_)(light, local));
}

#endif
