/* SPDX-License-Identifier: MIT */
/* All kinds of work, a file each: work_NAME.c. */
#ifndef MERLIN_SERVE_JOBS_WORK_KINDS_H
#define MERLIN_SERVE_JOBS_WORK_KINDS_H

#include "serve/jobs/work.h"

extern const work_kind work_mask, work_estimate, work_relight, work_stereo;

#endif
