#include "estimate/find_object.h"

#include <math.h>
#include <stdbool.h>
#include <stdint.h>
#include <stdlib.h>

#include "base/parallel.h"
#include "estimate/border_distance.h"
#include "estimate/exposure.h"
#include "image/resize.h"

/* The search runs on a small copy: what cannot be reached from the border without crossing an edge starts a two-sided
 * colour model (object, background), which is refined in a few rounds of "classify, smooth, keep one filled region,
 * learn the colours again" (the idea of GrabCut, Rother et al. 2004, with histograms instead of mixtures and a blur
 * instead of a cut). */
enum { WORKING_SIDE = 192, ROUNDS = 4, SMOOTHING = 2, BINS = 12, OTSU_BINS = 128 };
static const float FARTHEST = 1.5f, OTSU_SHARE = 0.35f, LEAST_BARRIER = 0.08f;
static const float KEPT_SHARE = 0.1f;
static const float LEAST_WHITE = 0.5f, MOST_GAIN = 64;
static const float COLOR_WEIGHT = 0.5f, LEAST_AREA = 0.005f, LARGEST_AREA = 0.9f;

typedef struct search {
    float exposure;  /* what the photograph's values are multiplied by */
    img color;       /* small, square-root encoded */
    img probability; /* of being object */
    float *prior;    /* log odds of being object, from the place alone */
    uint8_t *object; /* 0 or 1 */
    uint8_t *ring;   /* 1 within the border's width */
    size_t *stack;
    size_t count;
    int width, height;
} search;

static void search_free(search *s)
{
    img_free(&s->color);
    img_free(&s->probability);
    free(s->prior);
    free(s->object);
    free(s->ring);
    free(s->stack);
}

static void mark_ring(search *s)
{
    int shorter = s->width < s->height ? s->width : s->height;
    int margin = shorter / 40 > 1 ? shorter / 40 : 1;
    for (int y = 0; y < s->height; y++)
        for (int x = 0; x < s->width; x++)
            s->ring[y * s->width + x] = x < margin || y < margin || x >= s->width - margin || y >= s->height - margin;
}

/* Brings values to the usual ones: those far above 1, and those of a picture that has no bright pixel at all. */
static float exposure_of(const search *s)
{
    float brightest = 0;
    for (size_t i = 0; i < 3 * s->count; i++)
        brightest = fmaxf(brightest, s->color.data[i]);
    if (brightest < LEAST_WHITE) return LEAST_WHITE / fmaxf(brightest, LEAST_WHITE / MOST_GAIN);
    for (size_t i = 0; i < s->count; i++)
        s->probability.data[i] = 1; /* so far, all of it */
    return fminf(exposure_gain(&s->color, &s->probability) / EXPOSURE_WHITE, 1);
}

static status search_new(const img *photo, search *s)
{
    *s = (search){0};
    int longest = photo->width > photo->height ? photo->width : photo->height;
    float scale = longest > WORKING_SIDE ? (float)WORKING_SIDE / (float)longest : 1;
    s->width = (int)fmaxf(roundf((float)photo->width * scale), 1);
    s->height = (int)fmaxf(roundf((float)photo->height * scale), 1);
    s->count = (size_t)s->width * (size_t)s->height;
    status result = img_resize(photo, s->width, s->height, &s->color);
    if (result == OK) result = img_new(&s->probability, s->width, s->height, 1);
    if (result != OK) return result;
    s->prior = calloc(s->count, sizeof *s->prior);
    s->object = calloc(s->count, 1);
    s->ring = calloc(s->count, 1);
    s->stack = malloc(s->count * sizeof *s->stack);
    if (!s->prior || !s->object || !s->ring || !s->stack) return fail(ERROR_MEMORY, "no memory to look for the object");
    s->exposure = exposure_of(s);
    for (size_t i = 0; i < 3 * s->count; i++)
        s->color.data[i] = sqrtf(fminf(fmaxf(s->exposure * s->color.data[i], 0), 1));
    mark_ring(s);
    return OK;
}

/* ---- a first guess ---- */

/* Threshold that separates two groups best (Otsu 1979), for values in [0, FARTHEST]. */
static float otsu(const float *value, size_t count)
{
    double histogram[OTSU_BINS] = {0}, total = 0, below = 0, below_sum = 0, best = -1;
    int threshold = OTSU_BINS / 2;
    for (size_t i = 0; i < count; i++)
        histogram[(int)fminf(value[i] / FARTHEST * OTSU_BINS, OTSU_BINS - 1)]++;
    for (int i = 0; i < OTSU_BINS; i++)
        total += i * histogram[i];
    for (int i = 0; i < OTSU_BINS - 1; i++) {
        below += histogram[i];
        below_sum += i * histogram[i];
        double above = (double)count - below;
        if (below == 0 || above == 0) continue;
        double apart = below_sum / below - (total - below_sum) / above;
        double between = below * above * apart * apart;
        if (between > best) {
            best = between;
            threshold = i + 1;
        }
    }
    return (float)threshold / OTSU_BINS * FARTHEST;
}

static status start_from_border(search *s)
{
    img away = {0};
    status result = border_distance(&s->color, s->ring, &away);
    if (result != OK) return result;
    float threshold = fmaxf(OTSU_SHARE * otsu(away.data, s->count), LEAST_BARRIER);
    for (size_t i = 0; i < s->count; i++) {
        s->object[i] = away.data[i] > threshold;
        /* odds 1 at the threshold, e² twice as far */
        s->prior[i] = 2 * (away.data[i] / threshold - 1);
    }
    img_free(&away);
    return OK;
}

/* ---- regions ---- */

/* Turns the connected pixels of value `from` around start into `to`; how many, weighted toward the picture's centre. */
static float flood(search *s, size_t start, uint8_t from, uint8_t to)
{
    size_t width = (size_t)s->width, height = (size_t)s->height, depth = 0;
    float sum = 0;
    s->object[start] = to;
    s->stack[depth++] = start;
    while (depth) {
        size_t at = s->stack[--depth], x = at % width, y = at / width;
        float u = ((float)x + 0.5f) / (float)width - 0.5f, v = ((float)y + 0.5f) / (float)height - 0.5f;
        sum += expf(-4 * (u * u + v * v));
        size_t next[4];
        int count = img_beside(s->width, s->height, at, next);
        for (int i = 0; i < count; i++) {
            if (s->object[next[i]] != from) continue;
            s->object[next[i]] = to;
            s->stack[depth++] = next[i];
        }
    }
    return sum;
}

/* Keeps the heaviest region, those at least a tenth as heavy, and what they enclose. */
static void keep_main_regions(search *s)
{
    enum { BACKGROUND, OBJECT, SEEN, KEPT, OUTSIDE };
    float heaviest = 0;
    for (size_t i = 0; i < s->count; i++)
        if (s->object[i] == OBJECT) heaviest = fmaxf(heaviest, flood(s, i, OBJECT, SEEN));
    for (size_t i = 0; i < s->count; i++) {
        if (s->object[i] != SEEN) continue;
        float weight = flood(s, i, SEEN, KEPT);
        if (weight < KEPT_SHARE * heaviest) flood(s, i, KEPT, BACKGROUND);
    }
    for (size_t i = 0; i < s->count; i++) {
        size_t x = i % (size_t)s->width, y = i / (size_t)s->width;
        bool edge = x == 0 || y == 0 || x + 1 == (size_t)s->width || y + 1 == (size_t)s->height;
        if (edge && s->object[i] == BACKGROUND) flood(s, i, BACKGROUND, OUTSIDE);
    }
    for (size_t i = 0; i < s->count; i++)
        s->object[i] = s->object[i] != OUTSIDE;
}

/* ---- colour model of both sides ---- */

/* A colour's eight bins and their trilinear weights. */
typedef struct bins {
    size_t at[8];
    float weight[8];
} bins;

static bins bins_of(const float color[3])
{
    bins found;
    size_t low[3];
    float part[3];
    for (int c = 0; c < 3; c++) {
        float place = color[c] * (BINS - 1);
        low[c] = place < BINS - 2 ? (size_t)place : BINS - 2;
        part[c] = place - (float)low[c];
    }
    for (size_t i = 0; i < 8; i++) {
        size_t r = i & 1, g = (i >> 1) & 1, b = i >> 2;
        found.at[i] = ((low[0] + r) * BINS + low[1] + g) * BINS + low[2] + b;
        found.weight[i] = (r ? part[0] : 1 - part[0]) * (g ? part[1] : 1 - part[1]) * (b ? part[2] : 1 - part[2]);
    }
    return found;
}

static float logistic(float x)
{
    return 1 / (1 + expf(-x));
}

/* Histograms of both sides' colours, and what they hold in all. */
typedef struct color_model {
    search *s;
    float object[BINS * BINS * BINS], background[BINS * BINS * BINS];
    float objects, backgrounds;
} color_model;

static void learn_colors(color_model *m)
{
    const search *s = m->s;
    *m = (color_model){.s = m->s, .objects = 1, .backgrounds = 1};
    for (size_t i = 0; i < s->count; i++) {
        bins b = bins_of(s->color.data + 3 * i);
        float *to = s->object[i] ? m->object : m->background;
        for (int k = 0; k < 8; k++)
            to[b.at[k]] += b.weight[k];
        *(s->object[i] ? &m->objects : &m->backgrounds) += 1;
    }
}

static void classify(void *context, size_t begin, size_t end)
{
    const color_model *m = context;
    search *s = m->s;
    for (size_t i = begin; i < end; i++) {
        bins b = bins_of(s->color.data + 3 * i);
        float o = 0, c = 0;
        for (int k = 0; k < 8; k++) {
            o += b.weight[k] * m->object[b.at[k]];
            c += b.weight[k] * m->background[b.at[k]];
        }
        o = (o + 0.05f) / m->objects;
        c = (c + 0.05f) / m->backgrounds;
        s->probability.data[i] = logistic(COLOR_WEIGHT * logf(o / c) + fminf(fmaxf(s->prior[i], -3), 3));
    }
}

/* Whether the mean of the probability around (x, y) is above a half. */
static bool is_probable(const search *s, int x, int y)
{
    int left = x > SMOOTHING ? x - SMOOTHING : 0, top = y > SMOOTHING ? y - SMOOTHING : 0;
    int right = x + SMOOTHING < s->width ? x + SMOOTHING : s->width - 1;
    int bottom = y + SMOOTHING < s->height ? y + SMOOTHING : s->height - 1;
    float sum = 0;
    for (int v = top; v <= bottom; v++)
        for (int u = left; u <= right; u++)
            sum += *img_at(&s->probability, u, v);
    return sum / (float)((right - left + 1) * (bottom - top + 1)) > 0.5f;
}

static void choose_rows(void *context, size_t begin, size_t end)
{
    const search *s = context;
    for (int y = (int)begin; y < (int)end; y++)
        for (int x = 0; x < s->width; x++)
            s->object[y * s->width + x] = is_probable(s, x, y);
}

static status refine_by_color(search *s)
{
    color_model *m = malloc(sizeof *m);
    if (!m) return fail(ERROR_MEMORY, "no memory to look for the object");
    m->s = s;
    for (int round = 0; round < ROUNDS; round++) {
        learn_colors(m);
        parallel_blocks(s->count, classify, m);
        parallel_blocks((size_t)s->height, choose_rows, s);
        keep_main_regions(s);
    }
    free(m);
    return OK;
}

/* How decided the colours are, less what of the object is cut by the picture's border. */
static float trust(const search *s, float area)
{
    double decided = 0;
    size_t ring = 0, cut = 0;
    for (size_t i = 0; i < s->count; i++) {
        float p = s->probability.data[i];
        decided += s->object[i] ? p : 1 - p;
        ring += s->ring[i];
        cut += s->ring[i] && s->object[i];
    }
    float agreement = (float)(decided / (double)s->count), spill = (float)cut / (float)ring;
    float plausible = fminf(1, fminf(area / 0.03f, (1 - area) / 0.15f));
    float raw = (2 * agreement - 1) * (1 - 2 * fminf(spill, 0.5f)) * plausible;
    /* no photograph comes out much below 0.3: what is left spans 0 to 1 */
    return fmaxf(0, (raw - 0.3f) / 0.7f);
}

/* To the photograph's size, edges where its edges are. */
static status enlarge(const search *s, const img *photo, img *mask)
{
    img small = {0};
    float epsilon = 1e-4f / (s->exposure * s->exposure);
    status result = img_new(&small, s->width, s->height, 1);
    for (size_t i = 0; result == OK && i < s->count; i++)
        small.data[i] = s->object[i];
    if (result == OK && (photo->width != s->width || photo->height != s->height))
        result = img_guided_upsample(&small, NULL, photo, NULL, 2, epsilon, mask);
    else if (result == OK)
        result = img_copy(mask, &small);
    img_free(&small);
    if (result != OK) return result;
    size_t count = (size_t)mask->width * (size_t)mask->height;
    for (size_t i = 0; i < count; i++)
        mask->data[i] = fminf(fmaxf((mask->data[i] - 0.3f) / 0.4f, 0), 1);
    return OK;
}

static status find(search *s, float *area)
{
    status result = start_from_border(s);
    if (result != OK) return result;
    keep_main_regions(s);
    result = refine_by_color(s);
    if (result != OK) return result;
    size_t objects = 0;
    for (size_t i = 0; i < s->count; i++)
        objects += s->object[i];
    *area = (float)objects / (float)s->count;
    if (*area < LEAST_AREA || *area > LARGEST_AREA)
        return fail(ERROR_INPUT, "no object stands out from the background; give a mask");
    return OK;
}

status find_object(const img *photo, img *mask, float *confidence)
{
    *mask = (img){0};
    *confidence = 0;
    search s;
    float area = 0;
    status result = search_new(photo, &s);
    if (result == OK) result = find(&s, &area);
    if (result == OK) {
        *confidence = trust(&s, area);
        result = enlarge(&s, photo, mask);
    }
    search_free(&s);
    return result;
}
