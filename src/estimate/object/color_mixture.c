/* SPDX-License-Identifier: MIT */
#include "estimate/object/color_mixture.h"

#include <math.h>
#include <string.h>

#include "base/number.h"

enum { FEW = 16, FEWEST = 4, ROUNDS = 2, COLORS = 3, BLOCK = 256, STEP = 2 };
/* Least variance, the noise of a dark photograph, so that a uniform colour does not give a degenerate Gaussian. */
static const double LEAST_VARIANCE = 2e-4;
/* Largest distance in standard deviations; beyond it all colours are equally unlikely. */
static const float FARTHEST = 6;
/* Largest brightening: three times the light, encoded by a square root. */
static const float MOST_SHADOW = 1.75f;

/* Sums over pixels. */
typedef struct moments {
    double count, sum[MIXTURE_VALUES], product[MIXTURE_VALUES][MIXTURE_VALUES];
} moments;

static void moments_add(moments *m, const mixture_pixels *p, size_t i)
{
    m->count++;
    for (int a = 0; a < MIXTURE_VALUES; a++) {
        double x = (double)p->value[a][i];
        m->sum[a] += x;
        for (int b = 0; b <= a; b++)
            m->product[a][b] += x * (double)p->value[b][i];
    }
}

/* ---- one Gaussian ---- */

/* Computes the lower triangle L with L Lᵀ = c; returns log det L. */
static double factor(const double c[MIXTURE_VALUES][MIXTURE_VALUES], double l[MIXTURE_VALUES][MIXTURE_VALUES])
{
    double log_det = 0;
    for (int i = 0; i < MIXTURE_VALUES; i++)
        for (int j = 0; j <= i; j++) {
            double sum = c[i][j];
            for (int n = 0; n < j; n++)
                sum -= l[i][n] * l[j][n];
            l[i][j] = i == j ? sqrt(fmax(sum, LEAST_VARIANCE / 100)) : sum / l[j][j];
            if (i == j) log_det += log(l[i][i]);
        }
    return log_det;
}

static void invert(const double l[MIXTURE_VALUES][MIXTURE_VALUES], float out[MIXTURE_VALUES][MIXTURE_VALUES])
{
    double inverse[MIXTURE_VALUES][MIXTURE_VALUES] = {{0}};
    for (int i = 0; i < MIXTURE_VALUES; i++)
        for (int j = 0; j <= i; j++) {
            double sum = i == j;
            for (int n = j; n < i; n++)
                sum -= l[i][n] * inverse[n][j];
            inverse[i][j] = sum / l[i][i];
            out[i][j] = (float)inverse[i][j];
        }
}

static void gaussian_fit(gaussian *g, const moments *m, double all)
{
    double c[MIXTURE_VALUES][MIXTURE_VALUES], l[MIXTURE_VALUES][MIXTURE_VALUES] = {{0}};
    *g = (gaussian){0};
    for (int i = 0; i < MIXTURE_VALUES; i++) {
        g->mean[i] = (float)(m->sum[i] / m->count);
        for (int j = 0; j <= i; j++)
            c[i][j] = m->product[i][j] / m->count - m->sum[i] / m->count * (m->sum[j] / m->count);
        c[i][i] = fmax(c[i][i], 0) + LEAST_VARIANCE;
    }
    g->offset = (float)(factor((const double(*)[MIXTURE_VALUES])c, l) - log(m->count / all));
    invert((const double(*)[MIXTURE_VALUES])l, g->inverse);
}

/* Computes a pixel's squared distances in standard deviations, with its own colour and with the best brightening. */
static inline void distances(const gaussian *g, const mixture_pixels *p, size_t i, float *as_is, float *brightened)
{
    float uu = 0, uv = 0, vv = 0;
    for (int a = 0; a < MIXTURE_VALUES; a++) {
        float u = 0, v = 0;
        for (int b = 0; b <= a; b++) {
            float x = p->value[b][i];
            u += b < COLORS ? g->inverse[a][b] * x : 0;
            v += g->inverse[a][b] * (b < COLORS ? -g->mean[b] : x - g->mean[b]);
        }
        uu += u * u;
        uv += u * v;
        vv += v * v;
    }
    float gain = min_of(max_of(-uv / max_of(uu, 1e-12f), 1), MOST_SHADOW);
    *as_is = uu + 2 * uv + vv;
    *brightened = gain * (gain * uu + 2 * uv) + vv;
}

static float gaussian_cost(const gaussian *g, const mixture_pixels *p, size_t i)
{
    float as_is, brightened;
    distances(g, p, i, &as_is, &brightened);
    return 0.5f * min_of(as_is, FARTHEST * FARTHEST) + g->offset;
}

/* ---- learning ---- */

/* Returns the total variance of a part's pixels, and which value varies most. */
static double widest_value(const moments *m, int *along)
{
    double most = -1;
    for (int i = 0; i < MIXTURE_VALUES; i++) {
        double spread = m->product[i][i] - m->sum[i] / fmax(m->count, 1) * m->sum[i];
        if (spread <= most) continue;
        most = spread;
        *along = i;
    }
    return m->count < FEW ? -1 : most;
}

/* A split of a part into pixels with one value above and below its mean. */
typedef struct split {
    int of, along;
    float at;
} split;

static void sum_parts(const mixture_pixels *p, const uint8_t *part, uint8_t which, const split *splits, int parts,
                      moments *out)
{
    memset(out, 0, MIXTURE_MOST * sizeof *out);
    for (size_t i = 0; i < p->count; i += STEP) {
        int k = 0;
        if (part[i] != which) continue;
        for (int n = 1; n < parts; n++)
            if (splits[n].of == k && p->value[splits[n].along][i] > splits[n].at) k = n;
        moments_add(&out[k], p, i);
    }
}

/* Repeatedly splits the part with the largest total variance; returns the number of parts. */
static int split_parts(const mixture_pixels *p, const uint8_t *part, uint8_t which, moments out[MIXTURE_MOST])
{
    split splits[MIXTURE_MOST];
    for (int parts = 1;; parts++) {
        double most = -1;
        split next = {0};
        sum_parts(p, part, which, splits, parts, out);
        for (int k = 0; k < parts; k++) {
            int along = 0;
            double spread = widest_value(&out[k], &along);
            if (spread <= most) continue;
            most = spread;
            next = (split){k, along, (float)(out[k].sum[along] / out[k].count)};
        }
        if (parts == MIXTURE_MOST || most < 0) return parts;
        splits[parts] = next;
    }
}

static void fit_all(mixture *m, const moments part[MIXTURE_MOST], int count)
{
    double all = 0;
    for (int k = 0; k < count; k++)
        all += part[k].count;
    m->count = 0;
    for (int k = 0; k < count; k++)
        if (part[k].count >= FEWEST) gaussian_fit(&m->part[m->count++], &part[k], all);
}

static int nearest(const mixture *m, const mixture_pixels *p, size_t i)
{
    int best = 0;
    float least = INFINITY;
    for (int k = 0; k < m->count; k++) {
        float cost = gaussian_cost(&m->part[k], p, i);
        if (cost >= least) continue;
        least = cost;
        best = k;
    }
    return best;
}

void mixture_learn(mixture *m, const mixture_pixels *pixels, const uint8_t *part, uint8_t which)
{
    moments sums[MIXTURE_MOST] = {0};
    fit_all(m, sums, split_parts(pixels, part, which, sums));
    for (int round = 0; round < ROUNDS; round++) {
        memset(sums, 0, sizeof sums);
        for (size_t i = 0; i < pixels->count; i += STEP)
            if (part[i] == which) moments_add(&sums[nearest(m, pixels, i)], pixels, i);
        fit_all(m, sums, m->count);
    }
}

/* ---- costs ---- */

void mixture_costs(const mixture *m, const mixture_pixels *pixels, float shadow, float *cost)
{
    memset(cost, 0, pixels->count * sizeof *cost);
    for (size_t begin = 0; begin < pixels->count && m->count; begin += BLOCK) {
        size_t end = begin + BLOCK < pixels->count ? begin + BLOCK : pixels->count;
        for (size_t i = begin; i < end; i++)
            cost[i] = INFINITY;
        for (int k = 0; k < m->count; k++) {
            const gaussian *g = &m->part[k];
#pragma omp simd
            for (size_t i = begin; i < end; i++) {
                float as_is, brightened;
                distances(g, pixels, i, &as_is, &brightened);
                float least = min_of(as_is, FARTHEST * FARTHEST);
                least = min_of(least, brightened + 2 * shadow);
                cost[i] = min_of(cost[i], 0.5f * least + g->offset);
            }
        }
    }
}
