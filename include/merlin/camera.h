/* SPDX-License-Identifier: MIT */
/* merlin/camera: a camera by its focal length and principal point, as calibrations tell it. */
#ifndef MERLIN_CAMERA_H
#define MERLIN_CAMERA_H

#ifdef __cplusplus
extern "C" {
#endif

typedef struct merlin_camera {
    float focal; /* focal length in pixels; 0: the camera is far away, its lines of sight are parallel */
    float x, y;  /* principal point, pixels from the upper left corner of the picture; not asked for where focal is 0 */
    float distance; /* of the object from the camera, its mean, in the unit of the lights' positions; 0: not known */
} merlin_camera;

#ifdef __cplusplus
}
#endif

#endif
