#include "estimate/find_object.h"

#include <float.h>
#include <math.h>
#include <stdbool.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include "image/resize.h"

/* The search runs on a small copy: what cannot be reached from the border without crossing an edge starts a two-sided
 * colour model (object, background), which is refined in a few rounds of "classify, smooth, keep one filled region,
 * learn the colours again" (the idea of GrabCut, Rother et al. 2004, with histograms instead of mixtures and a blur
 * instead of a cut). */
enum { WORKING_SIDE = 192, SCANS = 6, ROUNDS = 4, SMOOTHING = 2, BINS = 12, OTSU_BINS = 128 };
static const float FARTHEST = 1.5f, OTSU_SHARE = 0.35f, LEAST_BARRIER = 0.08f, LIKE_COLOR = 0.06f;
static const float KEPT_SHARE = 0.1f;
static const float COLOR_WEIGHT = 0.5f, LEAST_AREA = 0.005f, LARGEST_AREA = 0.9f;

typedef struct search {
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
    for (size_t i = 0; i < 3 * s->count; i++)
        s->color.data[i] = sqrtf(fminf(fmaxf(s->color.data[i], 0), 1));
    s->prior = calloc(s->count, sizeof *s->prior);
    s->object = calloc(s->count, 1);
    s->ring = calloc(s->count, 1);
    s->stack = malloc(s->count * sizeof *s->stack);
    if (!s->prior || !s->object || !s->ring || !s->stack) return fail(ERROR_MEMORY, "no memory to look for the object");
    mark_ring(s);
    return OK;
}

/* ---- how far from the border ---- */

static float distance2(const float a[3], const float b[3])
{
    float r = a[0] - b[0], g = a[1] - b[1], c = a[2] - b[2];
    return r * r + g * g + c * c;
}

/* Of the picture's four sides, the nearest. */
static int side_of(const search *s, size_t i)
{
    int x = (int)(i % (size_t)s->width), y = (int)(i / (size_t)s->width);
    const int away[4] = {x, s->width - 1 - x, y, s->height - 1 - y};
    int best = 0;
    for (int k = 1; k < 4; k++)
        if (away[k] < away[best]) best = k;
    return best;
}

/* Which border pixels are background: those with a like colour on another side. An object that the picture cuts off at
 * one side has none. */
static void choose_seeds(search *s)
{
    size_t ring = 0, seeds = 0;
    for (size_t i = 0; i < s->count; i++) {
        if (!s->ring[i]) continue;
        s->stack[ring++] = i;
    }
    for (size_t i = 0; i < ring; i++) {
        float nearest = FLT_MAX;
        for (size_t j = 0; j < ring; j++) {
            if (side_of(s, s->stack[j]) == side_of(s, s->stack[i])) continue;
            nearest = fminf(nearest, distance2(s->color.data + 3 * s->stack[i], s->color.data + 3 * s->stack[j]));
        }
        s->object[s->stack[i]] = nearest < LIKE_COLOR * LIKE_COLOR;
        seeds += s->object[s->stack[i]];
    }
    for (size_t i = 0; i < ring && 3 * seeds < ring; i++)
        s->object[s->stack[i]] = 1;
}

/* One channel's barrier: the least (maximum - minimum) of any path from a seed (Strand et al. 2013), found by a few
 * raster scans (Zhang et al. 2015). */
typedef struct barrier {
    const float *value; /* every third */
    float *cost, *high, *low;
    int width, height;
} barrier;

static void barrier_visit(barrier *b, size_t at, size_t from)
{
    float x = b->value[3 * at], high = fmaxf(b->high[from], x), low = fminf(b->low[from], x);
    if (high - low >= b->cost[at]) return;
    b->cost[at] = high - low;
    b->high[at] = high;
    b->low[at] = low;
}

static void barrier_scan(barrier *b, bool backward)
{
    size_t width = (size_t)b->width, height = (size_t)b->height, count = width * height;
    for (size_t k = 0; k < count; k++) {
        size_t i = backward ? count - 1 - k : k, x = i % width, y = i / width;
        if (!backward && x > 0) barrier_visit(b, i, i - 1);
        if (!backward && y > 0) barrier_visit(b, i, i - width);
        if (backward && x + 1 < width) barrier_visit(b, i, i + 1);
        if (backward && y + 1 < height) barrier_visit(b, i, i + width);
    }
}

/* probability = the barriers of all channels, seeds (in object) having none. */
static status measure_barriers(search *s)
{
    float *memory = calloc(s->count, 3 * sizeof *memory);
    if (!memory) return fail(ERROR_MEMORY, "no memory to look for the object");
    memset(s->probability.data, 0, s->count * sizeof(float));
    for (int c = 0; c < 3; c++) {
        barrier b = {s->color.data + c, memory, memory + s->count, memory + 2 * s->count, s->width, s->height};
        for (size_t i = 0; i < s->count; i++) {
            bool seed = s->ring[i] && s->object[i];
            b.cost[i] = seed ? 0 : FLT_MAX;
            b.high[i] = b.low[i] = b.value[3 * i];
        }
        for (int scan = 0; scan < SCANS; scan++)
            barrier_scan(&b, scan & 1);
        for (size_t i = 0; i < s->count; i++)
            s->probability.data[i] += fminf(b.cost[i], 1);
    }
    free(memory);
    return OK;
}

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
    choose_seeds(s);
    status result = measure_barriers(s);
    if (result != OK) return result;
    const float *away = s->probability.data;
    float threshold = fmaxf(OTSU_SHARE * otsu(away, s->count), LEAST_BARRIER);
    for (size_t i = 0; i < s->count; i++) {
        s->object[i] = away[i] > threshold;
        /* odds 1 at the threshold, e² twice as far */
        s->prior[i] = 2 * (away[i] / threshold - 1);
    }
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
        const size_t next[4] = {at - 1, at + 1, at - width, at + width};
        const bool inside[4] = {x > 0, x + 1 < width, y > 0, y + 1 < height};
        for (int i = 0; i < 4; i++) {
            if (!inside[i] || s->object[next[i]] != from) continue;
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

typedef float histogram[BINS][BINS][BINS];

/* Trilinear weights of a colour's eight bins; visit: add to them, or read them. */
static float visit(histogram *h, const float color[3], float add)
{
    int low[3];
    float part[3], value = 0;
    for (int c = 0; c < 3; c++) {
        float place = color[c] * (BINS - 1);
        low[c] = (int)fminf(place, BINS - 2);
        part[c] = place - (float)low[c];
    }
    for (int i = 0; i < 8; i++) {
        int r = i & 1, g = (i >> 1) & 1, b = i >> 2;
        float weight = (r ? part[0] : 1 - part[0]) * (g ? part[1] : 1 - part[1]) * (b ? part[2] : 1 - part[2]);
        float *bin = &(*h)[low[0] + r][low[1] + g][low[2] + b];
        *bin += weight * add;
        value += weight * *bin;
    }
    return value;
}

static float logistic(float x)
{
    return 1 / (1 + expf(-x));
}

static void classify(search *s, histogram *object, histogram *background)
{
    memset(object, 0, sizeof *object);
    memset(background, 0, sizeof *background);
    float objects = 1, backgrounds = 1;
    for (size_t i = 0; i < s->count; i++) {
        visit(s->object[i] ? object : background, s->color.data + 3 * i, 1);
        *(s->object[i] ? &objects : &backgrounds) += 1;
    }
    for (size_t i = 0; i < s->count; i++) {
        const float *color = s->color.data + 3 * i;
        float o = (visit(object, color, 0) + 0.05f) / objects, b = (visit(background, color, 0) + 0.05f) / backgrounds;
        s->probability.data[i] = logistic(COLOR_WEIGHT * logf(o / b) + fminf(fmaxf(s->prior[i], -3), 3));
    }
}

/* Mean of the probability around (x, y). */
static float smoothed(const search *s, int x, int y)
{
    float sum = 0, count = 0;
    for (int v = y - SMOOTHING; v <= y + SMOOTHING; v++) {
        for (int u = x - SMOOTHING; u <= x + SMOOTHING; u++) {
            if (u < 0 || v < 0 || u >= s->width || v >= s->height) continue;
            sum += *img_at(&s->probability, u, v);
            count += 1;
        }
    }
    return sum / count;
}

static status refine_by_color(search *s)
{
    histogram *both = malloc(2 * sizeof *both);
    if (!both) return fail(ERROR_MEMORY, "no memory to look for the object");
    for (int round = 0; round < ROUNDS; round++) {
        classify(s, &both[0], &both[1]);
        for (int y = 0; y < s->height; y++)
            for (int x = 0; x < s->width; x++)
                s->object[y * s->width + x] = smoothed(s, x, y) > 0.5f;
        keep_main_regions(s);
    }
    free(both);
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
    status result = img_new(&small, s->width, s->height, 1);
    for (size_t i = 0; result == OK && i < s->count; i++)
        small.data[i] = s->object[i];
    if (result == OK && (photo->width != s->width || photo->height != s->height))
        result = img_guided_upsample(&small, NULL, photo, NULL, 2, 1e-4f, mask);
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
