/* SPDX-License-Identifier: MIT */
/* Expected cost of long work in seconds on two processors. Only ratios matter, which are about the same on other
 * machines. */
#ifndef MERLIN_CLI_EXPECT_H
#define MERLIN_CLI_EXPECT_H

#include "cli/stage_bar.h"

/* Returns the probable number of pixels of a photograph or a folder of maps by the file's size; 0 if it cannot be
 * accessed. */
double expect_pixels(const char *path);
/* Returns the cost of such a photograph. */
double expect_photo(const char *path);

/* Appends the stages of a photograph of this size to `count` ones: "reading", "estimating" and "refining"; returns the
 * new count. */
size_t expect_estimate(double pixels, stage_cost *stages, size_t count);

/* Does the same for "reading" maps of this size. */
size_t expect_maps(double pixels, stage_cost *stages, size_t count);

typedef struct expect_relight {
    double pixels;           /* number of pixels of a picture of the photograph's size */
    double pictures, frames; /* numbers of these and of an orbit's frames */
    bool environment;
} expect_relight;

/* Does the same for "preparing", "relighting", "going round" and "animating". */
size_t expect_relit(const expect_relight *e, stage_cost *stages, size_t count);

/* Returns the seconds for writing maps of this size. */
double expect_maps_written(double pixels, bool mesh);

#endif
