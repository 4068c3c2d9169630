/* SPDX-License-Identifier: MIT */
#include "photo_stereo/align_pictures.h"

#include <math.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

#include "base/parallel.h"
#include "image/resize.h"

/* Longer sides of the coarsest and the finest pictures of edges, how far is searched in them, and how often; ratio of
 * the longer side to the margin around the mask, which holds the outline. */
enum { COARSEST = 128, FINEST = 1024, FIRST_REACH = 6, REACH = 2, PASSES = 4, MARGIN = 32 };
/* Brightness, as a share of a picture's mean, that is added before the logarithm, so that noise in the dark is no edge;
 * largest slope of the logarithm that counts: an outline before a dark background would be all there is else. */
static const float floor_share = 0.1f, steepest = 0.5f;
/* A shift counts if the edges' correlation is at least this, and what it lacks of 1 at most this share of what it lacks
 * without; less strictly as long as finer pictures follow. A shadow's edge lies elsewhere in each picture: those of a
 * plain ball under eight lights reach 0.6 and a share of 0.62, pictures that moved by four pixels 0.25 to 0.5. */
static const double alike = 0.5, clearly = 0.6, perhaps = 0.85;

/* Longer side of the pictures of edges in which shifts are searched that are too large to be undone, how far, and up to
 * where they are none. A shift from there on counts if what the correlation lacks of 1 is at most this share of what it
 * lacks nearer. Measured: 0.25 to 0.45 of a cat, an owl and a ball that moved by 40 to 75 of 512 pixels, 0.69 and more
 * of pictures that did not move, and then of a correlation below 0.3. Two pictures of one relief under lights from two
 * sides, lit in different places, reach a correlation of 0.67 by chance. */
enum { FAR_SIDE = 64, FAR_REACH = 16, NEAR = 3 };
static const double plainly = 0.5, alike_of_two = 0.72;
/* Least share of the edges of an object that moved so far that lie where the others have none of it. */
static const double aside = 0.02;

typedef struct shift {
    int x, y; /* pixels to the right and down */
} shift;

/* The pictures at one size. */
typedef struct level {
    const merlin_capture *capture;
    int width, height;
    img *edges;    /* of each picture, 1 channel */
    img mask, sum; /* where edges are compared; the sum of those of the pictures that are compared with, as shifted */
    shift *by;     /* of each picture */
    bool coarsest, finest;
    int far; /* a picture that moved too far; -1: none */
    shift far_by;
} level;

/* ---- edges ---- */

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
    const level *l = context;
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

static status find_mask(level *l)
{
    const bool given = l->capture->mask.data != NULL;
    img *out = &l->mask;
    status s = given ? img_resize(&l->capture->mask, l->width, l->height, out) : img_new(out, l->width, l->height, 1);
    if (s == OK && given) s = img_box_sums(out, (l->width > l->height ? l->width : l->height) / MARGIN);
    for (size_t i = 0; s == OK && i < img_value_count(out); i++)
        out->data[i] = !given || out->data[i] > 0.5f;
    return s;
}

/* ---- shifts ---- */

/* The part of a row that stays in the picture when it is shifted. */
static int first_of(int by)
{
    return by < 0 ? -by : 0;
}

static int end_of(int by, int size)
{
    return by > 0 ? size - by : size;
}

/* Adds a picture's edges, shifted back, to the sum of all that are compared with. */
static void add_edges(level *l, int k, float weight)
{
    const shift by = l->by[k];
    for (int y = first_of(by.y); y < end_of(by.y, l->height); y++) {
        float *to = img_at(&l->sum, 0, y);
        const float *from = img_at(&l->edges[k], 0, y + by.y) + by.x;
        for (int x = first_of(by.x); x < end_of(by.x, l->width); x++)
            to[x] += weight * from[x];
    }
}

/* Returns the correlation, within the mask, of a picture's edges, shifted back, with the sum of the others'. */
static double likeness(const level *l, int k, shift by)
{
    double a = 0, b = 0, aa = 0, bb = 0, ab = 0, count = 1e-9;
    for (int y = first_of(by.y); y < end_of(by.y, l->height); y++) {
        const float *mask = img_at(&l->mask, 0, y), *sum = img_at(&l->sum, 0, y);
        const float *own = img_at(&l->edges[k], 0, y + by.y) + by.x;
        float row[6] = {0};
        for (int x = first_of(by.x); x < end_of(by.x, l->width); x++) {
            const float m = mask[x], p = m * own[x], q = m * sum[x];
            row[0] += p, row[1] += q, row[2] += p * p, row[3] += q * q, row[4] += p * q, row[5] += m;
        }
        a += (double)row[0], b += (double)row[1], aa += (double)row[2], bb += (double)row[3], ab += (double)row[4];
        count += (double)row[5];
    }
    const double spread = (aa - a * a / count) * (bb - b * b / count);
    return spread > 0 ? (ab - a * b / count) / sqrt(spread) : 0;
}

/* Shifts that are tried of one picture. */
typedef struct trial {
    const level *level;
    int picture, side; /* side² of them */
    shift start;       /* in the middle */
    double likeness[(2 * FAR_REACH + 1) * (2 * FAR_REACH + 1)];
} trial;

static shift tried(const trial *t, size_t i)
{
    const int half = t->side / 2, at = (int)i;
    return (shift){t->start.x + at % t->side - half, t->start.y + at / t->side - half};
}

static void try_shift(void *context, size_t i)
{
    trial *t = context;
    const shift by = tried(t, i);
    const bool inside = abs(by.x) < t->level->width && abs(by.y) < t->level->height;
    t->likeness[i] = inside ? likeness(t->level, t->picture, by) : -1;
}

/* Finds the shift with which a picture's edges are most like the others'. */
static void find_shift(level *l, int k, int reach)
{
    trial t = {.level = l, .picture = k, .side = 2 * reach + 1, .start = l->by[k]};
    const size_t count = (size_t)t.side * (size_t)t.side;
    const double unmoved = likeness(l, k, (shift){0, 0});
    double best = unmoved;
    parallel_for(count, try_shift, &t);
    l->by[k] = (shift){0, 0};
    for (size_t i = 0; i < count; i++) {
        if (t.likeness[i] <= best) continue;
        best = t.likeness[i];
        l->by[k] = tried(&t, i);
    }
    if (best < alike || 1 - best > (l->finest ? clearly : perhaps) * (1 - unmoved)) l->by[k] = (shift){0, 0};
}

/* Finds the shifts at one size: without earlier ones first of each picture from those before it, then of each from all
 * others. One after another, as two that look for each other at once would change places. */
static void find_level_shifts(level *l)
{
    const int count = l->capture->count;
    add_edges(l, 0, 1);
    for (int k = 1; k < count; k++) {
        if (l->coarsest) find_shift(l, k, FIRST_REACH);
        add_edges(l, k, 1);
    }
    bool changed = true;
    for (int pass = 0; pass < PASSES && changed; pass++) {
        changed = false;
        /* the first one, too, since all others may agree that it has moved */
        for (int k = 0; k < count; k++) {
            const shift before = l->by[k];
            add_edges(l, k, -1);
            find_shift(l, k, pass ? 1 : REACH);
            add_edges(l, k, 1);
            changed |= before.x != l->by[k].x || before.y != l->by[k].y;
        }
    }
}

/* Returns the share of edges in the object's place, as shifted, that lie outside of the object's place. */
static double share_aside(const level *l, const img *edges, shift by)
{
    double all = 1e-9, out = 0;
    for (int y = first_of(by.y); y < end_of(by.y, l->height); y++) {
        const float *mask = img_at(&l->mask, 0, y), *at = img_at(&l->mask, 0, y + by.y) + by.x;
        const float *own = img_at(edges, 0, y + by.y) + by.x;
        for (int x = first_of(by.x); x < end_of(by.x, l->width); x++) {
            const double energy = (double)(mask[x] * own[x] * own[x]);
            all += energy;
            out += at[x] > 0 ? 0 : energy;
        }
    }
    return out / all;
}

/* Tells whether the object is seen outside of its place, in a picture or, the other way, in the others: one that moved
 * takes its outline along; what is lit elsewhere on one that did not move is inside. */
static bool is_aside(const level *l, int k, shift by)
{
    return share_aside(l, &l->edges[k], by) >= aside || share_aside(l, &l->sum, (shift){-by.x, -by.y}) >= aside;
}

/* Tells whether a picture's edges are those of the others after a large shift. */
static bool look_far(const level *l, int k, shift *by)
{
    trial t = {.level = l, .picture = k, .side = 2 * FAR_REACH + 1};
    const size_t count = (size_t)t.side * (size_t)t.side;
    double near = -1, far = -1;
    parallel_for(count, try_shift, &t);
    for (size_t i = 0; i < count; i++) {
        const shift at = tried(&t, i);
        if (abs(at.x) <= NEAR && abs(at.y) <= NEAR) {
            near = fmax(near, t.likeness[i]);
        } else if (t.likeness[i] > far) {
            far = t.likeness[i];
            *by = at;
        }
    }
    if (far < (l->capture->count == 2 ? alike_of_two : alike) || 1 - far > plainly * (1 - near)) return false;
    return !l->capture->mask.data || is_aside(l, k, *by);
}

static void find_far(level *l)
{
    const int count = l->capture->count;
    l->far = -1;
    for (int k = 0; k < count; k++)
        add_edges(l, k, 1);
    for (int k = 0; k < count && l->far < 0; k++) {
        add_edges(l, k, -1);
        if (look_far(l, k, &l->far_by)) l->far = k;
        add_edges(l, k, 1);
    }
}

static void level_free(level *l)
{
    for (int k = 0; k < l->capture->count && l->edges; k++)
        img_free(&l->edges[k]);
    free(l->edges);
    img_free(&l->mask);
    img_free(&l->sum);
}

/* Searches pictures of edges of this longer side; *l: its capture, shifts and place among the levels. */
static status run_level(level *l, int longest, void (*search)(level *l))
{
    const merlin_capture *c = l->capture;
    const float scale = (float)longest / (float)(c->width > c->height ? c->width : c->height);
    l->width = (int)fmaxf(1, roundf(scale * (float)c->width));
    l->height = (int)fmaxf(1, roundf(scale * (float)c->height));
    l->edges = calloc((size_t)c->count, sizeof *l->edges);
    status s = l->edges ? OK : fail(MERLIN_NO_MEMORY, "no memory for %d pictures", c->count);
    if (s == OK) s = parallel_try((size_t)c->count, find_edges, l);
    if (s == OK) s = find_mask(l);
    if (s == OK) s = img_new(&l->sum, l->width, l->height, 1);
    if (s == OK) search(l);
    level_free(l);
    return s;
}

/* Finds the shifts in pixels of the finest size, which is returned. */
static status find_shifts(const merlin_capture *c, shift *by, int *finest)
{
    const int longer = c->width > c->height ? c->width : c->height;
    *finest = longer < FINEST ? longer : FINEST;
    int longest = *finest;
    while (longest > COARSEST)
        longest = (longest + 1) / 2;
    level l = {.capture = c, .by = by, .coarsest = true, .finest = longest == *finest};
    status s = run_level(&l, longest, find_level_shifts);
    while (s == OK && longest < *finest) {
        const int next = 2 * longest < *finest ? 2 * longest : *finest;
        for (int k = 0; k < c->count; k++)
            by[k] = (shift){by[k].x * next / longest, by[k].y * next / longest};
        longest = next;
        l = (level){.capture = c, .by = by, .finest = longest == *finest};
        s = run_level(&l, longest, find_level_shifts);
    }
    return s;
}

/* Refuses pictures of which one moved too far. by: zeros. */
static status refuse_far(const merlin_capture *c, shift *by)
{
    const int longer = c->width > c->height ? c->width : c->height, longest = longer < FAR_SIDE ? longer : FAR_SIDE;
    level l = {.capture = c, .by = by};
    status s = run_level(&l, longest, find_far);
    if (s != OK || l.far < 0) return s;
    const float pixels = hypotf((float)l.far_by.x, (float)l.far_by.y) * (float)longer / (float)longest;
    const char *name = c->name && c->name[l.far] ? c->name[l.far] : "one of them";
    return fail(
        MERLIN_BAD_INPUT,
        "the pictures are not from one place: in %s the object is about %.0f pixels aside from where the others "
        "have it; leave it out, or take all with a camera that stands still",
        name, (double)pixels);
}

/* ---- pictures ---- */

static status move_picture(const merlin_capture *c, int k, shift by, pst_plane *out)
{
    const pst_plane *picture = &c->picture[k];
    const size_t pixel = (size_t)c->channels * pst_plane_bytes(picture), width = (size_t)c->width;
    char *to = calloc(width * (size_t)c->height, pixel);
    if (!to) return fail(MERLIN_NO_MEMORY, "no memory to move a picture");
    const int left = first_of(by.x), right = end_of(by.x, c->width);
    for (int y = first_of(by.y); y < end_of(by.y, c->height) && left < right; y++) {
        const size_t at = (size_t)y * width + (size_t)left, from = (size_t)(y + by.y) * width + (size_t)(left + by.x);
        memcpy(to + at * pixel, pst_plane_data(picture) + from * pixel, (size_t)(right - left) * pixel);
    }
    *out = *picture;
    if (picture->narrow)
        out->narrow = (uint8_t *)to;
    else
        out->wide = (uint16_t *)(void *)to;
    return OK;
}

static status move_pictures(const merlin_capture *c, const shift *by, float scale, merlin_capture *out,
                            picture_shifts *shifts)
{
    status s = OK;
    for (int k = 1; k < c->count && s == OK; k++) {
        const float x = scale * (float)(by[k].x - by[0].x), y = scale * (float)(by[k].y - by[0].y);
        const int length = (int)roundf(hypotf(x, y));
        if (length == 0) continue;
        shifts->moved++;
        if (length > shifts->most) shifts->most = length, shifts->which = k;
        s = move_picture(c, k, (shift){(int)roundf(x), (int)roundf(y)}, &out->picture[k]);
    }
    return s;
}

status align_pictures(const merlin_capture *c, merlin_capture *out, picture_shifts *shifts)
{
    const size_t count = (size_t)c->count;
    int finest = 1;
    *out = *c;
    *shifts = (picture_shifts){0};
    out->picture = calloc(count, sizeof *out->picture);
    shift *by = calloc(count, sizeof *by);
    status s = out->picture && by ? OK : fail(MERLIN_NO_MEMORY, "no memory for %d pictures", c->count);
    if (s == OK) memcpy(out->picture, c->picture, count * sizeof *out->picture);
    if (s == OK && c->count > 1) s = refuse_far(c, by);
    if (s == OK && c->count > 1) s = find_shifts(c, by, &finest);
    if (s == OK && c->count > 1)
        s = move_pictures(c, by, (float)(c->width > c->height ? c->width : c->height) / (float)finest, out, shifts);
    free(by);
    if (s != OK) align_pictures_free(c, out);
    return s;
}

void align_pictures_free(const merlin_capture *c, merlin_capture *aligned)
{
    for (int k = 0; k < c->count && aligned->picture; k++)
        if (pst_plane_data(&aligned->picture[k]) != pst_plane_data(&c->picture[k]))
            pst_plane_free(&aligned->picture[k]);
    free(aligned->picture);
    *aligned = (merlin_capture){0};
}
