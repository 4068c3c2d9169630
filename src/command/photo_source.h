/* SPDX-License-Identifier: MIT */
/* Notes in the report.json of maps what they were made of: names and sizes of the photograph's and the mask's files. By
 * them
 * --resume tells the maps of cup.png from those of cup.jpg, whose folder may have the same name. */
#ifndef MERLIN_COMMAND_PHOTO_SOURCE_H
#define MERLIN_COMMAND_PHOTO_SOURCE_H

#include <stdbool.h>

#include "base/status.h"
#include "command/photo_list.h"

/* Adds "source" to a folder's report.json. MERLIN_BAD_INPUT if a file is not there any more. */
status photo_source_note(const photo_job *job, const char *folder);
/* Tells whether the folder's report.json names the files of this photograph. */
bool photo_source_is_noted(const photo_job *job, const char *folder);

#endif
