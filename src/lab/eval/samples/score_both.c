/* SPDX-License-Identifier: MIT */
/* Setting B: photographs by flash in surroundings, and relighting under both. */
#include <math.h>

#include "lab/eval/samples/score_parts.h"
#include "lab/eval/samples/truth.h"
#include "optics/sh.h"

static void scale(float factor, const float from[9][3], float to[9][3])
{
    for (int i = 0; i < 9; i++)
        for (int c = 0; c < 3; c++)
            to[i][c] = factor * from[i][c];
}

const float (*eval_mean_surroundings(const eval_scorer *e, float sh[9][3]))[3]
{
    if (eval_config(e)->lighting != MODEL_LIGHT_BOTH) return NULL;
    scale(EVAL_ENVIRONMENT_STRENGTH, (const float(*)[3])e->means.sh, sh);
    return (const float(*)[3])sh;
}

/* Mean squared difference of the radiance of white surfaces over all normals, mean of the channels. */
static double difference(const float a[9][3], const float b[9][3])
{
    float code_a[MODEL_SH], code_b[MODEL_SH];
    double sum = 0;
    model_encode_sh(a, code_a);
    model_encode_sh(b, code_b);
    for (int i = 0; i < MODEL_SH; i++)
        sum += (double)(code_a[i] - code_b[i]) * (double)(code_a[i] - code_b[i]);
    return sum / 3;
}

static void score_surroundings(eval_scorer *e, eval_subject *on)
{
    float truth[9][3], mean[9][3], found[9][3];
    scale(EVAL_ENVIRONMENT_STRENGTH, (const float(*)[3])on->sample->sh, truth);
    scale(eval_exposure(on), (const float(*)[3])on->maps.environment, found);
    const float(*t)[3] = (const float(*)[3])truth;
    eval_note(&on->scores, EVAL_SURROUNDINGS, EVAL_MODEL, difference((const float(*)[3])found, t));
    eval_note(&on->scores, EVAL_SURROUNDINGS, EVAL_MEAN, difference(eval_mean_surroundings(e, mean), t));
}

/* The photograph's own surroundings after i + 1 eighths of a turn about the vertical. */
static void turned(const sample *s, int i, float sh[9][3])
{
    float angle = (float)(i + 1) * 0.78539816f, c = cosf(angle), d = sinf(angle);
    const float about_vertical[3][3] = {{c, 0, d}, {0, 1, 0}, {-d, 0, c}};
    scale(EVAL_ENVIRONMENT_STRENGTH, (const float(*)[3])s->sh, sh);
    sh_turn(sh, about_vertical);
}

status eval_score_both_lights(eval_scorer *e, eval_subject *on)
{
    status s = OK;
    score_surroundings(e, on);
    for (int i = 0; i < EVAL_LIGHTS && s == OK; i++) {
        float sh[9][3];
        turned(on->sample, i, sh);
        const illumination light = {eval_light(on->sample, i), (const float(*)[3])sh};
        s = eval_score_rendered(e, on, &light, EVAL_BOTH_NETWORK, EVAL_BOTH_BRDF);
    }
    return s;
}
