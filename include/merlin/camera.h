/* SPDX-License-Identifier: MIT */
/* merlin/camera: a camera by its focal length and principal point, as calibrations give it. */
#ifndef MERLIN_CAMERA_H
#define MERLIN_CAMERA_H

#ifdef __cplusplus
extern "C" {
#endif

typedef struct merlin_camera {
    float focal;    /* focal length in pixels; 0: the camera is far away, and its lines of sight are parallel */
    float x, y;     /* principal point in pixels from the upper left corner of the picture; ignored if focal is 0 */
    float distance; /* mean distance of the object from the camera in the unit of the lights' positions; 0: unknown */
} merlin_camera;

#ifdef __cplusplus
}
#endif

#endif
