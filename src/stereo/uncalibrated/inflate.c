/* SPDX-License-Identifier: MIT */
#include "stereo/uncalibrated/inflate.h"

#include <math.h>
#include <stdbool.h>
#include <stdlib.h>

#include "base/vec.h"
#include "image/resize.h"
#include "stereo/integrate/poisson.h"

/* Largest side that is solved; larger objects are solved at this size and enlarged, as u is smooth. */
enum { LARGEST = 512 };

static const double tolerance = 1e-7;

/* Sets the differences between neighbours to those of a paraboloid, -|x - c|^2, whose Laplacian is -4; beyond the edges
 * u is 0. */
static void set_differences(poisson_grid *g)
{
    const float middle[2] = {0.5f * (float)g->width, 0.5f * (float)g->height};
    for (int i = 0; i < g->count; i++) {
        const int place[2] = {g->pixel[i] % g->width, g->pixel[i] / g->width};
        float sum = 0;
        for (int d = 0; d < 2; d++) {
            const float next = -2 * ((float)place[d] + 0.5f - middle[d]), previous = next + 2;
            if (g->next[d][i] >= 0) {
                g->target[d][i] = next;
            } else {
                g->pull[i]++;
                sum -= next;
            }
            if (g->previous[d][i] < 0) {
                g->pull[i]++;
                sum += previous;
            }
        }
        if (g->pull[i] > 0) g->pulled_to[i] = sum / g->pull[i];
    }
}

static bool is_empty(const img *mask)
{
    for (size_t i = 0; i < img_value_count(mask); i++)
        if (mask->data[i] > 0.5f) return false;
    return true;
}

/* Solves for u, zero outside the mask. */
static status solve_poisson(const img *mask, img *u)
{
    poisson_grid g;
    poisson_solver *solver = NULL;
    status s = img_new(u, mask->width, mask->height, 1);
    if (s != OK || is_empty(mask)) return s;
    s = poisson_grid_new(mask, &g);
    if (s != OK) return s;
    set_differences(&g);
    double *x = calloc((size_t)g.count, sizeof *x);
    s = x ? poisson_solver_new(&g, &solver) : fail(MERLIN_NO_MEMORY, "no memory to inflate %d pixels", g.count);
    if (s == OK) s = poisson_solve(solver, tolerance, x);
    for (int i = 0; i < g.count && s == OK; i++)
        u->data[g.pixel[i]] = fmaxf((float)x[i], 0);
    poisson_solver_free(solver);
    free(x);
    poisson_grid_free(&g);
    return s;
}

typedef struct box {
    int x, y, width, height;
} box;

static box box_of(const img *mask)
{
    int left = mask->width, right = -1, top = mask->height, bottom = -1;
    for (int y = 0; y < mask->height; y++) {
        for (int x = 0; x < mask->width; x++) {
            if (!(*img_at(mask, x, y) > 0.5f)) continue;
            left = x < left ? x : left;
            right = x > right ? x : right;
            top = y < top ? y : top;
            bottom = y;
        }
    }
    return right < 0 ? (box){0, 0, 1, 1} : (box){left, top, right - left + 1, bottom - top + 1};
}

/* Computes u for the part of the mask in the box, in its size. */
static status solve_smaller(const img *mask, const box *b, float shrink, img *out)
{
    img part = {0}, small_mask = {0}, u = {0};
    int width = (int)ceilf((float)b->width / shrink), height = (int)ceilf((float)b->height / shrink);
    status s = img_crop(mask, b->x, b->y, b->width, b->height, &part);
    if (s == OK) s = img_resize(&part, width, height, &small_mask);
    if (s == OK) s = solve_poisson(&small_mask, &u);
    const float area = (float)b->width / (float)width * ((float)b->height / (float)height);
    for (size_t i = 0; s == OK && i < img_value_count(&u); i++)
        u.data[i] *= area;
    if (s == OK) s = img_resize(&u, b->width, b->height, out);
    img_free(&part);
    img_free(&small_mask);
    img_free(&u);
    return s;
}

static status solve(const img *mask, img *u)
{
    const box b = box_of(mask);
    const float shrink = (float)(b.width > b.height ? b.width : b.height) / LARGEST;
    if (shrink <= 1) return solve_poisson(mask, u);
    img part = {0};
    status s = img_new(u, mask->width, mask->height, 1);
    if (s == OK) s = solve_smaller(mask, &b, shrink, &part);
    for (int y = 0; s == OK && y < b.height; y++)
        for (int x = 0; x < b.width; x++)
            if (*img_at(mask, b.x + x, b.y + y) > 0.5f) *img_at(u, b.x + x, b.y + y) = fmaxf(0, *img_at(&part, x, y));
    img_free(&part);
    return s;
}

static float value_at(const img *u, int x, int y)
{
    return x >= 0 && y >= 0 && x < u->width && y < u->height ? *img_at(u, x, y) : 0;
}

/* Writes normals and heights. With h = √u the normal (-∂h/∂x, -∂h/∂y, 1) is parallel to (-∂u/∂x, -∂u/∂y, 2 √u), which
 * is finite at the edge. */
static void write_surface(const img *mask, const img *u, img *normal, img *height)
{
    for (int y = 0; y < mask->height; y++) {
        for (int x = 0; x < mask->width; x++) {
            if (!(*img_at(mask, x, y) > 0.5f)) continue;
            const float h = sqrtf(*img_at(u, x, y));
            const vec3 n = {(value_at(u, x - 1, y) - value_at(u, x + 1, y)) / 2,
                            (value_at(u, x, y + 1) - value_at(u, x, y - 1)) / 2, 2 * h + 1e-6f};
            vec3_put(vec3_normalize(n), img_at(normal, x, y));
            *img_at(height, x, y) = h;
        }
    }
}

status pst_inflate(const img *mask, img *normal, img *height)
{
    *normal = *height = (img){0};
    img u = {0};
    status s = solve(mask, &u);
    if (s == OK) s = img_new(normal, mask->width, mask->height, 3);
    if (s == OK) s = img_new(height, mask->width, mask->height, 1);
    if (s == OK)
        write_surface(mask, &u, normal, height);
    else
        img_free(normal);
    img_free(&u);
    return s;
}
