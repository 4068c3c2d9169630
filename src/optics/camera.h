/* SPDX-License-Identifier: MIT */
/* Pinhole camera at the origin, looking along -z, x right, y up; square pixels.
 *
 *     camera c = {.width = 256, .height = 256, .fov = CAMERA_FOV};
 *     vec3 d = camera_ray(&c, 10.5f, 20.5f);           through the centre of the pixel in column 10, row 20
 *     vec3 p = camera_point(&c, 10.5f, 20.5f, depth);  the point there whose depth is -p.z
 *
 * A crop away from the lens's axis is a camera that looks at the crop's middle, with an image plane tilted against its
 * line of sight: the plane stays perpendicular to the lens's axis.
 *
 *     camera c = {256, 256, 60, camera_tilt(20, 0)};   its middle 20 degrees to the right of the lens's axis
 *
 * Pixel coordinates start at the image's top left corner: pixel (i, j) covers [i, i+1) × [j, j+1). */
#ifndef MERLIN_OPTICS_CAMERA_H
#define MERLIN_OPTICS_CAMERA_H

#include "base/vec.h"

/* Horizontal field of view in degrees of the training data's camera (docs/conventions.md), also assumed for pictures
 * whose lens is not known. */
#define CAMERA_FOV ((real)60)

/* Direction from the lens's axis to the picture's middle: sines of the angles to the right and upwards. Zero for a
 * picture that is not cropped. */
typedef struct camera_slant {
    real right, up;
} camera_slant;

/* The lens that took a picture, independent of the picture's size. */
typedef struct camera_lens {
    real fov; /* horizontal field of view, degrees, by the size of a pixel in the middle */
    camera_slant slant;
} camera_lens;

typedef struct camera {
    int width, height;
    real fov; /* fov and slant: as in camera_lens */
    camera_slant slant;
} camera;

static inline camera camera_through(camera_lens lens, int width, int height)
{
    return (camera){width, height, lens.fov, lens.slant};
}

/* Returns the slant for angles in degrees, of the picture's middle to the lens's axis; together less than 90. */
static inline camera_slant camera_tilt(real right, real up)
{
    real x = tan(right * DEGREE), y = tan(up * DEGREE), length = sqrt(1 + x * x + y * y);
    return (camera_slant){x / length, y / length};
}

/* Returns the tangent of half the field of view: half the picture's width at depth 1. */
static inline real camera_tangent(real fov)
{
    return tan(fov * (DEGREE / 2));
}

/* Returns the size of a pixel at depth 1. */
static inline real camera_pixel_size(const camera *c)
{
    return 2 * camera_tangent(c->fov) / (real)c->width;
}

/* The image plane's axes, to the right and upwards, in the space of a camera that looks along -z: the lens's axes,
 * turned by the smallest rotation that brings the picture's middle onto the optical axis. */
typedef struct camera_plane {
    vec3 right, up;
} camera_plane;

static inline camera_plane camera_plane_of(camera_slant at)
{
    real forward = sqrt(1 - at.right * at.right - at.up * at.up), share = 1 / (1 + forward);
    return (camera_plane){{1 - at.right * at.right * share, -at.right * at.up * share, -at.right},
                          {-at.right * at.up * share, 1 - at.up * at.up * share, -at.up}};
}

/* Returns the plane's point at u to the right and v upwards, in units of its distance, scaled to depth 1: (X, Y, -1).
 */
static inline vec3 camera_on_plane(const camera_plane *p, real u, real v)
{
    real z = 1 - u * p->right.z - v * p->up.z;
    return vec3_make((u * p->right.x + v * p->up.x) / z, (u * p->right.y + v * p->up.y) / z, -1);
}

/* Returns the point at this depth (-z) seen at (x, y). At depth 1: (X, Y, -1). */
static inline vec3 camera_point(const camera *c, real x, real y, real depth)
{
    const camera_plane plane = camera_plane_of(c->slant);
    real size = camera_pixel_size(c);
    vec3 ray = camera_on_plane(&plane, (x - (real)c->width / 2) * size, ((real)c->height / 2 - y) * size);
    return vec3_scale(ray, depth);
}

/* Returns the unit direction through (x, y). */
static inline vec3 camera_ray(const camera *c, real x, real y)
{
    return vec3_normalize(camera_point(c, x, y, 1));
}

/* Projects a point in front of the camera (p.z < 0) to pixel coordinates. */
static inline void camera_project(const camera *c, vec3 p, real *x, real *y)
{
    const camera_plane plane = camera_plane_of(c->slant);
    const camera_slant at = c->slant;
    vec3 behind = vec3_cross(plane.right, plane.up);
    real scale = -sqrt(1 - at.right * at.right - at.up * at.up) / vec3_dot(p, behind), size = camera_pixel_size(c);
    *x = (real)c->width / 2 + (scale * vec3_dot(p, plane.right) - at.right) / size;
    *y = (real)c->height / 2 - (scale * vec3_dot(p, plane.up) - at.up) / size;
}

#endif
