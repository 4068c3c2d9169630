/* SPDX-License-Identifier: MIT */
#include "stereo/methods/unlit.h"

#include <math.h>
#include <stdlib.h>

#include "base/parallel.h"
#include "stereo/fit/normal_spread.h"
#include "stereo/integrate/poisson.h"

/* Share of the mean of the object's brightest values from which on a pixel is lit; a darker one may be noise or a dark
 * material. */
static const float dark = 0.1f;

/* Least cosine similarity, over lights and channels, of a lit pixel's values and its neighbours': 1 for lit pixels of
 * even the darkest materials; 0.46 for noise around black whose negative values were cut off. And the radius over which
 * it is averaged, as single pixels can be similar to their neighbours by chance. */
static const float coherent = 0.65f;
enum { REACH = 2 };

/* Weight of known normals relative to smoothness, and of unknown ones toward the camera. */
static const float held = 1e4f, drift = 1e-6f;

static float value_at(const pst_problem *p, int light, size_t pixel, int channel)
{
    const merlin_capture *c = p->capture;
    return (float)pst_code(&c->picture[light], pixel * (size_t)c->channels + (size_t)channel) /
           p->light[light].intensity[channel];
}

/* Returns the sum over channels of a pixel's brightest values in any picture. */
static float brightest(const pst_problem *p, size_t pixel)
{
    float most = 0;
    for (int k = 0; k < p->capture->count; k++) {
        float sum = 0;
        for (int ch = 0; ch < p->capture->channels; ch++)
            sum += value_at(p, k, pixel, ch);
        most = fmaxf(most, sum);
    }
    return most;
}

/* Lists the adjacent pixels on the object; returns their number. */
static int neighbours_of(const img *mask, size_t pixel, size_t to[4])
{
    size_t sides[4];
    int count = 0, there = img_beside(mask->width, mask->height, pixel, sides);
    for (int k = 0; k < there; k++)
        if (mask->data[sides[k]] > 0.5f) to[count++] = sides[k];
    return count;
}

static float likeness(const pst_problem *p, size_t pixel)
{
    size_t beside[4];
    int neighbours = neighbours_of(&p->capture->mask, pixel, beside);
    double aa = 0, ab = 0, bb = 0;
    for (int k = 0; k < p->capture->count; k++)
        for (int ch = 0; ch < p->capture->channels; ch++) {
            double own = (double)value_at(p, k, pixel, ch), around = 0;
            for (int j = 0; j < neighbours; j++)
                around += (double)value_at(p, k, beside[j], ch);
            aa += own * own;
            ab += own * around;
            bb += around * around;
        }
    return ab > 0 ? (float)(ab / sqrt(aa * bb)) : 0;
}

enum { BRIGHT = 2 }; /* more than any similarity */

typedef struct search {
    const pst_problem *problem;
    float most; /* largest brightness of pixels that may be dark */
    img *alike; /* brightness, then similarity */
} search;

static void measure(void *context, size_t begin, size_t end)
{
    const search *w = context;
    for (size_t i = begin; i < end; i++)
        w->alike->data[w->problem->pixel[i]] = brightest(w->problem, w->problem->pixel[i]);
}

static void compare(void *context, size_t begin, size_t end)
{
    const search *w = context;
    for (size_t i = begin; i < end; i++) {
        float *at = &w->alike->data[w->problem->pixel[i]];
        *at = *at < w->most ? likeness(w->problem, w->problem->pixel[i]) : BRIGHT;
    }
}

/* Finds dark pixels. alike: 1 channel, their similarity to neighbours; BRIGHT elsewhere. */
static status find_dark(const pst_problem *p, img *alike)
{
    const merlin_capture *c = p->capture;
    status s = img_new(alike, c->width, c->height, 1);
    if (s != OK) return s;
    for (size_t i = 0; i < img_value_count(alike); i++)
        alike->data[i] = BRIGHT;
    search w = {.problem = p, .alike = alike};
    double sum = 0;
    parallel_blocks(p->pixel_count, measure, &w);
    for (size_t i = 0; i < p->pixel_count; i++)
        sum += (double)alike->data[p->pixel[i]];
    w.most = dark * (float)(sum / (double)p->pixel_count);
    parallel_blocks(p->pixel_count, compare, &w);
    return OK;
}

static bool is_unlit(const img *alike, int x, int y)
{
    float sum = 0, count = 0;
    if (*img_at(alike, x, y) == BRIGHT) return false;
    for (int v = y < REACH ? 0 : y - REACH; v <= y + REACH && v < alike->height; v++)
        for (int u = x < REACH ? 0 : x - REACH; u <= x + REACH && u < alike->width; u++)
            if (*img_at(alike, u, v) != BRIGHT) {
                sum += *img_at(alike, u, v);
                count++;
            }
    return sum < coherent * count;
}

/* Finds unlit pixels. unlit: 1 channel, 1 where no light arrives; *any tells whether there are some. */
static status find(const pst_problem *p, img *unlit, bool *any)
{
    img alike;
    status s = find_dark(p, &alike);
    if (s == OK) s = img_new(unlit, alike.width, alike.height, 1);
    *any = false;
    for (int y = 0; y < alike.height && s == OK; y++)
        for (int x = 0; x < alike.width; x++)
            if (is_unlit(&alike, x, y)) {
                *img_at(unlit, x, y) = 1;
                *any = true;
            }
    img_free(&alike);
    return s;
}

/* Marks these pixels, and the object's pixels next to them. */
static status with_neighbours(const img *unlit, const img *mask, img *out)
{
    status s = img_new(out, mask->width, mask->height, 1);
    if (s != OK) return s;
    for (int y = 0; y < mask->height; y++)
        for (int x = 0; x < mask->width; x++) {
            size_t beside[4], pixel = (size_t)y * (size_t)mask->width + (size_t)x;
            int count = neighbours_of(mask, pixel, beside);
            bool near = unlit->data[pixel] > 0;
            for (int k = 0; k < count; k++)
                near |= unlit->data[beside[k]] > 0;
            *img_at(out, x, y) = near && *img_at(mask, x, y) > 0.5f;
        }
    return OK;
}

/* Smooths one component of the normals; x: the grid's count. */
static status smooth(poisson_solver *solver, poisson_grid *g, const img *unlit, int component, double *x, img *normal)
{
    const double tolerance = 1e-4;
    for (int i = 0; i < g->count; i++) {
        bool known = !(unlit->data[g->pixel[i]] > 0);
        float value = known ? normal->data[3 * (size_t)g->pixel[i] + (size_t)component] : (float)(component == 2);
        g->pull[i] = known ? held : drift;
        g->pulled_to[i] = value;
        x[i] = value;
    }
    status s = poisson_solve(solver, tolerance, x);
    for (int i = 0; s == OK && i < g->count; i++)
        if (unlit->data[g->pixel[i]] > 0) normal->data[3 * (size_t)g->pixel[i] + (size_t)component] = (float)x[i];
    return s;
}

static void normalize(const poisson_grid *g, img *normal)
{
    for (int i = 0; i < g->count; i++) {
        float *n = normal->data + 3 * (size_t)g->pixel[i];
        vec3 v = vec3_make(n[0], n[1], fmaxf(n[2], 1e-3f));
        vec3_put(vec3_normalize(v), n);
    }
}

static status fill(const img *unlit, const img *around, img *normal)
{
    poisson_grid g;
    status s = poisson_grid_new(around, &g);
    if (s != OK) return s;
    poisson_solver *solver = NULL;
    double *x = malloc((size_t)g.count * sizeof *x);
    s = x ? poisson_solver_new(&g, &solver) : fail(MERLIN_NO_MEMORY, "no memory for %d pixels in shadow", g.count);
    for (int k = 0; k < 3 && s == OK; k++)
        s = smooth(solver, &g, unlit, k, x, normal);
    if (s == OK) normalize(&g, normal);
    poisson_solver_free(solver);
    free(x);
    poisson_grid_free(&g);
    return s;
}

static void doubt(const img *unlit, img *spread)
{
    for (size_t i = 0; i < img_value_count(unlit) && spread->data; i++)
        if (unlit->data[i] > 0) spread->data[i] = PST_ANY_NORMAL;
}

status pst_unlit_fill(const pst_problem *p, merlin_surface *s)
{
    img unlit = {0}, around = {0};
    bool any;
    status result = find(p, &unlit, &any);
    if (result == OK && any) {
        result = with_neighbours(&unlit, &p->capture->mask, &around);
        if (result == OK) result = fill(&unlit, &around, &s->normal);
        if (result == OK) doubt(&unlit, &s->spread);
    }
    img_free(&unlit);
    img_free(&around);
    return result;
}
