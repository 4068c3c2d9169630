/* SPDX-License-Identifier: MIT */
/* A sample photographed under mixtures of the lights that it was rendered with, and figures of maps against its truth.
 *
 *     status s = lit_subject_measure(path, measure, &run);        with, in measure:
 *     img radiance;
 *     float white;
 *     status s = lit_radiance(on, &(lit_mixture){.lamp = 2}, &radiance, &white);
 *     ... maps of radiance / white ...
 *     lit_figures_add(&maps, on, sum); */
#ifndef MERLIN_LAB_EVAL_TABLES_LIT_SUBJECT_H
#define MERLIN_LAB_EVAL_TABLES_LIT_SUBJECT_H

#include "estimate/surface/surface.h"
#include "lab/render/sample.h"

typedef struct lit_subject {
    const sample *s;
    img mask; /* 1 where the object is, else 0 */
    surface truth;
} lit_subject;

/* Reads a sample and measures it, which is then freed again. MERLIN_BAD_INPUT for one without lamps or environment. */
status lit_subject_measure(const char *path, status (*measure)(void *context, const lit_subject *on), void *context);

/* The lights of one photograph, and how much of each there is. */
typedef struct lit_mixture {
    float flash, room; /* room: its mean over the object in that of the other light */
    int lamp;          /* -1: none */
} lit_mixture;

/* Computes the radiance, and the one that a camera makes white: a flash alone is exposed as the samples are, everything
 * else by its bright part. */
status lit_radiance(const lit_subject *on, const lit_mixture *m, img *out, float *white);

typedef enum lit_figure {
    LIT_ANGLE,       /* of normals, degrees */
    LIT_ALBEDO,      /* mean squared error in [-1, 1] */
    LIT_ALBEDO_FREE, /* the same where the albedo may be as many times as large as suits best */
    LIT_ROUGHNESS,   /* mean squared error in [-1, 1] */
    LIT_RELIEF,      /* root mean square error of depth, its mean apart, in widths of the frame */
    LIT_FIGURES
} lit_figure;

/* Names of the figures in tables and in JSON. */
typedef struct lit_words {
    const char *heading, *key;
    double factor; /* of the printed figure */
} lit_words;
extern const lit_words lit_figure_words[LIT_FIGURES];

void lit_figures_add(const surface *maps, const lit_subject *on, double sum[LIT_FIGURES]);

#endif
