/* SPDX-License-Identifier: MIT */
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

#include "base/parallel.h"
#include "image/resize.h"

/* Lines of `values` consecutive values, `step` apart, each to be replaced by the sum over its neighbours. */
typedef struct strip {
    float *first;
    size_t step, values;
    int count, radius;
} strip;

/* Running sums, in double so that adding and subtracting a line cancels exactly, and the original lines that were
 * overwritten by sums but are still to be subtracted. */
typedef struct running {
    double *sums;
    float *replaced; /* radius + 1 lines */
} running;

static void add(double *sums, const float *line, size_t count)
{
    for (size_t i = 0; i < count; i++)
        sums[i] += line[i];
}

static void sum_strip(const strip *s, const running *r)
{
    size_t n = s->values, reach = (size_t)s->radius * s->step;
    memset(r->sums, 0, n * sizeof *r->sums);
    memset(r->replaced, 0, n * (size_t)(s->radius + 1) * sizeof *r->replaced);
    for (int i = 0; i < s->radius && i < s->count; i++)
        add(r->sums, s->first + (size_t)i * s->step, n);
    for (int i = 0; i < s->count; i++) {
        float *line = s->first + (size_t)i * s->step, *before = r->replaced + (size_t)(i % (s->radius + 1)) * n;
        if (i + s->radius < s->count) add(r->sums, line + reach, n);
        for (size_t k = 0; k < n; k++)
            r->sums[k] -= before[k];
        memcpy(before, line, n * sizeof *line);
        for (size_t k = 0; k < n; k++)
            line[k] = (float)r->sums[k];
    }
}

typedef struct box_job {
    const img *image;
    int radius, failed;
} box_job;

static bool running_new(box_job *job, size_t values, running *r)
{
    *r = (running){malloc(values * sizeof *r->sums), malloc(values * (size_t)(job->radius + 1) * sizeof *r->replaced)};
    if (r->sums && r->replaced) return true;
#pragma omp atomic write
    job->failed = 1;
    return false;
}

static void running_free(running *r)
{
    free(r->sums);
    free(r->replaced);
}

static void sum_along_rows(void *context, size_t begin, size_t end)
{
    box_job *job = context;
    const img *m = job->image;
    size_t planes = (size_t)m->channels;
    running r;
    if (running_new(job, planes, &r))
        for (size_t y = begin; y < end; y++)
            sum_strip(&(strip){img_at(m, 0, (int)y), planes, planes, m->width, job->radius}, &r);
    running_free(&r);
}

/* Sums columns begin .. end of values over the rows. */
static void sum_down(void *context, size_t begin, size_t end)
{
    box_job *job = context;
    const img *m = job->image;
    running r;
    if (running_new(job, end - begin, &r))
        sum_strip(
            &(strip){m->data + begin, (size_t)m->width * (size_t)m->channels, end - begin, m->height, job->radius}, &r);
    running_free(&r);
}

status img_box_sums(img *image, int radius)
{
    box_job job = {image, radius, 0};
    parallel_blocks((size_t)image->height, sum_along_rows, &job);
    parallel_blocks((size_t)image->width * (size_t)image->channels, sum_down, &job);
    return job.failed ? fail(MERLIN_NO_MEMORY, "no memory to filter an image") : OK;
}
