/* SPDX-License-Identifier: MIT */
/* A pinhole camera by focal length and principal point in pixels, as calibrations give them (camera.h describes one by
 * its field of view); without perspective for an object far away. */
#ifndef MERLIN_OPTICS_PINHOLE_H
#define MERLIN_OPTICS_PINHOLE_H

#include <math.h>
#include <stdbool.h>

typedef struct pinhole {
    bool perspective;
    float focal;              /* focal length, pixels */
    float center_x, center_y; /* principal point, pixels from the top left corner */
    float mean_distance; /* distance from the camera to the object, in the unit of the light positions; 0 if unknown */
} pinhole;

/* Returns the camera of this horizontal field of view (degrees) with the principal point in the picture's middle. */
static inline pinhole pinhole_of(int width, int height, float field_of_view)
{
    static const float HALF_DEGREE = 0.00872664626f;
    return (pinhole){.perspective = true,
                     .focal = 0.5f * (float)width / tanf(field_of_view * HALF_DEGREE),
                     .center_x = 0.5f * (float)width,
                     .center_y = 0.5f * (float)height};
}

#endif
