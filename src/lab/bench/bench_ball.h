/* SPDX-License-Identifier: MIT */
/* The picture that estimating and relighting are measured on. */
#ifndef MERLIN_LAB_BENCH_BENCH_BALL_H
#define MERLIN_LAB_BENCH_BENCH_BALL_H

#include "image/image.h"

/* A shiny ball under the flash, on black: 256×256, 3 channels of radiance. */
status bench_ball(img *picture);

#endif
