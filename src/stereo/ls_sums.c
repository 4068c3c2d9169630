#include "stereo/ls_sums.h"

#include <stdlib.h>
#include <string.h>

/* Pictures added at once; pictures whose bits fill a word; pixels side by side. */
enum { TOGETHER = 2, WORD = 32, PRODUCTS = 8, CACHE_LINE = 64 };

/* What one picture's light contributes. */
typedef struct ls_light {
    float x, y, z;
    float scale[3];          /* code to radiance under unit intensity */
    float product[PRODUCTS]; /* l lᵀ in the first six; as many as fit a register well */
    int32_t bit;             /* in its word; 0 for what only fills up the last few */
    const uint16_t *picture;
} ls_light;

struct ls_lights {
    int count; /* filled up to a multiple of TOGETHER */
    int channels;
    ls_limits limits;
    ls_light at[];
};

static ls_light make_light(const pst_light *from, const uint16_t *picture, int index)
{
    vec3 d = from->direction;
    ls_light l = {.x = d.x, .y = d.y, .z = d.z, .bit = (int32_t)(1u << (index % WORD)), .picture = picture};
    for (int c = 0; c < 3; c++)
        l.scale[c] = 1 / (65535 * from->intensity[c]);
    const float product[PRODUCTS] = {d.x * d.x, d.x * d.y, d.x * d.z, d.y * d.y, d.y * d.z, d.z * d.z};
    memcpy(l.product, product, sizeof product);
    return l;
}

status ls_lights_new(const pst_problem *p, ls_limits limits, ls_lights **out)
{
    const pst_capture *c = p->capture;
    int filled = (c->count + TOGETHER - 1) / TOGETHER * TOGETHER;
    ls_lights *l = malloc(sizeof *l + (size_t)filled * sizeof l->at[0]);
    *out = l;
    if (!l) return fail(ERROR_MEMORY, "no memory for %d lights", c->count);
    *l = (ls_lights){.count = filled, .channels = c->channels, .limits = limits};
    for (int i = 0; i < c->count; i++)
        l->at[i] = make_light(&p->light[i], c->picture[i], i);
    for (int i = c->count; i < filled; i++)
        l->at[i] = (ls_light){.picture = c->picture[0]};
    return OK;
}

void ls_lights_free(ls_lights *l)
{
    free(l);
}

/* ---- right sides ---- */

typedef uint32_t lane_words __attribute__((vector_size(LANES * sizeof(uint32_t))));
typedef uint16_t lane_codes __attribute__((vector_size(2 * LANES * sizeof(uint16_t)))); /* of twice as many pixels */

/* Sums of LANES pixels while pictures are added. */
typedef struct lane_sums {
    lanes right[3][3], square;
    lane_bits lit;
} lane_sums;

static inline void load(lane_sums *to, const ls_sums *s, const uint32_t *lit, int channels, int i)
{
    for (int c = 0; c < channels; c++)
        for (int k = 0; k < 3; k++)
            memcpy(&to->right[c][k], &s->right[c][k][i], sizeof(lanes));
    memcpy(&to->square, &s->square[i], sizeof(lanes));
    memcpy(&to->lit, &lit[i], sizeof(lane_bits));
}

static inline void store(const lane_sums *from, ls_sums *s, uint32_t *lit, int channels, int i)
{
    for (int c = 0; c < channels; c++)
        for (int k = 0; k < 3; k++)
            memcpy(&s->right[c][k][i], &from->right[c][k], sizeof(lanes));
    memcpy(&s->square[i], &from->square, sizeof(lanes));
    memcpy(&lit[i], &from->lit, sizeof(lane_bits));
}

/* Codes of one channel as radiance, zero where they do not count. */
static inline void add_channel(lane_sums *s, int channel, const lanes *codes, const lane_bits *counts,
                               const ls_light *l)
{
    lanes v = *codes * l->scale[channel];
    v = (lanes)((lane_bits)v & *counts);
    s->right[channel][0] += v * l->x;
    s->right[channel][1] += v * l->y;
    s->right[channel][2] += v * l->z;
    s->square += v * v;
}

/* LANES pixels' codes; a grey picture has only the first. */
typedef struct lane_colour {
    lanes r, g, b;
} lane_colour;

/* The even codes of a vector, and the odd ones. */
static inline void widen(const lane_codes *codes, lanes *even, lanes *odd)
{
    *even = __builtin_convertvector((lane_bits)((lane_words)*codes & 0xffff), lanes);
    *odd = __builtin_convertvector((lane_bits)((lane_words)*codes >> 16), lanes);
}

/* Twice LANES pixels from here on: the first half's and the second's. Before codes are widened the halves' alternate.
 */
static inline void take_grey(const uint16_t *from, lane_colour *first, lane_colour *second)
{
    lane_codes in;
    memcpy(&in, from, sizeof in);
    lane_codes mixed = __builtin_shufflevector(in, in, 0, 16, 1, 17, 2, 18, 3, 19, 4, 20, 5, 21, 6, 22, 7, 23, 8, 24, 9,
                                               25, 10, 26, 11, 27, 12, 28, 13, 29, 14, 30, 15, 31);
    widen(&mixed, &first->r, &second->r);
}

/* Every third code of 96: from the first two vectors what they have, the rest from the last one. */
static inline void take_colour(const uint16_t *from, lane_colour *first, lane_colour *second)
{
    lane_codes p, q, s;
    memcpy(&p, from, sizeof p);
    memcpy(&q, from + 2 * LANES, sizeof q);
    memcpy(&s, from + 4 * LANES, sizeof s);
    lane_codes some = __builtin_shufflevector(p, q, 0, 48, 3, 51, 6, 54, 9, 57, 12, 60, 15, 63, 18, 0, 21, 0, 24, 0, 27,
                                              0, 30, 0, 33, 0, 36, 0, 39, 0, 42, 0, 45, 0);
    lane_codes red = __builtin_shufflevector(some, s, 0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 34, 14, 37, 16, 40, 18,
                                             43, 20, 46, 22, 49, 24, 52, 26, 55, 28, 58, 30, 61);
    some = __builtin_shufflevector(p, q, 1, 49, 4, 52, 7, 55, 10, 58, 13, 61, 16, 0, 19, 0, 22, 0, 25, 0, 28, 0, 31, 0,
                                   34, 0, 37, 0, 40, 0, 43, 0, 46, 0);
    lane_codes green = __builtin_shufflevector(some, s, 0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 32, 12, 35, 14, 38, 16, 41,
                                               18, 44, 20, 47, 22, 50, 24, 53, 26, 56, 28, 59, 30, 62);
    some = __builtin_shufflevector(p, q, 2, 50, 5, 53, 8, 56, 11, 59, 14, 62, 17, 0, 20, 0, 23, 0, 26, 0, 29, 0, 32, 0,
                                   35, 0, 38, 0, 41, 0, 44, 0, 47, 0);
    lane_codes blue = __builtin_shufflevector(some, s, 0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 33, 12, 36, 14, 39, 16, 42, 18,
                                              45, 20, 48, 22, 51, 24, 54, 26, 57, 28, 60, 30, 63);
    widen(&red, &first->r, &second->r);
    widen(&green, &first->g, &second->g);
    widen(&blue, &first->b, &second->b);
}

static inline void add_grey(lane_sums *s, const lane_colour *codes, const ls_light *l, ls_limits limits)
{
    lane_bits counts = (codes->r > limits.low) & (codes->r < limits.high);
    s->lit |= counts & l->bit;
    add_channel(s, 0, &codes->r, &counts, l);
}

static inline void add_colour(lane_sums *s, const lane_colour *codes, const ls_light *l, ls_limits limits)
{
    lane_bits counts = (codes->r + codes->g + codes->b > limits.low) & (codes->r < limits.high) &
                       (codes->g < limits.high) & (codes->b < limits.high);
    s->lit |= counts & l->bit;
    add_channel(s, 0, &codes->r, &counts, l);
    add_channel(s, 1, &codes->g, &counts, l);
    add_channel(s, 2, &codes->b, &counts, l);
}

/* Values of the same pixels in TOGETHER pictures. */
typedef struct places {
    const uint16_t *at[TOGETHER];
} places;

static inline places places_from(const ls_light *l, size_t value)
{
    places p;
    for (int k = 0; k < TOGETHER; k++)
        p.at[k] = l[k].picture + value;
    return p;
}

/* Pixels i .. i + 2 LANES - 1 of a block; the values are theirs. Written out, because sums in arrays that a loop walks
 * through would not stay in registers. */
static inline void add_lanes(const ls_lights *all, const ls_light *l, places values, ls_sums *s, uint32_t *lit, int i)
{
    lane_sums first, second;
    lane_colour a[TOGETHER], b[TOGETHER]; /* the first half's and the second's, a picture each */
    if (all->channels == 1) {
        take_grey(values.at[0], &a[0], &b[0]);
        take_grey(values.at[1], &a[1], &b[1]);
        load(&first, s, lit, 1, i);
        add_grey(&first, &a[0], l, all->limits);
        add_grey(&first, &a[1], l + 1, all->limits);
        store(&first, s, lit, 1, i);
        load(&second, s, lit, 1, i + LANES);
        add_grey(&second, &b[0], l, all->limits);
        add_grey(&second, &b[1], l + 1, all->limits);
        store(&second, s, lit, 1, i + LANES);
    } else {
        take_colour(values.at[0], &a[0], &b[0]);
        take_colour(values.at[1], &a[1], &b[1]);
        load(&first, s, lit, 3, i);
        add_colour(&first, &a[0], l, all->limits);
        add_colour(&first, &a[1], l + 1, all->limits);
        store(&first, s, lit, 3, i);
        load(&second, s, lit, 3, i + LANES);
        add_colour(&second, &b[0], l, all->limits);
        add_colour(&second, &b[1], l + 1, all->limits);
        store(&second, s, lit, 3, i + LANES);
    }
}

/* Fetches the values that will be wanted when these pixels come up in other pictures or the next block. */
static void fetch(places from, size_t bytes)
{
    for (int k = 0; k < TOGETHER; k++)
        for (size_t b = 0; b < bytes; b += CACHE_LINE)
            __builtin_prefetch((const char *)from.at[k] + b, 0, 0); /* to be read once */
}

/* Some pictures of a block: the first one's light, the block's first value. */
typedef struct portion {
    const ls_light *light;
    size_t value;
} portion;

/* The last pixels of a picture, which do not fill all lanes: zeros, which never count, stand for the others. */
static void add_rest(const ls_lights *all, portion now, int count, int i, ls_sums *s, uint32_t *lit)
{
    uint16_t copy[TOGETHER][6 * LANES] = {0};
    places values = places_from(now.light, now.value + (size_t)i * (size_t)all->channels);
    for (int k = 0; k < TOGETHER; k++) {
        memcpy(copy[k], values.at[k], (size_t)(count - i) * (size_t)all->channels * sizeof copy[k][0]);
        values.at[k] = copy[k];
    }
    add_lanes(all, now.light, values, s, lit, i);
}

/* What is next is fetched meanwhile. */
static void add_pictures(const ls_lights *all, portion now, portion next, int count, ls_sums *s, uint32_t *lit)
{
    int i = 0, channels = all->channels;
    size_t bytes = 2 * LANES * (size_t)channels * sizeof(uint16_t);
    for (; i + 2 * LANES <= count; i += 2 * LANES) {
        size_t offset = (size_t)i * (size_t)channels;
        fetch(places_from(next.light, next.value + offset), bytes);
        add_lanes(all, now.light, places_from(now.light, now.value + offset), s, lit, i);
    }
    if (i < count) add_rest(all, now, count, i, s, lit);
}

/* ---- matrices ---- */

/* The matrix of the last word of bits that was asked for. */
typedef struct matrix_memory {
    uint32_t word;
    float matrix[PRODUCTS]; /* of no lights at first */
} matrix_memory;

/* Without branches: which pixels are in shadow is hard to foresee. */
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
        for (int k = i; k < i + LANES; k++)
            s->matrix[e][k] += m->matrix[e];
}

static inline void add_product(lanes *sum, float product, const lane_bits *counts)
{
    lanes p = product - (lanes){0};
    *sum += (lanes)((lane_bits)p & *counts);
}

static void add_each(const uint32_t *lit, const ls_light *l, int lights, int i, ls_sums *s)
{
    lanes m0 = {0}, m1 = {0}, m2 = {0}, m3 = {0}, m4 = {0}, m5 = {0};
    lane_bits word;
    memcpy(&word, lit + i, sizeof word);
    for (int k = 0; k < lights; k++) {
        lane_bits counts = (word & l[k].bit) != 0;
        add_product(&m0, l[k].product[0], &counts);
        add_product(&m1, l[k].product[1], &counts);
        add_product(&m2, l[k].product[2], &counts);
        add_product(&m3, l[k].product[3], &counts);
        add_product(&m4, l[k].product[4], &counts);
        add_product(&m5, l[k].product[5], &counts);
    }
    const lanes all[6] = {m0, m1, m2, m3, m4, m5};
    for (int e = 0; e < 6; e++)
        for (int k = 0; k < LANES; k++)
            s->matrix[e][i + k] += all[e][k];
}

/* Of the lights of one word. */
static void add_matrices(const uint32_t *lit, const ls_light *l, int lights, int count, ls_sums *s)
{
    matrix_memory memory = {0};
    for (int i = 0; i < count; i += LANES) {
        uint32_t all = lit[i], any = lit[i];
        for (int k = i; k < i + LANES; k++) {
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
