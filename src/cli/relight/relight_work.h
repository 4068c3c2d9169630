/* SPDX-License-Identifier: MIT */
/* Pictures of a job, one after the other: the state that the parts of relight_output.h share. */
#ifndef MERLIN_CLI_RELIGHT_RELIGHT_WORK_H
#define MERLIN_CLI_RELIGHT_RELIGHT_WORK_H

#include "cli/relight/relight_job.h"
#include "cli/relight/relight_sheet.h"
#include "merlin/merlin.h"

typedef struct relight_work {
    const relight_job *job;
    staging *staging;
    merlin_relighter *relighter;
    merlin_found_lights found; /* of a job's `found`; an orbit turns it */
    relight_result *result;
    size_t done; /* of relight_count_whole */
} relight_work;

/* MERLIN_STOPPED if the job is to stop. */
status relight_check(const relight_work *w);
/* Tells whether surroundings go round in an orbit, and no lamp. */
bool relight_surroundings_turn(const relight_job *job);
/* Returns the lamps that shine together in picture i, and how many: the found light's, else the user's i-th, if any. */
const merlin_lamp *relight_lamps(const relight_work *w, size_t i, int *count);
/* Returns how many pictures single lights take, or their surroundings alone. */
size_t relight_count_lights(const relight_job *job);
/* Renders the relighter's square under so many lamps together; counts what is burnt out. */
status relight_square(relight_work *w, const merlin_lamp *lights, int count, merlin_image *out);
/* ".png" or ".jpg" */
const char *relight_ending(const relight_job *job);

/* A picture of the photograph's size. */
typedef struct relight_picture {
    const char *name; /* NAME_000.png or .jpg */
    size_t number;
    const merlin_lamp *lights; /* together; */
    int count;                 /* 0: the environment alone */
    relight_sheet *sheet;      /* where a small copy goes, or NULL */
    bool alone;                /* as NAME.png or .jpg, too */
} relight_picture;
status relight_write(relight_work *w, const relight_picture *p);

#endif
