/* SPDX-License-Identifier: MIT */
/* The result of merlin stereo. */
#ifndef MERLIN_CLI_STEREO_STEREO_RESULT_H
#define MERLIN_CLI_STEREO_STEREO_RESULT_H

#include "base/skipped.h"
#include "base/warnings.h"
#include "stereo/capture/capture.h"

typedef struct stereo_result {
    img normal, albedo, depth, mask; /* 3, 3, 1, 1 channels; albedo in [0, 1] */
    img error;                       /* 1 */
    const char *error_name;          /* what error is: the residual, or the spread in degrees */
    float error_white;               /* shown as white */
    pinhole camera;
    warnings doubts;
    skipped_files skipped; /* skipped files of the folder */
} stereo_result;

void stereo_result_free(stereo_result *r);

#endif
