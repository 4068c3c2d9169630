/* SPDX-License-Identifier: MIT */
/* merlin stereo of pictures whose lights nobody knows, by a network that sees them together: maps as of merlin
 * estimate. */
#ifndef MERLIN_CLI_STEREO_STEREO_UNIVERSAL_H
#define MERLIN_CLI_STEREO_STEREO_UNIVERSAL_H

#include <stdbool.h>

#include "base/watch.h"
#include "cli/stage_bar.h"
#include "cli/stereo/stereo_output.h"
#include "merlin/merlin.h"

typedef struct universal_request {
    const char *input, *weights; /* weights: NULL for those that ship */
    const stereo_files *files;
    merlin_params params;
    bool json, quiet;
    stage_bar *bar;
    const watch *watch;
    double began; /* when the command began (clock_seconds) */
} universal_request;

/* Makes maps, frees the capture, as both take much memory, writes the maps' folder and reports it. */
status stereo_universal(const universal_request *r, merlin_capture *capture);

#endif
