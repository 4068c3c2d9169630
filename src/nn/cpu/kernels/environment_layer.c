/* SPDX-License-Identifier: MIT */
/* The diffuse half of setting B's rendering layer: maps under an environment given by nine spherical harmonics, and the
 * derivative by maps and coefficients. Pixels outside the mask are never read. */
#include "nn/cpu/kernels/kernels.h"

#include "nn/cpu/kernels/chunk.h"
#include "optics/sh.h"

enum { COEFFICIENTS = 27 };
static const float INVERSE_PI = 0.318309886183790672f;

/* One row of one sample. */
typedef struct row {
    const float *albedo, *normal, *mask;
    const float (*sh)[3];
    size_t first, width; /* first: index of the row's first pixel in the batch; width: pixels */
} row;

static row row_at(const cpu_environment *in, const cpu_tensor *mask, size_t y)
{
    size_t width = (size_t)mask->w, first = y * width;
    return (row){.albedo = (const float *)in->albedo.data + 3 * first,
                 .normal = (const float *)in->normal.data + 3 * first,
                 .mask = (const float *)mask->data + first,
                 .sh = (const float(*)[3])((const float *)in->sh.data + y / (size_t)mask->h * COEFFICIENTS),
                 .first = first,
                 .width = width};
}

/* Returns what a white surface would reflect, times the mask. */
static vec3 white(const row *r, size_t i)
{
    return vec3_scale(sh_irradiance(r->sh, vec3_of(r->normal + 3 * i)), r->mask[i] * INVERSE_PI);
}

/* Returns the albedo in [0, 1]; the network's is in [-1, 1]. */
static vec3 albedo_at(const row *r, size_t i)
{
    const vec3 half = {0.5f, 0.5f, 0.5f};
    return vec3_fma(half, 0.5f, vec3_of(r->albedo + 3 * i));
}

void cpu_shade_environment(const cpu_environment *in, const cpu_tensor *mask, cpu_tensor *y)
{
    const vec3 black = {0, 0, 0};
    size_t rows = (size_t)y->n * (size_t)y->h;
#pragma omp parallel for schedule(dynamic, 16) if (cpu_count(mask) > CPU_CHUNK)
    for (size_t k = 0; k < rows; k++) {
        row r = row_at(in, mask, k);
        float *out = (float *)y->data + 3 * r.first;
        for (size_t i = 0; i < r.width; i++)
            vec3_put(r.mask[i] != 0 ? vec3_mul(white(&r, i), albedo_at(&r, i)) : black, out + 3 * i);
    }
}

static void store3(cpu_tensor *t, size_t pixel, vec3 v, bool accumulate)
{
    if (!t->data) return;
    float *to = (float *)t->data + 3 * pixel;
    to[0] = (accumulate ? to[0] : 0) + v.x;
    to[1] = (accumulate ? to[1] : 0) + v.y;
    to[2] = (accumulate ? to[2] : 0) + v.z;
}

/* Adds one pixel's gradient by the coefficients; outgoing is d(loss)/d(irradiance). */
static void add_coefficients(vec3 n, vec3 outgoing, float sum[COEFFICIENTS])
{
    const float channels[3] = {outgoing.x, outgoing.y, outgoing.z};
    float basis[9];
    sh_basis(n, basis);
    for (int i = 0; i < 9; i++)
        for (int c = 0; c < 3; c++)
            sum[3 * i + c] += sh_cosine_band(i) * basis[i] * channels[c];
}

static void differentiate_row(const row *r, const float *dy, cpu_environment *gradients,
                              cpu_environment_accumulate accumulate, float sum[COEFFICIENTS])
{
    const vec3 none = {0, 0, 0};
    for (size_t i = 0; i < r->width; i++) {
        size_t pixel = r->first + i;
        if (r->mask[i] == 0) {
            store3(&gradients->albedo, pixel, none, accumulate.albedo);
            store3(&gradients->normal, pixel, none, accumulate.normal);
            continue;
        }
        vec3 d = vec3_of(dy + 3 * i), n = vec3_of(r->normal + 3 * i);
        vec3 outgoing = vec3_scale(vec3_mul(d, albedo_at(r, i)), r->mask[i] * INVERSE_PI);
        store3(&gradients->albedo, pixel, vec3_scale(vec3_mul(d, white(r, i)), 0.5f), accumulate.albedo);
        store3(&gradients->normal, pixel, sh_irradiance_gradient(r->sh, n, outgoing), accumulate.normal);
        if (gradients->sh.data) add_coefficients(n, outgoing, sum);
    }
}

/* Sums a sample's rows in order, each in float and then in double: the same bits for any number of threads. */
void cpu_environment_backward(const cpu_environment *in, const cpu_tensor *mask, const cpu_tensor *dy,
                              cpu_environment *gradients, cpu_environment_accumulate accumulate)
{
    size_t batch = (size_t)mask->n, height = (size_t)mask->h;
#pragma omp parallel for schedule(dynamic, 1) if (cpu_count(mask) > CPU_CHUNK)
    for (size_t n = 0; n < batch; n++) {
        double sum[COEFFICIENTS] = {0};
        for (size_t y = 0; y < height; y++) {
            float part[COEFFICIENTS] = {0};
            row r = row_at(in, mask, n * height + y);
            differentiate_row(&r, (const float *)dy->data + 3 * r.first, gradients, accumulate, part);
            for (int k = 0; k < COEFFICIENTS; k++)
                sum[k] += (double)part[k];
        }
        float total[COEFFICIENTS];
        for (int k = 0; k < COEFFICIENTS; k++)
            total[k] = (float)sum[k];
        if (gradients->sh.data) cpu_store(&gradients->sh, n * COEFFICIENTS, COEFFICIENTS, total, accumulate.sh);
    }
}
