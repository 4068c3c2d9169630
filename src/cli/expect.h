/* SPDX-License-Identifier: MIT */
/* What long work costs: seconds that it took two processors. Only how the parts compare is of use, which is about the
 * same on other machines. */
#ifndef MERLIN_CLI_EXPECT_H
#define MERLIN_CLI_EXPECT_H

#include "cli/stage_bar.h"

/* How many pixels a photograph that is not read yet may have, or a folder of maps, by the file's size; 0 of what cannot
 * be looked at. */
double expect_pixels(const char *path);
/* Of such a photograph. */
double expect_photo(const char *path);

/* Adds the stages of a photograph of so many pixels behind the `count` that are there, and returns how many there are
 * then: "reading", "estimating" and "refining". */
size_t expect_estimate(double pixels, stage_cost *stages, size_t count);

/* Likewise "reading" of so large maps. */
size_t expect_maps(double pixels, stage_cost *stages, size_t count);

typedef struct expect_relight {
    double pixels;           /* of a picture of the photograph's size, */
    double pictures, frames; /* and how many of these and of an orbit there are */
    bool environment;
} expect_relight;

/* Likewise "preparing", "relighting", "going round" and "animating". */
size_t expect_relit(const expect_relight *e, stage_cost *stages, size_t count);

/* Seconds for writing the maps of so many pixels. */
double expect_maps_written(double pixels, bool mesh);

#endif
