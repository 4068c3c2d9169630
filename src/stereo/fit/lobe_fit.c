/* SPDX-License-Identifier: MIT */
/* A residual counts relative to the pixel's ordinary brightness or, for brighter values, to the value itself: the
 * lobe's model is accurate to a share of its height, and a highlight's flank still determines the normal. */
#include "stereo/fit/lobe_fit.h"

#include <math.h>
#include <stddef.h>

#include "stereo/algebra/matrix3.h"
#include "stereo/fit/lobe_descent.h"
#include "stereo/fit/lobe_model.h"

/* Number of parts for cross-validation. */
enum { PARTS = 4 };

static const float trial_sharpness[] = {0.7f, 2.2f, 3.7f, 5.2f, 6.7f, 8.5f};
enum { TRIALS = sizeof trial_sharpness / sizeof *trial_sharpness };

/* Share of the brightest value below which values count as dark. */
static const float dark = 0.01f;

/* Computes the median of the values that are not dark, within 4 percent, by bisection in logarithms. */
float pst_ordinary_level(const pst_observations *o)
{
    const float *value = o->value, *usable = o->usable;
    const int n = pst_whole(o->padded);
    float top = 0, all = 0;
    for (int i = 0; i < n; i++) {
        float v = usable[i] * value[i];
        top = v > top ? v : top;
    }
    float least = dark * top, low = least, high = top;
    for (int i = 0; i < n; i++)
        all += value[i] > least ? usable[i] : 0;
    for (int round = 0; round < 7; round++) {
        float middle = sqrtf(low * high), below = 0;
        for (int i = 0; i < n; i++)
            below += value[i] > least && value[i] < middle ? usable[i] : 0;
        if (below > 0.5f * all)
            high = middle;
        else
            low = middle;
    }
    return sqrtf(low * high);
}

void pst_lobe_prepare(const pst_observations *o, vec3 view, float shadow, pst_lobe_data *out)
{
    const float *lx = o->x, *ly = o->y, *lz = o->z, *value = o->value, *usable = o->usable;
    const int n = pst_whole(o->padded);
    out->seen = *o;
    out->level = pst_ordinary_level(o);
    float level = out->level > 1e-12f ? out->level : 1e-12f, less = 1 - shadow;
#pragma omp simd
    for (int i = 0; i < n; i++) {
        float x = lx[i] + view.x, y = ly[i] + view.y, z = lz[i] + view.z, v = value[i];
        float inverse = 1 / sqrtf(x * x + y * y + z * z + 1e-12f), above = v > level ? v - level : 0;
        out->hx[i] = x * inverse;
        out->hy[i] = y * inverse;
        out->hz[i] = z * inverse;
        out->shadowy[i] = v < 0.5f * level ? less : 0;
        out->precision[i] = usable[i] / (level * level + above * above);
    }
}

/* Matches the curvature γ u of (1 + u x)^−γ at the lobe's top. */
pst_shading pst_lobe_translate(const pst_lobe *from, const pst_lobe *to, const pst_shading *at)
{
    pst_shading start = *at;
    if (from->tail > 0 && to->tail > 0)
        start.sharpness = clamp_sharpness(at->sharpness + logf((float)from->tail / (float)to->tail));
    return start;
}

pst_shading pst_lobe_refine(const pst_lobe_data *d, const pst_lobe *lobe, const pst_shading *start, float limit)
{
    return pst_lobe_descend(d, lobe, start, PST_DESCENT_NEAR, limit);
}

/* Factors of albedo and gloss at every light. */
typedef struct heights {
    float diffuse[PST_LIGHTS_ROOM], lobe[PST_LIGHTS_ROOM];
} heights;

static void find_heights(const pst_lobe_data *d, const pst_lobe *lobe, const pst_shading *at, heights *out)
{
    const float *lx = d->seen.x, *ly = d->seen.y, *lz = d->seen.z;
    const int count = pst_whole(d->seen.padded);
    const tail_choice tail = choose_tail(lobe->tail);
    const vec3 n = at->normal;
    const float u = expf(at->sharpness), tau = lobe->terminator, k = lobe->masking;
    for (int i = 0; i < count; i++) {
        float nl = n.x * lx[i] + n.y * ly[i] + n.z * lz[i];
        float nh = n.x * d->hx[i] + n.y * d->hy[i] + n.z * d->hz[i], x = 1 - nh * nh;
        out->diffuse[i] = nl > tau ? nl - tau : 0;
        out->lobe[i] = lobe_at(&tail, u, x > 0 ? x : 0, nl > 0 ? nl : 0, k);
    }
}

static float loss(const pst_lobe_data *d, const heights *h, const pst_shading *at, float width)
{
    const float *value = d->seen.value, *usable = d->seen.usable;
    const int count = pst_whole(d->seen.padded);
    const float a = at->albedo, s = at->gloss, narrow = 1 / (width * width);
    float cost = 0;
    for (int i = 0; i < count; i++) {
        float v = value[i], r = v - a * h->diffuse[i] - s * h->lobe[i], t = r * r * d->precision[i] * narrow;
        cost += usable[i] * charge(d->shadowy[i], v, r) * t / (1 + t);
    }
    return cost;
}

/* Fits albedo and gloss for a given normal and sharpness, with weights by their previous values; both stay above 0. */
static void scale_heights(const pst_lobe_data *d, const heights *h, float width, pst_shading *at)
{
    const float *value = d->seen.value;
    const int count = pst_whole(d->seen.padded);
    const float a = at->albedo, s = at->gloss, narrow = 1 / (width * width);
    float aa = 1e-20f, as = 0, ss = 1e-20f, ra = 0, rs = 0;
    for (int i = 0; i < count; i++) {
        float v = value[i], diffuse = h->diffuse[i], lobe = h->lobe[i], r = v - a * diffuse - s * lobe;
        float c = d->precision[i], q = 1 / (1 + r * r * c * narrow), w = c * q * q, wd = w * diffuse, wl = w * lobe;
        aa += wd * diffuse;
        as += wd * lobe;
        ss += wl * lobe;
        ra += wd * v;
        rs += wl * v;
    }
    float determinant = aa * ss * 1.0001f - as * as;
    at->albedo = (ra * ss - rs * as) / determinant;
    at->gloss = (rs * aa - ra * as) / determinant;
    if (at->gloss < 0) {
        at->albedo = ra / aa;
        at->gloss = 0;
    } else if (at->albedo < 0) {
        at->albedo = 0;
        at->gloss = rs / ss;
    }
}

/* Finds the best sharpness for a start's normal. */
static pst_shading best_sharpness(const pst_lobe_data *d, const pst_lobe *lobe, const pst_shading *start)
{
    heights h;
    pst_shading best = *start;
    best.gloss = 0;
    best.sharpness = trial_sharpness[2];
    best.cost = HUGE_VALF;
    for (int k = 0; k < TRIALS; k++) {
        pst_shading trial = *start;
        trial.sharpness = trial_sharpness[k];
        trial.gloss = 0;
        find_heights(d, lobe, &trial, &h);
        if (k == 0) best.cost = loss(d, &h, &best, PST_WIDEST); /* without gloss any lobe is equally good */
        scale_heights(d, &h, PST_WIDEST, &trial);
        scale_heights(d, &h, PST_WIDEST, &trial);
        trial.cost = loss(d, &h, &trial, PST_WIDEST);
        if (trial.cost < best.cost) best = trial;
    }
    return best;
}

/* Returns the normal half way to the brightest lights, that of a mirror there. */
static vec3 mirror_normal(const pst_lobe_data *d)
{
    const pst_observations *o = &d->seen;
    float top = 0;
    for (int i = 0; i < o->padded; i++)
        top = o->value[i] > top ? o->value[i] : top;
    vec3 sum = {0, 0, 0};
    for (int i = 0; i < o->padded; i++) {
        float v = o->value[i]; /* saturated values, too */
        if (v > 0.5f * top) sum = vec3_fma(sum, v * v, vec3_make(d->hx[i], d->hy[i], d->hz[i]));
    }
    return pst_facing(sum);
}

static pst_shading descend(const pst_lobe_data *d, const pst_lobe *lobe, const pst_shading *start, float limit)
{
    pst_shading from = best_sharpness(d, lobe, start);
    return pst_lobe_descend(d, lobe, &from, PST_DESCENT_FAR, limit);
}

pst_shading pst_lobe_fit(const pst_lobe_data *d, const pst_lobe *lobe)
{
    float weight[PST_MAX_LIGHTS];
    pst_observations lambert = d->seen;
    lambert.terminator = lobe->terminator;
    pst_pixel p = pst_pixel_fit(&lambert, weight);
    pst_shading start = {.normal = pst_facing(p.b), .albedo = vec3_length(p.b)};
    if (!(d->level > 0)) return start;
    pst_shading best = descend(d, lobe, &start, HUGE_VALF);
    if (best.cost < 0.5f) return best;
    start.normal = mirror_normal(d);
    start.albedo = 0;
    pst_shading other = descend(d, lobe, &start, HUGE_VALF);
    return other.cost < best.cost ? other : best;
}

pst_shading pst_lobe_search(const pst_lobe_data *d, const pst_lobe *lobe, const pst_shading *so_far)
{
    static const vec3 tilted[] = {{0.64f, 0, 0.768f},  {0.32f, 0.554f, 0.768f},   {-0.32f, 0.554f, 0.768f},
                                  {-0.64f, 0, 0.768f}, {-0.32f, -0.554f, 0.768f}, {0.32f, -0.554f, 0.768f}};
    pst_shading best = *so_far;
    for (size_t k = 0; k < sizeof tilted / sizeof *tilted; k++) {
        pst_shading found = descend(d, lobe, &(pst_shading){.normal = tilted[k]}, best.cost);
        if (found.cost < best.cost) best = found;
    }
    return best;
}

void pst_lobe_weigh(const pst_lobe_data *d, const pst_lobe *lobe, const pst_shading *at, float *weight, float *model)
{
    const float *lx = d->seen.x, *ly = d->seen.y, *lz = d->seen.z, *value = d->seen.value, *usable = d->seen.usable;
    const int count = pst_whole(d->seen.padded);
    const tail_choice tail = choose_tail(lobe->tail);
    const vec3 n = at->normal;
    const float u = expf(at->sharpness), tau = lobe->terminator, k = lobe->masking, a = at->albedo, s = at->gloss;
    const float narrow = 1 / (lobe->width * lobe->width);
#pragma omp simd
    for (int i = 0; i < count; i++) {
        float nl = n.x * lx[i] + n.y * ly[i] + n.z * lz[i];
        float nh = n.x * d->hx[i] + n.y * d->hy[i] + n.z * d->hz[i];
        float x = 1 - nh * nh, diffuse = nl > tau ? nl - tau : 0, lit = nl > 0 ? nl : 0;
        float fit = a * diffuse + s * lobe_at(&tail, u, x > 0 ? x : 0, lit, k);
        float r = value[i] - fit, q = 1 / (1 + r * r * d->precision[i] * narrow);
        model[i] = fit;
        weight[i] = (nl > tau ? usable[i] : 0) * q * q;
    }
}

float pst_lobe_predict(const pst_observations *o, vec3 view, const pst_lobe *lobe)
{
    float usable[PST_MAX_LIGHTS], weight[PST_MAX_LIGHTS], model[PST_MAX_LIGHTS] = {0}, off = 0;
    pst_lobe_data all, some;
    pst_observations seen = *o;
    seen.usable = usable;
    pst_lobe_prepare(o, view, PST_SHADOW_COST, &all);
    for (int part = 0; part < PARTS; part++) {
        for (int i = 0; i < o->padded; i++)
            usable[i] = i % PARTS == part ? 0 : o->usable[i];
        pst_lobe_prepare(&seen, view, lobe->shadow, &some);
        pst_shading found = pst_lobe_fit(&some, lobe);
        pst_lobe_weigh(&some, lobe, &found, weight, model);
        for (int i = part; i < o->padded; i += PARTS) {
            float r = o->value[i] - model[i], t = r * r * all.precision[i];
            off += charge(all.shadowy[i], o->value[i], r) * sqrtf(t / (1 + t));
        }
    }
    return off;
}
