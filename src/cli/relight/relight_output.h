/* SPDX-License-Identifier: MIT */
/* The files of merlin relight: a picture per light or environment, domes, frames and animations of an orbit, contact
 * sheets. */
#ifndef MERLIN_CLI_RELIGHT_RELIGHT_OUTPUT_H
#define MERLIN_CLI_RELIGHT_RELIGHT_OUTPUT_H

#include "cli/relight/relight_job.h"

/* Writes all files, or none; MERLIN_STOPPED if requested by stop. */
status relight_output(const relight_job *job, relight_result *result);
/* Writes the job's single picture to standard output, as a file's bytes. */
status relight_print(const relight_job *job, relight_result *result);

#endif
