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

/* State that an evaluation keeps between samples. */
typedef struct eval_scorer {
    merlin_model *model;
    bool raw; /* whether the network alone is measured, else merlin_estimate and merlin_relight */
    int views;
    eval_means means;
    sheet_rows *sheet;   /* NULL: no picture requested */
    float white;         /* radiance at which the photograph saturates */
    int given;           /* set of EVAL_GIVEN_*: true maps that replace the raw ones */
    size_t environments; /* number of samples still to be relit by environments */
} eval_scorer;

/* One sample during its evaluation. */
typedef struct eval_subject {
    const sample *sample;
    img mask; /* 1 where the object is, else 0: the pixels that count for maps */
    eval_photo photo;
    img image; /* its radiance, saturated at 1 like everything that is compared */
    surface truth, inflated;
    merlin_maps maps;           /* the model's, in the photograph's frame */
    surface found;              /* the same in the sample's frame */
    network_features *features; /* of a raw model with a relighting decoder; else NULL */
    eval_scores scores;
} eval_subject;

/* Geometric mean of the strengths of a sample's environment in training. */
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

/* Returns a trivial baseline's maps as the sample's camera sees them; its images are borrowed. */
static inline surface eval_shown(const eval_subject *on, const surface *trivial)
{
    surface shown = *trivial;
    shown.mask = on->truth.mask;
    shown.lens = on->truth.lens;
    return shown;
}

/* Scores the maps' errors by region. */
void eval_score_regions(const eval_scorer *e, eval_subject *on);

/* Scores rows that only models of setting B have, and the environment, whose trivial baseline in sh is the data's mean
 * at the strength that the picture has; NULL in setting A. */
status eval_score_both_lights(eval_scorer *e, eval_subject *on);
const float (*eval_mean_surroundings(const eval_scorer *e, float sh[9][3]))[3];

/* Scores rows of relighting by environments. */
status eval_score_environment(eval_scorer *e, eval_subject *on);

/* Scores the rendering of a trivial baseline's maps against the target. */
status eval_score_trivial(eval_subject *on, const surface *maps, eval_answer answer, eval_row row,
                          const illumination *light, const img *target);
/* Scores a picture of the product, of the photograph's size and exposure. */
status eval_score_picture(eval_subject *on, eval_row row, const merlin_image *picture, const img *target);
/* Scores the trivial baselines' pictures, and the photograph itself, against the target. */
status eval_score_answers(const eval_scorer *e, eval_subject *on, eval_row row, const illumination *light,
                          const img *target);
/* Scores the maps rendered under a light, and a raw model's relighting decoder, against the true maps rendered, all
 * without shadows and bounces. */
status eval_score_rendered(eval_scorer *e, eval_subject *on, const illumination *light, eval_row decoder,
                           eval_row brdf);

#endif
