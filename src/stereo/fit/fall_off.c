/* SPDX-License-Identifier: MIT */
#include "stereo/fit/fall_off.h"

#include <math.h>

/* Unknowns: normal (two angles), albedo, gloss, sharpness; then depth. */
enum { SURFACE = 5, UNKNOWNS = SURFACE + 1 };

/* Least standard deviation of residuals beyond noise, in ordinary values, as the lobe is only a model. */
static const float least_residual = 0.01f;
static const float turn = 0.01f, share = 0.01f;

/* Computes the derivatives of the residuals, −(model' − model), for rotation, brightness and gloss of the surface, a
 * row each. */
static void change_surface(const pst_lobe_data *d, const pst_lobe *lobe, const pst_shading *at, const float *model,
                           float rows[SURFACE][PST_MAX_LIGHTS])
{
    float ignored[PST_MAX_LIGHTS];
    vec3 n = at->normal, t1, t2;
    pst_tangents(n, &t1, &t2);
    pst_shading next[SURFACE] = {*at, *at, *at, *at, *at};
    next[0].normal = vec3_normalize(vec3_fma(n, turn, t1));
    next[1].normal = vec3_normalize(vec3_fma(n, turn, t2));
    next[2].albedo = at->albedo + share * d->level;
    next[3].gloss = at->gloss + share * d->level;
    next[4].sharpness = at->sharpness + share;
    for (int j = 0; j < SURFACE; j++) {
        pst_lobe_weigh(d, lobe, &next[j], ignored, rows[j]);
        for (int k = 0; k < d->seen.padded; k++)
            rows[j][k] = model[k] - rows[j][k];
    }
}

/* Eliminates all unknowns but the last. m: symmetric, lower triangle; it then contains Cholesky's factors, except for
 * what follows the last row's pivot. Directions that nothing determines are ignored. Returns the last unknown's
 * information after the others have been optimized. */
static float eliminate(float m[UNKNOWNS][UNKNOWNS], float right[UNKNOWNS])
{
    for (int j = 0; j < SURFACE; j++) {
        float pivot = m[j][j] * 1.001f;
        if (!(pivot > 1e-12f)) continue;
        for (int i = j + 1; i < UNKNOWNS; i++) {
            float factor = m[i][j] / pivot;
            for (int k = j + 1; k <= i; k++)
                m[i][k] -= factor * m[k][j];
            right[i] -= factor * right[j];
        }
    }
    return m[SURFACE][SURFACE];
}

pst_fall_off pst_fall_off_of(const pst_lobe_data *here, const pst_lobe_data *deeper, const pst_lobe *lobe,
                             const pst_shading *at)
{
    float weight[PST_MAX_LIGHTS], model[PST_MAX_LIGHTS], ignored[PST_MAX_LIGHTS];
    float rows[UNKNOWNS][PST_MAX_LIGHTS], m[UNKNOWNS][UNKNOWNS] = {{0}}, right[UNKNOWNS] = {0};
    float squares = 0, count = 0;
    pst_lobe_weigh(here, lobe, at, weight, model);
    change_surface(here, lobe, at, model, rows);
    pst_lobe_weigh(deeper, lobe, at, ignored, rows[SURFACE]);
    for (int k = 0; k < here->seen.padded; k++) {
        float r = here->seen.value[k] - model[k], w = weight[k] * here->precision[k];
        rows[SURFACE][k] = (deeper->seen.value[k] - rows[SURFACE][k] - r) / PST_DEEPER;
        squares += w * r * r;
        count += weight[k];
        for (int i = 0; i < UNKNOWNS; i++) {
            right[i] -= w * rows[i][k] * r;
            for (int j = 0; j <= i; j++)
                m[i][j] += w * rows[i][k] * rows[j][k];
        }
    }
    float information = eliminate(m, right), freedom = count - (float)(lobe->tail > 0 ? UNKNOWNS : UNKNOWNS - 2);
    if (!(information > 0) || !(freedom > 0)) return (pst_fall_off){0, 0};
    float variance = squares / freedom + least_residual * least_residual;
    return (pst_fall_off){right[SURFACE] / information, information / variance};
}
