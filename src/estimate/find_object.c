#include "estimate/find_object.h"

#include <math.h>
#include <stdbool.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include "image/resize.h"

/* The search runs on a small copy: colours at the border start a two-sided colour model (object, background), which is
 * refined in a few rounds of "classify, smooth, keep one filled region, learn the colours again" (the idea of GrabCut,
 * Rother et al. 2004, with histograms instead of mixtures and a blur instead of a cut). */
enum { WORKING_SIDE = 192, CLUSTERS = 4, CLUSTER_ROUNDS = 8, ROUNDS = 5, SMOOTHING = 2, BINS = 12, OTSU_BINS = 128 };
static const float LEAST_SIGMA = 0.03f, FARTHEST = 12.0f, LEAST_AREA = 0.005f, LARGEST_AREA = 0.9f;

typedef struct search {
    img color;       /* small, square-root encoded */
    img probability; /* of being object */
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
    s->object = calloc(s->count, 1);
    s->ring = calloc(s->count, 1);
    s->stack = malloc(s->count * sizeof *s->stack);
    if (!s->object || !s->ring || !s->stack) return fail(ERROR_MEMORY, "no memory to look for the object");
    mark_ring(s);
    return OK;
}

/* ---- the border's colours ---- */

typedef struct cluster {
    float mean[3], deviation;
} cluster;

static float distance2(const float a[3], const float b[3])
{
    float r = a[0] - b[0], g = a[1] - b[1], c = a[2] - b[2];
    return r * r + g * g + c * c;
}

static int nearest(const cluster *k, const float color[3])
{
    int best = 0;
    for (int i = 1; i < CLUSTERS; i++)
        if (distance2(k[i].mean, color) < distance2(k[best].mean, color)) best = i;
    return best;
}

static void cluster_round(const search *s, cluster *k)
{
    float sum[CLUSTERS][3] = {{0}}, square[CLUSTERS] = {0}, weight[CLUSTERS] = {0};
    for (size_t i = 0; i < s->count; i++) {
        if (!s->ring[i]) continue;
        const float *color = s->color.data + 3 * i;
        int at = nearest(k, color);
        for (int c = 0; c < 3; c++)
            sum[at][c] += color[c];
        square[at] += distance2(color, k[at].mean);
        weight[at] += 1;
    }
    for (int j = 0; j < CLUSTERS; j++) {
        if (!(weight[j] > 0)) continue;
        for (int c = 0; c < 3; c++)
            k[j].mean[c] = sum[j][c] / weight[j];
        k[j].deviation = fmaxf(sqrtf(square[j] / weight[j]), LEAST_SIGMA);
    }
}

static void cluster_border(const search *s, cluster *k)
{
    size_t ring = 0, seen = 0;
    for (size_t i = 0; i < s->count; i++)
        ring += s->ring[i];
    for (size_t i = 0; i < s->count; i++) {
        if (!s->ring[i]) continue;
        size_t j = seen++ * CLUSTERS / ring;
        memcpy(k[j].mean, s->color.data + 3 * i, sizeof k[j].mean); /* the last of each quarter starts it */
        k[j].deviation = LEAST_SIGMA;
    }
    for (int round = 0; round < CLUSTER_ROUNDS; round++)
        cluster_round(s, k);
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

static void start_from_border(search *s)
{
    cluster k[CLUSTERS] = {{{0}, 0}};
    cluster_border(s, k);
    float *away = s->probability.data;
    for (size_t i = 0; i < s->count; i++) {
        away[i] = FARTHEST;
        for (int j = 0; j < CLUSTERS; j++)
            away[i] = fminf(away[i], sqrtf(distance2(s->color.data + 3 * i, k[j].mean)) / k[j].deviation);
    }
    float threshold = fmaxf(otsu(away, s->count), 2);
    for (size_t i = 0; i < s->count; i++)
        s->object[i] = away[i] > threshold;
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

/* Keeps the heaviest region and what it encloses. */
static void keep_one_region(search *s)
{
    enum { BACKGROUND, OBJECT, SEEN, BEST, OUTSIDE };
    float heaviest = 0;
    size_t best = s->count;
    for (size_t i = 0; i < s->count; i++) {
        if (s->object[i] != OBJECT) continue;
        float weight = flood(s, i, OBJECT, SEEN);
        if (weight > heaviest) {
            heaviest = weight;
            best = i;
        }
    }
    if (best < s->count) flood(s, best, SEEN, BEST);
    for (size_t i = 0; i < s->count; i++)
        if (s->object[i] == SEEN) s->object[i] = BACKGROUND;
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
        s->probability.data[i] = o / (o + b);
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
        keep_one_region(s);
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
    return fmaxf(0, (2 * agreement - 1) * (1 - 2 * fminf(spill, 0.5f)) * plausible);
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
    start_from_border(s);
    keep_one_region(s);
    status result = refine_by_color(s);
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
