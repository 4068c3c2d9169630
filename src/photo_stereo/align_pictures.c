/* SPDX-License-Identifier: MIT */
#include "photo_stereo/align_pictures.h"

#include <math.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

#include "photo_stereo/far_pictures.h"

/* Longer sides of the coarsest and the finest pictures of edges, how far is searched in them, and how often. */
enum { COARSEST = 128, FINEST = 1024, FIRST_REACH = 6, REACH = 2, PASSES = 4 };
/* A shift counts if the edges are alike (edges_alike), and what their correlation lacks of 1 is at most this share of
 * what it lacks without; less strictly as long as finer pictures follow. A plain ball under eight lights that did not
 * move has a share of 0.62. */
static const double clearly = 0.6, perhaps = 0.85;

/* Finds the shift with which a picture's edges are most like the others'. share: of what the correlation lacks. */
static void find_shift(edge_level *l, int k, int reach, double share)
{
    edge_trials t = {.level = l, .picture = k, .reach = reach, .start = l->by[k]};
    const double unmoved = edge_level_likeness(l, k, (shift){0, 0});
    double best = unmoved;
    const size_t count = edge_trials_run(&t);
    l->by[k] = (shift){0, 0};
    for (size_t i = 0; i < count; i++) {
        if (t.likeness[i] <= best) continue;
        best = t.likeness[i];
        l->by[k] = edge_trials_at(&t, i);
    }
    if (best < edges_alike || 1 - best > share * (1 - unmoved)) l->by[k] = (shift){0, 0};
}

/* Finds the shifts at one size: without earlier ones first of each picture from those before it, then of each from all
 * others. One after another, as two that look for each other at once would change places. */
static void find_level_shifts(edge_level *l, bool coarsest, bool finest)
{
    const int count = l->capture->count;
    const double share = finest ? clearly : perhaps;
    edge_level_add(l, 0, 1);
    for (int k = 1; k < count; k++) {
        if (coarsest) find_shift(l, k, FIRST_REACH, share);
        edge_level_add(l, k, 1);
    }
    bool changed = true;
    for (int pass = 0; pass < PASSES && changed; pass++) {
        changed = false;
        /* the first one, too, since all others may agree that it has moved */
        for (int k = 0; k < count; k++) {
            const shift before = l->by[k];
            edge_level_add(l, k, -1);
            find_shift(l, k, pass ? 1 : REACH, share);
            edge_level_add(l, k, 1);
            changed |= before.x != l->by[k].x || before.y != l->by[k].y;
        }
    }
}

static status find_shifts_at(const merlin_capture *c, int longest, bool coarsest, bool finest, shift *by)
{
    edge_level l;
    status s = edge_level_new(c, by, longest, &l);
    if (s == OK) find_level_shifts(&l, coarsest, finest);
    edge_level_free(&l);
    return s;
}

static void scale_shifts(shift *by, int count, int to, int from)
{
    for (int k = 0; k < count; k++)
        by[k] = (shift){by[k].x * to / from, by[k].y * to / from};
}

/* Finds the shifts in pixels of the finest size, which is returned. by: those that far_pictures_refuse has found. */
static status find_shifts(const merlin_capture *c, shift *by, int *finest)
{
    const int longer = edge_longer_side(c);
    *finest = longer < FINEST ? longer : FINEST;
    int longest = *finest;
    while (longest > COARSEST)
        longest = (longest + 1) / 2;
    scale_shifts(by, c->count, longest, far_pictures_side(c));
    status s = find_shifts_at(c, longest, true, longest == *finest, by);
    while (s == OK && longest < *finest) {
        const int next = 2 * longest < *finest ? 2 * longest : *finest;
        scale_shifts(by, c->count, next, longest);
        longest = next;
        s = find_shifts_at(c, longest, false, longest == *finest, by);
    }
    return s;
}

/* ---- pictures ---- */

static status move_picture(const merlin_capture *c, int k, shift by, pst_plane *out)
{
    const pst_plane *picture = &c->picture[k];
    const size_t pixel = (size_t)c->channels * pst_plane_bytes(picture), width = (size_t)c->width;
    char *to = calloc(width * (size_t)c->height, pixel);
    if (!to) return fail(MERLIN_NO_MEMORY, "no memory to move a picture");
    const int left = shift_first(by.x), right = shift_end(by.x, c->width);
    for (int y = shift_first(by.y); y < shift_end(by.y, c->height) && left < right; y++) {
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
    if (s == OK && c->count > 1) s = far_pictures_refuse(c, by);
    if (s == OK && c->count > 1) s = find_shifts(c, by, &finest);
    if (s == OK && c->count > 1) s = move_pictures(c, by, (float)edge_longer_side(c) / (float)finest, out, shifts);
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
