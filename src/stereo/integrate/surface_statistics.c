/* SPDX-License-Identifier: MIT */
#include "stereo/integrate/surface_statistics.h"

#include <stdlib.h>

static void exchange(double *a, double *b)
{
    double old = *a;
    *a = *b;
    *b = old;
}

/* Returns the value that would be at place k if they were sorted, and sorts them in part (Hoare's selection). */
static double of_rank(double *values, size_t count, size_t k)
{
    size_t low = 0, end = count;
    for (;;) {
        double pivot = values[low + (end - low) / 2];
        size_t less = low, more = end;
        for (size_t i = low; i < more;) {
            if (values[i] < pivot)
                exchange(&values[i++], &values[less++]);
            else if (values[i] > pivot)
                exchange(&values[i], &values[--more]);
            else
                i++;
        }
        if (k >= less && k < more) return pivot;
        low = k < less ? low : more;
        end = k < less ? less : end;
    }
}

/* Summarizes values, which change places. */
static merlin_statistics summarize(double *values, size_t count)
{
    double sum = 0;
    for (size_t i = 0; i < count; i++)
        sum += values[i];
    if (!count) return (merlin_statistics){0};
    return (merlin_statistics){sum / (double)count, of_rank(values, count, count / 2), count};
}

static double *values_of(const merlin_surface *s)
{
    double *values = malloc((size_t)s->mask.width * (size_t)s->mask.height * sizeof *values);
    if (!values) fail(MERLIN_NO_MEMORY, "no memory for a report");
    return values;
}

status surface_statistics(const merlin_surface *s, const img *map, merlin_statistics *out)
{
    *out = (merlin_statistics){0};
    if (!map->data) return OK;
    double *values = values_of(s);
    size_t count = 0;
    if (!values) return MERLIN_NO_MEMORY;
    for (size_t i = 0, pixels = img_value_count(&s->mask); i < pixels; i++)
        if (s->mask.data[i] > 0.5f) values[count++] = (double)map->data[i];
    *out = summarize(values, count);
    free(values);
    return OK;
}

status surface_normal_error(const merlin_surface *s, const merlin_capture *c, merlin_statistics *out)
{
    *out = (merlin_statistics){0};
    if (!c->normal_true.data) return OK;
    double *values = values_of(s);
    size_t count = 0;
    if (!values) return MERLIN_NO_MEMORY;
    for (size_t i = 0, pixels = img_value_count(&s->mask); i < pixels; i++) {
        vec3 n = vec3_of(s->normal.data + 3 * i), t = vec3_of(c->normal_true.data + 3 * i);
        if (s->mask.data[i] <= 0.5f || !(vec3_dot(t, t) > (real)0.25)) continue;
        values[count++] = vec3_angle(n, t);
    }
    *out = summarize(values, count);
    free(values);
    return OK;
}
