/* SPDX-License-Identifier: MIT */
/* merlin estimate of a video, or of numbered pictures: a folder of maps for each frame. */
#ifndef MERLIN_CLI_ESTIMATE_SEQUENCE_H
#define MERLIN_CLI_ESTIMATE_SEQUENCE_H

#include "cli/estimate_write.h"

/* Sets `sequence` for a video and for a pattern of names, too, and refuses what a sequence cannot have. */
status estimate_sequence_check(estimate_request *r, int count, char *const *names);
/* Does the work; returns the command's exit status. */
int estimate_sequence(const estimate_request *asked, int count, char *const *names);

#endif
