/* SPDX-License-Identifier: MIT */
/* The test picture for measuring estimates and relighting. */
#ifndef MERLIN_LAB_BENCH_BENCH_BALL_H
#define MERLIN_LAB_BENCH_BENCH_BALL_H

#include "image/image.h"

/* Renders a shiny ball under the flash on black: 256×256, 3 channels of radiance. */
status bench_ball(img *picture);

#endif
