/* SPDX-License-Identifier: MIT */
/* The job of merlin relight: the requested pictures, and the results. */
#ifndef MERLIN_CLI_RELIGHT_RELIGHT_JOB_H
#define MERLIN_CLI_RELIGHT_RELIGHT_JOB_H

#include <stdbool.h>

#include "base/lights/relit_light.h"
#include "base/staging.h"
#include "base/status.h"
#include "base/watch.h"
#include "cli/relight/lamps.h"
#include "merlin/merlin.h"

enum { RELIGHT_MOST_FRAMES = 240, RELIGHT_MOST_DOME = 999 };

/* Exposure of the pictures. */
typedef enum relight_exposing {
    RELIGHT_AS_SOURCE, /* as the photograph was exposed; for a capture as for lamps of power 1 at distance 1 */
    RELIGHT_BY_LAMPS,  /* the brightest value stays below white, as if all lamps had power 1 and were white */
    RELIGHT_AUTO,      /* the brightest value stays below white */
} relight_exposing;

typedef struct relight_dome {
    int count;  /* number of pictures under a dome of lights, of the photograph's size; 0: none */
    bool lp;    /* whether to write a list of the lights' directions for RTI viewers */
    float near; /* distance of the lamps from (0, 0, -1); 0: distant */
} relight_dome;

/* Instead of a dome's pictures one that viewers relight. */
typedef struct relight_rti {
    bool wanted;
    merlin_rti_basis basis;
    const char *file; /* the name of a .ptm in the output's folder; NULL: info.json and planes */
} relight_rti;

typedef struct relight_job {
    merlin_model *model;
    merlin_maps *maps;               /* freed, except for the mask, when they are not needed any more */
    const char *output;              /* folder */
    const char *const *inputs;       /* as in staging_begin */
    lamp_options lamps;              /* lamps of relit_000 …, of the photograph's size */
    bool together;                   /* one picture under all of them instead of one for each */
    merlin_environment *environment; /* an orbit turns it; beside the lights, and alone where there are none; or NULL */
    bool found;                      /* use the light estimated from the photograph instead of lamps and environment */
    float turn;                      /* rotation about the vertical in degrees, as for merlin_relight_found */
    merlin_relighting how;
    bool matte;
    merlin_image_format format; /* format of pictures of the photograph's size */
    relight_exposing exposing;
    float ev; /* additional stops */
    relight_dome dome;
    relight_rti rti;
    int orbit; /* number of frames; 0: none. A given environment rotates, with the first of the lights if any; so does
                * the estimated light; otherwise a lamp moves around */
    int frame; /* side of the frames; 0: the crop's, at most 512 */
    const merlin_sequence_files *frames; /* a sequence, of which `maps` are the first frame's; or NULL */
    int (*stop)(void);
    const watch *watch; /* receives "preparing", "relighting", "going round" (of an orbit) and "animating" */
} relight_job;

/* Results of the job. */
typedef struct relight_result {
    staged_files files;
    float ev;           /* stops by which the pictures are brighter than with RELIGHT_AS_SOURCE */
    relit_light seen;   /* what is burnt out or black */
    size_t left;        /* number of numbered pictures of an earlier run among them */
    char left_name[16]; /* name of the first of these */
    char no_video[256]; /* why a sequence was not written as a video; "": it was, or there is none */
} relight_result;

/* Returns the number of pictures of the photograph's size. */
size_t relight_count_whole(const relight_job *job);

#endif
