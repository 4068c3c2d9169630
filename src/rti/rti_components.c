/* SPDX-License-Identifier: MIT */
#include "rti/rti_components.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/number.h"
#include "base/parallel.h"
#include "base/rng.h"
#include "stereo/algebra/dense.h"

enum { LEAST_PICTURES = 4, LEAST_SAMPLES = 8192, SAMPLES_A_VALUE = 8, TRIES = 16 };

/* ---- the sum of products of sampled pixels ---- */

typedef struct sampling {
    const merlin_rti *rti;
    size_t *pixels, count;
    double *products; /* length × length */
    int length;
} sampling;

static bool is_black(const merlin_rti *rti, size_t pixel)
{
    for (int i = 0; i < rti->count; i++) {
        const uint8_t *rgb = rti->pictures[i] + 3 * pixel;
        if (rgb[0] || rgb[1] || rgb[2]) return false;
    }
    return true;
}

/* Pixels that are black throughout would add nothing; where all are, any do. */
static void choose_pixels(sampling *s)
{
    const size_t all = rti_pixel_count(s->rti);
    for (size_t i = 0; i < s->count; i++) {
        rng random = rng_at(0, i, 0);
        int tries = 0;
        do
            s->pixels[i] = (size_t)rng_below(&random, (int)min_size(all, INT32_MAX));
        while (++tries < TRIES && is_black(s->rti, s->pixels[i]));
    }
}

static float value_of(const merlin_rti *rti, size_t pixel, int place)
{
    const int picture = place / 3, channel = place % 3;
    return (float)rti->pictures[picture][3 * pixel + (size_t)channel] / 255;
}

static void sum_row(void *context, size_t row)
{
    const sampling *s = context;
    double *sums = s->products + row * (size_t)s->length;
    for (size_t i = 0; i < s->count; i++) {
        const double value = (double)value_of(s->rti, s->pixels[i], (int)row);
        if (value == 0) continue;
        for (int k = (int)row; k < s->length; k++)
            sums[k] += value * (double)value_of(s->rti, s->pixels[i], k);
    }
}

static status sum_products(const merlin_rti *rti, int length, double **products)
{
    sampling s = {.rti = rti, .length = length};
    *products = s.products = calloc((size_t)length * (size_t)length, sizeof *s.products);
    s.count = min_size(rti_pixel_count(rti), LEAST_SAMPLES + SAMPLES_A_VALUE * (size_t)length);
    s.pixels = malloc(s.count * sizeof *s.pixels);
    const bool done = s.pixels && s.products;
    if (done) choose_pixels(&s);
    if (done) parallel_for((size_t)length, sum_row, &s);
    free(s.pixels);
    return done ? OK : fail(MERLIN_NO_MEMORY, "no memory for %zu sampled pixels", s.count);
}

/* ---- the vectors ---- */

/* products: eigenvectors in columns, their values ascending. */
static void code_vectors(rti_components *c, const double *products)
{
    for (int p = 0; p < c->planes; p++) {
        const int column = c->length - 1 - p;
        double most = 1e-9;
        for (int k = 0; k < c->length; k++)
            most = fmax(most, fabs(products[(size_t)k * (size_t)c->length + (size_t)column]));
        c->range[p] = (float)(RTI_BASIS_ZERO / most);
        for (int k = 0; k < c->length; k++) {
            const double value = products[(size_t)k * (size_t)c->length + (size_t)column] / most;
            c->codes[(size_t)p * (size_t)c->length + (size_t)k] =
                (uint8_t)(RTI_BASIS_ZERO + lrint(RTI_BASIS_ZERO * value));
        }
    }
}

static double coded_value(const rti_components *c, int plane, int k)
{
    const int code = c->codes[(size_t)plane * (size_t)c->length + (size_t)k];
    return (double)(code - RTI_BASIS_ZERO) / (double)c->range[plane];
}

/* Least squares onto the vectors as they are coded, which are not quite orthogonal any more. */
static status set_projection(rti_components *c)
{
    const int n = c->planes;
    double gram[MERLIN_RTI_MOST_PLANES * MERLIN_RTI_MOST_PLANES] = {0};
    for (int p = 0; p < n; p++)
        for (int q = 0; q < n; q++)
            for (int k = 0; k < c->length; k++)
                gram[p * n + q] += coded_value(c, p, k) * coded_value(c, q, k);
    for (int k = 0; k < c->length; k++) {
        double m[MERLIN_RTI_MOST_PLANES * MERLIN_RTI_MOST_PLANES], column[MERLIN_RTI_MOST_PLANES];
        memcpy(m, gram, sizeof m);
        for (int p = 0; p < n; p++)
            column[p] = coded_value(c, p, k);
        if (!dense_solve_positive(m, n, column)) return fail(MERLIN_WRONG_USE, "the pictures are too much alike");
        for (int p = 0; p < n; p++)
            c->projection[(size_t)k * (size_t)n + (size_t)p] = (float)column[p];
    }
    return OK;
}

static status find_vectors(rti_components *c)
{
    const size_t length = (size_t)c->length, planes = (size_t)c->planes;
    double *products = NULL, *value = malloc(2 * length * sizeof *value);
    c->codes = malloc(planes * length);
    c->projection = malloc(length * planes * sizeof *c->projection);
    status s = value && c->codes && c->projection
                   ? sum_products(c->rti, c->length, &products)
                   : fail(MERLIN_NO_MEMORY, "no memory for the principal components of %d pictures", c->rti->count);
    if (s == OK && !dense_eigen(products, c->length, true, value))
        s = fail(MERLIN_BAD_INPUT, "the pictures have no principal components");
    if (s == OK) code_vectors(c, products);
    if (s == OK) s = set_projection(c);
    free(products);
    free(value);
    return s;
}

/* ---- pixels ---- */

static void project_row(const void *context, int y, float *values)
{
    const rti_components *c = context;
    const size_t width = (size_t)c->rti->width, planes = (size_t)c->planes;
    memset(values, 0, width * planes * sizeof *values);
    for (int k = 0; k < c->length; k++) {
        const uint8_t *code = c->rti->pictures[k / 3] + (size_t)y * width * 3 + k % 3;
        const float *onto = c->projection + (size_t)k * planes;
        for (size_t x = 0; x < width; x++) {
            const float value = (float)code[3 * x] / 255;
            if (value == 0) continue;
            for (size_t p = 0; p < planes; p++)
                values[x * planes + p] += value * onto[p];
        }
    }
}

status rti_components_new(const merlin_rti *rti, rti_components *out, rti_values *values)
{
    *out = (rti_components){.rti = rti, .length = 3 * rti->count, .planes = min_int(rti->how.planes, 3 * rti->count)};
    *values = (rti_values){.width = rti->width, .height = rti->height, .planes = out->planes, .row = project_row};
    values->context = out;
    if (rti->count < LEAST_PICTURES)
        return fail(MERLIN_WRONG_USE, "%d pictures are too few to interpolate between: at least %d are needed",
                    rti->count, LEAST_PICTURES);
    status s = find_vectors(out);
    if (s != OK) rti_components_free(out);
    return s;
}

void rti_components_free(rti_components *components)
{
    free(components->codes);
    free(components->projection);
    components->codes = NULL, components->projection = NULL;
}

double rti_sigma(const merlin_rti *rti)
{
    static const double OF_DISTANCE = 0.75;
    double sum = 0;
    for (int i = 0; i < rti->count; i++) {
        double nearest = 4;
        for (int j = 0; j < rti->count; j++) {
            double squares = 0;
            for (int k = 0; k < 3; k++)
                squares += pow((double)rti->direction[3 * i + k] - (double)rti->direction[3 * j + k], 2);
            if (j != i) nearest = fmin(nearest, squares);
        }
        sum += sqrt(nearest);
    }
    return fmax(OF_DISTANCE * sum / rti->count, 1e-3);
}
