/* SPDX-License-Identifier: MIT */
/* Robust regression of Lambert's law for one pixel: iteratively reweighted least squares under the redescending loss of
 * Geman & McClure (1987), with a scale that narrows step by step (graduated non-convexity, Blake & Zisserman 1987),
 * started from the observations between two ranks of brightness (position thresholding: highlights are the brightest,
 * shadows the darkest); the best of several starts is kept. Observations for which the fit faces away from the light do
 * not influence it, but a bright one among them adds to the cost. */
#include "stereo/fit/pixel_fit.h"
#include "base/number.h"

#include <stdlib.h>
#include <string.h>

#include "stereo/algebra/matrix3.h"

enum { STEPS = 6, POLISH = 4 };

/* Widths in units of the pixel's own albedo: from 0.45, where half the object is an inlier, down to 0.05, which
 * excludes the foot of a highlight. */
static const float widest = 0.45f, narrowest = 0.05f, narrowing = 0.6444f; /* (0.05 / 0.45)^(1/5) */

/* Ranks of each start's darkest and brightest observations: for many shadows and highlights, few shadows, few of
 * either. */
static const float window[][2] = {{0.2f, 0.6f}, {0.3f, 0.8f}, {0.1f, 0.95f}, {0.7f, 0.97f}};
enum { STARTS = sizeof window / sizeof *window };

/* Fits albedo · (n·l − τ) = b · (l − τ n), which is linear in b for the last n. */
static vec3 weighted_fit(const pst_observations *o, vec3 last, const float *restrict w)
{
    const float *lx = o->x, *ly = o->y, *lz = o->z, *value = o->value;
    const int count = pst_whole(o->padded);
    vec3 n = vec3_scale(vec3_normalize(last), o->terminator);
    float xx = 0, xy = 0, xz = 0, yy = 0, yz = 0, zz = 0, bx = 0, by = 0, bz = 0;
    for (int i = 0; i < count; i++) {
        float x = lx[i] - n.x, y = ly[i] - n.y, z = lz[i] - n.z, u = w[i], v = u * value[i];
        xx += u * x * x;
        xy += u * x * y;
        xz += u * x * z;
        yy += u * y * y;
        yz += u * y * z;
        zz += u * z * z;
        bx += v * x;
        by += v * y;
        bz += v * z;
    }
    return pst_solve3((float[6]){xx, xy, xz, yy, yz, zz}, vec3_make(bx, by, bz));
}

/* Returns 1 / σ². */
static float precision_of(vec3 b, float width)
{
    float sigma = width * vec3_length(b);
    return 1 / (sigma * sigma + 1e-20f);
}

/* Sets the weights for residuals of the given width (in albedos). */
static void reweigh(const pst_observations *o, vec3 b, float width, float *restrict w)
{
    const float *lx = o->x, *ly = o->y, *lz = o->z, *value = o->value, *usable = o->usable;
    const int count = pst_whole(o->padded);
    const float offset = o->terminator * vec3_length(b), precision = precision_of(b, width);
#pragma omp simd
    for (int i = 0; i < count; i++) {
        float fit = b.x * lx[i] + b.y * ly[i] + b.z * lz[i] - offset, r = value[i] - (fit > 0 ? fit : 0);
        float g = 1 / (1 + r * r * precision);
        w[i] = (fit > 0 ? usable[i] : 0) * g * g;
    }
}

static float loss(const pst_observations *o, vec3 b, float width)
{
    const float *lx = o->x, *ly = o->y, *lz = o->z, *value = o->value, *usable = o->usable;
    const int count = pst_whole(o->padded);
    const float offset = o->terminator * vec3_length(b), precision = precision_of(b, width);
    float cost = 0;
    for (int i = 0; i < count; i++) {
        float fit = b.x * lx[i] + b.y * ly[i] + b.z * lz[i] - offset, v = value[i], r = v - (fit > 0 ? fit : 0);
        float t = r * r * precision;
        cost += usable[i] * (PST_IS_SHADOW(v, r) ? PST_SHADOW_COST : 1) * t / (1 + t);
    }
    return cost;
}

static pst_pixel fit_from(const pst_observations *o, float low, float high, float *w)
{
    for (int i = 0; i < o->padded; i++)
        w[i] = o->usable[i] > 0 && o->value[i] >= low && o->value[i] <= high ? 1 : 0;
    vec3 b = weighted_fit(o, (vec3){0, 0, 0}, w);
    float width = widest;
    for (int k = 0; k < STEPS; k++, width *= narrowing) {
        reweigh(o, b, width, w);
        b = weighted_fit(o, b, w);
    }
    reweigh(o, b, narrowest, w);
    return (pst_pixel){b, loss(o, b, narrowest)};
}

pst_pixel pst_pixel_fit(const pst_observations *o, float *weight)
{
    float sorted[PST_MAX_LIGHTS], w[PST_MAX_LIGHTS];
    size_t n = 0;
    for (int i = 0; i < o->padded; i++)
        if (o->usable[i] > 0) sorted[n++] = o->value[i];
    memset(weight, 0, (size_t)o->padded * sizeof *weight);
    if (n == 0) return (pst_pixel){{0, 0, 0}, 0};
    qsort(sorted, n, sizeof *sorted, number_ascending);
    pst_pixel best = {{0, 0, 0}, HUGE_VALF};
    for (int s = 0; s < STARTS; s++) {
        float last = (float)(n - 1);
        pst_pixel p = fit_from(o, sorted[(int)(window[s][0] * last)], sorted[(int)(window[s][1] * last + 0.5f)], w);
        /* a fit of zero explains only darkness; any other is better */
        if (vec3_dot(p.b, p.b) < 1e-20f) p.cost = (float)o->padded;
        if (p.cost >= best.cost) continue;
        best = p;
        memcpy(weight, w, (size_t)o->padded * sizeof *w);
    }
    for (int k = 0; k < POLISH; k++) {
        best.b = weighted_fit(o, best.b, weight);
        reweigh(o, best.b, narrowest, weight);
    }
    best.cost = loss(o, best.b, narrowest);
    return best;
}
