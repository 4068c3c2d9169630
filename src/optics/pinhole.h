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

#endif
