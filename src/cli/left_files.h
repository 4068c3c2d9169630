/* SPDX-License-Identifier: MIT */
/* Results of an earlier run that remain beside new ones, maybe of another object: they are not removed, since this run
 * did not write them, but reported. */
#ifndef MERLIN_CLI_LEFT_FILES_H
#define MERLIN_CLI_LEFT_FILES_H

#include "base/staging.h"
#include "base/warnings.h"

/* Adds files_left to the warnings if a folder of maps still has maps, meshes, a page, or folders of merlin relight,
 * export or stereo that this run has not written. */
void left_files_warn(const char *folder, const staged_files *written, warnings *doubts);
/* Likewise of a sequence's folder: frames that this run has not written. */
void left_frames_warn(const char *folder, const staged_files *written, warnings *doubts);

#endif
