/* SPDX-License-Identifier: MIT */
#include "stereo/uncalibrated/inflate.h"

#include <math.h>
#include <stdbool.h>
#include <stdlib.h>

#include "base/vec.h"
#include "image/resize.h"

/* Largest side that is solved; larger objects are solved at this size and enlarged, as the time of sweeps grows with
 * the third power of the side, and floats are too inaccurate for the sums of a large one. */
enum { LARGEST = 512 };

/* The unknown u with a border of one row or column of zeros, so that neighbours need no test for the edges. */
typedef struct field {
    int width, height;
    float *u;
    unsigned char *inside;
} field;

static size_t field_at(const field *f, int x, int y)
{
    return (size_t)(y + 1) * (size_t)(f->width + 2) + (size_t)(x + 1);
}

static void field_free(field *f)
{
    free(f->u);
    free(f->inside);
    *f = (field){0};
}

static status field_new(const img *mask, field *f)
{
    size_t count = (size_t)(mask->width + 2) * (size_t)(mask->height + 2);
    *f = (field){mask->width, mask->height, calloc(count, sizeof *f->u), calloc(count, 1)};
    if (!f->u || !f->inside) {
        field_free(f);
        return fail(MERLIN_NO_MEMORY, "no memory to inflate a mask of %dx%d", mask->width, mask->height);
    }
    for (int y = 0; y < f->height; y++)
        for (int x = 0; x < f->width; x++)
            f->inside[field_at(f, x, y)] = *img_at(mask, x, y) > 0.5f;
    return OK;
}

/* Solves by successive over-relaxation with Young's optimal factor for a square of the picture's longer side; three
 * sweeps per pixel of that side reduce the error far below that of the mask's edges of half a pixel. */
static void solve_poisson(field *f)
{
    int side = f->width > f->height ? f->width : f->height;
    float omega = 2 / (1 + sinf(3.14159265f / (float)(side + 1)));
    size_t stride = (size_t)f->width + 2;
    for (int sweep = 0; sweep < 3 * side; sweep++) {
        for (int y = 0; y < f->height; y++) {
            for (int x = 0; x < f->width; x++) {
                size_t i = field_at(f, x, y);
                if (!f->inside[i]) continue;
                float mean = (f->u[i - 1] + f->u[i + 1] + f->u[i - stride] + f->u[i + stride]) / 4 + 1;
                f->u[i] += omega * (mean - f->u[i]);
            }
        }
    }
}

typedef struct box {
    int x, y, width, height;
} box;

static box box_of(const field *f)
{
    int left = f->width, right = -1, top = f->height, bottom = -1;
    for (int y = 0; y < f->height; y++) {
        for (int x = 0; x < f->width; x++) {
            if (!f->inside[field_at(f, x, y)]) continue;
            left = x < left ? x : left;
            right = x > right ? x : right;
            top = y < top ? y : top;
            bottom = y;
        }
    }
    return right < 0 ? (box){0, 0, 1, 1} : (box){left, top, right - left + 1, bottom - top + 1};
}

/* Computes u for the part of the mask in the box, in its size. */
static status solve_smaller(const img *mask, const box *b, float shrink, img *u)
{
    img part = {0}, small_mask = {0}, small = {0};
    int width = (int)ceilf((float)b->width / shrink), height = (int)ceilf((float)b->height / shrink);
    status s = img_crop(mask, b->x, b->y, b->width, b->height, &part);
    if (s == OK) s = img_resize(&part, width, height, &small_mask);
    field f = {0};
    if (s == OK) s = field_new(&small_mask, &f);
    if (s == OK) s = img_new(&small, width, height, 1);
    if (s == OK) {
        solve_poisson(&f);
        float area = (float)b->width / (float)width * ((float)b->height / (float)height);
        for (int y = 0; y < height; y++)
            for (int x = 0; x < width; x++)
                *img_at(&small, x, y) = area * f.u[field_at(&f, x, y)];
        s = img_resize(&small, b->width, b->height, u);
    }
    field_free(&f);
    img_free(&part);
    img_free(&small_mask);
    img_free(&small);
    return s;
}

static status solve(const img *mask, field *f)
{
    box b = box_of(f);
    float shrink = (float)(b.width > b.height ? b.width : b.height) / LARGEST;
    if (shrink <= 1 && f->width <= LARGEST && f->height <= LARGEST) {
        solve_poisson(f);
        return OK;
    }
    img u = {0};
    status s = solve_smaller(mask, &b, fmaxf(1, shrink), &u);
    for (int y = 0; s == OK && y < b.height; y++) {
        for (int x = 0; x < b.width; x++) {
            size_t i = field_at(f, b.x + x, b.y + y);
            if (f->inside[i]) f->u[i] = fmaxf(0, *img_at(&u, x, y));
        }
    }
    img_free(&u);
    return s;
}

/* Writes normals and heights. With h = √u the normal (-∂h/∂x, -∂h/∂y, 1) is parallel to (-∂u/∂x, -∂u/∂y, 2 √u), which
 * is finite at the edge. */
static void write_surface(const field *f, img *normal, img *height)
{
    size_t stride = (size_t)f->width + 2;
    for (int y = 0; y < f->height; y++) {
        for (int x = 0; x < f->width; x++) {
            size_t i = field_at(f, x, y);
            if (!f->inside[i]) continue;
            float h = sqrtf(f->u[i] > 0 ? f->u[i] : 0);
            vec3 n = {(f->u[i - 1] - f->u[i + 1]) / 2, (f->u[i + stride] - f->u[i - stride]) / 2, 2 * h + 1e-6f};
            n = vec3_normalize(n);
            float *o = img_at(normal, x, y);
            vec3_put(n, o);
            *img_at(height, x, y) = h;
        }
    }
}

status pst_inflate(const img *mask, img *normal, img *height)
{
    *normal = *height = (img){0};
    field f = {0};
    status s = field_new(mask, &f);
    if (s == OK) s = solve(mask, &f);
    if (s == OK) s = img_new(normal, mask->width, mask->height, 3);
    if (s == OK) s = img_new(height, mask->width, mask->height, 1);
    if (s == OK)
        write_surface(&f, normal, height);
    else
        img_free(normal);
    field_free(&f);
    return s;
}
