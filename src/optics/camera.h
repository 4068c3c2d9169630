/* Pinhole camera at the origin, looking along -z, x right, y up; square pixels.
 *
 *     camera c = {256, 256, 60};
 *     vec3 d = camera_ray(&c, 10.5f, 20.5f);           through the centre of the pixel in column 10, row 20
 *     vec3 p = camera_point(&c, 10.5f, 20.5f, depth);  the point there whose depth is -p.z
 *
 * Pixel coordinates run from the image's top left corner: pixel (i, j) covers [i, i+1) × [j, j+1). */
#ifndef MERLIN_OPTICS_CAMERA_H
#define MERLIN_OPTICS_CAMERA_H

#include "base/vec.h"

typedef struct camera {
    int width, height;
    real fov; /* horizontal, degrees */
} camera;

/* Size of a pixel at depth 1. */
static inline real camera_pixel_size(const camera *c)
{
    return 2 * tan(c->fov * (real)(3.14159265358979323846 / 360)) / (real)c->width;
}

/* The point of depth (-z) seen at (x, y). At depth 1: (X, Y, -1). */
static inline vec3 camera_point(const camera *c, real x, real y, real depth)
{
    real size = camera_pixel_size(c) * depth;
    return vec3_make((x - (real)c->width / 2) * size, ((real)c->height / 2 - y) * size, -depth);
}

/* Unit direction through (x, y). */
static inline vec3 camera_ray(const camera *c, real x, real y)
{
    return vec3_normalize(camera_point(c, x, y, 1));
}

/* Pixel coordinates of a point in front of the camera (p.z < 0). */
static inline void camera_project(const camera *c, vec3 p, real *x, real *y)
{
    real size = camera_pixel_size(c) * -p.z;
    *x = (real)c->width / 2 + p.x / size;
    *y = (real)c->height / 2 - p.y / size;
}

#endif
