/* SPDX-License-Identifier: MIT */
#include "estimate/object/object_search.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/number.h"
#include "estimate/object/border_distance.h"
#include "estimate/object/object_quality.h"
#include "image/resize.h"

enum { WORKING_SIDE = 96, OTSU_BINS = 128, FREE = 0, BACKGROUND = 1, OBJECT = 2 };
static const float FARTHEST = 1.5f, OTSU_SHARE = 0.35f, LEAST_BARRIER = 0.08f;
/* Log odds against an object at the picture's border: at its top, where photographers do not cut objects off, and at
 * its sides. */
static const float AGAINST_TOP = 3, AGAINST_SIDES = 1.5f;
/* Largest log odds by place in the presence of a hint, which says more; and the bonus in log odds by which each point
 * favours candidates grown from the points. */
static const float MOST_BESIDE_HINT = 0.6f, BONUS_BY_POINT = 1;
/* Ties between similar neighbours in log odds. */
static const float TIE = 6;

static status no_memory(void)
{
    return fail(MERLIN_NO_MEMORY, "no memory to look for the object");
}

void object_search_free(object_search *s)
{
    object_view_free(&s->view);
    img_free(&s->away);
    free(s->prior);
    free(s->fixed);
    free(s->wanted);
    free(s->ring);
    free(s->start);
    for (int i = 0; i < s->count; i++)
        object_candidate_free(&s->candidate[i]);
    *s = (object_search){0};
}

/* ---- the border and what is known ---- */

static void mark_ring(object_search *s)
{
    int w = s->view.width, h = s->view.height, shorter = w < h ? w : h;
    int margin = shorter / 40 > 1 ? shorter / 40 : 1;
    for (int y = 0; y < h; y++)
        for (int x = 0; x < w; x++)
            s->ring[y * w + x] = x < margin || y < margin || x >= w - margin || y >= h - margin;
}

/* Makes everything outside the box background, like the border. */
static void apply_box(object_search *s, const img *photo, const merlin_hint *hint)
{
    const float across = (float)s->view.width / (float)photo->width,
                down = (float)s->view.height / (float)photo->height;
    for (int y = 0; y < s->view.height; y++)
        for (int x = 0; x < s->view.width; x++) {
            bool in_columns = (float)(x + 1) > across * (float)hint->box.x &&
                              (float)x < across * (float)(hint->box.x + hint->box.width);
            bool in_rows =
                (float)(y + 1) > down * (float)hint->box.y && (float)y < down * (float)(hint->box.y + hint->box.height);
            s->fixed[y * s->view.width + x] = in_columns && in_rows ? FREE : BACKGROUND;
        }
    for (size_t i = 0; i < s->view.count; i++)
        s->ring[i] |= s->fixed[i] == BACKGROUND;
}

static status apply_points(object_search *s, const img *photo, const merlin_hint *hint)
{
    s->wanted = calloc(s->view.count, 1);
    if (!s->wanted) return no_memory();
    for (int i = 0; i < hint->point_count; i++) {
        size_t x = (size_t)hint->point[i].x * (size_t)s->view.width / (size_t)photo->width;
        size_t y = (size_t)hint->point[i].y * (size_t)s->view.height / (size_t)photo->height;
        size_t at = y * (size_t)s->view.width + x;
        s->wanted[at] = 1;
        s->fixed[at] = OBJECT;
    }
    return OK;
}

static status search_new(const img *photo, const merlin_hint *hint, object_search *s)
{
    status st = object_view_exposure(photo, WORKING_SIDE, &s->exposure);
    if (st == OK) st = object_view_new(photo, WORKING_SIDE, s->exposure, &s->view);
    if (st != OK) return st;
    size_t count = s->view.count;
    s->prior = calloc(count, sizeof *s->prior);
    s->fixed = calloc(count, 1);
    s->ring = calloc(count, 1);
    s->start = calloc(count, 1);
    if (!s->prior || !s->fixed || !s->ring || !s->start) return no_memory();
    mark_ring(s);
    if (hint && hint->box.width) apply_box(s, photo, hint);
    if (hint && hint->point_count) st = apply_points(s, photo, hint);
    return st == OK ? border_distance(&s->view.color, s->ring, &s->away) : st;
}

/* Returns the threshold that separates two groups best (Otsu 1979), for values in [0, highest]. */
static float otsu(const float *value, size_t count, float highest)
{
    double histogram[OTSU_BINS] = {0}, total = 0, below = 0, below_sum = 0, best = -1;
    int threshold = OTSU_BINS / 2;
    for (size_t i = 0; i < count; i++)
        histogram[(int)fminf(value[i] / highest * OTSU_BINS, OTSU_BINS - 1)]++;
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
    return (float)threshold / OTSU_BINS * highest;
}

static void find_prior(object_search *s, float threshold)
{
    const size_t width = (size_t)s->view.width, height = (size_t)s->view.height;
    for (size_t i = 0; i < s->view.count; i++) {
        s->prior[i] = 2 * (s->away.data[i] / threshold - 1);
        size_t x = i % width, y = i / width;
        if (!s->ring[i]) continue;
        bool at_side = x * 40 < width || (x + 1) * 40 > width * 39;
        s->prior[i] -= y * 40 < height ? AGAINST_TOP : at_side ? AGAINST_SIDES : 0;
    }
}

/* ---- first guesses ---- */

static void start_away(object_search *s, float threshold)
{
    for (size_t i = 0; i < s->view.count; i++)
        s->start[i] = s->away.data[i] > threshold;
}

static status start_bright(object_search *s)
{
    float *light = malloc(s->view.count * sizeof *light);
    if (!light) return no_memory();
    for (size_t i = 0; i < s->view.count; i++)
        light[i] = (s->view.color.data[3 * i] + s->view.color.data[3 * i + 1] + s->view.color.data[3 * i + 2]) / 3;
    float threshold = otsu(light, s->view.count, 1);
    for (size_t i = 0; i < s->view.count; i++)
        s->start[i] = light[i] > threshold && !s->ring[i];
    free(light);
    return OK;
}

/* Starts from an ellipse in the middle of the picture or of the hint's box. */
static void start_middle(object_search *s, const img *photo, const merlin_hint *hint)
{
    bool boxed = hint && hint->box.width;
    float x = boxed ? ((float)hint->box.x + 0.5f * (float)hint->box.width) / (float)photo->width : 0.5f;
    float y = boxed ? ((float)hint->box.y + 0.5f * (float)hint->box.height) / (float)photo->height : 0.5f;
    float across = boxed ? 0.45f * (float)hint->box.width / (float)photo->width : 0.33f;
    float down = boxed ? 0.45f * (float)hint->box.height / (float)photo->height : 0.33f;
    const size_t width = (size_t)s->view.width;
    for (size_t i = 0; i < s->view.count; i++) {
        size_t row = i / width;
        float u = (((float)(i % width) + 0.5f) / (float)width - x) / across;
        float v = (((float)row + 0.5f) / (float)s->view.height - y) / down;
        s->start[i] = u * u + v * v < 1;
    }
}

/* Starts from discs around the points, whose radius is a share of the picture's longer side. */
static void start_around(object_search *s, float share)
{
    const int w = s->view.width, h = s->view.height, radius = (int)(share * (float)(w > h ? w : h));
    memset(s->start, 0, s->view.count);
    for (size_t i = 0; i < s->view.count; i++) {
        if (!s->wanted[i]) continue;
        int x = (int)(i % (size_t)w), y = (int)(i / (size_t)w);
        for (int v = y - radius; v <= y + radius; v++)
            for (int u = x - radius; u <= x + radius; u++) {
                bool inside =
                    u >= 0 && v >= 0 && u < w && v < h && (u - x) * (u - x) + (v - y) * (v - y) <= radius * radius;
                if (inside) s->start[v * w + u] = 1;
            }
    }
}

/* ---- candidates ---- */

static status grow(object_search *s, object_ground *ground, bool outside_hull)
{
    for (size_t i = 0; i < s->view.count; i++)
        if (s->fixed[i]) s->start[i] = s->fixed[i] == OBJECT;
    status st = object_candidate_grow(ground, s->start, outside_hull, &s->candidate[s->count]);
    if (st == OK) s->count++;
    return st;
}

/* Grows candidates from the hint alone, as the part that differs from the border need not be the object that is meant.
 */
static status grow_by_hint(object_search *s, const img *photo, const merlin_hint *hint, object_ground *ground)
{
    static const float radii[] = {0.06f, 0.12f, 0.2f};
    status st = OK;
    for (size_t i = 0; i < s->view.count; i++)
        s->prior[i] = clamp(s->prior[i], -MOST_BESIDE_HINT, MOST_BESIDE_HINT);
    s->hinted = s->count;
    for (int i = 0; i < 3 && s->wanted && st == OK; i++) {
        start_around(s, radii[i]);
        st = grow(s, ground, false);
    }
    if (st != OK || !hint->box.width) return st;
    start_middle(s, photo, hint);
    return grow(s, ground, false);
}

static status grow_all(object_search *s, const img *photo, const merlin_hint *hint, object_ground *ground)
{
    static const struct {
        float times;
        bool outside_hull;
    } guesses[] = {{1, true}, {2.2f, true}, {1, false}, {2.2f, false}};
    float threshold = fmaxf(OTSU_SHARE * otsu(s->away.data, s->view.count, FARTHEST), LEAST_BARRIER);
    status st = OK;
    find_prior(s, threshold);
    for (int i = 0; i < 4 && st == OK; i++) {
        start_away(s, guesses[i].times * threshold);
        st = grow(s, ground, guesses[i].outside_hull);
    }
    if (st == OK) st = start_bright(s);
    if (st == OK) st = grow(s, ground, true);
    start_middle(s, photo, hint);
    if (st == OK) st = grow(s, ground, true);
    return st == OK && hint ? grow_by_hint(s, photo, hint, ground) : st;
}

/* Tells whether colours change anywhere on the way from the border. */
static bool stands_out(const object_search *s)
{
    size_t count = 0;
    for (size_t i = 0; i < s->view.count; i++)
        count += s->away.data[i] > LEAST_BARRIER;
    return (float)count >= OBJECT_LEAST_AREA * (float)s->view.count;
}

/* Chooses the best candidate; the more points there are, the less other guesses count. */
static void choose(object_search *s, const merlin_hint *hint)
{
    const float bonus = hint ? BONUS_BY_POINT * (float)hint->point_count : 0;
    float best = 0;
    for (int i = 0; i < s->count; i++) {
        object_cues *c = &s->candidate[i].cues;
        for (int j = 0; j < s->count; j++) {
            if (i == j) continue;
            float overlap = object_overlap(s->candidate[i].object, s->candidate[j].object, s->view.count);
            c->agree += overlap / (float)(s->count - 1);
            c->most_agree = fmaxf(c->most_agree, overlap);
        }
        s->candidate[i].quality = object_quality(c);
        float score = s->candidate[i].quality + (i >= s->hinted ? bonus : 0);
        if (i > 0 && score <= best) continue;
        best = score;
        s->best = i;
    }
}

/* ---- from picture to picture ---- */

/* Returns how much of the window around each pixel a mask covers. */
static status covered_around(const img *mask, int radius, img *out)
{
    status st = img_copy(out, mask);
    if (st == OK) st = img_box_sums(out, radius);
    for (size_t i = 0; st == OK && i < img_value_count(out); i++)
        out->data[i] /= (float)((2 * radius + 1) * (2 * radius + 1));
    return st;
}

/* Expects the object where it was: surely inside, and surely not far outside. Near it, parts may appear that were dark
 * or hidden before, and the outline may move. */
static status find_prior_before(object_search *s, const img *before)
{
    enum { MOVES = 3, NEAR = 10 };
    static const float MOST = 4, LEAST_NEAR = 0, INNER = 0.6f;
    img small = {0}, close = {0}, near = {0};
    status st = img_resize(before, s->view.width, s->view.height, &small);
    if (st == OK) st = covered_around(&small, MOVES, &close);
    if (st == OK) st = covered_around(&small, NEAR, &near);
    for (size_t i = 0; st == OK && i < s->view.count; i++) {
        s->start[i] = small.data[i] >= 0.5f;
        const float toward = MOST * clamp(2 * close.data[i] - 1, -1, 1);
        s->prior[i] = near.data[i] > 0.01f ? fmaxf(toward, LEAST_NEAR) : toward;
        s->wanted[i] = close.data[i] > INNER; /* parts that shadows separate remain */
    }
    img_free(&small);
    img_free(&close);
    img_free(&near);
    return st;
}

status object_search_follow(const img *photo, const img *before, object_search *out)
{
    *out = (object_search){0};
    object_ground ground = {.view = &out->view, .tie = OBJECT_UNIT * TIE};
    status st = search_new(photo, NULL, out);
    if (st == OK) st = grid_cut_new(&ground.cut, out->view.width, out->view.height);
    ground.prior = out->prior;
    ground.away = out->away.data;
    ground.fixed = out->fixed;
    if (st == OK) out->wanted = calloc(out->view.count, 1);
    if (st == OK && !out->wanted) st = no_memory();
    ground.wanted = out->wanted;
    if (st == OK) object_view_tie(&out->view, ground.tie, &ground.cut);
    if (st == OK) st = find_prior_before(out, before);
    if (st == OK) st = grow(out, &ground, false);
    grid_cut_free(&ground.cut);
    if (st != OK) object_search_free(out);
    return st;
}

status object_search_run(const img *photo, const merlin_hint *hint, object_search *out)
{
    *out = (object_search){0};
    object_ground ground = {.view = &out->view};
    status st = search_new(photo, hint, out);
    if (st == OK) st = grid_cut_new(&ground.cut, out->view.width, out->view.height);
    ground.prior = out->prior;
    ground.away = out->away.data;
    ground.fixed = out->fixed;
    ground.wanted = out->wanted;
    ground.tie = OBJECT_UNIT * TIE;
    if (st == OK && !hint && !stands_out(out))
        st = fail(MERLIN_BAD_INPUT,
                  "no object stands out from the background; give a mask, or say where it is by a point "
                  "or a box");
    if (st == OK) object_view_tie(&out->view, ground.tie, &ground.cut);
    if (st == OK) st = grow_all(out, photo, hint, &ground);
    grid_cut_free(&ground.cut);
    if (st == OK) choose(out, hint);
    if (st != OK) object_search_free(out);
    return st;
}
