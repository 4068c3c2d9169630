/* SPDX-License-Identifier: MIT */
#include "nn/cpu/winograd/winograd_tiles.h"

#include <string.h>

#include "nn/cpu/winograd/winograd_points.h"

static size_t tiles_across(int size)
{
    return ((size_t)size + TILE - 1) / TILE;
}

size_t winograd_tiles(const winograd *g)
{
    return (size_t)g->n * tiles_across(g->h) * tiles_across(g->w);
}

typedef struct corner {
    int image, y, x; /* position of a tile's first pixel */
} corner;

static corner corner_of(const winograd *g, size_t tile)
{
    size_t across = tiles_across(g->w), down = tiles_across(g->h);
    return (corner){(int)(tile / (across * down)), (int)(tile / across % down) * TILE, (int)(tile % across) * TILE};
}

static size_t element_bytes(nn_type type)
{
    return type == NN_FLOAT32 ? sizeof(float) : sizeof(uint16_t);
}

/* Returns the number of elements before a pixel. */
static size_t place_of(const winograd *g, int channels, corner at)
{
    size_t pixel = ((size_t)at.image * (size_t)g->h + (size_t)at.y) * (size_t)g->w + (size_t)at.x;
    return pixel * (size_t)channels;
}

static const char *pixel_at(const winograd *g, const void *x, nn_type type, int channels, corner at)
{
    return (const char *)x + place_of(g, channels, at) * element_bytes(type);
}

/* Returns a square of side × side pixels, in place or copied with zeros outside the image. */
static square look_at(const winograd *g, const void *x, nn_type type, int channels, corner at, int side, char *copy)
{
    const size_t pixel = (size_t)channels * element_bytes(type);
    int top = at.y < 0 ? -at.y : 0, left = at.x < 0 ? -at.x : 0, bottom = g->h - at.y, right = g->w - at.x;
    if (top == 0 && left == 0 && bottom >= side && right >= side)
        return (square){pixel_at(g, x, type, channels, at), (size_t)g->w * (size_t)channels};
    bottom = bottom < side ? bottom : side;
    right = right < side ? right : side;
    memset(copy, 0, (size_t)(side * side) * pixel);
    for (int i = top; i < bottom; i++)
        memcpy(copy + (size_t)(i * side + left) * pixel,
               pixel_at(g, x, type, channels, (corner){at.image, at.y + i, at.x + left}),
               (size_t)(right - left) * pixel);
    return (square){copy, (size_t)(side * channels)};
}

ALWAYS_INLINE void take(square from, const nn_type type, size_t channels, const size_t side, line_map map, float *to,
                        size_t stride)
{
    for (size_t c = 0; c < channels; c += WIDE)
        to_points(from, type, c, channels, side, map, to + c, stride);
}

void winograd_take_window(const winograd *g, const void *x, size_t tile, void *copy, float *to, size_t stride)
{
    corner at = corner_of(g, tile);
    at = (corner){at.image, at.y - 1, at.x - 1};
    square from = look_at(g, x, g->from, g->in, at, WINDOW, copy);
    if (g->from == NN_FLOAT32)
        take(from, NN_FLOAT32, (size_t)g->in, WINDOW, input_line, to, stride);
    else
        take(from, NN_BFLOAT16, (size_t)g->in, WINDOW, input_line, to, stride);
}

void winograd_take_result_back(const winograd *g, const void *dy, size_t tile, void *copy, float *to, size_t stride)
{
    square from = look_at(g, dy, g->to, g->out, corner_of(g, tile), TILE, copy);
    if (g->to == NN_FLOAT32)
        take(from, NN_FLOAT32, (size_t)g->out, TILE, output_line_back, to, stride);
    else
        take(from, NN_BFLOAT16, (size_t)g->out, TILE, output_line_back, to, stride);
}

/* Stores a register of results at element `at` of y, which is its channel c. */
ALWAYS_INLINE void finish(wide *v, const winograd *g, const winograd_after *after, size_t c, void *y, size_t at,
                          const nn_type type)
{
    wide other;
    if (after->bias) {
        wide_load(&other, after->bias + c);
        *v += other;
    }
    if (after->beside) {
        wide_read(&other, after->beside, at, g->from);
        *v += other;
    }
    if (after->accumulate) {
        wide_read(&other, y, at, type);
        *v += other;
    }
    if (after->relu) *v = (wide)((wide_bits)*v & ~(*v < 0)); /* NaN passes, so that a diverged run is visible */
    wide_write(v, y, at, type);
}

ALWAYS_INLINE void put(const winograd *g, const float *from, size_t stride, const winograd_after *after, corner at,
                       void *y, const nn_type type)
{
    const size_t channels = (size_t)g->out, row = (size_t)g->w * channels, first = place_of(g, g->out, at);
    const size_t rows = (size_t)(g->h - at.y), columns = (size_t)(g->w - at.x); /* rows and columns left in the image */
    for (size_t c = 0; c < channels; c += WIDE) {
        wide pixel[TILE][TILE];
        from_points(from + c, stride, TILE, output_line, pixel[0]);
        for (size_t i = 0; i < TILE && i < rows; i++)
#pragma GCC unroll 6
            for (size_t j = 0; j < TILE; j++)
                if (j < columns) finish(&pixel[i][j], g, after, c, y, first + i * row + j * channels + c, type);
    }
}

void winograd_put_result(const winograd *g, const float *from, size_t stride, const winograd_after *after, size_t tile,
                         void *y)
{
    if (g->to == NN_FLOAT32)
        put(g, from, stride, after, corner_of(g, tile), y, NN_FLOAT32);
    else
        put(g, from, stride, after, corner_of(g, tile), y, NN_BFLOAT16);
}
