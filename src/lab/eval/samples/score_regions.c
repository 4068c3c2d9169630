/* SPDX-License-Identifier: MIT */
/* Errors of the maps by what the photograph shows at a pixel: where gloss is not visible, roughness cannot be
 * estimated. */
#include "lab/eval/metrics/metrics.h"
#include "lab/eval/samples/score_parts.h"
#include "optics/camera.h"

/* Least share of gloss in the flash's light for each region after EVAL_BURNT_OUT. */
static const float gloss_from[EVAL_REGIONS - 1] = {0, 0.03f, 0.1f, 0.3f};

static bool is_burnt_out(const eval_subject *on, size_t i)
{
    const float *photo = on->photo.picture.data + 3 * i;
    return photo[0] >= 1 || photo[1] >= 1 || photo[2] >= 1;
}

/* Returns the share of gloss by the true maps. */
static float gloss_share(const eval_subject *on, size_t i)
{
    const sample *s = on->sample;
    const surface *t = &on->truth;
    const size_t width = (size_t)on->mask.width, column = i % width, row = i / width;
    const camera view = surface_camera(t);
    shade_input in = {.albedo = vec3_of(t->albedo.data + 3 * i),
                      .roughness = t->roughness.data[i],
                      .normal = vec3_of(t->normal.data + 3 * i),
                      .depth = t->depth.data[i],
                      .ray = camera_point(&view, (float)column + 0.5f, (float)row + 0.5f, 1),
                      .light = s->light,
                      .power = s->light_power};
    shade_terms terms = shade_terms_of(&in);
    float diffuse = (in.albedo.x + in.albedo.y + in.albedo.z) / (3 * PI);
    return terms.specular / (terms.specular + diffuse);
}

static int region_of(const eval_subject *on, size_t i)
{
    if (is_burnt_out(on, i)) return EVAL_BURNT_OUT;
    float share = gloss_share(on, i);
    int region = EVAL_REGIONS - 1;
    while (region > EVAL_BURNT_OUT + 1 && share < gloss_from[region - 1])
        region--;
    return region;
}

/* Returns the mean over the channels. */
static double squared_error(const img *a, const img *b, size_t i)
{
    const size_t channels = (size_t)a->channels;
    double sum = 0;
    for (size_t c = channels * i; c < channels * (i + 1); c++)
        sum += ((double)a->data[c] - b->data[c]) * ((double)a->data[c] - b->data[c]);
    return sum / (double)channels;
}

static void add_errors(eval_region *to, const surface *maps, const surface *truth, eval_answer answer, size_t i)
{
    to->sum[EVAL_ALBEDO][answer] += EVAL_UNIT * squared_error(&maps->albedo, &truth->albedo, i);
    to->sum[EVAL_NORMAL][answer] += squared_error(&maps->normal, &truth->normal, i);
    to->sum[EVAL_DEPTH][answer] += squared_error(&maps->depth, &truth->depth, i);
    to->sum[EVAL_ROUGHNESS][answer] += EVAL_UNIT * squared_error(&maps->roughness, &truth->roughness, i);
}

void eval_score_regions(const eval_scorer *e, eval_subject *on)
{
    for (size_t i = 0; i < (size_t)on->mask.width * (size_t)on->mask.height; i++) {
        if (!(on->mask.data[i] > EVAL_MASK_LEVEL)) continue;
        eval_region *r = &on->scores.regions[region_of(on, i)];
        r->pixels++;
        add_errors(r, &on->found, &on->truth, EVAL_MODEL, i);
        add_errors(r, &e->means.maps, &on->truth, EVAL_MEAN, i);
        add_errors(r, &on->inflated, &on->truth, EVAL_INFLATED, i);
    }
}
