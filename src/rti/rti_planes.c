/* SPDX-License-Identifier: MIT */
#include "rti/rti_planes.h"

#include <math.h>
#include <stdlib.h>

#include "base/memory.h"
#include "base/number.h"
#include "base/parallel.h"

typedef struct range {
    float low, high;
} range;

typedef struct coding {
    const rti_values *values;
    rti_planes *planes;
    range *of_rows; /* height × planes */
} coding;

/* Bodies have a row of their own, because a thread's stack is too small for one. */
static float *new_row(const rti_values *v)
{
    return malloc((size_t)v->width * (size_t)v->planes * sizeof(float));
}

static status find_range(void *context, size_t y)
{
    const coding *c = context;
    const rti_values *v = c->values;
    const size_t planes = (size_t)v->planes;
    range *of_row = c->of_rows + y * planes;
    float *row = new_row(v);
    if (!row) return fail(MERLIN_NO_MEMORY, "no memory for a row of %d planes", v->planes);
    v->row(v->context, (int)y, row);
    for (size_t i = 0; i < (size_t)v->width * planes; i++) {
        range *r = &of_row[i % planes];
        r->low = min_of(r->low, row[i]);
        r->high = max_of(r->high, row[i]);
    }
    free(row);
    return OK;
}

static void set_plane(rti_planes *p, int plane, range r)
{
    const int zero = (int)lrintf(255 * -r.low / max_of(r.high - r.low, 1e-9f));
    float step = 1e-9f; /* difference of two codes */
    if (zero > 0) step = max_of(step, -r.low / (float)zero);
    if (zero < 255) step = max_of(step, r.high / (float)(255 - zero));
    p->zero[plane] = zero;
    p->scale[plane] = 255 * step;
}

/* All ranges hold 0. */
static void set_planes(const coding *c)
{
    const rti_values *v = c->values;
    range all[MERLIN_RTI_MOST_PLANES] = {{0, 0}};
    for (size_t i = 0; i < (size_t)v->height * (size_t)v->planes; i++) {
        range *r = &all[i % (size_t)v->planes];
        r->low = min_of(r->low, c->of_rows[i].low);
        r->high = max_of(r->high, c->of_rows[i].high);
    }
    for (int p = 0; p < v->planes; p++) {
        range r = all[p];
        for (int k = p - p % 3; v->shared && k < p - p % 3 + 3; k++)
            r = (range){min_of(r.low, all[k].low), max_of(r.high, all[k].high)};
        set_plane(c->planes, p, p < v->plain ? (range){0, 1} : r);
    }
}

static status code_row(void *context, size_t y)
{
    const coding *c = context;
    const rti_values *v = c->values;
    const size_t planes = (size_t)v->planes, count = (size_t)v->width * planes;
    uint8_t *codes = c->planes->codes + y * count;
    float *row = new_row(v);
    if (!row) return fail(MERLIN_NO_MEMORY, "no memory for a row of %d planes", v->planes);
    v->row(v->context, (int)y, row);
    for (size_t i = 0; i < count; i++) {
        const size_t p = i % planes;
        codes[i] = (uint8_t)lrintf(clamp(255 * row[i] / c->planes->scale[p] + (float)c->planes->zero[p], 0, 255));
    }
    free(row);
    return OK;
}

status rti_planes_new(const rti_values *values, rti_planes *out)
{
    *out = (rti_planes){.width = values->width, .height = values->height, .planes = values->planes};
    const size_t rows = (size_t)values->height, planes = (size_t)values->planes;
    coding c = {.values = values, .planes = out, .of_rows = calloc(rows * planes, sizeof *c.of_rows)};
    out->codes = memory_new(rows * (size_t)values->width * planes);
    status s = c.of_rows && out->codes ? OK : fail(MERLIN_NO_MEMORY, "no memory for %d planes", values->planes);
    if (s == OK) s = parallel_try(rows, find_range, &c);
    if (s == OK) set_planes(&c);
    if (s == OK) s = parallel_try(rows, code_row, &c);
    free(c.of_rows);
    if (s != OK) rti_planes_free(out);
    return s;
}

void rti_planes_free(rti_planes *planes)
{
    memory_free(planes->codes);
    *planes = (rti_planes){0};
}
