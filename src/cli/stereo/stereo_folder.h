/* SPDX-License-Identifier: MIT */
/* Photometric stereo of a capture on disk, ready to be written. */
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

/* What was found is added to the report: the method, sizes, the fit's residual, found lights, and errors against ground
 * truth where the layout has it. */
status stereo_from_folder(const stereo_folder *f, stereo_result *out, cJSON *report);

#endif
