/* SPDX-License-Identifier: MIT */
/* The kinds of work that a client can request. Each checks the form at once, so that errors are in the response to the
 * upload, and runs when its turn comes.
 *
 *     const work_kind *kind = work_find("estimate");
 *     void *request = NULL;
 *     status s = kind->check(&form, &request);           the client waits
 *     ...
 *     if (s == OK) s = kind->run(&context, request);     in the worker's thread
 *     free(request); */
#ifndef MERLIN_SERVE_JOBS_WORK_H
#define MERLIN_SERVE_JOBS_WORK_H

#include <cjson/cJSON.h>

#include "merlin/merlin.h"
#include "serve/jobs/form.h"

/* Limits of all work of a server. */
typedef struct work_limits {
    double megapixels; /* size of a photograph, and of one picture of a capture */
    int pictures;      /* number of a capture's pictures, and of a relighting's lights */
} work_limits;

typedef struct work_context {
    merlin_model *model;
    const merlin_near_network *near; /* NULL: none */
    const store *store;
    const form *form;
    const work_limits *limits;
    merlin_progress progress;
    void *progress_context;
    int (*stop)(void);
    cJSON *report; /* report of the job, for facts that are not in the files */
} work_context;

/* A stage of the progress, and its share of the time. */
typedef struct work_stage {
    const char *name;
    float share;
} work_stage;

typedef struct work_kind {
    const char *name;
    const work_stage *stages; /* stages in their order, ended by one without a name */
    /* *request is malloc'ed and freed by free. MERLIN_WRONG_USE names the field. */
    status (*check)(const form *f, const work_limits *limits, void **request);
    status (*run)(const work_context *w, const void *request);
    const char *uses; /* file of an earlier job's results that the field "job" adds to the uploads; NULL: none */
} work_kind;

#endif
