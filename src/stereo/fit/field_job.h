/* SPDX-License-Identifier: MIT */
/* Tasks that field_fit.c and field_sweep.c do for the pixels of a field, one at a time. Internal to both.
 *
 *     pst_field_job job = {.field = f, .task = PST_REFINE};
 *     status s = pst_field_run(&job, 0, f->count);
 */
#ifndef MERLIN_STEREO_FIT_FIELD_JOB_H
#define MERLIN_STEREO_FIT_FIELD_JOB_H

#include "stereo/fit/fall_off.h"
#include "stereo/fit/field_neighbours.h"
#include "stereo/integrate/stereo_surface.h"

typedef enum pst_field_task {
    PST_FIT,
    PST_REFINE,
    PST_SEARCH,
    PST_SECOND,
    PST_PREDICT,
    PST_SPREAD,
    PST_OUTLIERS,
    PST_ALBEDO,
    PST_MODEL,
    PST_FALL_OFF,
    PST_STORE
} pst_field_task;

typedef struct pst_field_job {
    const pst_field *field;
    pst_field_task task;
    pst_around around;     /* neighbours, for spread and outliers */
    float limit;           /* cost from which on a pixel is searched again */
    float contradiction;   /* cost of differing from all neighbours, for outliers */
    pst_shading *next;     /* of the pixels from `first` on: results that will replace the field's, for spread and
                            * outliers */
    float *weight, *model; /* padded lights per pixel, for model */
    pst_fall_off *fall;    /* results of fall-off */
    merlin_surface *out;   /* results of store */
    float *x, *y, *z;      /* directions of distant lights, padded */
    size_t first, end;     /* the pixels */
    double *cost;          /* of each block of them */
    double total;          /* sum of these, in the pixels' order whatever the number of threads */
} pst_field_job;

/* Runs the task for the pixels first .. end - 1. */
status pst_field_run(pst_field_job *job, size_t first, size_t end);

/* Number of pixels from a field's begin, or from the end of the last ones, that are processed together by who cannot
 * keep two results of all: many more than a row of the pictures has. */
size_t pst_field_band(const pst_field *f);

#endif
