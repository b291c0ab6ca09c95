/*
 * tem00: laser beams as lights, speckle, and how it moves and decorrelates. C99 and C++17.
 *
 * UNITS are SI and radians. Vectors are three numbers x, y, z in the world of the caller. All lengths
 * share one unit, metres unless the caller uses another throughout, wavelengths included.
 *
 * STATUS: what can fail returns a tem00_status and writes its results only where it succeeds. After a
 * failure tem00_last_error() says what is wrong, with the name of the parameter, its value and what is
 * allowed, and tem00_last_error_parameter() names the parameter. Each thread has one place for both, which
 * stays where it is as long as the thread lives and is overwritten by the next failure on that thread: copy
 * what is to be kept. NaN, infinite and senseless numbers are refused, except in the points and normals at
 * which speckle is asked for, where the factor is 1 or that of new speckle: no NaN comes out.
 *
 * POINTERS must be valid and aligned. Null is refused with a status, as are results that overlap with
 * what is read; columns of no numbers may be null. What is written is never read before.
 *
 * HANDLES (tem00_light, tem00_camera, tem00_speckle, tem00_speckle_frame; tem00_stack, tem00_bandwidth,
 * tem00_imaging) come from a function named create or read, which leaves null where it fails, and go to the
 * one named destroy, once; null may be destroyed. They never change, so that threads may use one at the same
 * time.
 *
 * ENUMERATIONS in what the caller writes are uint32_t, so that any number may be refused.
 */


#ifndef TEM00_H
#define TEM00_H



#include <stddef.h>
#include <stdint.h>

/** Version of this header; tem00_version() is that of the library. */
#define TEM00_VERSION "0.1.0"


/**
 * Success of a call, or the kind of its failure. The message is that of `tem00_last_error`.
 */
typedef enum {
    /**
     * The call succeeded, and all its results are written.
     */
    TEM00_STATUS_OK = 0,
    /**
     * A number is outside what is allowed; `tem00_last_error_parameter` names it.
     */
    TEM00_STATUS_INVALID_ARGUMENT = 1,
    /**
     * A pointer is null or not aligned, or what is written overlaps what is read.
     */
    TEM00_STATUS_INVALID_POINTER = 2,
    /**
     * The memory is more than the limit, or than the machine has.
     */
    TEM00_STATUS_MEMORY = 3,
    /**
     * The library failed: a bug, to be reported with its message.
     */
    TEM00_STATUS_PANIC = 4,
} tem00_status;

/**
 * The kinds of lights, and the structs of `tem00_beam.h` whose fields they are.
 */
typedef enum {
    /**
     * `Tem00SpotLightF32`: a round or elliptic beam, 24 fields.
     */
    TEM00_LIGHT_KIND_SPOT = 0,
    /**
     * `Tem00LineLightF32`: a laser line, 28 fields.
     */
    TEM00_LIGHT_KIND_LINE = 1,
    /**
     * `Tem00LineLightF32` without its table, so that the closed forms leave it dark: 28 fields.
     */
    TEM00_LIGHT_KIND_TABULATED_LINE = 2,
} tem00_light_kind;

/**
 * The way the pupil takes from slice to slice of a stack.
 */
typedef enum {
    /**
     * Single slice: the pattern moves, but does not change.
     */
    TEM00_SLICE_PATH_STILL = 0,
    /**
     * A circle, as of Bergmann et al. 2016: slices are uncorrelated after `half_period`.
     */
    TEM00_SLICE_PATH_CIRCLE = 1,
    /**
     * A straight line of `length` pupil diameters: a motion over `length` - 1 diameters never
     * returns to speckle it has left.
     */
    TEM00_SLICE_PATH_STRAIGHT = 2,
} tem00_slice_path;

/**
 * Meaning of `focus` of a description: the position of the surface in focus before a lens.
 */
typedef enum {
    /**
     * The distance from the surface to the entrance pupil, in metres.
     */
    TEM00_FOCUS_SURFACE_TO_PUPIL = 0,
    /**
     * The distance from the surface to the front principal plane, in metres.
     */
    TEM00_FOCUS_SURFACE_TO_PRINCIPAL_PLANE = 1,
    /**
     * The magnification, counted positive.
     */
    TEM00_FOCUS_MAGNIFICATION = 2,
} tem00_focus;

/**
 * Surface on which a laser line is thinnest off its axis.
 */
typedef enum {
    /**
     * On the circle about the virtual apex of the fan.
     */
    TEM00_FOCUS_CURVE_EQUAL_DISTANCE = 0,
    /**
     * On the plane square to the axis.
     */
    TEM00_FOCUS_CURVE_EQUAL_PLANE = 1,
} tem00_focus_curve;

/**
 * Distribution of the power of a laser line along the fan.
 */
typedef enum {
    /**
     * Gaussian in the tangent of the fan angle, and so along the line on a flat screen.
     */
    TEM00_LINE_PROFILE_GAUSSIAN_TAN = 0,
    /**
     * Gaussian in the fan angle.
     */
    TEM00_LINE_PROFILE_GAUSSIAN_ANGLE = 1,
    /**
     * Gaussian in the sine of the fan angle.
     */
    TEM00_LINE_PROFILE_GAUSSIAN_SIN = 2,
    /**
     * Uniform in the tangent of the fan angle between the edges of the fan.
     */
    TEM00_LINE_PROFILE_UNIFORM_TAN = 3,
    /**
     * Uniform in the fan angle between the edges of the fan.
     */
    TEM00_LINE_PROFILE_UNIFORM_ANGLE = 4,
    /**
     * Uniform in the tangent of the fan angle with a Gaussian roll-off, as behind a Powell lens.
     */
    TEM00_LINE_PROFILE_POWELL = 5,
    /**
     * A table of the power per angle.
     */
    TEM00_LINE_PROFILE_TABULATED = 6,
} tem00_line_profile;

/**
 * The shape of a spectral peak.
 */
typedef enum {
    /**
     * A normal distribution: many modes, or a filter.
     */
    TEM00_PEAK_SHAPE_GAUSSIAN = 0,
    /**
     * A Cauchy distribution, of long wings: a single mode.
     */
    TEM00_PEAK_SHAPE_LORENTZIAN = 1,
    /**
     * Constant between two ends: a wavelength that is swept during the exposure.
     */
    TEM00_PEAK_SHAPE_RECTANGULAR = 2,
} tem00_peak_shape;

/**
 * The light of a laser with a linewidth in one resolution cell of a camera. It never changes: any
 * number of threads may ask it at once.
 *
 * To show it, draw a wave for each camera sample, and add what it finds in the stacks of pattern j
 * and height h:
 *
 * `I = sum_j patterns[j] |sum_h heights[2h + 1] exp(i heights[2h] wave.phase_per_height) U_jh(x, y, u)|^2`
 *
 * `U_jh` is `tem00_stack_amplitude` of stacks of one description but their own seeds, on a
 * straight path whose x axis leads along `tilt` in the image. The shift of the wave adds to u:
 * `wave.pupil_shift` times the slices of a diameter, `2 half_period / length`. With 32 of them the
 * contrast is right to 1 %, with 8 it is 4 % too high. Without heights the intensities of one
 * wavelength add, `I = sum_j patterns[j] I_j`.
 */
typedef struct tem00_bandwidth tem00_bandwidth;

/**
 * A perspective camera with a thin lens, whose image the speckle is in. It never changes: any
 * number of threads may ask it at once.
 */
typedef struct tem00_camera tem00_camera;

/**
 * A camera focused on a surface: a lens, its pupils and the sensor behind it. It never changes:
 * any number of threads may ask it at once.
 */
typedef struct tem00_imaging tem00_imaging;

/**
 * A laser in a scene. It never changes: any number of threads may ask it at once.
 */
typedef struct tem00_light tem00_light;

/**
 * The speckle of a light in the image of a camera, prepared for the motions of some frames. It
 * never changes: any number of threads may ask it at once.
 */
typedef struct tem00_speckle tem00_speckle;

/**
 * The speckle of one body in one frame; it outlives the speckle that it came from. It never
 * changes: any number of threads may ask it at once.
 */
typedef struct tem00_speckle_frame tem00_speckle_frame;

/**
 * Speckle that moves and decorrelates. It never changes: any number of threads may look it up at
 * once.
 */
typedef struct tem00_stack tem00_stack;

/**
 * Position and directions of a light, in world coordinates.
 */
typedef struct {
    /**
     * Centre of the aperture (the lens of a laser line), in metres.
     */
    double origin[3];
    /**
     * Direction of travel, of any length.
     */
    double direction[3];
    /**
     * Any vector that is not parallel to `direction`. Its part at right angles to `direction` is
     * the x axis of the light, along which a fan opens.
     */
    double fan_axis[3];
} tem00_placement;

/**
 * A round Gaussian beam.
 */
typedef struct {
    /**
     * Position and directions of the light.
     */
    tem00_placement placement;
    /**
     * Wavelength in the medium, in metres.
     */
    double wavelength;
    /**
     * Power, in watts.
     */
    double power;
    /**
     * Waist radius to 1/e² of the irradiance, in metres.
     */
    double waist_radius;
    /**
     * Signed distance from the aperture to the waist, in metres.
     */
    double waist_distance;
    /**
     * Beam quality factor M², at least 1, which is that of an ideal beam.
     */
    double m_squared;
} tem00_spot_description;

/**
 * An elliptic Gaussian beam with two principal axes, as of a laser diode. Its arrays hold the
 * value of the first axis, then that of the second; a refusal names one as "`waist_radius[1]`".
 */
typedef struct {
    /**
     * Position and directions of the light.
     */
    tem00_placement placement;
    /**
     * Wavelength in the medium, in metres.
     */
    double wavelength;
    /**
     * Power, in watts.
     */
    double power;
    /**
     * Waist radii to 1/e² of the irradiance, in metres.
     */
    double waist_radius[2];
    /**
     * Signed distances from the aperture to the waists, in metres.
     */
    double waist_distance[2];
    /**
     * Beam quality factors M², at least 1.
     */
    double m_squared[2];
    /**
     * Angle from the x axis of the light to the first axis of the beam, towards y, in radians.
     */
    double rotation;
} tem00_elliptic_description;

/**
 * A laser line behind a cylinder lens or a Powell lens.
 */
typedef struct {
    /**
     * Position and directions of the light; the fan opens along its fan axis.
     */
    tem00_placement placement;
    /**
     * Wavelength in the medium, in metres.
     */
    double wavelength;
    /**
     * Power, in watts.
     */
    double power;
    /**
     * Half-thickness of the line where it is thinnest, to 1/e² of the irradiance, in metres.
     */
    double waist_radius;
    /**
     * Beam quality factor M² across the fan, at least 1.
     */
    double m_squared;
    /**
     * Full fan angle between the edges of the line, in radians.
     */
    double fan_angle;
    /**
     * Distance of the virtual apex of the fan behind the lens, in metres.
     */
    double apex_offset;
    /**
     * Signed distance from the lens to where the line is thinnest on the axis, in metres.
     */
    double focus_distance;
    /**
     * Surface on which the line is thinnest off the axis: a `tem00_focus_curve`.
     */
    uint32_t focus_curve;
    /**
     * The profile along the line: a `tem00_line_profile`.
     */
    uint32_t profile;
    /**
     * Standard deviation of the roll-off relative to the half-length of the line, from 1e-6 to 1;
     * read for the Powell profile alone.
     */
    double edge;
    /**
     * Ascending angles from the axis, in radians; read for the tabulated profile alone, as are the
     * next two. The light keeps a copy.
     */
    const double *angles;
    /**
     * Power per angle at each of the angles, in any unit.
     */
    const double *powers;
    /**
     * Number of angles and powers, at least 2.
     */
    size_t knot_count;
} tem00_line_description;

/**
 * The light at a point, as one direction and one irradiance; all 0 where it is dark.
 */
typedef struct {
    /**
     * Point of the aperture plane that the light seems to come from, in metres.
     */
    double point[3];
    /**
     * Distance to that point, in metres.
     */
    double distance;
    /**
     * Unit vector towards the light, against the mean energy flow.
     */
    double wi[3];
    /**
     * Irradiance of a surface square to `wi`, in W/m².
     */
    double e_perp;
} tem00_next_event;

/**
 * Next event in single precision, otherwise as `tem00_next_event`.
 */
typedef struct {
    /**
     * Point of the aperture plane that the light seems to come from, in metres.
     */
    float point[3];
    /**
     * Distance to that point, in metres.
     */
    float distance;
    /**
     * Unit vector towards the light, against the mean energy flow.
     */
    float wi[3];
    /**
     * Irradiance of a surface square to `wi`, in W/m².
     */
    float e_perp;
} tem00_next_event_f32;

/**
 * The light at a point, as a random direction and its density; all 0 where it is dark.
 */
typedef struct {
    /**
     * Point of the aperture plane that the ray comes from, in metres.
     */
    double point[3];
    /**
     * Distance to that point, in metres.
     */
    double distance;
    /**
     * Unit vector towards the light.
     */
    double wi[3];
    /**
     * Radiance divided by `pdf`, in W/m².
     */
    double value;
    /**
     * Probability density of `wi`, per steradian.
     */
    double pdf;
} tem00_sampled_event;

/**
 * The probability densities of a ray, whose joint density factors in two ways: position times
 * direction given position, which bidirectional methods want, and direction times position given
 * direction, which a ray is drawn from. Positions are those on the aperture plane.
 */
typedef struct {
    /**
     * Density of the position, whatever the direction, per m² of the aperture plane.
     */
    double position;
    /**
     * Density of the direction at this position, per steradian.
     */
    double direction_given_position;
    /**
     * Density of the direction, wherever the ray starts, per steradian.
     */
    double direction;
    /**
     * Density of the position among the rays of this direction, per m² of the aperture plane.
     */
    double position_given_direction;
} tem00_ray_pdf;

/**
 * A ray that leaves the aperture.
 */
typedef struct {
    /**
     * Point of the aperture plane, in metres.
     */
    double origin[3];
    /**
     * Power of the light, in watts, to be divided by the number of rays.
     */
    double flux;
    /**
     * Unit vector along the ray.
     */
    double direction[3];
    /**
     * Cosine of the angle between the ray and the axis.
     */
    double cos;
    /**
     * Probability densities of the ray.
     */
    tem00_ray_pdf pdf;
} tem00_ray_sample;

/**
 * Bounds of the light in space and direction, as a light hierarchy stores them.
 */
typedef struct {
    /**
     * Smallest corner of a box around the lit volume, in metres.
     */
    double min[3];
    /**
     * Largest corner of the box, in metres.
     */
    double max[3];
    /**
     * Unit vector along the axis.
     */
    double axis[3];
    /**
     * Half-angle of the cone about `axis` that the light travels in, in radians.
     */
    double half_angle;
} tem00_bounds;

/**
 * Parameters of a light.
 */
typedef struct {
    /**
     * Centre of the aperture, in metres.
     */
    double origin[3];
    /**
     * Power, in watts.
     */
    double power;
    /**
     * Unit vector along the direction of travel.
     */
    double axis[3];
    /**
     * Wavelength in the medium, in metres.
     */
    double wavelength;
} tem00_light_info;

/**
 * The light that a ray meets on its way to the aperture; all 0 if it meets none.
 */
typedef struct {
    /**
     * Point of the aperture plane, in metres.
     */
    double point[3];
    /**
     * Distance to that point, in metres.
     */
    double distance;
    /**
     * Radiance that arrives along the ray, in W/(m² sr).
     */
    double radiance;
    /**
     * Probability density with which a sampled next event has this direction, per steradian.
     */
    double pdf;
} tem00_aperture_hit;

/**
 * Destination of the next events at many points: pointers to as many numbers as there are points.
 *
 * The point of the aperture plane is p + distance * wi.
 */
typedef struct {
    /**
     * Components x of the unit vectors towards the light.
     */
    double *wi_x;
    /**
     * Components y.
     */
    double *wi_y;
    /**
     * Components z.
     */
    double *wi_z;
    /**
     * Distances to the aperture plane along `wi`, in metres.
     */
    double *distance;
    /**
     * Irradiances of a surface square to `wi`, in W/m²; 0 where no light arrives.
     */
    double *e_perp;
} tem00_next_event_columns;

/**
 * Columns of next events in single precision, otherwise as `tem00_next_event_columns`.
 */
typedef struct {
    /**
     * Components x of the unit vectors towards the light.
     */
    float *wi_x;
    /**
     * Components y.
     */
    float *wi_y;
    /**
     * Components z.
     */
    float *wi_z;
    /**
     * Distances to the aperture plane along `wi`, in metres.
     */
    float *distance;
    /**
     * Irradiances of a surface square to `wi`, in W/m²; 0 where no light arrives.
     */
    float *e_perp;
} tem00_next_event_columns_f32;

/**
 * A light as plain numbers in single precision: what a kernel that cannot call a library
 * evaluates.
 */
typedef struct {
    /**
     * Struct of `tem00_beam.h` or `tem00_beam.wgsl` that the fields belong to.
     */
    tem00_light_kind kind;
    /**
     * Number of fields, 24 or 28.
     */
    uint32_t count;
    /**
     * The fields in the order of memory, then zeros.
     */
    float fields[28];
} tem00_light_data;

/**
 * Parameters of a camera: a thin lens, and a sensor behind it. With 0 in the last three fields the
 * axis of the lens meets the middle of the image, without tilt or distortion.
 */
typedef struct {
    /**
     * Centre of the lens, which is its entrance pupil, in metres.
     */
    double position[3];
    /**
     * A point on the axis of the lens, in metres.
     */
    double look_at[3];
    /**
     * A direction that points up in the image.
     */
    double up[3];
    /**
     * Focal length of the lens, in metres.
     */
    double focal_length;
    /**
     * F-number, at least 0.5: focal length over the diameter of the entrance pupil.
     */
    double f_number;
    /**
     * Distance along the axis from the lens to what is in focus there, in metres.
     */
    double focus_distance;
    /**
     * Distance between the centres of neighbouring pixels on the sensor, in metres.
     */
    double pixel_pitch;
    /**
     * Numbers of pixel columns and rows.
     */
    size_t resolution[2];
    /**
     * Image point on the axis of the lens, from the middle of the image, in pixels with y down.
     */
    double principal_offset[2];
    /**
     * Angle by which the sensor is tilted, right-handed about a line in it, and the azimuth of
     * that line, from the right of the image towards its top; both in radians.
     */
    double tilt[2];
    /**
     * Coefficients k1, k2 and k3 of the radial distortion, with the signs of `OpenCV`.
     */
    double distortion[3];
} tem00_camera_description;

/**
 * Motion of a rigid body from the reference state to now: x' = R x + t. All 0 is no motion.
 */
typedef struct {
    /**
     * Rows of the rotation matrix R, right-handed and orthonormal within 1e-6; all 0 for no
     * rotation.
     */
    double rotation[3][3];
    /**
     * Translation t, in metres.
     */
    double translation[3];
} tem00_pose;

/**
 * Motion of a body, the camera and the light from the reference state to now. Only differences
 * count: if all three move as one, nothing changes. All 0 is the reference state of body 0.
 */
typedef struct {
    /**
     * Number of the body. Bodies that move apart have numbers of their own, and speckle of their
     * own.
     */
    size_t body;
    /**
     * Pose of the body whose surface is looked at.
     */
    tem00_pose surface;
    /**
     * Pose of the camera.
     */
    tem00_pose camera;
    /**
     * Pose of the light.
     */
    tem00_pose light;
} tem00_body_motion;

/**
 * Parameters of speckle.
 */
typedef struct {
    /**
     * Seed of the patterns. Two lights want two seeds.
     */
    uint64_t seed;
    /**
     * Motions of the frames, beside the reference state; null if nothing moves.
     */
    const tem00_body_motion *motions;
    /**
     * Number of motions.
     */
    size_t motion_count;
    /**
     * Points x, y, z in the reference state, in metres, one after the other, from which the
     * largest shift of the speckle is found; null for where the light crosses the plane in focus.
     */
    const double *points;
    /**
     * Unit normals of the surface at these points; null if there are none.
     */
    const double *normals;
    /**
     * Number of points.
     */
    size_t point_count;
    /**
     * Bytes that the patterns may take.
     */
    uint64_t memory_limit;
    /**
     * Number of equal independent patterns that add up, from 1 on: contrast falls to 1/√looks.
     */
    size_t looks;
    /**
     * Degree of polarisation of the light that reaches the sensor, from 0 to 1: 1 behind a
     * polariser.
     */
    double polarisation;
    /**
     * Number of threads that generate the patterns, at most 1024; 0 for all the cores of the
     * machine. The patterns are the same, to the last bit, for any number.
     */
    uint32_t threads;
} tem00_speckle_description;

/**
 * Properties of speckle.
 */
typedef struct {
    /**
     * Choices with their reasons, in UTF-8. The text belongs to the speckle.
     */
    const char *summary;
    /**
     * Speckle size on the sensor, in pixels.
     */
    double speckle_size;
    /**
     * Bytes that the patterns take.
     */
    uint64_t memory_bytes;
} tem00_speckle_info;

/**
 * Displacement and correlation of the speckle at a point since the reference state.
 */
typedef struct {
    /**
     * Displacement of the speckle in the image, in pixels with y down.
     */
    double displacement[2];
    /**
     * Displacement of the pupil over the speckle, in pupil diameters. A motion along the axis
     * counts by the displacement that leaves the same correlation. Infinite where the speckle is
     * new.
     */
    double pupil_shift;
    /**
     * Correlation of intensity with the speckle in the reference state, in [0, 1], where it is
     * looked up at the displacement.
     */
    double correlation;
} tem00_speckle_shift;

/**
 * Parameters of a stack.
 */
typedef struct {
    /**
     * Width of the pattern, in samples, after which it repeats.
     */
    size_t width;
    /**
     * Height of the pattern, in samples.
     */
    size_t height;
    /**
     * Diameter of the pupil along the width, in lattice points: the speckles after which the
     * pattern repeats, from 8 to half the width. 0 if `speckle_size` is to say it.
     */
    size_t diameter;
    /**
     * Speckle size in samples, at least 2 and at most an eighth of the smaller side; read if
     * `diameter` is 0, else it is width / diameter.
     */
    double speckle_size;
    /**
     * Seed of the pattern.
     */
    uint64_t seed;
    /**
     * The way the pupil takes: a `tem00_slice_path`.
     */
    uint32_t path;
    /**
     * Half the number of slices, not read for a still path.
     */
    size_t half_period;
    /**
     * Length of a straight path in pupil diameters, at least 2; not read for others.
     */
    size_t length;
    /**
     * Bytes that the slices may take; `UINT64_MAX` for all the machine has.
     */
    uint64_t memory_limit;
    /**
     * Number of threads that generate it, at most 1024; 0 for all the cores of the machine. The
     * stack is the same, to the last bit, for any number.
     */
    uint32_t threads;
} tem00_stack_description;

/**
 * Demands on a stack: image, motion and memory.
 */
typedef struct {
    /**
     * Width and height of the image, in pixels.
     */
    double image[2];
    /**
     * Width and height of all that is looked up in any frame, in pixels: the image, and what
     * motion brings in.
     */
    double region[2];
    /**
     * Speckle size on the sensor, in pixels.
     */
    double speckle_size;
    /**
     * 1 if the speckle changes, 0 if it never does.
     */
    uint32_t changes;
    /**
     * Largest motion of the pupil over the speckle, in its diameters; not read if nothing changes.
     */
    double motion;
    /**
     * Number of frames among which the speckle is compared.
     */
    uint32_t frames;
    /**
     * Bytes that the slices may take.
     */
    uint64_t memory_limit;
} tem00_stack_needs;

/**
 * Properties of a stack.
 */
typedef struct {
    /**
     * Width of the pattern, in samples, after which it repeats.
     */
    size_t width;
    /**
     * Height of the pattern, in samples.
     */
    size_t height;
    /**
     * Number of slices, after which the coordinate u repeats: 1, or twice `half_period`.
     */
    size_t slice_count;
    /**
     * Speckle size in samples.
     */
    double speckle_size;
    /**
     * The way the pupil takes.
     */
    tem00_slice_path path;
    /**
     * Half the number of slices, 0 for a still path.
     */
    size_t half_period;
    /**
     * Length of a straight path in pupil diameters, 0 for others.
     */
    size_t length;
    /**
     * Bytes that the slices take.
     */
    uint64_t memory_bytes;
} tem00_stack_info;

/**
 * The light of a laser, and how a camera sees the surface that it lights, in focus. Directions
 * lead away from the surface, of any length; lengths in metres.
 */
typedef struct {
    /**
     * Wavelength of the peak; not read if there are `peaks`.
     */
    double wavelength;
    /**
     * Full width of each peak at half maximum, from 0 to a tenth of the wavelength.
     */
    double linewidth;
    /**
     * Shape of each peak: a `tem00_peak_shape`.
     */
    uint32_t shape;
    /**
     * Wavelength and power, in any unit, of each of several peaks.
     */
    const double *peaks;
    /**
     * Number of peaks, at most 256; 0 for a single one at `wavelength`.
     */
    size_t peak_count;
    /**
     * To the source.
     */
    double to_source[3];
    /**
     * Half-angle of the disc from which light reaches the surface, seen from there, at most 0.3
     * rad; 0 for a point. Light of its parts does not interfere.
     */
    double source_half_angle;
    /**
     * To the centre of the pupil.
     */
    double to_pupil[3];
    /**
     * Normal of the surface, on the side of both.
     */
    double normal[3];
    /**
     * Half the pupil's diameter over its distance, at most 1.
     */
    double sin_aperture;
    /**
     * Root mean square height of the relief that is finer than a speckle, at most 1 mm.
     */
    double rms_height;
    /**
     * Distance at which the correlation of the heights falls to 1/e, at most 1 mm; 0 if they
     * differ as soon as scatterers do.
     */
    double correlation_length;
} tem00_bandwidth_description;

/**
 * Effect of a linewidth on speckle, and its representation in a renderer.
 */
typedef struct {
    /**
     * Contrast of polarised speckle, from 0 to 1: what is seen, and not the noise of a line.
     */
    double contrast;
    /**
     * Coherence length in metres; infinite for peaks without a width.
     */
    double coherence_length;
    /**
     * Unit vector along which the field moves across the pupil where the wave number grows; 0, 0,
     * 0 without a tilt of the cell.
     */
    double tilt[3];
    /**
     * Difference of wave numbers that moves it by the pupil's diameter, in rad/m; infinite without
     * a tilt.
     */
    double tilt_wave_number;
    /**
     * Fractions of the light in patterns whose intensities add: one; or, of heights that dominate
     * or of the directions of a source, as many as its contrast asks for, at most 1024. They
     * belong to the handle.
     */
    const double *patterns;
    /**
     * Number of patterns.
     */
    size_t pattern_count;
    /**
     * Heights of the relief in metres whose fields add, each with the root of its fraction of the
     * light. They belong to the handle.
     */
    const double *heights;
    /**
     * Number of heights; 0 if each pattern is looked up as in one wavelength.
     */
    size_t height_count;
} tem00_bandwidth_info;

/**
 * A wave number drawn from the light.
 */
typedef struct {
    /**
     * The wave number less the mean one, in rad/m.
     */
    double wave_number;
    /**
     * Displacement of the field across the pupil, along `tilt`, in pupil diameters.
     */
    double pupil_shift;
    /**
     * Phase per height of the relief, in rad/m.
     */
    double phase_per_height;
} tem00_wave;

/**
 * A lens and a sensor.
 */
typedef struct {
    /**
     * Vacuum wavelength of the light, in metres.
     */
    double wavelength;
    /**
     * Focal length of the lens, in metres.
     */
    double focal_length;
    /**
     * F-number as engraved on the lens, for focus at infinity, at least 0.5.
     */
    double f_number;
    /**
     * Diameter of the exit pupil over that of the entrance pupil; 1 for a thin lens.
     */
    double pupil_magnification;
    /**
     * Meaning of `focus`: a `tem00_focus`.
     */
    uint32_t focus_kind;
    /**
     * Position of the surface in focus.
     */
    double focus;
    /**
     * Distance between the centres of neighbouring pixels on the sensor, in metres.
     */
    double pixel_pitch;
} tem00_lens_description;

/**
 * The distances and the pupil of a camera as such. Entrance and exit pupil are one, at the lens.
 */
typedef struct {
    /**
     * Vacuum wavelength of the light, in metres.
     */
    double wavelength;
    /**
     * Distance from the surface in focus to the pupil along the optical axis, in metres.
     */
    double surface_to_pupil;
    /**
     * Distance from the pupil to the sensor, in metres.
     */
    double pupil_to_image;
    /**
     * Diameter of the pupil, in metres.
     */
    double pupil_diameter;
    /**
     * Distance between the centres of neighbouring pixels on the sensor, in metres.
     */
    double pixel_pitch;
} tem00_pupil_distances;

/**
 * Properties of a camera.
 */
typedef struct {
    /**
     * Vacuum wavelength of the light, in metres.
     */
    double wavelength;
    /**
     * Focal length, in metres.
     */
    double focal_length;
    /**
     * F-number for focus at infinity.
     */
    double f_number;
    /**
     * F-number of the light on the sensor.
     */
    double working_f_number;
    /**
     * Diameter of the entrance pupil, in metres.
     */
    double pupil_diameter;
    /**
     * Diameter of the exit pupil over that of the entrance pupil.
     */
    double pupil_magnification;
    /**
     * Distance from the surface in focus to the entrance pupil, in metres.
     */
    double surface_to_pupil;
    /**
     * Distance from the exit pupil to the sensor, in metres.
     */
    double pupil_to_image;
    /**
     * Length of the image of a unit tangent of the viewing angle, in metres.
     */
    double principal_distance;
    /**
     * Magnification at the surface in focus, without a sign.
     */
    double magnification;
    /**
     * Distance between the centres of neighbouring pixels on the sensor, in metres.
     */
    double pixel_pitch;
    /**
     * Speckle size on the sensor, the period of its finest fringes, in metres.
     */
    double speckle_size;
    /**
     * Speckle size on the sensor, in pixels.
     */
    double speckle_size_in_pixels;
    /**
     * Speckle size projected onto the surface in focus, in metres.
     */
    double object_speckle_size;
    /**
     * Displacement along the axis that first decorrelates the speckle entirely, in metres.
     */
    double axial_decorrelation_length;
} tem00_imaging_info;

#ifdef __cplusplus
extern "C" {
#endif // __cplusplus

/**
 * Returns the version of the library, as "0.1.0"; that of the header is `TEM00_VERSION`.
 */
const char *tem00_version(void);

/**
 * Returns why the last call that failed on this thread failed, in UTF-8, with the parameter, its
 * value and what is allowed; empty if none has failed.
 *
 * The text stays in one place for as long as the thread lives: the pointer never dangles
 * meanwhile, and after the next call that fails on this thread it has the text of that one. Copy
 * what is to be kept longer. Not to be freed. Messages are cut off after 2047 bytes.
 */
const char *tem00_last_error(void);

/**
 * Returns the name of the parameter that the last call that failed on this thread refused; empty
 * if it was none.
 *
 * It stays in one place as the text of `tem00_last_error` does. Not to be freed.
 */
const char *tem00_last_error_parameter(void);

/**
 * Frees a light; null is allowed. No thread may be using it, and it must not be used again.
 *
 * `light` is null, or came from one of the functions that create lights and was not destroyed.
 */
void tem00_light_destroy(tem00_light *light);

/**
 * Creates a round Gaussian beam.
 *
 * On failure `*light` is null.
 *
 * The pointers are null or valid.
 */
tem00_status tem00_light_create_spot(const tem00_spot_description *description,
                                     tem00_light **light);

/**
 * Creates an elliptic Gaussian beam.
 *
 * On failure `*light` is null.
 *
 * The pointers are null or valid.
 */
tem00_status tem00_light_create_elliptic(const tem00_elliptic_description *description,
                                         tem00_light **light);

/**
 * Creates a laser line.
 *
 * On failure `*light` is null.
 *
 * The pointers are null or valid, those of a table for `knot_count` numbers.
 */
tem00_status tem00_light_create_line(const tem00_line_description *description,
                                     tem00_light **light);

/**
 * Computes the irradiance, in W/m², of a plane through `point` at right angles to the axis.
 *
 * `point` holds x, y, z in metres.
 *
 * The pointers are null or valid.
 */
tem00_status tem00_light_irradiance(const tem00_light *light,
                                    const double *point,
                                    double *irradiance);

/**
 * Computes the energy-flow vector at `point`, in W/m²: a surface whose normal n lies on the lit
 * side receives the irradiance max(0, -flux . n).
 *
 * `point` and `flux` hold x, y, z.
 *
 * The pointers are null or valid, `flux` for three numbers.
 */
tem00_status tem00_light_flux(const tem00_light *light, const double *point, double *flux);

/**
 * Computes the light at `point` as one direction, that of the mean energy flow: a delta light.
 *
 * A surface of normal n reflects f |n . wi| V times `e_perp`. Where it is dark, beyond the cut-off
 * and behind the aperture, all of `event` is 0 and no shadow ray is needed. `point` holds x, y, z
 * in metres.
 *
 * The pointers are null or valid.
 */
tem00_status tem00_light_next_event(const tem00_light *light,
                                    const double *point,
                                    tem00_next_event *event);

/**
 * Single-precision form of `tem00_light_next_event`.
 *
 * The pointers are null or valid.
 */
tem00_status tem00_light_next_event_f32(const tem00_light *light,
                                        const float *point,
                                        tem00_next_event_f32 *event);

/**
 * Draws a direction from the light that arrives at `point`, with two random numbers `u` in [0, 1).
 *
 * The estimate of the reflected radiance is f |n . wi| V times `value`, which has been divided by
 * the density. Where it is dark, all of `event` is 0. `point` holds x, y, z in metres.
 *
 * The pointers are null or valid.
 */
tem00_status tem00_light_next_event_sampled(const tem00_light *light,
                                            const double *point,
                                            const double *u,
                                            tem00_sampled_event *event);

/**
 * Computes the density, per steradian, with which `tem00_light_next_event_sampled` draws the
 * direction `wi` towards the light at `point`; 0 where it is dark.
 *
 * `point` and `wi`, of any length but 0, hold x, y, z.
 *
 * The pointers are null or valid.
 */
tem00_status tem00_light_next_event_pdf(const tem00_light *light,
                                        const double *point,
                                        const double *wi,
                                        double *pdf);

/**
 * Draws a ray that leaves the aperture, with four random numbers `u` in [0, 1).
 *
 * Every ray stands for the same power, so straight rays reproduce the irradiance at every
 * distance.
 *
 * The pointers are null or valid.
 */
tem00_status tem00_light_sample_ray(const tem00_light *light,
                                    const double *u,
                                    tem00_ray_sample *ray);

/**
 * Computes the densities with which `tem00_light_sample_ray` draws the ray through `origin` along
 * `direction`; 0 for a ray against the axis.
 *
 * `origin`, any point of the ray, and `direction`, of any length but 0, hold x, y, z.
 *
 * The pointers are null or valid.
 */
tem00_status tem00_light_ray_pdf(const tem00_light *light,
                                 const double *origin,
                                 const double *direction,
                                 tem00_ray_pdf *pdf);

/**
 * Computes the radiance, in W/(m² sr), of the ray through `origin` along the direction of travel
 * `direction`; 0 for a ray against the axis.
 *
 * `origin`, any point of the ray, and `direction`, of any length but 0, hold x, y, z.
 *
 * The pointers are null or valid.
 */
tem00_status tem00_light_radiance(const tem00_light *light,
                                  const double *origin,
                                  const double *direction,
                                  double *radiance);

/**
 * Computes bounds of the light from the aperture to `distance`, in metres, along its axis.
 *
 * The pointers are null or valid.
 */
tem00_status tem00_light_bounds(const tem00_light *light, double distance, tem00_bounds *bounds);

/**
 * Tells what a light was made with.
 *
 * The pointers are null or valid.
 */
tem00_status tem00_light_describe(const tem00_light *light, tem00_light_info *info);

/**
 * Finds the light that a ray from `point` along `wi` meets, for a direction that a material has
 * drawn: the other technique beside `tem00_light_next_event_sampled`.
 *
 * A direction of the density q, per steradian, has the weight q / (q + `pdf`) of the balance
 * heuristic. Only what is nearer than `distance` hides the light. Where the ray meets none, all of
 * `hit` is 0. `point` and `wi`, of any length but 0, hold x, y, z.
 *
 * The pointers are null or valid.
 */
tem00_status tem00_light_hit(const tem00_light *light,
                             const double *point,
                             const double *wi,
                             tem00_aperture_hit *hit);

/**
 * Computes a bound of the power, in watts, that reaches the box from `min` to `max`, for a
 * hierarchy of lights: 0 if the box is behind the aperture, beyond the cut-off or empty.
 *
 * `min` and `max` hold x, y, z in metres.
 *
 * The pointers are null or valid.
 */
tem00_status tem00_light_power_bound(const tem00_light *light,
                                     const double *min,
                                     const double *max,
                                     double *bound);

/**
 * Computes the irradiances, in W/m², of planes through `count` points at right angles to the axis:
 * the bits of `tem00_light_irradiance`.
 *
 * `x`, `y`, `z` hold the coordinates, in metres; `irradiance` must not overlap with them.
 *
 * The pointers are null or valid for `count` numbers.
 */
tem00_status tem00_light_irradiance_batch(const tem00_light *light,
                                          const double *x,
                                          const double *y,
                                          const double *z,
                                          size_t count,
                                          double *irradiance);

/**
 * Single-precision form of `tem00_light_irradiance_batch`.
 *
 * The pointers are null or valid for `count` numbers.
 */
tem00_status tem00_light_irradiance_batch_f32(const tem00_light *light,
                                              const float *x,
                                              const float *y,
                                              const float *z,
                                              size_t count,
                                              float *irradiance);

/**
 * Computes the next events at `count` points: the bits of `tem00_light_next_event`.
 *
 * `x`, `y`, `z` hold the coordinates, in metres. The columns of `events` are written; they must
 * not overlap with each other nor with the coordinates.
 *
 * The pointers are null or valid for `count` numbers.
 */
tem00_status tem00_light_next_event_batch(const tem00_light *light,
                                          const double *x,
                                          const double *y,
                                          const double *z,
                                          size_t count,
                                          const tem00_next_event_columns *events);

/**
 * Single-precision form of `tem00_light_next_event_batch`.
 *
 * The pointers are null or valid for `count` numbers.
 */
tem00_status tem00_light_next_event_batch_f32(const tem00_light *light,
                                              const float *x,
                                              const float *y,
                                              const float *z,
                                              size_t count,
                                              const tem00_next_event_columns_f32 *events);

/**
 * Draws a direction from the light that arrives at each of `count` points: the bits of
 * `tem00_light_next_event_sampled`.
 *
 * `points` holds x, y, z in metres of one point after the other, `u` two random numbers in [0, 1)
 * for each; `events` must not overlap with them. Where it is dark, all of an event is 0.
 *
 * The pointers are null or valid, for `3 * count` and `2 * count` numbers and for `count` events.
 */
tem00_status tem00_light_next_event_sampled_batch(const tem00_light *light,
                                                  const double *points,
                                                  const double *u,
                                                  size_t count,
                                                  tem00_sampled_event *events);

/**
 * Draws `count` rays that leave the aperture: the bits of `tem00_light_sample_ray`.
 *
 * `u` holds four random numbers in [0, 1) for each ray; `rays` must not overlap with it.
 *
 * The pointers are null or valid, for `4 * count` numbers and for `count` rays.
 */
tem00_status tem00_light_sample_ray_batch(const tem00_light *light,
                                          const double *u,
                                          size_t count,
                                          tem00_ray_sample *rays);

/**
 * Copies a light as plain numbers in single precision, to be uploaded to a GPU or evaluated by
 * `tem00_beam.h`.
 *
 * The pointers are null or valid.
 */
tem00_status tem00_light_plain_data(const tem00_light *light, tem00_light_data *data);

/**
 * Frees a camera; null is allowed. No thread may be using it, and it must not be used again.
 *
 * `camera` is null, or came from `tem00_camera_create` and was not destroyed.
 */
void tem00_camera_destroy(tem00_camera *camera);

/**
 * Frees speckle, whose frames live on; null is allowed. No thread may be using it, and it must not
 * be used again.
 *
 * `speckle` is null, or came from `tem00_speckle_create` and was not destroyed.
 */
void tem00_speckle_destroy(tem00_speckle *speckle);

/**
 * Frees a frame; null is allowed. No thread may be using it, and it must not be used again.
 *
 * `frame` is null, or came from `tem00_speckle_frame_create` and was not destroyed.
 */
void tem00_speckle_frame_destroy(tem00_speckle_frame *frame);

/**
 * Creates a camera.
 *
 * On failure `*camera` is null.
 *
 * The pointers are null or valid.
 */
tem00_status tem00_camera_create(const tem00_camera_description *description,
                                 tem00_camera **camera);

/**
 * Computes where in the image a point is seen, to be compared with where the renderer's own camera
 * sees it.
 *
 * `point` holds x, y, z in metres; it is refused where the camera cannot see it. `pixel` receives
 * x and y in pixels, y down, from the upper left corner of the image; it may lie outside.
 *
 * The pointers are null or valid, `point` for three numbers and `pixel` for two.
 */
tem00_status tem00_camera_project(const tem00_camera *camera, const double *point, double *pixel);

/**
 * Generates the speckle of a light in the image of a camera, both as they stand in the reference
 * state: chooses sizes, slices and seeds for the motions and the memory. `tem00_speckle_describe`
 * says what it chose.
 *
 * The light must be a spot or a line; its wavelength counts as that in vacuum. Speckle does not
 * need camera and light any more once it is created. On failure `*speckle` is null.
 *
 * The pointers are null or valid, those to points and normals for three numbers each.
 */
tem00_status tem00_speckle_create(const tem00_camera *camera,
                                  const tem00_light *light,
                                  const tem00_speckle_description *description,
                                  tem00_speckle **speckle);

/**
 * Tells what was chosen for speckle.
 *
 * The pointers are null or valid.
 */
tem00_status tem00_speckle_describe(const tem00_speckle *speckle, tem00_speckle_info *info);

/**
 * Computes the factors at `count` points that stood elsewhere in the reference state, for a
 * renderer that knows no bodies but has buffers of an image.
 *
 * `previous`, `points` and `normals` hold x, y, z of one point after the other: where the points
 * were, where they are, and their unit normals. A point counts as carried along without a turn.
 * Points whose motion is the same, one after the other, are fastest. Those that are not finite
 * have the factor 1. `factors` must not overlap with what is read.
 *
 * The pointers are null or valid, for `3 * count` numbers and for `count` factors.
 */
tem00_status tem00_speckle_factors_since(const tem00_speckle *speckle,
                                         const double *previous,
                                         const double *points,
                                         const double *normals,
                                         size_t count,
                                         double *factors);

/**
 * Finds the speckle of a body in a frame: once per body and frame.
 *
 * A motion that shifts the speckle farther than those that it was prepared for is refused. On
 * failure `*frame` is null.
 *
 * The pointers are null or valid.
 */
tem00_status tem00_speckle_frame_create(const tem00_speckle *speckle,
                                        const tem00_body_motion *motion,
                                        tem00_speckle_frame **frame);

/**
 * Computes the factor, with mean 1, by which speckle multiplies the radiance that a point of a
 * surface sends from the light to the camera.
 *
 * `point` and the unit vector `normal` hold x, y, z, both as they are now. The factor is 1 where
 * the camera does not see the point, NaN included; where the law has no value, as edge-on, the
 * speckle is new.
 *
 * The pointers are null or valid, `point` and `normal` for three numbers.
 */
tem00_status tem00_speckle_frame_factor(const tem00_speckle_frame *frame,
                                        const double *point,
                                        const double *normal,
                                        double *factor);

/**
 * Computes the factor at a point that a camera sample sees at an image point: out of focus it lies
 * beside the one where the centre of the lens sees it.
 *
 * `pixel` holds x and y in pixels, y down; `point` and `normal` are as for
 * `tem00_speckle_frame_factor`.
 *
 * The pointers are null or valid, `pixel` for two numbers, `point` and `normal` for three.
 */
tem00_status tem00_speckle_frame_factor_at(const tem00_speckle_frame *frame,
                                           const double *pixel,
                                           const double *point,
                                           const double *normal,
                                           double *factor);

/**
 * Computes the factors at `count` points: the bits of `tem00_speckle_frame_factor`. Neighbours in
 * the image, one after the other, are fastest.
 *
 * `points` and `normals` hold x, y, z of one point after the other; `factors` must not overlap
 * with them.
 *
 * The pointers are null or valid, for `3 * count` numbers and for `count` factors.
 */
tem00_status tem00_speckle_frame_factors(const tem00_speckle_frame *frame,
                                         const double *points,
                                         const double *normals,
                                         size_t count,
                                         double *factors);

/**
 * Computes the mean factor over the pixel about the image of a point, for a renderer with one
 * sample per pixel: 1 where the camera does not see it.
 *
 * The pointers are null or valid, `point` and `normal` for three numbers.
 */
tem00_status tem00_speckle_frame_average(const tem00_speckle_frame *frame,
                                         const double *point,
                                         const double *normal,
                                         double *average);

/**
 * Tells what has become of the speckle at a point since the reference state; it is new where the
 * law has no value or the camera does not see the point.
 *
 * The pointers are null or valid, `point` and `normal` for three numbers.
 */
tem00_status tem00_speckle_frame_shift(const tem00_speckle_frame *frame,
                                       const double *point,
                                       const double *normal,
                                       tem00_speckle_shift *shift);

/**
 * Frees a stack; null is allowed. No thread may be using it, and it must not be used again.
 *
 * `stack` is null, or came from one of the functions that create stacks and was not destroyed.
 */
void tem00_stack_destroy(tem00_stack *stack);

/**
 * Generates a stack, 8 bytes for each sample of each slice, on the threads that its description
 * asks for.
 *
 * On failure `*stack` is null.
 *
 * The pointers are null or valid.
 */
tem00_status tem00_stack_create(const tem00_stack_description *description, tem00_stack **stack);

/**
 * Chooses a stack that repeats nothing in the region and takes no more memory than allowed: writes
 * its description, with the seed 0 and all the cores of the machine, for `tem00_stack_create`.
 *
 * The pointers are null or valid.
 */
tem00_status tem00_stack_plan(const tem00_stack_needs *needs, tem00_stack_description *description);

/**
 * Tells what a stack is.
 *
 * The pointers are null or valid.
 */
tem00_status tem00_stack_describe(const tem00_stack *stack, tem00_stack_info *info);

/**
 * Looks up the intensity, with mean 1, at (`x`, `y`) in samples and `u` in slices.
 *
 * The pointers are null or valid.
 */
tem00_status tem00_stack_intensity(const tem00_stack *stack,
                                   double x,
                                   double y,
                                   double u,
                                   double *intensity);

/**
 * Looks up the amplitude whose squared magnitude is the intensity, for light whose fields add:
 * `amplitude` holds its real and imaginary part.
 *
 * It is the field in the frame of the pupil of the slice at u or before it: stacks along one path
 * have one frame.
 *
 * The pointers are null or valid, `amplitude` for two numbers.
 */
tem00_status tem00_stack_amplitude(const tem00_stack *stack,
                                   double x,
                                   double y,
                                   double u,
                                   double *amplitude);

/**
 * Looks up the intensities at `count` points: the bits of `tem00_stack_intensity`. Points close to
 * each other between the same two slices are fastest.
 *
 * `x` and `y` are in samples and `u` in slices; `intensity` must not overlap with them.
 *
 * The pointers are null or valid for `count` numbers.
 */
tem00_status tem00_stack_intensity_batch(const tem00_stack *stack,
                                         const double *x,
                                         const double *y,
                                         const double *u,
                                         size_t count,
                                         double *intensity);

/**
 * Single-precision form of `tem00_stack_intensity_batch`: the same intensities, rounded.
 *
 * A place that is rounded to single precision moves by up to 3e-8 of its distance from 0: take off
 * whole periods before.
 *
 * The pointers are null or valid for `count` numbers.
 */
tem00_status tem00_stack_intensity_batch_f32(const tem00_stack *stack,
                                             const float *x,
                                             const float *y,
                                             const float *u,
                                             size_t count,
                                             float *intensity);

/**
 * Computes the means of the intensity over boxes about `count` points, in single precision: those
 * of `tem00_stack_average` at these coordinates, rounded.
 *
 * `size` holds the width and the height of the boxes, in samples.
 *
 * The pointers are null or valid for `count` numbers, `size` for two.
 */
tem00_status tem00_stack_average_batch_f32(const tem00_stack *stack,
                                           const float *x,
                                           const float *y,
                                           const double *size,
                                           const float *u,
                                           size_t count,
                                           float *average);

/**
 * Computes the mean of the intensity over a box about `centre`, at `u`: what a pixel sees whose
 * whole area takes part.
 *
 * `centre` holds x, y and `size` the width and the height of the box, all in samples; `u` is in
 * slices.
 *
 * The pointers are null or valid, `centre` and `size` for two numbers.
 */
tem00_status tem00_stack_average(const tem00_stack *stack,
                                 const double *centre,
                                 const double *size,
                                 double u,
                                 double *average);

/**
 * Computes the coordinate u, in slices, at which the intensity has a given `correlation` to that
 * at u = 0: 0 for 1 or more, and the first slice of no correlation for 0 or less.
 *
 * The pointers are null or valid.
 */
tem00_status tem00_stack_coordinate_of(const tem00_stack *stack, double correlation, double *u);

/**
 * Computes the correlation of the intensities at u = 0 and u = `distance`, in slices: the inverse
 * of `tem00_stack_coordinate_of`.
 *
 * The pointers are null or valid.
 */
tem00_status tem00_stack_correlation_at(const tem00_stack *stack,
                                        double distance,
                                        double *correlation);

/**
 * Computes the correlation of the intensities at two coordinates u and v, on slices or between,
 * exactly.
 *
 * The pointers are null or valid.
 */
tem00_status tem00_stack_correlation_between(const tem00_stack *stack,
                                             double u,
                                             double v,
                                             double *correlation);

/**
 * Gives the coefficients of a slice, for upload to a GPU: width * height complex numbers row by
 * row, each a real and an imaginary part.
 *
 * They are the samples of the amplitude, or for the cubic spline its prefiltered coefficients, and
 * belong to the stack.
 *
 * The pointers are null or valid.
 */
tem00_status tem00_stack_coefficients(const tem00_stack *stack,
                                      size_t slice,
                                      const float **coefficients);

/**
 * Gives the place of the pupil of a slice, in its diameters: `offset` holds x, y.
 *
 * The pointers are null or valid, `offset` for two numbers.
 */
tem00_status tem00_stack_offset(const tem00_stack *stack, size_t slice, double *offset);

/**
 * Prepares the light of a laser with a linewidth: in milliseconds, or in seconds for a correlation
 * length of a thousand speckles. One serves all places at which the directions differ by little.
 *
 * On failure `*bandwidth` is null.
 *
 * The pointers are null or valid, that to peaks for two numbers each.
 */
tem00_status tem00_bandwidth_create(const tem00_bandwidth_description *description,
                                    tem00_bandwidth **bandwidth);

/**
 * Frees the light; null is allowed. No thread may be using it, and it must not be used again.
 *
 * `bandwidth` is null, or came from `tem00_bandwidth_create` and was not destroyed.
 */
void tem00_bandwidth_destroy(tem00_bandwidth *bandwidth);

/**
 * Tells what the linewidth makes of speckle, and what stands for it.
 *
 * The pointers are null or valid.
 */
tem00_status tem00_bandwidth_describe(const tem00_bandwidth *bandwidth, tem00_bandwidth_info *info);

/**
 * Draws a wave number with a random number from 0 to 1: stratified ones, among the samples of a
 * pixel, leave the least noise.
 *
 * The pointers are null or valid.
 */
tem00_status tem00_bandwidth_draw(const tem00_bandwidth *bandwidth,
                                  double uniform,
                                  tem00_wave *wave);

/**
 * Computes the covariance of two frames over the square of the mean intensity: what a motion
 * leaves of the contrast squared.
 *
 * `displacement` holds the motion of the field between them, in pupil diameters along the tilt and
 * across it. In focus.
 *
 * The pointers are null or valid, that to the displacement for two numbers.
 */
tem00_status tem00_bandwidth_covariance(const tem00_bandwidth *bandwidth,
                                        const double *displacement,
                                        double *covariance);

/**
 * Computes the standard deviation of the position of a laser line over that in light of one
 * wavelength: what counts for its noise, where the contrast does not.
 *
 * `row_height` is the height of the rows along which the line is looked for, in speckle sizes: 0
 * for rows finer than a speckle; rows taller than 40 count as tall, and so do round spots.
 *
 * The pointers are null or valid.
 */
tem00_status tem00_bandwidth_line_noise_ratio(const tem00_bandwidth *bandwidth,
                                              double row_height,
                                              double *ratio);

/**
 * Frees a camera; null is allowed. No thread may be using it, and it must not be used again.
 *
 * `imaging` is null, or came from one of the functions that create cameras and was not destroyed.
 */
void tem00_imaging_destroy(tem00_imaging *imaging);

/**
 * Creates a camera from its lens.
 *
 * On failure `*imaging` is null.
 *
 * The pointers are null or valid.
 */
tem00_status tem00_imaging_create_lens(const tem00_lens_description *description,
                                       tem00_imaging **imaging);

/**
 * Creates a camera from its distances and its pupil.
 *
 * On failure `*imaging` is null.
 *
 * The pointers are null or valid.
 */
tem00_status tem00_imaging_create_distances(const tem00_pupil_distances *distances,
                                            tem00_imaging **imaging);

/**
 * Tells what a camera is: among others, the size of its speckle.
 *
 * The pointers are null or valid.
 */
tem00_status tem00_imaging_describe(const tem00_imaging *imaging, tem00_imaging_info *info);

/**
 * Computes where in a speckle pattern a pixel lies, in pattern samples, not wrapped to its period.
 *
 * `pixel` holds its position in pixels, x to the right and y down as rows count, from any origin;
 * `displacement` the motion of the speckle since the reference state to the right and up, in
 * metres on the sensor; `pattern_speckle_size` is the speckle size of the pattern in samples.
 *
 * The pointers are null or valid, those to numbers for two.
 */
tem00_status tem00_imaging_pattern_coordinate(const tem00_imaging *imaging,
                                              const double *pixel,
                                              const double *displacement,
                                              double pattern_speckle_size,
                                              double *coordinate);

/**
 * Computes the intensity correlation left after a pupil displacement, in pupil diameters, and an
 * axial displacement, in axial decorrelation lengths, where it is largest: looked up at the
 * displacement of the speckle.
 *
 * The pointer is null or valid.
 */
tem00_status tem00_correlation(double pupil_shift, double axial_shift, double *correlation);

#ifdef __cplusplus
}  // extern "C"
#endif  // __cplusplus

#endif  /* TEM00_H */
