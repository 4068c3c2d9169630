/* SPDX-License-Identifier: MIT */
/* The files of merlin relight: a picture a light or environment, domes, frames and animations of an orbit, contact
 * sheets. */
#ifndef MERLIN_CLI_RELIGHT_RELIGHT_OUTPUT_H
#define MERLIN_CLI_RELIGHT_RELIGHT_OUTPUT_H

#include "cli/relight/relight_job.h"

/* All files, or none; MERLIN_STOPPED if stop said so. */
status relight_output(const relight_job *job, relight_result *result);
/* The job's one picture to standard output, a file's bytes. */
status relight_print(const relight_job *job, relight_result *result);

#endif
