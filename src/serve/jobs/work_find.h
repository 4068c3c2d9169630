/* SPDX-License-Identifier: MIT */
/* The kinds of work by their names. */
#ifndef MERLIN_SERVE_JOBS_WORK_FIND_H
#define MERLIN_SERVE_JOBS_WORK_FIND_H

#include "serve/jobs/work.h"

/* Returns the kind of this name, or NULL. */
const work_kind *work_find(const char *name);

#endif
