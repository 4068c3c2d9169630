/* SPDX-License-Identifier: MIT */
/* Checks what merlin_estimate is asked for (merlin/estimate.h). */
#ifndef MERLIN_ESTIMATE_PHOTO_PARAMS_H
#define MERLIN_ESTIMATE_PHOTO_PARAMS_H

#include "base/status.h"
#include "merlin/estimate.h"

/* MERLIN_WRONG_USE for a size, number of views, field of view or exposure that cannot be. */
status params_check(const merlin_params *params);

#endif
