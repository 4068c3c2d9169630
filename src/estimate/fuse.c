#include "estimate/fuse.h"

#include <stdlib.h>
#include <string.h>

#include "optics/camera.h"

/* ℓ and σ in pixels; σ a slope: depth steps of three pixels' size against the normals begin to count as jumps. */
static const float REACH = 20, JUMP = 3;
/* Grazing normals say little about depth. */
static const float LEAST_COSINE = 0.1f;
/* The conjugate gradients' error is far below a pixel's size after this many steps of ℓ. */
static const int ITERATIONS = 4;
static const double RESIDUAL = 1e-6;

/* The linear system, one value a pixel, rows from the top. Behind and before each array lies a row of zeros, so that
 * every pixel has four neighbours. */
typedef struct fusion {
    size_t width, count;
    float *memory;
    float *right, *down;           /* w of the pair with the pixel to the right, below */
    float *step_right, *step_down; /* what the normals say of that pair */
    float *u, *residual, *direction, *product;
} fusion;

enum { ARRAYS = 8 };

static status fusion_new(const img *mask, fusion *f)
{
    *f = (fusion){.width = (size_t)mask->width, .count = (size_t)mask->width * (size_t)mask->height};
    size_t length = f->count + 2 * f->width;
    f->memory = calloc(ARRAYS * length, sizeof *f->memory);
    if (!f->memory)
        return fail(ERROR_MEMORY, "no memory to fuse depth and normals of %dx%d", mask->width, mask->height);
    float **arrays[ARRAYS] = {&f->right,    &f->down, &f->step_right, &f->step_down,
                              &f->residual, &f->u,    &f->direction,  &f->product};
    for (size_t i = 0; i < ARRAYS; i++)
        *arrays[i] = f->memory + i * length + f->width;
    return OK;
}

static float cosine(const float *normal, vec3 ray)
{
    float c = -(normal[0] * ray.x + normal[1] * ray.y + normal[2] * ray.z);
    return c > LEAST_COSINE ? c : LEAST_COSINE;
}

/* ln(z_j / z_i) by the mean of both pixels' planes. */
static float step_between(const float *n_i, const float *n_j, vec3 r_i, vec3 r_j)
{
    return 0.5f * logf(cosine(n_i, r_i) * cosine(n_j, r_i) / (cosine(n_i, r_j) * cosine(n_j, r_j)));
}

/* The pair (i, j). */
static void join(fusion *f, const img *normal, size_t i, size_t j, vec3 r_i, vec3 r_j, float jump)
{
    float step = step_between(normal->data + 3 * i, normal->data + 3 * j, r_i, r_j);
    float e = (f->u[j] - f->u[i] - step) / jump, weight = 1 / (1 + e * e * e * e);
    if (j == i + 1) {
        f->right[i] = weight;
        f->step_right[i] = step;
    } else {
        f->down[i] = weight;
        f->step_down[i] = step;
    }
}

static void join_all(fusion *f, const img *normal, const img *mask, const camera *view)
{
    float jump = JUMP * camera_pixel_size(view);
    for (int y = 0; y < mask->height; y++) {
        for (int x = 0; x < mask->width; x++) {
            size_t i = (size_t)y * f->width + (size_t)x;
            if (mask->data[i] < 0.5f) continue;
            vec3 ray = camera_point(view, (float)x + 0.5f, (float)y + 0.5f, 1);
            if (x + 1 < mask->width && mask->data[i + 1] >= 0.5f)
                join(f, normal, i, i + 1, ray, camera_point(view, (float)x + 1.5f, (float)y + 0.5f, 1), jump);
            if (y + 1 < mask->height && mask->data[i + f->width] >= 0.5f)
                join(f, normal, i, i + f->width, ray, camera_point(view, (float)x + 0.5f, (float)y + 1.5f, 1), jump);
        }
    }
}

/* product = A direction. A pixel's pairs with the left and above are kept by those neighbours. */
static void multiply(const fusion *f, float lambda)
{
    size_t w = f->width;
    const float *d = f->direction, *before = d - 1, *above = d - w, *after = d + 1, *below = d + w;
    const float *right = f->right, *down = f->down, *left = right - 1, *up = down - w;
    float *out = f->product;
#pragma omp simd
    for (size_t i = 0; i < f->count; i++)
        out[i] = lambda * d[i] + right[i] * (d[i] - after[i]) + down[i] * (d[i] - below[i]) +
                 left[i] * (d[i] - before[i]) + up[i] * (d[i] - above[i]);
}

/* Minus the gradient at u = ln z, where the first sum has none. */
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

static double dot(const float *a, const float *b, size_t count)
{
    double sum = 0;
#pragma omp simd reduction(+ : sum)
    for (size_t i = 0; i < count; i++)
        sum += (double)a[i] * (double)b[i];
    return sum;
}

/* Conjugate gradients. */
static void solve(fusion *f)
{
    size_t n = f->count;
    double error = dot(f->residual, f->residual, n), enough = RESIDUAL * error;
    for (int i = 0; i < ITERATIONS * (int)REACH && error > enough; i++) {
        multiply(f, 1 / (REACH * REACH));
        float length = (float)(error / dot(f->direction, f->product, n));
        for (size_t k = 0; k < n; k++) {
            f->u[k] += length * f->direction[k];
            f->residual[k] -= length * f->product[k];
        }
        double before = error;
        error = dot(f->residual, f->residual, n);
        float turn = (float)(error / before);
        for (size_t k = 0; k < n; k++)
            f->direction[k] = f->residual[k] + turn * f->direction[k];
    }
}

status fuse_depth(const img *normal, const img *mask, float fov, img *depth)
{
    fusion f;
    status s = fusion_new(mask, &f);
    if (s != OK) return s;
    camera view = {mask->width, mask->height, fov};
    for (size_t i = 0; i < f.count; i++)
        f.u[i] = mask->data[i] >= 0.5f ? logf(depth->data[i]) : 0;
    join_all(&f, normal, mask, &view);
    start(&f);
    solve(&f);
    for (size_t i = 0; i < f.count; i++)
        if (mask->data[i] >= 0.5f) depth->data[i] = expf(f.u[i]);
    free(f.memory);
    return OK;
}
