/* SPDX-License-Identifier: MIT */
#include "stereo/fit/lobe_descent.h"

#include <math.h>
#include <string.h>

#include "base/number.h"
#include "stereo/fit/lobe_model.h"

enum { UNKNOWNS = 5, PRODUCTS = UNKNOWNS * (UNKNOWNS + 1) / 2 };

/* Successive widths of the loss. For a lobe with a larger width of its own the narrowing ends there. */
static const float widths[] = {PST_WIDEST, PST_WIDEST, 0.11f, 0.08f, 0.057f, 0.04f, 0.04f, 0.04f, 0.04f, 0.04f, 0.04f};
enum { STEPS = sizeof widths / sizeof *widths, FAR = 0, NEAR = 3 };

/* Factor of a hopeless step: if the loss would stay above the limit even if each remaining step gained this many times
 * what the last one did. After as many such steps the descent ends. */
static const float hopeful = 2;
enum { MOST_HOPELESS = 2 };

/* The linearized model at every light: its derivative by each unknown, the residual of the observation, and its weight
 * by the loss. */
typedef struct linearized {
    float slope[UNKNOWNS][PST_LIGHTS_ROOM], residual[PST_LIGHTS_ROOM], weight[PST_LIGHTS_ROOM];
    float loss, loss_before; /* loss at the width of the weights, and at the previous width */
    vec3 t1, t2;             /* directions in which the first two unknowns turn the normal */
} linearized;

/* Normal equations of the weighted, linearized problem; upper triangle by rows. */
typedef struct equations {
    float m[PRODUCTS], right[UNKNOWNS];
    vec3 t1, t2;
} equations;

static void find_slopes(const pst_lobe_data *d, const pst_lobe *lobe, const pst_shading *at, linearized *out)
{
    pst_tangents(at->normal, &out->t1, &out->t2);
    const float *px = d->seen.x, *py = d->seen.y, *pz = d->seen.z;
    const int count = pst_whole(d->seen.padded);
    const tail_choice tail = choose_tail(lobe->tail);
    const vec3 n = at->normal, t1 = out->t1, t2 = out->t2;
    const float u = expf(at->sharpness), tau = lobe->terminator, k = lobe->masking, a = at->albedo, s = at->gloss,
                gamma = (float)lobe->tail;
    for (int i = 0; i < count; i++) {
        float lx = px[i], ly = py[i], lz = pz[i], hx = d->hx[i], hy = d->hy[i], hz = d->hz[i];
        float nl = n.x * lx + n.y * ly + n.z * lz, nh = n.x * hx + n.y * hy + n.z * hz;
        float x = 1 - nh * nh, lit = nl > 0 ? nl : 0;
        x = x > 0 ? x : 0;
        float bent = 1 - tail.bend * x, wide = bent + u * x, mask = lit * (1 - k) + k + 1e-6f;
        float both = 1 / (wide * mask), inverse = both * mask, below = both * wide; /* one division for both */
        float base = bent * inverse, pm = power_below(&tail, base);
        float g = lit * below, by_g = (nl > 0 ? k : 0) * below * below, p = pm * base, gp = g * p;
        float by_nl = (nl > tau ? a : 0) + s * by_g * p, by_nh = 2 * gamma * u * s * g * pm * inverse * inverse * nh;
        out->slope[0][i] = by_nl * (lx * t1.x + ly * t1.y + lz * t1.z) + by_nh * (hx * t1.x + hy * t1.y + hz * t1.z);
        out->slope[1][i] = by_nl * (lx * t2.x + ly * t2.y + lz * t2.z) + by_nh * (hx * t2.x + hy * t2.y + hz * t2.z);
        out->slope[2][i] = nl > tau ? nl - tau : 0;
        out->slope[3][i] = gp;
        out->slope[4][i] = -gamma * u * x * inverse * s * gp;
    }
}

/* Computes residuals and weights. The model is linear in albedo and gloss, so that their derivatives yield it. */
static void find_weights(const pst_lobe_data *d, const pst_shading *at, float width, float width_before,
                         linearized *out)
{
    const float *value = d->seen.value, *usable = d->seen.usable, *diffuse = out->slope[2], *height = out->slope[3];
    const int count = pst_whole(d->seen.padded);
    const float a = at->albedo, s = at->gloss, narrow = 1 / (width * width),
                shrunk = width * width / (width_before * width_before);
    float loss = 0, before = 0;
    for (int i = 0; i < count; i++) {
        float v = value[i], r = v - a * diffuse[i] - s * height[i], c = d->precision[i] * narrow;
        float t = r * r * c, q = 1 / (1 + t), counts = charge(d->shadowy[i], v, r);
        out->residual[i] = r;
        out->weight[i] = c * q * q * counts;
        loss += usable[i] * counts * t * q;
        before += usable[i] * counts * (t * shrunk) / (1 + t * shrunk);
    }
    out->loss = loss;
    out->loss_before = before;
}

static void linearize(const pst_lobe_data *d, const pst_lobe *lobe, const pst_shading *at, float width,
                      float width_before, linearized *out)
{
    find_slopes(d, lobe, at, out);
    find_weights(d, at, width, width_before, out);
}

/* Sums the terms of the unknowns that turn the normal, in two parts because of the number of registers. */
static void add_up_turns(const linearized *at, int count, equations *e)
{
    const float *j0 = at->slope[0], *j1 = at->slope[1], *j2 = at->slope[2], *j3 = at->slope[3], *j4 = at->slope[4],
                *r = at->residual, *weight = at->weight;
    float m00 = 0, m01 = 0, m02 = 0, m03 = 0, m04 = 0, m11 = 0, m12 = 0, m13 = 0, m14 = 0, r0 = 0, r1 = 0;
    for (int i = 0; i < count; i++) {
        float w0 = weight[i] * j0[i], w1 = weight[i] * j1[i];
        m00 += w0 * j0[i];
        m01 += w0 * j1[i];
        m02 += w0 * j2[i];
        m03 += w0 * j3[i];
        m04 += w0 * j4[i];
        r0 += w0 * r[i];
        m11 += w1 * j1[i];
        m12 += w1 * j2[i];
        m13 += w1 * j3[i];
        m14 += w1 * j4[i];
        r1 += w1 * r[i];
    }
    *e = (equations){{m00, m01, m02, m03, m04, m11, m12, m13, m14}, {r0, r1}, at->t1, at->t2};
}

static void add_up_heights(const linearized *at, int count, equations *e)
{
    const float *j2 = at->slope[2], *j3 = at->slope[3], *j4 = at->slope[4], *r = at->residual, *weight = at->weight;
    float m22 = 0, m23 = 0, m24 = 0, m33 = 0, m34 = 0, m44 = 0, r2 = 0, r3 = 0, r4 = 0;
    for (int i = 0; i < count; i++) {
        float w2 = weight[i] * j2[i], w3 = weight[i] * j3[i], w4 = weight[i] * j4[i];
        m22 += w2 * j2[i];
        m23 += w2 * j3[i];
        m24 += w2 * j4[i];
        m33 += w3 * j3[i];
        m34 += w3 * j4[i];
        m44 += w4 * j4[i];
        r2 += w2 * r[i];
        r3 += w3 * r[i];
        r4 += w4 * r[i];
    }
    memcpy(e->m + 9, &(float[6]){m22, m23, m24, m33, m34, m44}, 6 * sizeof(float));
    memcpy(e->right + 2, &(float[3]){r2, r3, r4}, 3 * sizeof(float));
}

static void add_up(const linearized *at, int padded, equations *e)
{
    add_up_turns(at, pst_whole(padded), e);
    add_up_heights(at, pst_whole(padded), e);
}

/* Solves (M + damping diag M) x = right by factors L D Lᵀ; a direction that nothing determines stays 0. */
static void solve5(const equations *e, float damping, float x[UNKNOWNS])
{
    static const int row[UNKNOWNS] = {0, 4, 7, 9, 10}; /* m[row[i] + j] is entry (i, j), j >= i */
    float l[UNKNOWNS][UNKNOWNS] = {{0}}, inverse[UNKNOWNS] = {0};
#pragma GCC unroll 5
    for (int i = 0; i < UNKNOWNS; i++) {
        float diagonal = e->m[row[i] + i], sum = diagonal * (1 + damping), right = e->right[i];
#pragma GCC unroll 5
        for (int k = 0; k < i; k++) {
            sum -= l[i][k] * l[i][k] * inverse[k];
            right -= l[i][k] * inverse[k] * x[k];
        }
        inverse[i] = sum > 1e-5f * diagonal && diagonal > 1e-20f ? 1 / sum : 0;
        x[i] = right;
#pragma GCC unroll 5
        for (int j = i + 1; j < UNKNOWNS; j++) {
            float v = e->m[row[i] + j];
#pragma GCC unroll 5
            for (int k = 0; k < i; k++)
                v -= l[i][k] * inverse[k] * l[j][k];
            l[j][i] = v;
        }
    }
#pragma GCC unroll 5
    for (int i = UNKNOWNS - 1; i >= 0; i--) {
        float v = x[i];
#pragma GCC unroll 5
        for (int k = i + 1; k < UNKNOWNS; k++)
            v -= l[k][i] * x[k];
        x[i] = v * inverse[i];
    }
}

static pst_shading moved(const pst_shading *at, const equations *e, float damping)
{
    float x[UNKNOWNS] = {0};
    solve5(e, damping, x);
    pst_shading next = *at;
    float turn = sqrtf(x[0] * x[0] + x[1] * x[1]), most = turn > 0.4f ? 0.4f / turn : 1;
    next.normal = vec3_normalize(vec3_fma(vec3_fma(at->normal, most * x[0], e->t1), most * x[1], e->t2));
    next.albedo = fmaxf(at->albedo + x[2], 0);
    next.gloss = fmaxf(at->gloss + x[3], 0);
    next.sharpness = clamp_sharpness(at->sharpness + clamp(x[4], -1, 1));
    return next;
}

/* Tells whether another step of the same width would gain nothing. */
static bool settled(const pst_shading *before, const pst_shading *after, float loss_after)
{
    vec3 turn = vec3_sub(after->normal, before->normal);
    return vec3_dot(turn, turn) < 1.6e-7f && loss_after > 0.99f * before->cost - 1e-3f;
}

/* Makes damped steps of decreasing width; the damping grows if a step does not help. A step is evaluated at its own
 * width from what the next one needs anyway. */
pst_shading pst_lobe_descend(const pst_lobe_data *d, const pst_lobe *lobe, const pst_shading *start, pst_descent from,
                             float limit)
{
    const bool far = from == PST_DESCENT_FAR;
    const int first = far ? FAR : NEAR;
    const float narrowest = fmaxf(widths[STEPS - 1], lobe->width);
    float width = fmaxf(widths[first], lobe->width), damping = far ? 1e-2f : 1e-3f;
    int failures = 0, hopeless = 0;
    bool known = false; /* whether the equations at this place are known */
    pst_shading at = *start;
    linearized here;
    equations e;
    linearize(d, lobe, &at, width, width, &here);
    at.cost = here.loss;
    for (int k = first; k < STEPS; k++) {
        float narrower = k + 1 < STEPS ? fmaxf(widths[k + 1], lobe->width) : width;
        bool last = width == narrowest;
        if (!known) add_up(&here, d->seen.padded, &e);
        pst_shading next = moved(&at, &e, damping);
        linearize(d, lobe, &next, narrower, width, &here);
        float gain = at.cost - here.loss_before;
        known = !(gain > 0) && last;
        if (gain > 0) {
            bool done = last && settled(&at, &next, here.loss_before);
            damping *= 0.3f;
            failures = 0;
            at = next;
            at.cost = here.loss;
            hopeless = last && at.cost - hopeful * (float)(STEPS - 1 - k) * gain > limit ? hopeless + 1 : 0;
            if (done || hopeless == MOST_HOPELESS) break;
        } else {
            damping = damping * 10 + 1e-3f;
            if (last && ++failures == 2) break;
            if (!last) {
                linearize(d, lobe, &at, narrower, narrower, &here);
                at.cost = here.loss;
            }
        }
        width = narrower;
    }
    return at;
}
