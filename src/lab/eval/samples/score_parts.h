/* SPDX-License-Identifier: MIT */
/* Functions that the parts of a sample's score share. Internal to score.h. */
#ifndef MERLIN_LAB_EVAL_SAMPLES_SCORE_PARTS_H
#define MERLIN_LAB_EVAL_SAMPLES_SCORE_PARTS_H

#include "lab/eval/metrics/scores.h"
#include "lab/eval/samples/raw.h"
#include "lab/eval/samples/sheet_rows.h"
#include "lab/eval/samples/trivial.h"

/* Lights that are drawn for each sample. */
enum { EVAL_LIGHTS = 4 };

/* What an evaluation keeps from sample to sample. */
typedef struct eval_scorer {
    merlin_model *model;
    bool raw; /* the network alone is measured, else what merlin_estimate and merlin_relight make of it */
    int views;
    eval_means means;
    sheet_rows *sheet;   /* NULL: no picture wanted */
    float white;         /* radiance at which the photograph saturates */
    int given;           /* set of EVAL_GIVEN_*: true maps that take the place of the raw ones */
    size_t environments; /* samples that are still to be relit by environments */
} eval_scorer;

/* One sample on its way through. */
typedef struct eval_subject {
    const sample *sample;
    img mask; /* 1 where the object is, else 0: what figures of maps count */
    eval_photo photo;
    img image; /* its radiance, saturated at 1 as everything that is compared */
    surface truth, inflated;
    merlin_maps maps;   /* the model's, in the photograph's frame */
    surface found;      /* the same in the sample's */
    network_look *look; /* of a raw model with a relighting decoder; else NULL */
    eval_scores scores;
} eval_subject;

/* The middle, by the logarithm, of what training adds of a sample's environment. */
#define EVAL_ENVIRONMENT_STRENGTH 0.316f

static inline const model_config *eval_config(const eval_scorer *e)
{
    return network_config(e->model->network);
}

/* Returns the factor from the radiance that the maps explain to the true one: the estimate found the photograph's
 * exposure itself. */
static inline float eval_exposure(const eval_subject *on)
{
    return on->photo.white / on->maps.gain;
}

/* Returns a trivial answer's maps as the sample's camera sees them; its images are borrowed. */
static inline surface eval_shown(const eval_subject *on, const surface *trivial)
{
    surface shown = *trivial;
    shown.mask = on->truth.mask;
    shown.lens = on->truth.lens;
    return shown;
}

/* The maps' errors by region. */
void eval_score_regions(const eval_scorer *e, eval_subject *on);

/* Rows of models of setting B alone, and of the surroundings what a trivial answer takes them for: the data's mean, at
 * the strength they have in the picture, in sh; NULL in setting A. */
status eval_score_both_lights(eval_scorer *e, eval_subject *on);
const float (*eval_mean_surroundings(const eval_scorer *e, float sh[9][3]))[3];

/* Rows of relighting by environments. */
status eval_score_environment(eval_scorer *e, eval_subject *on);

/* Scores a trivial answer's picture, which is its maps rendered, against the target. */
status eval_score_trivial(eval_subject *on, const surface *maps, eval_answer answer, eval_row row,
                          const illumination *light, const img *target);
/* Scores a picture that the product made, of the photograph's size and exposure. */
status eval_score_picture(eval_subject *on, eval_row row, const merlin_image *picture, const img *target);
/* Scores the trivial answers' pictures, and the photograph itself, against the target. */
status eval_score_answers(const eval_scorer *e, eval_subject *on, eval_row row, const illumination *light,
                          const img *target);
/* Scores the maps rendered under a light, and what a raw model's relighting decoder makes of it, against the true maps
 * rendered, without shadows and bounces all. */
status eval_score_rendered(eval_scorer *e, eval_subject *on, const illumination *light, eval_row decoder,
                           eval_row brdf);

#endif
