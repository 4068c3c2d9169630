/* SPDX-License-Identifier: MIT */
#include "photo_stereo/far_pictures.h"

#include <limits.h>
#include <math.h>
#include <stdbool.h>
#include <string.h>

/* Longer side of the pictures of edges in which shifts are searched that are too large to be undone, and up to where
 * they are none. A shift from there on counts if what the correlation lacks of 1 is at most this share of what it lacks
 * nearer. Measured: 0.25 to 0.45 of a cat, an owl and a ball that moved by 40 to 75 of 512 pixels, 0.69 and more of
 * pictures that did not move, and then of a correlation below 0.3. Two pictures of one relief under lights from two
 * sides, lit in different places, reach a correlation of 0.67 by chance. */
enum { FAR_SIDE = 64, NEAR = 3 };
static const double plainly = 0.5, alike_of_two = 0.72;
/* Least share of the edges of an object that moved so far that lie where the others have none of it. */
static const double aside = 0.02;

/* If all pictures moved, the sum of the others is a blur, but three of them agree: the shifts from one to the next and
 * from that to the third make up the one from the first to the third, within a pixel. A highlight that travels with
 * the lamp agrees as well, but is small: the standard deviation of the places of what is alike is at least this many
 * times the shift of an object. As three agree by chance in a hundredth of all cases, they may be less alike. Largest
 * distance of two pictures that are both within a twentieth of one place. */
static const double extent = 0.9, alike_of_three = 0.35;
enum { AGREED = 1, MOST_APART = 2 * FAR_SIDE / 20 + 2 };

/* A picture that moved too far. */
typedef struct far_move {
    int picture; /* -1: none */
    int from;    /* the picture it is compared with; -1: all others */
    shift by;
} far_move;

static const far_move none = {-1, -1, {0, 0}};

int far_pictures_side(const merlin_capture *c)
{
    const int longer = edge_longer_side(c);
    return longer < FAR_SIDE ? longer : FAR_SIDE;
}

/* ---- one picture that moved ---- */

/* Returns the share of edges in the object's place, as shifted, that lie outside of the object's place. */
static double share_aside(const edge_level *l, const img *edges, shift by)
{
    double all = 1e-9, out = 0;
    for (int y = shift_first(by.y); y < shift_end(by.y, l->height); y++) {
        const float *mask = img_at(&l->mask, 0, y), *at = img_at(&l->mask, 0, y + by.y) + by.x;
        const float *own = img_at(edges, 0, y + by.y) + by.x;
        for (int x = shift_first(by.x); x < shift_end(by.x, l->width); x++) {
            const double energy = (double)(mask[x] * own[x] * own[x]);
            all += energy;
            out += at[x] > 0 ? 0 : energy;
        }
    }
    return out / all;
}

/* Tells whether the object is seen outside of its place, in a picture or, the other way, in the others: one that moved
 * takes its outline along; what is lit elsewhere on one that did not move is inside. */
static bool is_aside(const edge_level *l, int k, shift by)
{
    return share_aside(l, &l->edges[k], by) >= aside || share_aside(l, &l->sum, (shift){-by.x, -by.y}) >= aside;
}

/* Tells whether a picture's edges are those of the others after a large shift. */
static bool look_far(const edge_level *l, int k, shift *by)
{
    edge_trials t = {.level = l, .picture = k, .reach = EDGE_MOST_REACH};
    double near = -1, far = -1;
    const size_t count = edge_trials_run(&t);
    for (size_t i = 0; i < count; i++) {
        const shift at = edge_trials_at(&t, i);
        if (shift_reach(at) <= NEAR) {
            near = fmax(near, t.likeness[i]);
        } else if (t.likeness[i] > far) {
            far = t.likeness[i];
            *by = at;
        }
    }
    if (far < (l->capture->count == 2 ? alike_of_two : edges_alike) || 1 - far > plainly * (1 - near)) return false;
    return !l->capture->mask.data || is_aside(l, k, *by);
}

/* ---- pictures that all moved ---- */

/* Returns the standard deviation of the places where a picture's edges, shifted back, and the sum's are alike. */
static double extent_of(const edge_level *l, int k, shift by)
{
    double all = 1e-9, x_sum = 0, y_sum = 0, squares = 0;
    for (int y = shift_first(by.y); y < shift_end(by.y, l->height); y++) {
        const float *mask = img_at(&l->mask, 0, y), *sum = img_at(&l->sum, 0, y);
        const float *own = img_at(&l->edges[k], 0, y + by.y) + by.x;
        for (int x = shift_first(by.x); x < shift_end(by.x, l->width); x++) {
            const double weight = (double)(mask[x] * sum[x] * own[x]);
            all += weight, x_sum += weight * x, y_sum += weight * y, squares += weight * (x * x + y * y);
        }
    }
    return sqrt(fmax(0, squares / all - (x_sum * x_sum + y_sum * y_sum) / (all * all)));
}

/* Finds the shift with which a picture is most like the sum; false: it is less alike than `least`, or only in a small
 * part. */
static bool find_likest(const edge_level *l, int k, double least, shift *by)
{
    edge_trials t = {.level = l, .picture = k, .reach = EDGE_MOST_REACH};
    const size_t count = edge_trials_run(&t);
    size_t best = 0;
    for (size_t i = 1; i < count; i++)
        if (t.likeness[i] > t.likeness[best]) best = i;
    *by = edge_trials_at(&t, best);
    if (t.likeness[best] < least) return false;
    return shift_reach(*by) <= NEAR || extent_of(l, k, *by) >= extent * hypot(by->x, by->y);
}

/* Makes the sum that of the pictures from `first` to before `end`. */
static void sum_edges(edge_level *l, int first, int end)
{
    memset(l->sum.data, 0, img_value_count(&l->sum) * sizeof *l->sum.data);
    for (int k = first; k < end; k++)
        edge_level_add(l, k, 1);
}

/* Finds the shift from one picture to another. */
static bool find_pair(edge_level *l, int from, int to, shift *by)
{
    sum_edges(l, from, from + 1);
    return find_likest(l, to, alike_of_three, by);
}

/* Puts pictures from `first` to before `end` in their places, around that of `middle`, and looks where the others are
 * like these. */
static void put_places(edge_level *l, const shift *place, int first, int end, int middle)
{
    for (int k = first; k < end; k++)
        l->by[k] = shift_between(place[middle], place[k]);
    sum_edges(l, first, end);
    for (int k = 0; k < l->capture->count; k++) {
        shift by;
        const bool known = k >= first && k < end;
        if (!known && find_likest(l, k, edges_alike, &by) && shift_reach(by) <= MOST_APART) l->by[k] = by;
    }
}

/* Takes the places of pictures from `first` to before `end`, around the one that is nearest to all others, unless the
 * search finds them by itself. Tells of two that are too far apart to be aligned. */
static far_move take_places(edge_level *l, const shift *place, int first, int end)
{
    far_move most = none;
    int middle = first, least = INT_MAX;
    for (int a = first; a < end; a++) {
        int sum = 0;
        for (int b = first; b < end; b++) {
            const shift by = shift_between(place[a], place[b]);
            sum += shift_reach(by);
            if (shift_reach(by) > shift_reach(most.by)) most = (far_move){b, a, by};
        }
        if (sum < least) least = sum, middle = a;
    }
    if (shift_reach(most.by) > MOST_APART) return most;
    if (shift_reach(most.by) > NEAR) put_places(l, place, first, end, middle);
    return none;
}

/* Finds where the object is in the longest run of pictures that agree by threes. */
static status find_places(edge_level *l, far_move *out)
{
    const int count = l->capture->count;
    shift *place = calloc((size_t)count, sizeof *place), next, second, both;
    if (!place) return fail(MERLIN_NO_MEMORY, "no memory for %d pictures", count);
    int first = 0, end = 0;
    bool found = find_pair(l, 0, 1, &next);
    place[1] = next;
    for (int k = 0, start = 0; k + 2 < count; k++) {
        const bool onward = find_pair(l, k + 1, k + 2, &second);
        const bool agree = found && onward && find_pair(l, k, k + 2, &both) &&
                           shift_reach(shift_between(shift_sum(next, second), both)) <= AGREED;
        place[k + 2] = shift_sum(place[k + 1], second);
        if (!agree) start = k + 1;
        if (agree && k + 3 - start > end - first) first = start, end = k + 3;
        next = second, found = onward;
    }
    *out = take_places(l, place, first, end);
    free(place);
    return OK;
}

/* Finds a picture that moved too far from where all others are. */
static far_move find_far(edge_level *l)
{
    const int count = l->capture->count;
    far_move far = none;
    sum_edges(l, 0, count);
    for (int k = 0; k < count && far.picture < 0; k++) {
        edge_level_add(l, k, -1);
        if (look_far(l, k, &far.by)) far.picture = k;
        edge_level_add(l, k, 1);
    }
    return far;
}

static const char *name_of(const merlin_capture *c, int k)
{
    return c->name && c->name[k] ? c->name[k] : "one of them";
}

status far_pictures_refuse(const merlin_capture *c, shift *by)
{
    const int longest = far_pictures_side(c);
    far_move far = none;
    edge_level l;
    status s = edge_level_new(c, by, longest, &l);
    if (s == OK) far = find_far(&l);
    if (s == OK && far.picture < 0 && c->count > 2) s = find_places(&l, &far);
    edge_level_free(&l);
    if (s != OK || far.picture < 0) return s;
    const double pixels = hypot(far.by.x, far.by.y) * edge_longer_side(c) / longest;
    if (far.from >= 0)
        return fail(MERLIN_BAD_INPUT,
                    "the pictures are not from one place: from %s to %s the object moved by about %.0f pixels; take "
                    "all with a camera that stands still",
                    name_of(c, far.from), name_of(c, far.picture), pixels);
    return fail(
        MERLIN_BAD_INPUT,
        "the pictures are not from one place: in %s the object is about %.0f pixels aside from where the others "
        "have it; leave it out, or take all with a camera that stands still",
        name_of(c, far.picture), pixels);
}
