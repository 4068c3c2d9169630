/* SPDX-License-Identifier: MIT */
#include "photo_stereo/picture_edges.h"

#include <math.h>
#include <stdbool.h>

#include "base/parallel.h"
#include "image/resize.h"

/* Ratio of the longer side to the margin around the mask, which holds the outline. */
enum { MARGIN = 32 };
/* Brightness, as a share of a picture's mean, that is added before the logarithm, so that noise in the dark is no edge;
 * largest slope of the logarithm that counts: an outline before a dark background would be all there is else. */
static const float floor_share = 0.1f, steepest = 0.5f;

int edge_longer_side(const merlin_capture *c)
{
    return c->width > c->height ? c->width : c->height;
}

/* Makes a picture's brightness, each pixel the mean of `side` × `side`; a rest at the right and below is left out. */
static status brightness_of(const merlin_capture *c, int k, int side, img *out)
{
    const size_t channels = (size_t)c->channels, run = (size_t)side * channels;
    const float share = 1 / (65535 * (float)(side * side) * (float)channels);
    status s = img_new(out, c->width / side, c->height / side, 1);
    for (int y = 0; s == OK && y < side * out->height; y++) {
        size_t from = (size_t)y * (size_t)c->width * channels;
        float *to = img_at(out, 0, y / side);
        for (int x = 0; x < out->width; x++) {
            uint32_t sum = 0;
            for (size_t i = 0; i < run; i++)
                sum += pst_code(&c->picture[k], from++);
            to[x] += share * (float)sum;
        }
    }
    return s;
}

/* Replaces a picture by the logarithm of its brightness. */
static void take_logarithm(img *picture)
{
    double sum = 0;
    const size_t count = img_value_count(picture);
    for (size_t i = 0; i < count; i++)
        sum += (double)picture->data[i];
    const float base = floor_share * (float)(sum / (double)count) + 1e-6f;
    for (size_t i = 0; i < count; i++)
        picture->data[i] = logf(picture->data[i] + base);
}

static status slopes_of(const img *log_brightness, img *out)
{
    const img *l = log_brightness;
    status s = img_new(out, l->width, l->height, 1);
    if (s != OK) return s;
    for (int y = 0; y + 1 < l->height; y++)
        for (int x = 0; x + 1 < l->width; x++) {
            const float here = *img_at(l, x, y);
            const float slope = hypotf(*img_at(l, x + 1, y) - here, *img_at(l, x, y + 1) - here);
            *img_at(out, x, y) = fminf(slope, steepest);
        }
    return s;
}

static status find_edges(void *context, size_t k)
{
    const edge_level *l = context;
    img whole = {0}, small = {0};
    const int across = l->capture->width / l->width, down = l->capture->height / l->height;
    const int side = across < down ? across : down;
    status s = brightness_of(l->capture, (int)k, side > 1 ? side : 1, &whole);
    if (s == OK) s = img_resize(&whole, l->width, l->height, &small);
    if (s == OK) {
        take_logarithm(&small);
        s = slopes_of(&small, &l->edges[k]);
    }
    img_free(&whole);
    img_free(&small);
    return s;
}

static status find_mask(edge_level *l)
{
    const bool given = l->capture->mask.data != NULL;
    img *out = &l->mask;
    status s = given ? img_resize(&l->capture->mask, l->width, l->height, out) : img_new(out, l->width, l->height, 1);
    if (s == OK && given) s = img_box_sums(out, (l->width > l->height ? l->width : l->height) / MARGIN);
    for (size_t i = 0; s == OK && i < img_value_count(out); i++)
        out->data[i] = !given || out->data[i] > 0.5f;
    return s;
}

void edge_level_add(edge_level *l, int k, float weight)
{
    const shift by = l->by[k];
    for (int y = shift_first(by.y); y < shift_end(by.y, l->height); y++) {
        float *to = img_at(&l->sum, 0, y);
        const float *from = img_at(&l->edges[k], 0, y + by.y) + by.x;
        for (int x = shift_first(by.x); x < shift_end(by.x, l->width); x++)
            to[x] += weight * from[x];
    }
}

double edge_level_likeness(const edge_level *l, int k, shift by)
{
    double a = 0, b = 0, aa = 0, bb = 0, ab = 0, count = 1e-9;
    for (int y = shift_first(by.y); y < shift_end(by.y, l->height); y++) {
        const float *mask = img_at(&l->mask, 0, y), *sum = img_at(&l->sum, 0, y);
        const float *own = img_at(&l->edges[k], 0, y + by.y) + by.x;
        float row[6] = {0};
        for (int x = shift_first(by.x); x < shift_end(by.x, l->width); x++) {
            const float m = mask[x], p = m * own[x], q = m * sum[x];
            row[0] += p, row[1] += q, row[2] += p * p, row[3] += q * q, row[4] += p * q, row[5] += m;
        }
        a += (double)row[0], b += (double)row[1], aa += (double)row[2], bb += (double)row[3], ab += (double)row[4];
        count += (double)row[5];
    }
    const double spread = (aa - a * a / count) * (bb - b * b / count);
    return spread > 0 ? (ab - a * b / count) / sqrt(spread) : 0;
}

shift edge_trials_at(const edge_trials *t, size_t i)
{
    const int side = 2 * t->reach + 1, at = (int)i;
    return (shift){t->start.x + at % side - t->reach, t->start.y + at / side - t->reach};
}

static void try_shift(void *context, size_t i)
{
    edge_trials *t = context;
    const shift by = edge_trials_at(t, i);
    const bool inside = abs(by.x) < t->level->width && abs(by.y) < t->level->height;
    t->likeness[i] = inside ? edge_level_likeness(t->level, t->picture, by) : -1;
}

size_t edge_trials_run(edge_trials *t)
{
    const size_t side = 2 * (size_t)t->reach + 1, count = side * side;
    parallel_for(count, try_shift, t);
    return count;
}

status edge_level_new(const merlin_capture *capture, shift *by, int longest, edge_level *out)
{
    const float scale = (float)longest / (float)edge_longer_side(capture);
    *out = (edge_level){.capture = capture, .by = by};
    out->width = (int)fmaxf(1, roundf(scale * (float)capture->width));
    out->height = (int)fmaxf(1, roundf(scale * (float)capture->height));
    out->edges = calloc((size_t)capture->count, sizeof *out->edges);
    status s = out->edges ? OK : fail(MERLIN_NO_MEMORY, "no memory for %d pictures", capture->count);
    if (s == OK) s = parallel_try((size_t)capture->count, find_edges, out);
    if (s == OK) s = find_mask(out);
    if (s == OK) s = img_new(&out->sum, out->width, out->height, 1);
    return s;
}

void edge_level_free(edge_level *l)
{
    for (int k = 0; k < l->capture->count && l->edges; k++)
        img_free(&l->edges[k]);
    free(l->edges);
    img_free(&l->mask);
    img_free(&l->sum);
}
