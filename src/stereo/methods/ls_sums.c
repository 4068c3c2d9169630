/* SPDX-License-Identifier: MIT */
#include "stereo/methods/ls_sums.h"

#include <stdlib.h>
#include <string.h>

#include "stereo/methods/ls_lanes.h"

/* Number of pictures that are added at once; pictures whose bits fill a word; padded length of a light's products.
 * docs/notes/least_squares.md lists what was tried. */
enum { TOGETHER = 2, WORD = 32, PRODUCTS = 8, CACHE_LINE = 64 };

/* Contribution of one picture's light. */
typedef struct ls_light {
    float x, y, z;
    float scale[3];          /* factor from code to radiance under unit intensity */
    float product[PRODUCTS]; /* l lᵀ in the first six; padded to fit a register */
    int32_t bit;             /* bit in its word; 0 for padding at the end */
    const pst_plane *picture;
} ls_light;

struct ls_lights {
    int count; /* number, padded to a multiple of TOGETHER */
    int channels;
    ls_limits limits;
    ls_light at[];
};

static ls_light make_light(const merlin_light *from, const pst_plane *picture, int index)
{
    vec3 d = vec3_of(from->direction);
    ls_light l = {.x = d.x, .y = d.y, .z = d.z, .bit = (int32_t)(1u << (index % WORD)), .picture = picture};
    for (int c = 0; c < 3; c++)
        l.scale[c] = 1 / (65535 * from->intensity[c]);
    const float product[PRODUCTS] = {d.x * d.x, d.x * d.y, d.x * d.z, d.y * d.y, d.y * d.z, d.z * d.z};
    memcpy(l.product, product, sizeof product);
    return l;
}

status ls_lights_new(const pst_problem *p, ls_limits limits, ls_lights **out)
{
    const merlin_capture *c = p->capture;
    int filled = (c->count + TOGETHER - 1) / TOGETHER * TOGETHER;
    ls_lights *l = malloc(sizeof *l + (size_t)filled * sizeof l->at[0]);
    *out = l;
    if (!l) return fail(MERLIN_NO_MEMORY, "no memory for %d lights", c->count);
    *l = (ls_lights){.count = filled, .channels = c->channels, .limits = limits};
    for (int i = 0; i < c->count; i++)
        l->at[i] = make_light(&p->light[i], &c->picture[i], i);
    for (int i = c->count; i < filled; i++)
        l->at[i] = (ls_light){.picture = c->picture};
    return OK;
}

void ls_lights_free(ls_lights *l)
{
    free(l);
}

/* ---- right-hand sides ---- */

static inline void which_grey(const ls_lane_colour *codes, ls_limits limits, ls_lane_bits *counts)
{
    *counts = (codes->r > limits.low) & (codes->r < limits.high);
}

static inline void which_colour(const ls_lane_colour *codes, ls_limits limits, ls_lane_bits *counts)
{
    *counts = (codes->r + codes->g + codes->b > limits.low) & (codes->r < limits.high) & (codes->g < limits.high) &
              (codes->b < limits.high);
}

static inline void add_lit(uint32_t *lit, const ls_lane_bits *a, const ls_lane_bits *b, const ls_light *l)
{
    ls_lane_bits sum;
    memcpy(&sum, lit, sizeof sum);
    sum |= (*a & l[0].bit) | (*b & l[1].bit);
    memcpy(lit, &sum, sizeof sum);
}

/* Converts codes to radiance, zero where they do not count. */
static inline void radiance(const ls_lanes *codes, const ls_lane_bits *counts, float scale, ls_lanes *out)
{
    ls_lanes v = *codes * scale;
    *out = (ls_lanes)((ls_lane_bits)v & *counts);
}

static inline void add_component(float *sums, const ls_lanes *a, const ls_lanes *b, float of_a, float of_b)
{
    ls_lanes sum;
    memcpy(&sum, sums, sizeof sum);
    sum += *a * of_a;
    sum += *b * of_b;
    memcpy(sums, &sum, sizeof sum);
}

/* Which of LS_LANES pixels count in each of two pictures. */
typedef struct lane_counts {
    ls_lane_bits a, b;
} lane_counts;

/* Adds one channel of two pictures: its sums are loaded and stored once for both, and occupy registers only meanwhile,
 * as some processors have only sixteen. */
static inline void add_channel(ls_sums *s, int channel, int i, const ls_lanes *codes_a, const ls_lanes *codes_b,
                               const lane_counts *counts, const ls_light *l)
{
    ls_lanes a, b, square;
    radiance(codes_a, &counts->a, l[0].scale[channel], &a);
    radiance(codes_b, &counts->b, l[1].scale[channel], &b);
    add_component(&s->right[channel][0][i], &a, &b, l[0].x, l[1].x);
    add_component(&s->right[channel][1][i], &a, &b, l[0].y, l[1].y);
    add_component(&s->right[channel][2][i], &a, &b, l[0].z, l[1].z);
    memcpy(&square, &s->square[i], sizeof square);
    square += a * a;
    square += b * b;
    memcpy(&s->square[i], &square, sizeof square);
}

static inline void add_grey(ls_sums *s, uint32_t *lit, int i, const ls_lane_colour *a, const ls_lane_colour *b,
                            const ls_light *l, ls_limits limits)
{
    lane_counts counts;
    which_grey(a, limits, &counts.a);
    which_grey(b, limits, &counts.b);
    add_lit(lit + i, &counts.a, &counts.b, l);
    add_channel(s, 0, i, &a->r, &b->r, &counts, l);
}

static inline void add_colour(ls_sums *s, uint32_t *lit, int i, const ls_lane_colour *a, const ls_lane_colour *b,
                              const ls_light *l, ls_limits limits)
{
    lane_counts counts;
    which_colour(a, limits, &counts.a);
    which_colour(b, limits, &counts.b);
    add_lit(lit + i, &counts.a, &counts.b, l);
    add_channel(s, 0, i, &a->r, &b->r, &counts, l);
    add_channel(s, 1, i, &a->g, &b->g, &counts, l);
    add_channel(s, 2, i, &a->b, &b->b, &counts, l);
}

/* Values of the same pixels in TOGETHER pictures. */
typedef struct places {
    const uint16_t *at[TOGETHER];
} places;

static inline places places_from(places p, size_t value)
{
    for (int k = 0; k < TOGETHER; k++)
        p.at[k] += value;
    return p;
}

/* Adds pixels i .. i + 2 LS_LANES - 1 of a block, whose values are given. */
static inline void add_lanes(const ls_lights *all, const ls_light *l, places values, ls_sums *s, uint32_t *lit, int i)
{
    ls_lane_colour a[2], b[2]; /* both halves of each picture */
    if (all->channels == 1) {
        ls_lanes_of_grey(values.at[0], &a[0], &a[1]);
        ls_lanes_of_grey(values.at[1], &b[0], &b[1]);
        add_grey(s, lit, i, &a[0], &b[0], l, all->limits);
        add_grey(s, lit, i + LS_LANES, &a[1], &b[1], l, all->limits);
    } else {
        ls_lanes_of_colour(values.at[0], &a[0], &a[1]);
        ls_lanes_of_colour(values.at[1], &b[0], &b[1]);
        add_colour(s, lit, i, &a[0], &b[0], l, all->limits);
        add_colour(s, lit, i + LS_LANES, &a[1], &b[1], l, all->limits);
    }
}

/* Some pictures of a block: the first one's light, and the block's first value. */
typedef struct portion {
    const ls_light *light;
    size_t value;
} portion;

/* Prefetches so many values of the next pictures, or of the next block. */
static void fetch(portion next, size_t values)
{
    for (int k = 0; k < TOGETHER; k++) {
        const pst_plane *picture = next.light[k].picture;
        const size_t bytes = pst_plane_bytes(picture);
        const char *from = pst_plane_data(picture) + next.value * bytes;
        for (size_t b = 0; b < values * bytes; b += CACHE_LINE)
            __builtin_prefetch(from + b, 0, 0); /* read once only */
    }
}

/* Adds the last pixels of a picture, which do not fill all lanes; the rest is zeros, which never count. */
static void add_rest(const ls_lights *all, const ls_light *l, places values, int count, int i, ls_sums *s,
                     uint32_t *lit)
{
    uint16_t copy[TOGETHER][6 * LS_LANES] = {0};
    values = places_from(values, (size_t)i * (size_t)all->channels);
    for (int k = 0; k < TOGETHER; k++) {
        memcpy(copy[k], values.at[k], (size_t)(count - i) * (size_t)all->channels * sizeof copy[k][0]);
        values.at[k] = copy[k];
    }
    add_lanes(all, l, values, s, lit, i);
}

/* Adds pictures, and prefetches the next ones meanwhile. */
static void add_pictures(const ls_lights *all, portion now, portion next, int count, ls_sums *s, uint32_t *lit)
{
    const size_t channels = (size_t)all->channels;
    uint16_t decoded[TOGETHER][3 * LS_BLOCK];
    places values;
    int i = 0;
    for (int k = 0; k < TOGETHER; k++)
        values.at[k] = pst_codes(now.light[k].picture, now.value, (size_t)count * channels, decoded[k]);
    for (; i + 2 * LS_LANES <= count; i += 2 * LS_LANES) {
        const size_t offset = (size_t)i * channels;
        fetch((portion){next.light, next.value + offset}, 2 * LS_LANES * channels);
        add_lanes(all, now.light, places_from(values, offset), s, lit, i);
    }
    if (i < count) add_rest(all, now.light, values, count, i, s, lit);
}

/* ---- matrices ---- */

/* The matrix of the most recent word of bits. */
typedef struct matrix_memory {
    uint32_t word;
    float matrix[PRODUCTS]; /* matrix of the word; of no lights at first */
} matrix_memory;

/* Computes the matrix of a word without branches, as shadows are hard to predict. */
static void recall(matrix_memory *m, uint32_t word, const ls_light *l, int lights)
{
    if (m->word == word) return;
    *m = (matrix_memory){.word = word};
    for (int k = 0; k < lights; k++) {
        float counts = (float)((word & (uint32_t)l[k].bit) != 0);
        for (int e = 0; e < PRODUCTS; e++)
            m->matrix[e] += counts * l[k].product[e];
    }
}

static void add_alike(const matrix_memory *m, int i, ls_sums *s)
{
    for (int e = 0; e < 6; e++)
        for (int k = i; k < i + LS_LANES; k++)
            s->matrix[e][k] += m->matrix[e];
}

static inline void add_product(ls_lanes *sum, float product, const ls_lane_bits *counts)
{
    ls_lanes p = product - (ls_lanes){0};
    *sum += (ls_lanes)((ls_lane_bits)p & *counts);
}

static void add_each(const uint32_t *lit, const ls_light *l, int lights, int i, ls_sums *s)
{
    ls_lanes m0 = {0}, m1 = {0}, m2 = {0}, m3 = {0}, m4 = {0}, m5 = {0};
    ls_lane_bits word;
    memcpy(&word, lit + i, sizeof word);
    for (int k = 0; k < lights; k++) {
        ls_lane_bits counts = (word & l[k].bit) != 0;
        add_product(&m0, l[k].product[0], &counts);
        add_product(&m1, l[k].product[1], &counts);
        add_product(&m2, l[k].product[2], &counts);
        add_product(&m3, l[k].product[3], &counts);
        add_product(&m4, l[k].product[4], &counts);
        add_product(&m5, l[k].product[5], &counts);
    }
    const ls_lanes all[6] = {m0, m1, m2, m3, m4, m5};
    for (int e = 0; e < 6; e++)
        for (int k = 0; k < LS_LANES; k++)
            s->matrix[e][i + k] += all[e][k];
}

/* Adds the matrices of the lights of one word. */
static void add_matrices(const uint32_t *lit, const ls_light *l, int lights, int count, ls_sums *s)
{
    matrix_memory memory = {0};
    for (int i = 0; i < count; i += LS_LANES) {
        uint32_t all = lit[i], any = lit[i];
        for (int k = i; k < i + LS_LANES; k++) {
            all &= lit[k];
            any |= lit[k];
        }
        if (all == any) {
            recall(&memory, all, l, lights);
            add_alike(&memory, i, s);
        } else {
            add_each(lit, l, lights, i, s);
        }
    }
}

void ls_sums_add(const ls_lights *l, size_t first, int count, ls_sums *out)
{
    uint32_t lit[LS_BLOCK];
    size_t value = first * (size_t)l->channels, block = (size_t)count * (size_t)l->channels;
    memset(out, 0, sizeof *out);
    for (int word = 0; word < l->count; word += WORD) {
        int end = word + WORD < l->count ? word + WORD : l->count;
        memset(lit, 0, sizeof lit);
        for (int k = word; k < end; k += TOGETHER) {
            bool last = k + TOGETHER == l->count;
            portion now = {&l->at[k], value}, next = {&l->at[k + TOGETHER], value};
            if (last) next = (portion){l->at, value + block};
            add_pictures(l, now, next, count, out, lit);
        }
        add_matrices(lit, &l->at[word], end - word, count, out);
    }
}
