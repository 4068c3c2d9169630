/* SPDX-License-Identifier: MIT */
/* Photometric stereo from one photograph: estimate, relight under many known near lights, and solve, several times. */
#ifndef MERLIN_CLI_STEREO_STEREO_PHOTO_H
#define MERLIN_CLI_STEREO_STEREO_PHOTO_H

#include <stdbool.h>

#include "cli/stereo/stereo_output.h"
#include "merlin/merlin.h"
#include "stereo/methods/solve.h"

typedef struct stereo_photo {
    const char *photo;           /* or a folder of merlin estimate, whose maps are used */
    const char *mask;            /* mask of the photograph, or NULL */
    const char *weights, *flash; /* weights of photo_find_models */
    merlin_params params;
    merlin_stereo_method method; /* MERLIN_STEREO_AUTO: near */
    const watch *watch;          /* told of the stages; may be NULL */
    bool preserve_edges;
} stereo_photo;

/* 50 lights of the frontal hemisphere, five draws of 32 of them, all by a fixed seed. The result is the square around
 * the object: the draws' mean normal (the network's own where they spread over more than 20 degrees), and as error that
 * spread in degrees; the albedo is the network's. What was found is added to the report. */
status stereo_from_photo(const stereo_photo *p, stereo_result *out, cJSON *report);

#endif
