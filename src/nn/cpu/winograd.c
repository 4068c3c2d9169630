#include "nn/cpu/winograd.h"

#include <omp.h>
#include <string.h>

#include "nn/cpu/kernels.h"
#include "nn/cpu/winograd_lines.h"

/* A tile of the result, of what it is made of, of the kernel; values of the last two; channels that the products'
 * innermost loop makes at once, and tiles. */
enum {
    TILE = 4,
    WINDOW = 6,
    KERNEL = 3,
    POINTS = WINDOW * WINDOW,
    TAPS = KERNEL * KERNEL,
    PANEL = WINOGRAD_CHANNELS,
    ROWS = 6
};

/* Floats between the points' matrices beyond their size, which would be a multiple of 4 KiB: then all were kept in the
 * same few lines of a cache. */
enum { APART = 16 };

/* Floats of a block of tiles, before and after the products: what stays in a second-level cache beside a point's
 * weights. */
enum { BLOCK_FLOATS = 160 * 1024, MOST_TILES = 48, GRADIENT_TILES = 96 };

/* ---- tiles ---- */

static size_t tiles_across(int size)
{
    return ((size_t)size + TILE - 1) / TILE;
}

size_t winograd_tiles(const winograd *g)
{
    return (size_t)g->n * tiles_across(g->h) * tiles_across(g->w);
}

typedef struct corner {
    int image, y, x; /* of a tile's first pixel */
} corner;

static corner corner_of(const winograd *g, size_t tile)
{
    size_t across = tiles_across(g->w), down = tiles_across(g->h);
    return (corner){(int)(tile / (across * down)), (int)(tile / across % down) * TILE, (int)(tile % across) * TILE};
}

/* A square of pixels: channels side by side, floats from one row to the next. */
typedef struct square {
    const float *first;
    size_t row;
} square;

static const float *pixel_at(const winograd *g, const float *x, int channels, corner at)
{
    size_t pixel = ((size_t)at.image * (size_t)g->h + (size_t)at.y) * (size_t)g->w + (size_t)at.x;
    return x + pixel * (size_t)channels;
}

/* In place, or copied with zeros outside of the image. */
static square look_at(const winograd *g, const float *x, int channels, corner at, int side, float *copy)
{
    const size_t pixel = (size_t)channels, row = (size_t)g->w * pixel;
    int top = at.y < 0 ? -at.y : 0, left = at.x < 0 ? -at.x : 0, bottom = g->h - at.y, right = g->w - at.x;
    if (top == 0 && left == 0 && bottom >= side && right >= side) return (square){pixel_at(g, x, channels, at), row};
    bottom = bottom < side ? bottom : side;
    right = right < side ? right : side;
    memset(copy, 0, (size_t)(side * side) * pixel * sizeof *copy);
    for (int i = top; i < bottom; i++)
        memcpy(copy + (size_t)(i * side + left) * pixel,
               pixel_at(g, x, channels, (corner){at.image, at.y + i, at.x + left}),
               (size_t)(right - left) * pixel * sizeof *copy);
    return (square){copy, (size_t)side * pixel};
}

/* Eight channels of a square of so many pixels a side to the points, each `stride` floats behind the one before. side
 * and map are constants where this is called. */
ALWAYS_INLINE void to_points(square from, size_t pixel, const size_t side, line_map map, float *to, size_t stride)
{
    eight half[WINDOW][WINDOW];
    for (size_t j = 0; j < side; j++) {
        eight column[WINDOW], mapped[WINDOW];
#pragma GCC unroll 6
        for (size_t i = 0; i < side; i++)
            eight_load(&column[i], from.first + i * from.row + j * pixel);
        map(column, mapped);
#pragma GCC unroll 6
        for (size_t i = 0; i < WINDOW; i++)
            half[i][j] = mapped[i];
    }
    for (size_t i = 0; i < WINDOW; i++) {
        eight mapped[WINDOW];
        map(half[i], mapped);
#pragma GCC unroll 6
        for (size_t j = 0; j < WINDOW; j++)
            eight_store(&mapped[j], to + (i * WINDOW + j) * stride);
    }
}

/* And back: `to` holds side × side. */
ALWAYS_INLINE void from_points(const float *from, size_t stride, const size_t side, line_map map, eight *to)
{
    eight half[WINDOW][WINDOW];
    for (size_t j = 0; j < WINDOW; j++) {
        eight column[WINDOW], mapped[WINDOW];
#pragma GCC unroll 6
        for (size_t i = 0; i < WINDOW; i++)
            eight_load(&column[i], from + (i * WINDOW + j) * stride);
        map(column, mapped);
#pragma GCC unroll 6
        for (size_t i = 0; i < side; i++)
            half[i][j] = mapped[i];
    }
#pragma GCC unroll 6
    for (size_t i = 0; i < side; i++)
        map(half[i], to + i * side);
}

static void take_window(const winograd *g, const float *x, size_t tile, float *copy, float *to, size_t stride)
{
    const size_t channels = (size_t)g->in;
    corner at = corner_of(g, tile);
    square from = look_at(g, x, g->in, (corner){at.image, at.y - 1, at.x - 1}, WINDOW, copy);
    for (size_t c = 0; c < channels; c += EIGHT, from.first += EIGHT)
        to_points(from, channels, WINDOW, input_line, to + c, stride);
}

static void take_result_back(const winograd *g, const float *dy, size_t tile, float *copy, float *to, size_t stride)
{
    const size_t channels = (size_t)g->out;
    square from = look_at(g, dy, g->out, corner_of(g, tile), TILE, copy);
    for (size_t c = 0; c < channels; c += EIGHT, from.first += EIGHT)
        to_points(from, channels, TILE, output_line_back, to + c, stride);
}

ALWAYS_INLINE void finish(eight *v, const winograd_after *after, size_t c, float *to)
{
    eight other;
    if (after->bias) {
        eight_load(&other, after->bias + c);
        *v += other;
    }
    if (after->accumulate) {
        eight_load(&other, to);
        *v += other;
    }
    if (after->relu) *v = (eight)((eight_bits)*v & ~(*v < 0)); /* NaN passes, so that a broken run shows */
    eight_store(v, to);
}

/* Sums at the points to pixels. */
static void put_result(const winograd *g, const float *from, size_t stride, const winograd_after *after, size_t tile,
                       float *y)
{
    const corner at = corner_of(g, tile);
    const size_t channels = (size_t)g->out, row = (size_t)g->w * channels;
    const size_t rows = (size_t)(g->h - at.y), columns = (size_t)(g->w - at.x); /* that there are */
    float *to = y + (pixel_at(g, y, g->out, at) - y);
    for (size_t c = 0; c < channels; c += EIGHT) {
        eight pixel[TILE][TILE];
        from_points(from + c, stride, TILE, output_line, pixel[0]);
        for (size_t i = 0; i < TILE && i < rows; i++)
#pragma GCC unroll 6
            for (size_t j = 0; j < TILE; j++)
                if (j < columns) finish(&pixel[i][j], after, c, to + i * row + j * channels + c);
    }
}

/* ---- products ---- */

/* Some rows (a constant where this is called) of c = a b, or c += a b: a has `depth` values a row, b a row of PANEL for
 * each of them. */
typedef struct product {
    const float *a, *b;
    float *c;
    size_t a_row, a_next, b_next, c_row; /* floats from one to the next */
    int depth;
    bool add;
} product;

ALWAYS_INLINE void multiply_rows(const product *p, const int rows)
{
    eight sum[ROWS][2];
#pragma GCC unroll 6
    for (int r = 0; r < rows; r++) {
        sum[r][0] = sum[r][1] = (eight){0};
        if (!p->add) continue;
        eight_load(&sum[r][0], p->c + (size_t)r * p->c_row);
        eight_load(&sum[r][1], p->c + (size_t)r * p->c_row + EIGHT);
    }
    const float *a = p->a, *b = p->b;
    for (int k = 0; k < p->depth; k++, a += p->a_next, b += p->b_next) {
        eight b0, b1;
        eight_load(&b0, b);
        eight_load(&b1, b + EIGHT);
#pragma GCC unroll 6
        for (int r = 0; r < rows; r++) {
            float v = a[(size_t)r * p->a_row];
            sum[r][0] += v * b0;
            sum[r][1] += v * b1;
        }
    }
#pragma GCC unroll 6
    for (int r = 0; r < rows; r++) {
        eight_store(&sum[r][0], p->c + (size_t)r * p->c_row);
        eight_store(&sum[r][1], p->c + (size_t)r * p->c_row + EIGHT);
    }
}

/* As many rows as there are, ROWS at a time. */
static void multiply(product p, size_t rows)
{
    for (; rows >= ROWS; rows -= ROWS) {
        multiply_rows(&p, ROWS);
        p.a += ROWS * p.a_row;
        p.c += ROWS * p.c_row;
    }
    switch (rows) {
    case 1:
        multiply_rows(&p, 1);
        break;
    case 2:
        multiply_rows(&p, 2);
        break;
    case 3:
        multiply_rows(&p, 3);
        break;
    case 4:
        multiply_rows(&p, 4);
        break;
    case 5:
        multiply_rows(&p, 5);
        break;
    default:
        break;
    }
}

/* ---- weights ---- */

size_t winograd_weights(int in, int out)
{
    return (size_t)POINTS * (size_t)in * (size_t)out;
}

/* Where the weights of eight outputs for an input begin: [point][panel of outputs][input][output in it]. */
static float *weights_at(float *u, int inputs, int input, int output)
{
    return u + ((size_t)(output / PANEL) * (size_t)inputs + (size_t)input) * PANEL + output % PANEL;
}

/* Eight kernels, `apart` floats from one to the next, to the points; turned by half a turn or not. */
ALWAYS_INLINE void take_kernels(const float *kernel, size_t apart, const bool turned, float *to, size_t stride)
{
    float tap[TAPS][EIGHT];
    for (size_t k = 0; k < EIGHT; k++)
        for (size_t t = 0; t < TAPS; t++)
            tap[turned ? TAPS - 1 - t : t][k] = kernel[k * apart + t];
    to_points((square){tap[0], KERNEL * EIGHT}, EIGHT, KERNEL, kernel_line, to, stride);
}

void winograd_transform(const float *weight, int in, int out, float *u)
{
    const size_t row = (size_t)in * TAPS, stride = (size_t)in * (size_t)out;
#pragma omp parallel for schedule(static)
    for (int o = 0; o < out; o += EIGHT)
        for (int i = 0; i < in; i++)
            take_kernels(weight + (size_t)o * row + (size_t)i * TAPS, row, false, weights_at(u, in, i, o), stride);
}

/* Inputs and outputs change places. */
void winograd_transform_back(const float *weight, int in, int out, float *u)
{
    const size_t row = (size_t)in * TAPS, stride = (size_t)in * (size_t)out;
#pragma omp parallel for schedule(static)
    for (int i = 0; i < in; i += EIGHT)
        for (int o = 0; o < out; o++)
            take_kernels(weight + (size_t)o * row + (size_t)i * TAPS, TAPS, true, weights_at(u, out, o, i), stride);
}

/* ---- the convolution ---- */

/* Tiles at a time: a few for every thread even of a small picture. */
static size_t block_tiles(const winograd *g)
{
    size_t fit = BLOCK_FLOATS / (size_t)(POINTS * (g->in + g->out)) / ROWS * ROWS;
    size_t share = (winograd_tiles(g) + (size_t)g->threads - 1) / (size_t)g->threads;
    size_t most = fit < MOST_TILES ? fit : MOST_TILES;
    most = most < share ? most : share;
    return most > ROWS ? most : ROWS;
}

/* Floats of a block's tiles at one point, and at all. */
static size_t point_stride(size_t tiles, int channels)
{
    return tiles * (size_t)channels + APART;
}

static size_t points_room(size_t tiles, int channels)
{
    return POINTS * point_stride(tiles, channels);
}

/* Of a square at the border. */
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
        for (size_t o = 0; o < out; o += PANEL)
            multiply((product){.a = v + point * v_stride,
                               .b = u + point * in * out + o * in,
                               .c = m + point * m_stride + o,
                               .a_row = in,
                               .a_next = 1,
                               .b_next = PANEL,
                               .c_row = out,
                               .depth = g->in},
                     tiles);
}

void winograd_convolve(const winograd *g, const float *x, const float *u, const winograd_after *after, float *y,
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
                take_window(g, x, first + t, copy, v + t * (size_t)g->in, v_stride);
            multiply_points(g, count, v, v_stride, u, m, m_stride);
            for (size_t t = 0; t < count; t++)
                put_result(g, m + t * (size_t)g->out, m_stride, after, first + t, y);
        }
    }
}

/* ---- the weights' gradient ---- */

/* Of eight outputs for an input: what the points have back to taps. */
static void put_kernels(const float *from, size_t stride, int in, int input, int output, float *dw)
{
    const size_t row = (size_t)in * TAPS;
    float *to = dw + (size_t)output * row + (size_t)input * TAPS;
    eight tap[TAPS];
    from_points(from, stride, KERNEL, kernel_line_back, tap);
    for (size_t k = 0; k < EIGHT; k++)
        for (size_t t = 0; t < TAPS; t++)
            to[k * row + t] = tap[t][k];
}

size_t winograd_gradient_room(const winograd *g)
{
    return winograd_weights(g->in, g->out) + points_room(GRADIENT_TILES, g->in) + points_room(GRADIENT_TILES, g->out) +
           (size_t)g->threads * copy_room(g);
}

/* The sums of one point grow by some tiles: [input][output]. */
static void add_products(const winograd *g, size_t tiles, const float *v, const float *m, bool first, float *sums)
{
    size_t in = (size_t)g->in, out = (size_t)g->out;
    for (size_t o = 0; o < out; o += PANEL)
        multiply((product){.a = v,
                           .b = m + o,
                           .c = sums + o,
                           .a_row = 1,
                           .a_next = in,
                           .b_next = out,
                           .c_row = out,
                           .depth = (int)tiles,
                           .add = !first},
                 in);
}

/* All threads take the same tiles, then share the points, so that every sum has one order. */
void winograd_gradient(const winograd *g, const float *x, const float *dy, float *dw, float *room)
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
                take_window(g, x, first + t, copy, v + t * in, v_stride);
                take_result_back(g, dy, first + t, copy, m + t * out, m_stride);
            }
#pragma omp for schedule(static)
            for (size_t point = 0; point < POINTS; point++)
                add_products(g, count, v + point * v_stride, m + point * m_stride, first == 0, sums + point * matrix);
        }
#pragma omp for schedule(static)
        for (int i = 0; i < g->in; i++)
            for (int o = 0; o < g->out; o += EIGHT)
                put_kernels(sums + (size_t)i * out + (size_t)o, matrix, g->in, i, o, dw);
    }
}
