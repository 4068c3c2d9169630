/* SPDX-License-Identifier: MIT */
#include "stereo/doubts/light_turns.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "stereo/uncalibrated/inflate.h"

enum { STEP = 15, TURNS = 360 / STEP, AXES = 48, LEAST_BORDER = 30, LEAST_INSIDE = 300 };
/* Sideways component of a normal close to an occluding contour; a bowl's edge is rarely as steep. */
static const double steep = 0.8;
/* Distance from the outline in small pixels within which normals still point outward. */
enum { RIM = 2 };
/* Weight of the outline relative to the logarithm of the normals' integrability. In 25 rendered and five real captures
 * the right axes are better than others by 0.3 at least. */
static const double outline_weight = 1.5;
/* Share of the surface that faces the camera with axes that can be right: rendered objects have 0.78 and more. */
static const double least_facing = 0.65, most_facing = 0.9;

/* A pixel of the surface, and the outward direction there; (0, 0) inside. */
typedef struct place {
    vec3 normal, by_x, by_y;
    float out_x, out_y;
    bool inside; /* whether it has neighbours on all sides, without a jump between them */
} place;

typedef struct places {
    place *at;
    size_t count, border, inside;
} places;

typedef struct score {
    double curl, outline, facing, hollow;
} score;

static vec3 turned(const double m[9], vec3 v)
{
    return vec3_make((float)(m[0] * v.x + m[1] * v.y + m[2] * v.z), (float)(m[3] * v.x + m[4] * v.y + m[5] * v.z),
                     (float)(m[6] * v.x + m[7] * v.y + m[8] * v.z));
}

static bool is_at_rim(const img *mask, int x, int y)
{
    for (int j = y - RIM; j <= y + RIM; j++)
        for (int i = x - RIM; i <= x + RIM; i++)
            if (i >= 0 && j >= 0 && i < mask->width && j < mask->height && *img_at(mask, i, j) <= 0.5f) return true;
    return false;
}

static bool differences(const vec3 *b, int width, vec3 *by_x, vec3 *by_y)
{
    const vec3 around[4] = {b[1], b[-1], b[-width], b[width]};
    vec3 n[4];
    for (int k = 0; k < 4; k++) {
        if (!(vec3_length(around[k]) > 0)) return false;
        n[k] = vec3_normalize(around[k]);
    }
    *by_x = vec3_sub(n[0], n[1]);
    *by_y = vec3_sub(n[2], n[3]);
    return vec3_dot(*by_x, *by_x) + vec3_dot(*by_y, *by_y) < 1; /* more is a jump */
}

static void take_place(const pst_light_fit *f, const vec3 *b, const img *inflated, int x, int y, places *all)
{
    int width = f->small.width, height = f->small.height;
    size_t i = (size_t)y * (size_t)width + (size_t)x;
    if (!(vec3_length(b[i]) > 0)) return;
    place *p = &all->at[all->count++];
    *p = (place){.normal = vec3_normalize(b[i])};
    const float *out = inflated->data + 3 * i;
    float aside = hypotf(out[0], out[1]);
    if (aside > 0.3f && is_at_rim(&f->small.mask, x, y)) {
        p->out_x = out[0] / aside;
        p->out_y = out[1] / aside;
        all->border++;
    }
    if (x < 1 || y < 1 || x + 1 >= width || y + 1 >= height) return;
    p->inside = differences(b + i, width, &p->by_x, &p->by_y);
    all->inside += p->inside;
}

static status list_places(const pst_light_fit *f, const vec3 *b, places *out)
{
    img inflated, height;
    *out = (places){malloc((size_t)f->small.width * (size_t)f->small.height * sizeof *out->at), 0, 0, 0};
    if (!out->at) return fail(MERLIN_NO_MEMORY, "no memory for %d x %d normals", f->small.width, f->small.height);
    status s = pst_inflate(&f->small.mask, &inflated, &height);
    if (s != OK) return s;
    for (int y = 0; y < f->small.height; y++)
        for (int x = 0; x < f->small.width; x++)
            take_place(f, b, &inflated, x, y, out);
    img_free(&inflated);
    img_free(&height);
    return OK;
}

static score score_of(const places *all, const double m[9])
{
    double curl = 0, change = 0, outward = 0, facing = 0, hollow = 0;
    for (size_t i = 0; i < all->count; i++) {
        const place *p = &all->at[i];
        vec3 n = turned(m, p->normal);
        facing += n.z > 0;
        double out = (double)(n.x * p->out_x + n.y * p->out_y);
        outward += out;
        hollow += out < -steep;
        if (!p->inside) continue;
        vec3 dx = turned(m, p->by_x), dy = turned(m, p->by_y);
        curl += fabs((double)(n.x * dy.z - n.y * dx.z + n.z * (dx.y - dy.x)));
        change += sqrt((double)(vec3_dot(dx, dx) + vec3_dot(dy, dy)));
    }
    bool seen = all->border >= LEAST_BORDER, tells = all->inside >= LEAST_INSIDE && change > 0;
    return (score){.curl = tells ? fmax(curl / change, 1e-3) : 1,
                   .outline = seen ? outward / (double)all->border : 0,
                   .hollow = seen ? hollow / (double)all->border : 0,
                   .facing = facing / fmax((double)all->count, 1)};
}

static double better(const score *now, const score *then)
{
    return log(now->curl / then->curl) + outline_weight * (then->outline - now->outline);
}

static void plane_turn(double degrees, bool mirrored, double m[9])
{
    double c = cos(degrees * 0.01745329252), s = sin(degrees * 0.01745329252);
    memcpy(m, &(double[9]){c, mirrored ? s : -s, 0, s, mirrored ? -c : c, 0, 0, 0, 1}, 9 * sizeof *m);
}

/* Computes one of the 48 ways to exchange and reverse three axes. */
static void axes_turn(int k, double m[9])
{
    static const int order[6][3] = {{0, 1, 2}, {1, 0, 2}, {0, 2, 1}, {2, 1, 0}, {1, 2, 0}, {2, 0, 1}};
    memset(m, 0, 9 * sizeof *m);
    for (int i = 0; i < 3; i++)
        m[3 * i + order[k / 8][i]] = k >> i & 1 ? -1 : 1;
}

static void try_turn(const places *all, const score *now, const pst_light_turn *trial, pst_light_turn *best)
{
    score then = score_of(all, trial->at);
    double gain = trial->axes && then.facing < most_facing ? -HUGE_VAL : better(now, &then);
    if (!(gain > best->better)) return;
    *best = *trial;
    best->better = gain;
}

/* Tells whether x reversed is as good as y reversed: without an outline they differ only in what is concave. */
static bool is_either(const places *all, const score *now)
{
    double of_x[9], of_y[9];
    plane_turn(180, true, of_x);
    plane_turn(0, true, of_y);
    score x = score_of(all, of_x), y = score_of(all, of_y);
    return fabs(better(now, &x) - better(now, &y)) < 0.1;
}

static void search(const places *all, pst_light_turn *best)
{
    double none[9];
    plane_turn(0, false, none);
    score now = score_of(all, none);
    *best = (pst_light_turn){.better = -HUGE_VAL};
    for (int k = 1; k < 2 * TURNS; k++) {
        int degrees = k % TURNS * STEP;
        pst_light_turn trial = {.mirrored = k >= TURNS, .degrees = degrees > 180 ? degrees - 360 : degrees};
        plane_turn(trial.degrees, trial.mirrored, trial.at);
        try_turn(all, &now, &trial, best);
    }
    for (int k = 0; k < AXES && now.facing < least_facing; k++) {
        pst_light_turn trial = {.axes = true};
        axes_turn(k, trial.at);
        try_turn(all, &now, &trial, best);
    }
    best->hollow = now.hollow;
    best->either = best->mirrored && fmod(best->degrees, 180) == 0 && is_either(all, &now);
}

status pst_light_turn_find(const pst_light_fit *f, const vec3 *b, pst_light_turn *out)
{
    places all;
    status s = list_places(f, b, &all);
    if (s == OK) search(&all, out);
    free(all.at);
    return s;
}
