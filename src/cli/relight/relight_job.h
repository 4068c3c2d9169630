/* SPDX-License-Identifier: MIT */
/* The job of merlin relight: the pictures that are asked for, and the ones that were made. */
#ifndef MERLIN_CLI_RELIGHT_RELIGHT_JOB_H
#define MERLIN_CLI_RELIGHT_RELIGHT_JOB_H

#include <stdbool.h>

#include "base/staging.h"
#include "base/status.h"
#include "base/watch.h"
#include "cli/relight/lamps.h"
#include "merlin/merlin.h"

enum { RELIGHT_MOST_FRAMES = 240, RELIGHT_MOST_DOME = 999 };

/* The brightness that pictures get. */
typedef enum relight_exposing {
    RELIGHT_AS_SOURCE, /* as the photograph was exposed; as lamps of power 1 would have it at distance 1 */
    RELIGHT_BY_LAMPS,  /* so that the brightest stays below white, were all lamps of power 1 and white */
    RELIGHT_AUTO,      /* so that the brightest stays below white */
} relight_exposing;

typedef struct relight_dome {
    int count;  /* pictures under a dome of lights, of the photograph's size; 0: none */
    bool lp;    /* and a list of the lights' directions for RTI viewers */
    float near; /* how far from (0, 0, -1) the lamps stand; 0: far away */
} relight_dome;

typedef struct relight_job {
    merlin_model *model;
    merlin_maps *maps;               /* but for the mask they are let go when nothing needs them any more */
    const char *output;              /* folder */
    const char *const *inputs;       /* as in staging_begin */
    lamp_options lamps;              /* relit_000 …, of the photograph's size */
    merlin_environment *environment; /* an orbit turns it; beside the lights, and alone where there are none; or NULL */
    bool found;                      /* instead of lamps and environment the light that was found in the photograph */
    float turn;                      /* degrees that it is turned about the vertical, as of merlin_relight_found */
    merlin_relighting how;
    bool matte;
    merlin_image_format format; /* of the photograph's size */
    relight_exposing exposing;
    float ev; /* stops brighter than that */
    relight_dome dome;
    int orbit; /* frames; 0: none. Under an environment that goes round, beside the first of the lights if any, or under
                * the light that was found, which goes round; else a lamp does */
    int frame; /* their side; 0: the crop's, at most 512 */
    int (*stop)(void);
    const watch *watch; /* told "preparing", "relighting", "going round" (of an orbit) and "animating" */
} relight_job;

/* The outcome of it. */
typedef struct relight_result {
    staged_files files;
    float ev;           /* stops by which the pictures are brighter than RELIGHT_AS_SOURCE has them */
    double burnt_out;   /* largest share of the object's pixels, of all pictures, with a channel at white */
    size_t pictures;    /* how many there are, */
    size_t burnt;       /* and with RELIGHT_MUCH_BURNT_OUT or more */
    size_t dark;        /* and in which the object is black */
    size_t left;        /* numbered pictures of an earlier run that are still among them, */
    char left_name[16]; /* and what the first is called */
} relight_result;

#define RELIGHT_MUCH_BURNT_OUT 0.05

/* Returns how many pictures of the photograph's size the job takes. */
size_t relight_count_whole(const relight_job *job);

#endif
