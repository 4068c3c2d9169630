/* SPDX-License-Identifier: MIT */
#include "estimate/surface/fuse.h"

#include <stdlib.h>
#include <string.h>

#include "base/parallel.h"
#include "image/coverage.h"
#include "optics/camera.h"

/* ℓ in pixels, and σ as a slope in pixels: where depth deviates by three pixels' size from the normals' step, it begins
 * to count as a discontinuity. */
static const float REACH = 20, JUMP = 3;
/* Least cosine to the line of sight: grazing normals hardly determine depth. */
static const float LEAST_COSINE = 0.1f;
/* Iterations in units of ℓ, after which the conjugate gradients' error is far below a pixel's size. */
static const int ITERATIONS = 4;
static const double RESIDUAL = 1e-6;

enum { ARRAYS = 6, STRIPS = 8 };

/* The linear system, one value per pixel of the rows that the mask covers, from the top. Each array has a row of zeros
 * before and after it, so that every pixel has four neighbours. */
typedef struct fusion {
    size_t top, first, width, count; /* top, first: the first row, and its first pixel, in the images */
    float *memory;
    float *right, *down; /* weight w of the pair with the pixel to the right, and below */
    /* step of that pair by the normals, which only the start needs; the conjugate gradients' product and direction take
     * their place */
    float *step_right, *step_down;
    float *product, *direction;
    float *u, *residual;
    float length, turn; /* step length of the conjugate gradients, and their update of the direction */
    double sum[STRIPS];
} fusion;

static status fusion_new(const img *mask, fusion *f)
{
    const coverage_box box = coverage_box_of(mask);
    *f = (fusion){.width = (size_t)mask->width};
    f->top = (size_t)box.top;
    f->first = f->width * f->top;
    f->count = box.pixels > 0 ? f->width * (size_t)(box.bottom - box.top) : 0;
    size_t length = f->count + 2 * f->width;
    f->memory = calloc(ARRAYS * length, sizeof *f->memory);
    if (!f->memory)
        return fail(MERLIN_NO_MEMORY, "no memory to fuse depth and normals of %dx%d", mask->width, mask->height);
    float **arrays[ARRAYS] = {&f->right, &f->down, &f->step_right, &f->step_down, &f->residual, &f->u};
    for (size_t i = 0; i < ARRAYS; i++)
        *arrays[i] = f->memory + i * length + f->width;
    f->product = f->step_right;
    f->direction = f->step_down;
    return OK;
}

static float cosine(const float *normal, vec3 ray)
{
    float c = -(normal[0] * ray.x + normal[1] * ray.y + normal[2] * ray.z);
    return c > LEAST_COSINE ? c : LEAST_COSINE;
}

/* Returns ln(z_j / z_i) by the mean of both pixels' planes. */
static float step_between(const float *n_i, const float *n_j, vec3 r_i, vec3 r_j)
{
    return 0.5f * logf(cosine(n_i, r_i) * cosine(n_j, r_i) / (cosine(n_i, r_j) * cosine(n_j, r_j)));
}

/* Adds the pair of pixels i and j to the system. normal: from the first one on. */
static void join(fusion *f, const float *normal, size_t i, size_t j, vec3 r_i, vec3 r_j, float jump)
{
    float step = step_between(normal + 3 * i, normal + 3 * j, r_i, r_j);
    float e = (f->u[j] - f->u[i] - step) / jump, weight = 1 / (1 + e * e * e * e);
    if (j == i + 1) {
        f->right[i] = weight;
        f->step_right[i] = step;
    } else {
        f->down[i] = weight;
        f->step_down[i] = step;
    }
}

typedef struct joining {
    fusion *f;
    const img *normal, *mask;
    const camera *view;
} joining;

static void join_rows(void *context, size_t begin, size_t end)
{
    const joining *j = context;
    fusion *f = j->f;
    const float *mask = j->mask->data + f->first, *normal = j->normal->data + 3 * f->first;
    const float jump = JUMP * camera_pixel_size(j->view), top = (float)f->top;
    for (size_t y = begin; y < end; y++) {
        for (size_t x = 0; x < f->width; x++) {
            size_t i = y * f->width + x;
            float column = (float)x, row = top + (float)y;
            if (mask[i] < 0.5f) continue;
            vec3 ray = camera_point(j->view, column + 0.5f, row + 0.5f, 1);
            if (x + 1 < f->width && mask[i + 1] >= 0.5f)
                join(f, normal, i, i + 1, ray, camera_point(j->view, column + 1.5f, row + 0.5f, 1), jump);
            if (i + f->width < f->count && mask[i + f->width] >= 0.5f)
                join(f, normal, i, i + f->width, ray, camera_point(j->view, column + 0.5f, row + 1.5f, 1), jump);
        }
    }
}

/* ---- strips of fixed pixels, so that sums do not depend on the number of threads ---- */

typedef struct strip {
    size_t begin, end;
} strip;

static strip strip_at(const fusion *f, size_t i)
{
    return (strip){f->count * i / STRIPS, f->count * (i + 1) / STRIPS};
}

static double sum_up(const fusion *f)
{
    double sum = 0;
    for (int i = 0; i < STRIPS; i++)
        sum += f->sum[i];
    return sum;
}

/* Computes product = A · direction and their scalar product. A pixel's pairs to the left and above are stored with
 * those neighbours. */
static void multiply(void *context, size_t i)
{
    fusion *f = context;
    strip at = strip_at(f, i);
    const float lambda = 1 / (REACH * REACH);
    size_t w = f->width;
    const float *d = f->direction, *before = d - 1, *above = d - w, *after = d + 1, *below = d + w;
    const float *right = f->right, *down = f->down, *left = right - 1, *up = down - w;
    float *out = f->product;
    double sum = 0;
#pragma omp simd reduction(+ : sum)
    for (size_t k = at.begin; k < at.end; k++) {
        out[k] = lambda * d[k] + right[k] * (d[k] - after[k]) + down[k] * (d[k] - below[k]) +
                 left[k] * (d[k] - before[k]) + up[k] * (d[k] - above[k]);
        sum += (double)d[k] * (double)out[k];
    }
    f->sum[i] = sum;
}

/* Updates the solution along the direction, and the residual. */
static void step(void *context, size_t i)
{
    fusion *f = context;
    strip at = strip_at(f, i);
    const float *direction = f->direction, *product = f->product;
    float *u = f->u, *residual = f->residual, length = f->length;
    double sum = 0;
#pragma omp simd reduction(+ : sum)
    for (size_t k = at.begin; k < at.end; k++) {
        u[k] += length * direction[k];
        residual[k] -= length * product[k];
        sum += (double)residual[k] * (double)residual[k];
    }
    f->sum[i] = sum;
}

static void turn(void *context, size_t i)
{
    fusion *f = context;
    strip at = strip_at(f, i);
    const float *residual = f->residual;
    float *direction = f->direction, share = f->turn;
#pragma omp simd
    for (size_t k = at.begin; k < at.end; k++)
        direction[k] = residual[k] + share * direction[k];
}

/* Sets the residual to minus the gradient at u = ln z, where the first sum has none. */
static void start(fusion *f)
{
    const float *u = f->u;
    size_t w = f->width;
    for (size_t i = 0; i < f->count; i++) {
        float *r = f->residual + i, right = f->right[i] * (u[i + 1] - u[i] - f->step_right[i]);
        float down = f->down[i] * (u[i + w] - u[i] - f->step_down[i]);
        *r += right + down;
        *(r + 1) -= right;
        *(r + w) -= down;
    }
    memcpy(f->direction, f->residual, f->count * sizeof *f->direction);
}

/* Solves the system by conjugate gradients. */
static void solve(fusion *f)
{
    double error = 0;
    for (size_t k = 0; k < f->count; k++)
        error += (double)f->residual[k] * (double)f->residual[k];
    double enough = RESIDUAL * error;
    for (int i = 0; i < ITERATIONS * (int)REACH && error > enough; i++) {
        double before = error;
        parallel_for(STRIPS, multiply, f);
        f->length = (float)(error / sum_up(f));
        parallel_for(STRIPS, step, f);
        error = sum_up(f);
        f->turn = (float)(error / before);
        parallel_for(STRIPS, turn, f);
    }
}

status fuse_depth(const img *normal, const img *mask, camera_lens lens, img *depth)
{
    fusion f;
    status s = fusion_new(mask, &f);
    if (s != OK) return s;
    const camera view = camera_through(lens, mask->width, mask->height);
    const float *inside = mask->data + f.first;
    float *z = depth->data + f.first;
    for (size_t i = 0; i < f.count; i++)
        f.u[i] = inside[i] >= 0.5f ? logf(z[i]) : 0;
    joining all = {&f, normal, mask, &view};
    parallel_blocks(f.count / f.width, join_rows, &all);
    start(&f);
    solve(&f);
    for (size_t i = 0; i < f.count; i++)
        if (inside[i] >= 0.5f) z[i] = expf(f.u[i]);
    free(f.memory);
    return OK;
}
