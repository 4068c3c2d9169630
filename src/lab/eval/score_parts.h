/* SPDX-License-Identifier: MIT */
/* Functions that the parts of a sample's score share. Internal to score.h. */
#ifndef MERLIN_LAB_EVAL_SCORE_PARTS_H
#define MERLIN_LAB_EVAL_SCORE_PARTS_H

#include "lab/eval/predict.h"
#include "lab/eval/scores.h"
#include "lab/eval/sheet.h"
#include "lab/eval/trivial.h"

/* What an evaluation keeps from sample to sample. */
typedef struct eval_scorer {
    eval_model *model;
    eval_means means;
    eval_prediction prediction;
    sheet_rows *sheet;   /* NULL: no picture wanted */
    float white;         /* radiance at which the photograph saturates */
    int given;           /* set of EVAL_GIVEN_*: true maps that take the place of the estimated ones */
    size_t environments; /* samples that are still to be relit by environments */
} eval_scorer;

/* One sample on its way through. */
typedef struct eval_subject {
    const sample *sample;
    img mask;  /* binary */
    img photo; /* the network's input before encoding */
    img image; /* the same, saturated at radiance 1 as everything that is compared */
    eval_maps truth, inflated;
    eval_scores scores;
} eval_subject;

/* Pictures of one relighting: up to EVAL_LIGHTS lights and their targets. */
typedef struct eval_relighting {
    illumination lights[EVAL_LIGHTS];
    img targets[EVAL_LIGHTS];
    int count;
} eval_relighting;

/* The middle, by the logarithm, of what training adds of a sample's environment. */
#define EVAL_ENVIRONMENT_STRENGTH 0.316f

/* The maps' errors by region. */
void eval_score_regions(const eval_scorer *e, eval_subject *on);

/* Rows of models of setting B alone, and of the surroundings what a trivial answer takes them for: the data's mean, at
 * the strength they have in the picture, in sh; NULL in setting A. */
status eval_score_both_lights(eval_scorer *e, eval_subject *on);
const float (*eval_mean_surroundings(const eval_scorer *e, float sh[9][3]))[3];

/* Rows of relighting by environments. */
status eval_score_environment(eval_scorer *e, eval_subject *on);

/* A trivial answer's picture, which is its maps rendered, against the target. */
status eval_score_trivial(eval_subject *on, const eval_maps *maps, eval_answer answer, eval_row row,
                          const illumination *light, const img *target);
/* The model's pictures (by_network may be NULL) and the trivial answers' against the targets. */
status eval_score_relighting(eval_scorer *e, eval_subject *on, const eval_relighting *r, eval_row decoder,
                             eval_row brdf, const img *by_network, const img *by_brdf);
/* Of the true maps under every light of r, without shadows. */
status eval_render_targets(const eval_subject *on, eval_relighting *r);
void eval_relighting_free(eval_relighting *r);

#endif
