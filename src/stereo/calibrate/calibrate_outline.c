/* SPDX-License-Identifier: MIT */
/* The outline of a mirror ball on a table. Its rim mirrors the table, its middle the room in front of it, and the edge
 * between these is a circle, too, and often the strongest visible one: with a large table directly behind the ball its
 * radius is the ball's divided by the square root of two, with a small table it is larger. So another circle is
 * searched around one that was found, along all of which the pictures have a sharp step of one sign. */
#include <math.h>

#include "stereo/calibrate/calibrate_parts.h"

enum { ANGLES = 96, RADII = 40, PLACES = 9, POLISH = 5 };

/* Limits in inner radii: of the search, and of the distance between centres (the camera looks obliquely). */
static const float LARGEST = 1.62f, ASIDE = 0.2f;
/* Mean of steps divided by their root mean square: 1 if all are equal, 0.1 to 0.3 on a table's texture. */
static const float LEAST_ALIKE = 0.6f;
/* Least mean step of the logarithm; and its least ratio to that slightly further in or out, otherwise it is a halo. */
static const float LEAST_STEP = 0.03f, SHARPER = 1.6f;
/* Least ratio of an outline's step to the least one between it and the inner circle, across so many pixels: the steps
 * of that one's own blurred edge only fall. */
static const float APART = 1.5f, FINELY = 1.5f;
/* Least share of the circle in the picture. */
static const float LEAST_WITHIN = 0.45f;

/* Steps across a circle from inside to outside. */
typedef struct steps {
    float mean, alike; /* over the circle; mean divided by root mean square */
} steps;

static bool pixel_at(const img *p, float x, float y, float *value)
{
    int i = (int)floorf(x), j = (int)floorf(y);
    if (i < 0 || j < 0 || i >= p->width || j >= p->height) return false;
    *value = *img_at(p, i, j);
    return true;
}

/* Measures the steps. across: distance from the circle in pixels. */
static steps steps_across(const img *p, const merlin_circle *c, float across)
{
    float sum = 0, squares = 0;
    int seen = 0;
    for (int k = 0; k < ANGLES; k++) {
        float turn = 6.2831853f * (float)k / ANGLES, u = cosf(turn), v = sinf(turn), inner = 0, outer = 0;
        bool within = true;
        for (int i = 1; i <= 2 && within; i++) {
            float in = c->radius - across * (float)i / 2, out = c->radius + across * (float)i / 2, a, b;
            within = pixel_at(p, c->x + in * u, c->y + in * v, &a) && pixel_at(p, c->x + out * u, c->y + out * v, &b);
            if (!within) break;
            inner += a / 2;
            outer += b / 2;
        }
        if (!within) continue;
        sum += outer - inner;
        squares += (outer - inner) * (outer - inner);
        seen++;
    }
    if ((float)seen < LEAST_WITHIN * ANGLES) return (steps){0, 0};
    float mean = sum / (float)seen;
    return (steps){mean, fabsf(mean) / sqrtf(fmaxf(squares / (float)seen, 1e-12f))};
}

static float worth(const steps *s)
{
    return fabsf(s->mean) * s->alike;
}

static void try_circle(const img *p, const merlin_circle *trial, float across, float *most, merlin_circle *best)
{
    steps s = steps_across(p, trial, across);
    if (!(worth(&s) > *most)) return;
    *most = worth(&s);
    *best = *trial;
}

/* Finds the best circle around the inner one, outside the range of steps at that one's own edge. */
static float search(const img *p, const merlin_circle *inner, float across, merlin_circle *best)
{
    float most = 0, reach = ASIDE * inner->radius;
    for (int place = 0; place < PLACES * PLACES; place++) {
        int column = place % PLACES, row = place / PLACES;
        float dx = reach * (2 * (float)column / (PLACES - 1) - 1);
        float dy = reach * (2 * (float)row / (PLACES - 1) - 1);
        float least = inner->radius + hypotf(dx, dy) + 2 * across, largest = LARGEST * inner->radius;
        for (int i = 0; i <= RADII && least < largest; i++) {
            merlin_circle trial = {inner->x + dx, inner->y + dy, least + (largest - least) * (float)i / RADII};
            try_circle(p, &trial, across, &most, best);
        }
    }
    return most;
}

/* Climbs from the grid's best circle by smaller and smaller moves. */
static void polish(const img *p, const merlin_circle *inner, float across, float most, merlin_circle *best)
{
    float move = 2 * ASIDE * inner->radius / (PLACES - 1);
    for (int round = 0; round < POLISH; round++, move /= 2)
        for (int k = 0; k < 27; k++) {
            int right = k % 3 - 1, down = k / 3 % 3 - 1, larger = k / 9 - 1;
            merlin_circle trial = {best->x + move * (float)right, best->y + move * (float)down,
                                   best->radius + move * (float)larger};
            float apart = hypotf(trial.x - inner->x, trial.y - inner->y);
            if (trial.radius < inner->radius + apart + 2 * across) continue;
            try_circle(p, &trial, across, &most, best);
        }
}

static bool is_outline(const img *p, const merlin_circle *c, float across)
{
    steps here = steps_across(p, c, across);
    merlin_circle in = *c, out = *c;
    in.radius -= 2 * across;
    out.radius += 2 * across;
    steps further_in = steps_across(p, &in, across), further_out = steps_across(p, &out, across);
    float beside =
        fminf(fabsf(further_in.mean), fabsf(further_out.mean)); /* one of them may be the inner circle's edge */
    return here.alike > LEAST_ALIKE && fabsf(here.mean) > LEAST_STEP && fabsf(here.mean) > SHARPER * beside;
}

/* Tells whether a circle is an edge of its own, not the blur around the inner circle's. */
static bool stands_apart(const img *p, const merlin_circle *inner, const merlin_circle *outer)
{
    const float gap = outer->radius - inner->radius;
    float least = INFINITY;
    const int count = (int)ceilf(2 * gap); /* each half a pixel further */
    for (int i = 0; i < count; i++) {
        const float share = 0.5f * (float)i / gap;
        const merlin_circle between = {inner->x + share * (outer->x - inner->x),
                                       inner->y + share * (outer->y - inner->y), inner->radius + share * gap};
        least = fminf(least, fabsf(steps_across(p, &between, FINELY).mean));
    }
    return fabsf(steps_across(p, outer, FINELY).mean) > APART * least;
}

bool ball_around(const img *picture, const merlin_circle *inner, merlin_circle *outer)
{
    float across = fmaxf(2, inner->radius / 24);
    float most = search(picture, inner, across, outer);
    if (!(most > 0)) return false;
    polish(picture, inner, across, most, outer);
    float finer = across / 2;
    while (finer >= 1.5f) {
        polish(picture, inner, finer, 0, outer);
        finer /= 2;
    }
    return is_outline(picture, outer, across) && stands_apart(picture, inner, outer);
}

bool ball_has_horizon(const img *picture, const merlin_circle *circle)
{
    enum { STEPS = 12 };
    static const float LEAST = 0.66f, MOST = 0.76f, BESIDE = 0.05f, CLEARLY = 0.8f;
    float across = fmaxf(1.5f, circle->radius / 30), most = 0;
    merlin_circle best = *circle;
    for (int place = 0; place < 9; place++)
        for (int i = 0; i <= STEPS; i++) {
            int right = place % 3 - 1, down = place / 3 - 1;
            merlin_circle trial = {circle->x + BESIDE * circle->radius * (float)right,
                                   circle->y + BESIDE * circle->radius * (float)down,
                                   circle->radius * (LEAST + (MOST - LEAST) * (float)i / STEPS)};
            try_circle(picture, &trial, across, &most, &best);
        }
    return most > 0 && steps_across(picture, &best, across).alike > CLEARLY && is_outline(picture, &best, across);
}

status ball_list_outlines(const img *picture, const img *darkest, merlin_ball ball, ball_outlines *out)
{
    *out = (ball_outlines){0};
    bool found = false;
    merlin_circle first, around, beside;
    status s = ball_find(picture, NULL, &first, &found);
    if (s != OK || !found) return s;
    bool within =
        !(ball == MERLIN_CHROME_BALL && ball_has_horizon(darkest, &first)) && ball_around(picture, &first, &around);
    if (within) s = ball_refine(picture, &around);
    if (within && ball == MERLIN_CHROME_BALL) out->at[out->count++] = around;
    out->at[out->count++] = first;
    if (within && ball == MERLIN_MATTE_BALL) out->at[out->count++] = around;
    out->nested = within;
    out->ratio = within ? first.radius / around.radius : 1;
    if (s == OK) s = ball_find(picture, within ? &around : &first, &beside, &found);
    if (s == OK && found) out->at[out->count++] = beside;
    return s;
}
