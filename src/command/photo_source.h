/* SPDX-License-Identifier: MIT */
/* Notes in the report.json of maps what they were made of, and how: names and sizes of the photograph's and the mask's
 * files, and the options that maps depend on. By them --resume tells the maps of cup.png from those of cup.jpg, whose
 * folder may have the same name, and from those of another lens or other weights. */
#ifndef MERLIN_COMMAND_PHOTO_SOURCE_H
#define MERLIN_COMMAND_PHOTO_SOURCE_H

#include <stdbool.h>

#include "base/status.h"
#include "command/photo_list.h"

/* How maps are made: options, and paths of weights as photo_find_models finds them. */
typedef struct photo_how {
    const merlin_params *params;
    const char *weights, *flash_weights; /* the second is NULL for none */
} photo_how;

/* Adds "source" to a folder's report.json. MERLIN_BAD_INPUT if a file is not there any more. */
status photo_source_note(const photo_job *job, const photo_how *how, const char *folder);
/* Tells whether the folder's report.json names the files of this photograph, and these options. */
bool photo_source_is_noted(const photo_job *job, const photo_how *how, const char *folder);

#endif
