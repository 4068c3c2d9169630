/* SPDX-License-Identifier: MIT */
#include "lab/render/visibility.h"

#include <math.h>
#include <stdlib.h>

#include "base/number.h"
#include "base/rng.h"

enum { ROWS = 3 }; /* rows of probes that are kept: a pixel's own and its neighbours' */

/* Results of a pixel's first rays. */
typedef struct probe {
    int met;
    float nearest, farthest;
    trace_hit hit[VISIBILITY_MAX_STRATA];
} probe;

struct visibility {
    trace_scene *scene;
    camera eye;
    int strata, rows; /* rows: number probed so far */
    uint64_t key;
    float pixel_size; /* at depth 1; a tangent */
    probe *probes;    /* ROWS × width, row y at y % ROWS */
};

status visibility_new(trace_scene *scene, const camera *eye, int strata, uint64_t key, visibility **out)
{
    visibility *v = calloc(1, sizeof *v);
    if (v) v->probes = malloc(ROWS * (size_t)eye->width * sizeof *v->probes);
    if (!v || !v->probes) {
        visibility_free(v);
        return fail(MERLIN_NO_MEMORY, "out of memory for %d pixels' rays", ROWS * eye->width);
    }
    v->scene = scene;
    v->eye = *eye;
    v->strata = strata;
    v->key = key;
    v->pixel_size = camera_pixel_size(eye);
    *out = v;
    return OK;
}

void visibility_free(visibility *v)
{
    if (!v) return;
    free(v->probes);
    free(v);
}

/* Returns the cell that is probed in a row of the strata: one in every column, for an even number of them. */
static int probed_column(int row, int strata)
{
    return strata == 1 ? 0 : (2 * row + 1) % (strata + 1);
}

/* Returns a direction inside a cell of a pixel. */
static vec3 cell_direction(const visibility *v, int x, int y, int column, int row)
{
    int cell = row * v->strata + column;
    uint64_t pixel = (uint64_t)y * (uint64_t)v->eye.width + (uint64_t)x;
    uint64_t bits = rng_mix(v->key + pixel * VISIBILITY_MAX_POINTS + (uint64_t)cell);
    float dx = (float)(bits >> 40) * 0x1p-24f, dy = (float)((bits >> 16) & 0xffffffu) * 0x1p-24f;
    float right = (float)x + ((float)column + dx) / (float)v->strata - (float)v->eye.width / 2;
    float up = (float)v->eye.height / 2 - ((float)y + ((float)row + dy) / (float)v->strata);
    return vec3_normalize(vec3_make(right * v->pixel_size, up * v->pixel_size, -1));
}

static probe *probe_at(const visibility *v, int x, int y)
{
    return &v->probes[(size_t)(y % ROWS) * (size_t)v->eye.width + (size_t)x];
}

static void take_probe(probe *p, const trace_hit *hits, int count)
{
    *p = (probe){.nearest = INFINITY};
    for (int i = 0; i < count; i++) {
        p->hit[i] = hits[i];
        if (hits[i].distance < 0) continue;
        p->met++;
        p->nearest = min_of(p->nearest, hits[i].distance);
        p->farthest = max_of(p->farthest, hits[i].distance);
    }
}

/* Probes a row of pixels; a packet takes whole pixels, so that its rays are close together. */
static void probe_row(visibility *v, int y)
{
    vec3 direction[TRACE_PACKET];
    trace_hit hit[TRACE_PACKET];
    int n = v->strata, abreast = TRACE_PACKET / n;
    for (int first = 0; first < v->eye.width; first += abreast) {
        int pixels = v->eye.width - first < abreast ? v->eye.width - first : abreast;
        for (int i = 0; i < pixels * n; i++)
            direction[i] = cell_direction(v, first + i / n, y, probed_column(i % n, n), i % n);
        trace_camera_rays(v->scene, direction, pixels * n, hit);
        for (int i = 0; i < pixels; i++)
            take_probe(probe_at(v, first + i, y), hit + i * n, n);
    }
}

/* Tells whether depths are consistent with one surface over so many pixels, up to a maximal slope. */
static bool is_smooth(const visibility *v, float nearest, float farthest, int pixels)
{
    return farthest - nearest < 6 * (float)pixels * v->pixel_size * nearest;
}

typedef enum pixel_kind { PIXEL_EMPTY, PIXEL_PLAIN, PIXEL_EDGE } pixel_kind;

static pixel_kind kind_of(const visibility *v, int x, int y)
{
    int met = 0, sent = 0;
    float nearest = INFINITY, farthest = 0;
    for (int j = y > 0 ? y - 1 : 0; j <= y + 1 && j < v->eye.height; j++)
        for (int i = x > 0 ? x - 1 : 0; i <= x + 1 && i < v->eye.width; i++) {
            const probe *p = probe_at(v, i, j);
            met += p->met;
            sent += v->strata;
            nearest = min_of(nearest, p->nearest);
            farthest = max_of(farthest, p->farthest);
        }
    if (met == 0) return PIXEL_EMPTY;
    const probe *own = probe_at(v, x, y);
    bool smooth = is_smooth(v, nearest, farthest, 3) && is_smooth(v, own->nearest, own->farthest, 1);
    return met == sent && smooth ? PIXEL_PLAIN : PIXEL_EDGE;
}

static void keep(pixel_hits *out, vec3 direction, const trace_hit *hit)
{
    out->direction[out->count] = direction;
    out->hit[out->count++] = *hit;
}

static void keep_probes(const visibility *v, int x, int y, pixel_hits *out)
{
    for (int row = 0; row < v->strata; row++)
        keep(out, cell_direction(v, x, y, probed_column(row, v->strata), row), &probe_at(v, x, y)->hit[row]);
    out->coverage = 1;
}

/* Traces all cells; repeating those of the probes costs less than excluding them. */
static void keep_all(visibility *v, int x, int y, pixel_hits *out)
{
    vec3 direction[VISIBILITY_MAX_POINTS];
    trace_hit hit[VISIBILITY_MAX_POINTS];
    int n = v->strata, cells = n * n;
    float nearest = INFINITY, farthest = 0;
    for (int i = 0; i < cells; i++)
        direction[i] = cell_direction(v, x, y, i % n, i / n);
    for (int i = 0; i < cells; i += TRACE_PACKET)
        trace_camera_rays(v->scene, direction + i, cells - i < TRACE_PACKET ? cells - i : TRACE_PACKET, hit + i);
    int met = 0;
    for (int i = 0; i < cells; i++) {
        if (hit[i].distance < 0) continue;
        met++;
        nearest = min_of(nearest, hit[i].distance);
        farthest = max_of(farthest, hit[i].distance);
    }
    bool plain = met == cells && is_smooth(v, nearest, farthest, 1);
    out->coverage = (float)met / (float)cells;
    for (int i = 0; i < cells; i++)
        if (hit[i].distance >= 0 && (!plain || i % n == probed_column(i / n, n))) keep(out, direction[i], &hit[i]);
}

void visibility_pixel(visibility *v, int x, int y, pixel_hits *out)
{
    while (v->rows <= y + 1 && v->rows < v->eye.height)
        probe_row(v, v->rows++);
    out->count = 0;
    out->coverage = 0;
    switch (kind_of(v, x, y)) {
    case PIXEL_EMPTY:
        break;
    case PIXEL_PLAIN:
        keep_probes(v, x, y, out);
        break;
    case PIXEL_EDGE:
        keep_all(v, x, y, out);
        break;
    }
}
