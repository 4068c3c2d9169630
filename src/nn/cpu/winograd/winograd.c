/* SPDX-License-Identifier: MIT */
#include "nn/cpu/winograd/winograd.h"

#include <omp.h>

#include "nn/cpu/kernels/kernels.h"
#include "nn/cpu/winograd/winograd_points.h"
#include "nn/cpu/winograd/winograd_product.h"
#include "nn/cpu/winograd/winograd_tiles.h"

/* Floats of padding between the points' matrices, whose size is a multiple of 4 KiB: without it they would compete for
 * the same few cache lines. */
enum { APART = 16 };

/* Floats of a block of tiles, before and after the products, that fit the second-level cache together with one point's
 * weights; bounds of the number of tiles. */
enum { BLOCK_FLOATS = 160 * 1024, MOST_TILES = 48, GRADIENT_TILES = 96 };

/* ---- weights ---- */

size_t winograd_weights(int in, int out)
{
    return (size_t)POINTS * (size_t)in * (size_t)out;
}

/* Returns the number of values in the panel that begins at this output; the last may be narrower. */
static size_t panel_width(size_t outputs, size_t first)
{
    return outputs - first < WINOGRAD_PANEL ? outputs - first : WINOGRAD_PANEL;
}

/* Returns where an output's weight for an input is at a point: [panel of outputs][input][output in it]. */
static float *weights_at(float *u, int inputs, int outputs, int input, int output)
{
    size_t at = (size_t)output % WINOGRAD_PANEL, first = (size_t)output - at;
    return u + first * (size_t)inputs + (size_t)input * panel_width((size_t)outputs, first) + at;
}

/* Transforms a register of kernels, `apart` floats from one to the next, to the points; rotated by half a turn or not.
 */
ALWAYS_INLINE void take_kernels(const float *kernel, size_t apart, const bool turned, float *to, size_t stride)
{
    float tap[TAPS][WIDE];
    for (size_t k = 0; k < WIDE; k++)
        for (size_t t = 0; t < TAPS; t++)
            tap[turned ? TAPS - 1 - t : t][k] = kernel[k * apart + t];
    to_points((square){tap[0], KERNEL * WIDE}, NN_FLOAT32, 0, WIDE, KERNEL, kernel_line, to, stride);
}

void winograd_transform(const float *weight, int in, int out, float *u)
{
    const size_t row = (size_t)in * TAPS, stride = (size_t)in * (size_t)out;
#pragma omp parallel for schedule(static)
    for (int o = 0; o < out; o += WIDE)
        for (int i = 0; i < in; i++)
            take_kernels(weight + (size_t)o * row + (size_t)i * TAPS, row, false, weights_at(u, in, out, i, o), stride);
}

/* Transforms with inputs and outputs exchanged. */
void winograd_transform_back(const float *weight, int in, int out, float *u)
{
    const size_t row = (size_t)in * TAPS, stride = (size_t)in * (size_t)out;
#pragma omp parallel for schedule(static)
    for (int i = 0; i < in; i += WIDE)
        for (int o = 0; o < out; o++)
            take_kernels(weight + (size_t)o * row + (size_t)i * TAPS, TAPS, true, weights_at(u, out, in, o, i), stride);
}

/* ---- the convolution ---- */

/* Returns the tiles of a block: few enough that every thread gets several even of a small picture. */
static size_t block_tiles(const winograd *g)
{
    size_t fit = BLOCK_FLOATS / (size_t)(POINTS * (g->in + g->out)) / WINOGRAD_ROWS * WINOGRAD_ROWS;
    size_t share = (winograd_tiles(g) + (size_t)g->threads - 1) / (size_t)g->threads;
    size_t most = fit < MOST_TILES ? fit : MOST_TILES;
    most = most < share ? most : share;
    return most > WINOGRAD_ROWS ? most : WINOGRAD_ROWS;
}

/* Return the floats of a block's tiles at one point, and at all points. */
static size_t point_stride(size_t tiles, int channels)
{
    return tiles * (size_t)channels + APART;
}

static size_t points_room(size_t tiles, int channels)
{
    return POINTS * point_stride(tiles, channels);
}

/* Returns the room for a copy of a square at the border. */
static size_t copy_room(const winograd *g)
{
    return POINTS * (size_t)(g->in > g->out ? g->in : g->out);
}

static size_t thread_room(const winograd *g)
{
    return points_room(block_tiles(g), g->in) + points_room(block_tiles(g), g->out) + copy_room(g);
}

size_t winograd_room(const winograd *g)
{
    return (size_t)g->threads * thread_room(g);
}

static void multiply_points(const winograd *g, size_t tiles, const float *v, size_t v_stride, const float *u, float *m,
                            size_t m_stride)
{
    size_t in = (size_t)g->in, out = (size_t)g->out;
    for (size_t point = 0; point < POINTS; point++)
        for (size_t o = 0; o < out; o += WINOGRAD_PANEL) {
            const size_t width = panel_width(out, o);
            winograd_multiply((winograd_product){.a = v + point * v_stride,
                                                 .b = u + point * in * out + o * in,
                                                 .c = m + point * m_stride + o,
                                                 .a_row = in,
                                                 .a_next = 1,
                                                 .b_next = width,
                                                 .c_row = out,
                                                 .depth = g->in},
                              tiles, width);
        }
}

void winograd_convolve(const winograd *g, const void *x, const float *u, const winograd_after *after, void *y,
                       float *room)
{
    const size_t tiles = winograd_tiles(g), size = block_tiles(g), blocks = (tiles + size - 1) / size;
    const size_t v_stride = point_stride(size, g->in), m_stride = point_stride(size, g->out);
#pragma omp parallel num_threads(g->threads)
    {
        float *v = room + (size_t)omp_get_thread_num() * thread_room(g), *m = v + points_room(size, g->in),
              *copy = m + points_room(size, g->out);
#pragma omp for schedule(dynamic)
        for (size_t b = 0; b < blocks; b++) {
            size_t first = b * size, count = tiles - first < size ? tiles - first : size;
            for (size_t t = 0; t < count; t++)
                winograd_take_window(g, x, first + t, copy, v + t * (size_t)g->in, v_stride);
            multiply_points(g, count, v, v_stride, u, m, m_stride);
            for (size_t t = 0; t < count; t++)
                winograd_put_result(g, m + t * (size_t)g->out, m_stride, after, first + t, y);
        }
    }
}

/* ---- the weights' gradient ---- */

/* Transforms the points of a register of outputs for one input back to taps. */
static void put_kernels(const float *from, size_t stride, int in, int input, int output, float *dw)
{
    const size_t row = (size_t)in * TAPS;
    float *to = dw + (size_t)output * row + (size_t)input * TAPS;
    wide tap[TAPS];
    from_points(from, stride, KERNEL, kernel_line_back, tap);
    for (size_t k = 0; k < WIDE; k++)
        for (size_t t = 0; t < TAPS; t++)
            to[k * row + t] = tap[t][k];
}

size_t winograd_gradient_room(const winograd *g)
{
    return winograd_weights(g->in, g->out) + points_room(GRADIENT_TILES, g->in) + points_room(GRADIENT_TILES, g->out) +
           (size_t)g->threads * copy_room(g);
}

/* Adds products of some tiles to the sums at one point: [input][output]. */
static void add_products(const winograd *g, size_t tiles, const float *v, const float *m, bool first, float *sums)
{
    size_t in = (size_t)g->in, out = (size_t)g->out;
    for (size_t o = 0; o < out; o += WINOGRAD_PANEL)
        winograd_multiply((winograd_product){.a = v,
                                             .b = m + o,
                                             .c = sums + o,
                                             .a_row = 1,
                                             .a_next = in,
                                             .b_next = out,
                                             .c_row = out,
                                             .depth = (int)tiles,
                                             .add = !first},
                          in, panel_width(out, o));
}

/* Processes the same tiles in all threads, which share the points, so that every sum has one order. */
void winograd_gradient(const winograd *g, const void *x, const void *dy, float *dw, float *room)
{
    const size_t tiles = winograd_tiles(g), in = (size_t)g->in, out = (size_t)g->out, matrix = in * out;
    const size_t v_stride = point_stride(GRADIENT_TILES, g->in), m_stride = point_stride(GRADIENT_TILES, g->out);
    float *sums = room, *v = sums + POINTS * matrix, *m = v + points_room(GRADIENT_TILES, g->in),
          *copies = m + points_room(GRADIENT_TILES, g->out);
#pragma omp parallel num_threads(g->threads)
    {
        float *copy = copies + (size_t)omp_get_thread_num() * copy_room(g);
        for (size_t first = 0; first < tiles; first += GRADIENT_TILES) {
            size_t count = tiles - first < GRADIENT_TILES ? tiles - first : GRADIENT_TILES;
#pragma omp for schedule(static)
            for (size_t t = 0; t < count; t++) {
                winograd_take_window(g, x, first + t, copy, v + t * in, v_stride);
                winograd_take_result_back(g, dy, first + t, copy, m + t * out, m_stride);
            }
#pragma omp for schedule(static)
            for (size_t point = 0; point < POINTS; point++)
                add_products(g, count, v + point * v_stride, m + point * m_stride, first == 0, sums + point * matrix);
        }
#pragma omp for schedule(static)
        for (int i = 0; i < g->in; i++)
            for (int o = 0; o < g->out; o += WIDE)
                put_kernels(sums + (size_t)i * out + (size_t)o, matrix, g->in, i, o, dw);
    }
}
