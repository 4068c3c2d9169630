/* SPDX-License-Identifier: MIT */
/* The kinds of work by their names. */
#ifndef MERLIN_SERVE_JOBS_WORK_FIND_H
#define MERLIN_SERVE_JOBS_WORK_FIND_H

#include "serve/jobs/work.h"

/* NULL: there is no such work. */
const work_kind *work_find(const char *name);

#endif
