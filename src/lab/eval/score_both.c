/* SPDX-License-Identifier: MIT */
/* Setting B: photographs by flash in surroundings, and relighting under both. */
#include <math.h>

#include "lab/eval/score_parts.h"
#include "optics/sh.h"

static void scaled(const float from[9][3], float to[9][3])
{
    for (int i = 0; i < 9; i++)
        for (int c = 0; c < 3; c++)
            to[i][c] = EVAL_ENVIRONMENT_STRENGTH * from[i][c];
}

const float (*eval_mean_surroundings(const eval_scorer *e, float sh[9][3]))[3]
{
    if (eval_model_config(e->model)->lighting != MODEL_LIGHT_BOTH) return NULL;
    scaled((const float(*)[3])e->means.sh, sh);
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
    float truth[9][3], mean[9][3];
    scaled(on->sample->sh, truth);
    const float(*t)[3] = (const float(*)[3])truth;
    eval_note(&on->scores, EVAL_SURROUNDINGS, EVAL_MODEL, difference((const float(*)[3])e->prediction.sh, t));
    eval_note(&on->scores, EVAL_SURROUNDINGS, EVAL_MEAN, difference(eval_mean_surroundings(e, mean), t));
}

/* The photograph's own surroundings after i + 1 eighths of a turn about the vertical. */
static void turned(const sample *s, int i, float sh[9][3])
{
    float angle = (float)(i + 1) * 0.78539816f, c = cosf(angle), d = sinf(angle);
    const float about_vertical[3][3] = {{c, 0, d}, {0, 1, 0}, {-d, 0, c}};
    scaled(s->sh, sh);
    sh_turn(sh, about_vertical);
}

status eval_score_both_lights(eval_scorer *e, eval_subject *on)
{
    float sh[EVAL_LIGHTS][9][3];
    eval_relighting r = {.count = EVAL_LIGHTS};
    score_surroundings(e, on);
    for (int i = 0; i < EVAL_LIGHTS; i++) {
        turned(on->sample, i, sh[i]);
        r.lights[i] = (illumination){eval_light(on->sample, i), (const float(*)[3])sh[i]};
    }
    status s = eval_render_targets(on, &r);
    if (s != OK) return s;
    s = eval_relight(e->model, &on->mask, r.lights, &e->prediction);
    if (s == OK)
        s = eval_score_relighting(e, on, &r, EVAL_BOTH_NETWORK, EVAL_BOTH_BRDF, e->prediction.by_network,
                                  e->prediction.by_brdf);
    eval_relighting_free(&r);
    return s;
}
