/* The files of merlin relight: a picture a light or environment, frames and animations of an orbit, contact sheets. */
#ifndef MERLIN_CLI_RELIGHT_OUTPUT_H
#define MERLIN_CLI_RELIGHT_OUTPUT_H

#include <stdbool.h>

#include "base/light_list.h"
#include "base/progress.h"
#include "base/status.h"
#include "estimate/staging.h"
#include "merlin/merlin.h"

enum { RELIGHT_MOST_FRAMES = 240, RELIGHT_MOST_DOME = 999 };

typedef struct relight_job {
    merlin_model *model;
    merlin_maps *maps;                     /* but for the mask they are let go when nothing needs them any more */
    const char *output;                    /* folder */
    const char *const *inputs;             /* as in staging_begin */
    light_list lights;                     /* relit_000.png …, of the photograph's size */
    const merlin_environment *environment; /* beside the lights, and alone where there are none; or NULL */
    merlin_relighting how;
    int dome;  /* pictures under a dome of lights, of the photograph's size; 0: none */
    bool lp;   /* and a list of the dome's lights for RTI viewers */
    int orbit; /* frames; 0: none. Under an environment that goes round, beside the first of the lights if any; else the
                * light does */
    int frame; /* their side; 0: the crop's, at most 512 */
    int (*stop)(void);
    progress *progress; /* moves on by one for each of relight_count */
} relight_job;

/* How many pictures of the object it takes. */
size_t relight_count(const relight_job *job);

/* All files, their paths added to *written, or none; ERROR_STOPPED if stop said so. */
status relight_output(const relight_job *job, staged_files *written);

#endif
