/* SPDX-License-Identifier: MIT */
#include "estimate/object/object_holes.h"

#include <stdlib.h>
#include <string.h>

static const float LEAST_HOLE = 0.01f, LIKE = 0.035f, DARK = 0.2f;
/* Number of pixels beyond an outline whose colours are mixed, and the states of a pixel. */
enum { BEYOND = 2, NOT_LIKE = 0, IS_LIKE, IS_SEEN, IS_HOLE };

static bool is_like(const object_view *v, size_t one, size_t other)
{
    const float *a = v->color.data + 3 * one, *b = v->color.data + 3 * other;
    float r = a[0] - b[0], g = a[1] - b[1], c = a[2] - b[2];
    return r * r + g * g + c * c < 3 * LIKE * LIKE && b[0] + b[1] + b[2] > 3 * DARK;
}

/* Goes along a row or column and compares each pixel of the object with the last background pixel before it. */
static void compare_along(const object_view *v, const uint8_t *object, size_t first, ptrdiff_t step, int count,
                          uint8_t *hole)
{
    size_t last = 0;
    int outside = 0; /* number of successive background pixels */
    bool known = false;
    for (int k = 0; k < count; k++) {
        size_t at = (size_t)((ptrdiff_t)first + k * step);
        outside = object[at] ? 0 : outside + 1;
        if (outside > BEYOND) {
            last = (size_t)((ptrdiff_t)at - BEYOND * step);
            known = true;
        }
        if (known && object[at] && is_like(v, at, last)) hole[at] = IS_LIKE;
    }
}

static void compare_all(const object_view *v, const uint8_t *object, uint8_t *hole)
{
    const size_t width = (size_t)v->width, height = (size_t)v->height;
    for (size_t y = 0; y < height; y++) {
        compare_along(v, object, y * width, 1, v->width, hole);
        compare_along(v, object, y * width + width - 1, -1, v->width, hole);
    }
    for (size_t x = 0; x < width; x++) {
        compare_along(v, object, x, (ptrdiff_t)width, v->height, hole);
        compare_along(v, object, (height - 1) * width + x, -(ptrdiff_t)width, v->height, hole);
    }
}

/* Changes the connected pixels of value `from` around start to `to`; returns their number. */
static size_t flood(const object_view *v, uint8_t *hole, size_t *stack, size_t start, uint8_t from, uint8_t to)
{
    size_t depth = 0, sum = 0;
    hole[start] = to;
    stack[depth++] = start;
    while (depth) {
        size_t at = stack[--depth], next[4];
        sum++;
        int count = img_beside(v->width, v->height, at, next);
        for (int i = 0; i < count; i++) {
            if (hole[next[i]] != from) continue;
            hole[next[i]] = to;
            stack[depth++] = next[i];
        }
    }
    return sum;
}

status object_holes_find(const object_view *v, const uint8_t *object, uint8_t *hole, bool *any)
{
    size_t *stack = malloc(v->count * sizeof *stack);
    if (!stack) return fail(MERLIN_NO_MEMORY, "no memory to look for the object");
    *any = false;
    memset(hole, NOT_LIKE, v->count);
    compare_all(v, object, hole);
    for (size_t i = 0; i < v->count; i++) {
        if (hole[i] != IS_LIKE) continue;
        bool large = (float)flood(v, hole, stack, i, IS_LIKE, IS_SEEN) >= LEAST_HOLE * (float)v->count;
        flood(v, hole, stack, i, IS_SEEN, large ? IS_HOLE : NOT_LIKE);
        *any |= large;
    }
    for (size_t i = 0; i < v->count; i++)
        hole[i] = hole[i] == IS_HOLE;
    free(stack);
    return OK;
}
