/* SPDX-License-Identifier: MIT */
/* State of the pictures of a job, which are rendered one after the other; shared by the parts of relight_output.h. */
#ifndef MERLIN_CLI_RELIGHT_RELIGHT_WORK_H
#define MERLIN_CLI_RELIGHT_RELIGHT_WORK_H

#include "cli/relight/relight_job.h"
#include "cli/relight/relight_sheet.h"
#include "merlin/merlin.h"

typedef struct relight_work {
    const relight_job *job;
    staging *staging;
    merlin_relighter *relighter;
    merlin_found_lights found; /* lights of a job's `found`; an orbit rotates it */
    relight_result *result;
    size_t done; /* number of pictures done of relight_count_whole */
} relight_work;

/* Returns MERLIN_STOPPED if the job must stop. */
status relight_check(const relight_work *w);
/* Tells whether an orbit rotates the environment instead of a lamp. */
bool relight_surroundings_turn(const relight_job *job);
/* Returns the lamps of picture i and their number: the estimated light's, else the user's i-th, if any, or all of his
 * together. */
const merlin_lamp *relight_lamps(const relight_work *w, size_t i, int *count);
/* Returns the number of pictures for single lights, or for the environment alone. */
size_t relight_count_lights(const relight_job *job);
/* Renders the relighter's square under these lamps together, and counts burnt-out pixels. */
status relight_square(relight_work *w, const merlin_lamp *lights, int count, merlin_image *out);
/* Returns ".png" or ".jpg". */
const char *relight_ending(const relight_job *job);

/* A picture of the photograph's size. */
typedef struct relight_picture {
    const char *name; /* name of NAME_000.png or .jpg */
    size_t number;
    const merlin_lamp *lights; /* lamps that are lit together */
    int count;                 /* 0: only the environment */
    relight_sheet *sheet;      /* sheet for a small copy, or NULL */
    bool alone;                /* whether it is also written as NAME.png or .jpg */
} relight_picture;
status relight_write(relight_work *w, const relight_picture *p);

#endif
