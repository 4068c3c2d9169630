/* SPDX-License-Identifier: MIT */
#include "stereo/uncalibrated/bundle_expected.h"

#include <math.h>
#include <stdlib.h>

#include "stereo/algebra/matrix3.h"

/* Largest slope of log depth that is expected. */
static const float steepest = 4;
/* Distances of the nearest and the farthest expected lights. */
static const float nearest = 0.25f, farthest = 8;

/* Finds the picture's pixel in the middle of a cell; false outside the object. */
static bool pixel_of(const bundle *b, float x, float y, size_t *at)
{
    const merlin_capture *c = b->problem->capture;
    const int column = (int)floorf(x), row = (int)floorf(y);
    if (column < 0 || row < 0 || column >= c->width || row >= c->height) return false;
    *at = (size_t)row * (size_t)c->width + (size_t)column;
    return c->mask.data[*at] > 0.5f;
}

/* Averages the expected normals over a cell. */
static vec3 mean_normal(const bundle *b, const bundle_cell *cell)
{
    enum { SAMPLES = 6 };
    const img *normal = b->problem->expected->normal;
    const float left = cell->x * b->camera.focal + b->camera.x - 0.5f * (float)b->side;
    const float top = b->camera.y - cell->y * b->camera.focal - 0.5f * (float)b->side;
    vec3 sum = {0, 0, 0};
    for (int k = 0; k < SAMPLES * SAMPLES; k++) {
        const int i = k % SAMPLES, j = k / SAMPLES;
        size_t at;
        const float x = left + ((float)i + 0.5f) / SAMPLES * (float)b->side;
        const float y = top + ((float)j + 0.5f) / SAMPLES * (float)b->side;
        if (pixel_of(b, x, y, &at)) sum = vec3_add(sum, vec3_of(normal->data + 3 * at));
    }
    return sum;
}

/* The slopes s of log depth at a ray (x, y, -1) make the normal's direction (s_x, s_y, 1 + x s_x + y s_y). */
static void expect_slopes(const bundle *b, bundle_expected *e)
{
    for (int i = 0; i < b->cells; i++) {
        const bundle_cell *c = &b->cell[i];
        const vec3 n = mean_normal(b, c);
        const float facing = n.z - c->x * n.x - c->y * n.y, across = hypotf(n.x, n.y);
        if (!(facing > 0)) continue;
        const float slope = across / facing, held = fminf(slope, steepest) / fmaxf(slope, 1e-6f);
        e->slope[2 * i] = held * n.x / facing;
        e->slope[2 * i + 1] = held * n.y / facing;
        e->weight[i] = 1 / (1 + slope * slope);
    }
}

static void expect_lights(const bundle *b, bundle_expected *e)
{
    const pst_expected *of = b->problem->expected;
    for (int k = 0; k < b->lights; k++) {
        const float sure = vec3_length(of->compared[k]);
        const float told = fminf(fmaxf(1 / fmaxf(of->near[k], 1e-6f), nearest), farthest);
        const float distance = bundle_is_near(b) ? told : BUNDLE_AFAR * b->radius;
        const vec3 way = sure > 0 ? vec3_scale(of->compared[k], 1 / sure) : vec3_make(0, 0, 1);
        e->sure[k] = fminf(sure, 1);
        e->place[k] = vec3_fma(b->centre, distance, way);
    }
}

status bundle_expect(bundle *b)
{
    const pst_expected *of = b->problem->expected;
    if (!of || !of->depth || !of->compared) return OK;
    const size_t cells = (size_t)b->cells, lights = (size_t)b->lights;
    bundle_expected *e = calloc(1, sizeof *e);
    if (!e) return fail(MERLIN_NO_MEMORY, "no memory for %zu cells", cells);
    b->expected = e;
    e->place = calloc(lights, sizeof *e->place);
    e->sure = calloc(lights + 3 * cells, sizeof *e->sure);
    if (!e->place || !e->sure) return fail(MERLIN_NO_MEMORY, "no memory for %zu cells", cells);
    e->slope = e->sure + lights;
    e->weight = e->slope + 2 * cells;
    expect_slopes(b, e);
    expect_lights(b, e);
    return OK;
}

/* Averages the logarithm of the expected depth about a corner; false where there is none. */
static bool log_depth_at(const bundle *b, int column, int row, double *out)
{
    enum { SAMPLES = 4 };
    double sum = 0;
    int count = 0;
    for (int k = 0; k < SAMPLES * SAMPLES; k++) {
        const int i = k % SAMPLES, j = k / SAMPLES;
        size_t at;
        const float x = (float)b->left + ((float)column + ((float)i + 0.5f) / SAMPLES - 0.5f) * (float)b->side;
        const float y = (float)b->top + ((float)row + ((float)j + 0.5f) / SAMPLES - 0.5f) * (float)b->side;
        if (!pixel_of(b, x, y, &at) || !(b->problem->expected->depth->data[at] > 0)) continue;
        sum += log((double)b->problem->expected->depth->data[at]);
        count++;
    }
    *out = count ? sum / count : 0;
    return count > 0;
}

void bundle_take_expected(bundle *b)
{
    double sum = 0;
    int known = 0;
    for (int row = 0; row <= b->rows; row++)
        for (int column = 0; column <= b->columns; column++) {
            const int n = b->corner_at[row * (b->columns + 1) + column];
            double depth;
            if (n < 0) continue;
            b->log_depth[n] = NAN;
            if (!log_depth_at(b, column, row, &depth)) continue;
            b->log_depth[n] = (float)depth;
            sum += depth;
            known++;
        }
    const float mean = known ? (float)(sum / known) : 0;
    for (int i = 0; i < b->corners; i++)
        b->log_depth[i] = isnan(b->log_depth[i]) ? 0 : b->log_depth[i] - mean;
    for (int k = 0; k < b->lights; k++)
        b->position[k] = b->expected->place[k];
}

/* ---- normals ---- */

/* By how much each cell's normal differs from the expected one, on the grid. */
typedef struct bends {
    const bundle *bundle;
    vec3 *at;    /* columns × rows */
    bool *known; /* likewise */
} bends;

static void find_bends(const bundle *b, bends *out)
{
    for (int i = 0; i < b->cells; i++) {
        const bundle_cell *c = &b->cell[i];
        const float x = c->x * b->camera.focal + b->camera.x, y = b->camera.y - c->y * b->camera.focal;
        const int column = (int)((x - (float)b->left) / (float)b->side),
                  row = (int)((y - (float)b->top) / (float)b->side);
        const vec3 expected = mean_normal(b, c);
        if (column < 0 || row < 0 || column >= b->columns || row >= b->rows || !(vec3_dot(expected, expected) > 0))
            continue;
        const int at = row * b->columns + column;
        out->at[at] = vec3_sub(bundle_normal(b, i), vec3_normalize(expected));
        out->known[at] = true;
    }
}

/* Interpolates between the middles of cells, by a tent wide enough to reach some. */
static vec3 bend_at(const bends *d, float x, float y)
{
    const bundle *b = d->bundle;
    const float column = (x - (float)b->left) / (float)b->side - 0.5f,
                row = (y - (float)b->top) / (float)b->side - 0.5f;
    vec3 sum = {0, 0, 0};
    float weights = 0;
    for (int reach = 1; weights <= 0 && reach < 2 * (b->columns + b->rows); reach *= 2)
        for (int j = (int)floorf(row) - reach + 1; j <= (int)floorf(row) + reach; j++)
            for (int i = (int)floorf(column) - reach + 1; i <= (int)floorf(column) + reach; i++) {
                if (i < 0 || j < 0 || i >= b->columns || j >= b->rows || !d->known[j * b->columns + i]) continue;
                const float w =
                    (1 - fabsf((float)i - column) / (float)reach) * (1 - fabsf((float)j - row) / (float)reach);
                sum = vec3_fma(sum, w, d->at[j * b->columns + i]);
                weights += w;
            }
    return weights > 0 ? vec3_scale(sum, 1 / weights) : sum;
}

status bundle_bend_normals(const bundle *b, img *out)
{
    const pst_problem *p = b->problem;
    const size_t cells = (size_t)b->columns * (size_t)b->rows, width = (size_t)p->capture->width;
    bends d = {b, calloc(cells, sizeof *d.at), calloc(cells, sizeof *d.known)};
    status s = d.at && d.known ? img_new(out, p->capture->width, p->capture->height, 3)
                               : fail(MERLIN_NO_MEMORY, "no memory for %zu cells", cells);
    if (s == OK) find_bends(b, &d);
    for (size_t i = 0; s == OK && i < p->pixel_count; i++) {
        const size_t at = p->pixel[i], column = at % width, row = at / width;
        const vec3 n = vec3_of(p->expected->normal->data + 3 * at);
        const vec3 bent = vec3_add(n, bend_at(&d, (float)column + 0.5f, (float)row + 0.5f));
        vec3_put(pst_facing(bent), out->data + 3 * at);
    }
    free(d.at);
    free(d.known);
    return s;
}
