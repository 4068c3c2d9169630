/* SPDX-License-Identifier: MIT */
/* A camera by its focal length and principal point in pixels (camera.h has one by its field of view). */
#ifndef MERLIN_OPTICS_PINHOLE_H
#define MERLIN_OPTICS_PINHOLE_H

#include <math.h>
#include <stdbool.h>

#include "merlin/camera.h"

/* The library's own camera, by a short name for the inside. */
typedef merlin_camera pinhole;

/* Tells whether its lines of sight meet: else it is far away. */
static inline bool pinhole_is_near(const pinhole *c)
{
    return c->focal > 0;
}

/* Returns the camera whose picture is so many degrees wide, with the axis through its middle. */
static inline pinhole pinhole_of(int width, int height, float field_of_view)
{
    static const float HALF_DEGREE = 0.00872664626f;
    return (pinhole){.focal = 0.5f * (float)width / tanf(field_of_view * HALF_DEGREE),
                     .x = 0.5f * (float)width,
                     .y = 0.5f * (float)height};
}

/* Returns how many degrees wide a picture of so many pixels is. The camera must be near. */
static inline float pinhole_field_of_view(const pinhole *c, int width)
{
    static const float DEGREES = 57.2957795f;
    return 2 * DEGREES * atanf(0.5f * (float)width / c->focal);
}

/* Returns the focal length in pixels of a picture by the one in mm that gives the same diagonal angle of view on
 * 36 × 24 mm, as EXIF states it; of 0 it is 0. */
static inline float pinhole_focal_of_35mm(int width, int height, float focal_35mm)
{
    static const float DIAGONAL_35MM = 43.2666f;
    return focal_35mm / DIAGONAL_35MM * hypotf((float)width, (float)height);
}

/* Returns the camera by the field of view, else by the 35 mm equivalent focal length, each 0 if it is unknown, with the
 * axis through the picture's middle; one that is far away if neither is known. */
static inline pinhole pinhole_known(int width, int height, float field_of_view, float focal_35mm)
{
    if (field_of_view > 0) return pinhole_of(width, height, field_of_view);
    if (!(focal_35mm > 0)) return (pinhole){0};
    return (pinhole){
        .focal = pinhole_focal_of_35mm(width, height, focal_35mm), .x = 0.5f * (float)width, .y = 0.5f * (float)height};
}

#endif
