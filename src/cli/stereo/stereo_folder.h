/* SPDX-License-Identifier: MIT */
/* Photometric stereo of a capture on disk, with results ready to be written. */
#ifndef MERLIN_CLI_STEREO_STEREO_FOLDER_H
#define MERLIN_CLI_STEREO_STEREO_FOLDER_H

#include <stdbool.h>

#include "cli/stereo/stereo_output.h"
#include "stereo/methods/solve.h"

typedef struct stereo_folder {
    const char *folder;
    merlin_capture_files files;
    merlin_stereo_params params;
} stereo_folder;

/* Solves the capture, and adds results to the report: the method, sizes, the fit's residual, lights, and errors
 * compared with ground truth if the layout has it. */
status stereo_from_folder(const stereo_folder *f, stereo_result *out, cJSON *report);

#endif
