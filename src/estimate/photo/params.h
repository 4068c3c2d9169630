/* SPDX-License-Identifier: MIT */
/* Checks the parameters of merlin_estimate (merlin/estimate.h). */
#ifndef MERLIN_ESTIMATE_PHOTO_PARAMS_H
#define MERLIN_ESTIMATE_PHOTO_PARAMS_H

#include "base/status.h"
#include "merlin/estimate.h"

/* Fails with MERLIN_WRONG_USE for an impossible size, number of views, field of view or exposure. */
status params_check(const merlin_params *params);

#endif
