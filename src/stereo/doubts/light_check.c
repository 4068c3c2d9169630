/* SPDX-License-Identifier: MIT */
#include "stereo/doubts/light_check.h"

#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "stereo/algebra/dense.h"
#include "stereo/doubts/light_turns.h"
#include "stereo/doubts/model_check.h"

enum { WORDS = 256, FEWEST = 4, FEWEST_STRENGTHS = 6, PAIRED = 64 };

/* Thresholds of the warning: by how much less of the pictures another arrangement of the same lights must leave
 * unexplained, and by which factor relative to what exceeds the best three lights. Of 70 rendered and five real
 * captures no other order comes close; in another order those leave 2.3 times as much and more. */
static const double plainly_less = 0.02, times_less = 2;
/* Largest residual of a correct list beyond that of the best three lights, unless that is large itself. Measured: 0.003
 * to 0.12, at most 0.087 if it is more than twice that; in a random order 0.11 to 0.55. */
static const double most_beyond = 0.1;
/* Largest such residual for lights so near that the whole object does not receive the light of its middle: 0.16 at
 * most. */
static const double most_beyond_near = 0.25;
/* Least gain of pst_light_turn: correct axes are better than others by 0.3 and more, wrong ones worse by as much, in
 * all but one of 70 rendered captures. */
static const double turned = 0.35;
/* Median residual of a surface up to which its lights' strengths explain the pictures: 0.005 to 0.009 of glossy
 * spheres, whose highlights the three-dimensional fit here takes for strengths; 0.017 and more where strengths differ.
 */
static const double explained = 0.012;
/* Share of the outline where normals point steeply inward, for an object that is not hollow. */
static const double inward = 0.4;

typedef struct check {
    const merlin_capture *capture;
    const merlin_surface *surface;
    pst_light_fit fit;
    double own, least;   /* share left unexplained by the list, and by the best three lights */
    vec3 *light, *trial; /* the lights that fit best; an arrangement */
    char remedy[WORDS];  /* the change that makes them fit; "": none is known */
    double best;         /* share left unexplained by `light` */
} check;

/* ---- arrangements ---- */

static void try_arrangement(check *c, const char *format, ...) __attribute__((format(printf, 2, 3)));

/* Uses the arrangement if it is clearly better than the list and the best one so far. */
static void try_arrangement(check *c, const char *format, ...)
{
    double left = pst_light_fit_unexplained(&c->fit, c->trial, -1);
    if (!(left < c->best - 1e-6) || !(c->own - left > plainly_less)) return;
    if (!(c->own - c->least > times_less * (left - c->least))) return;
    c->best = left;
    memcpy(c->light, c->trial, (size_t)c->fit.total * sizeof *c->light);
    va_list words;
    va_start(words, format);
    vsnprintf(c->remedy, sizeof c->remedy, format, words);
    va_end(words);
}

static int by_name(const void *a, const void *b)
{
    return strcmp(**(char **const *)a, **(char **const *)b);
}

/* Fills place[k] with picture k's place in alphabetical order, where 10.png precedes 9.png; returns false without
 * names. */
static status alphabetical(const merlin_capture *c, int *place, bool *differs)
{
    *differs = false;
    char ***sorted = malloc((size_t)c->count * sizeof *sorted);
    if (!sorted) return fail(MERLIN_NO_MEMORY, "no memory for %d names", c->count);
    bool named = c->name != NULL;
    for (int k = 0; k < c->count; k++) {
        named = named && c->name[k];
        sorted[k] = named ? &c->name[k] : NULL;
    }
    if (named) qsort(sorted, (size_t)c->count, sizeof *sorted, by_name);
    for (int k = 0; k < c->count && named; k++) {
        place[sorted[k] - c->name] = k;
        *differs = *differs || sorted[k] != &c->name[k];
    }
    free(sorted);
    return OK;
}

static status try_alphabet(check *c)
{
    int count = c->fit.total, *place = malloc((size_t)count * sizeof *place);
    bool differs = false;
    status s =
        place ? alphabetical(c->capture, place, &differs) : fail(MERLIN_NO_MEMORY, "no memory for %d names", count);
    if (s == OK && differs) {
        for (int k = 0; k < count; k++)
            c->trial[k] = c->fit.light[place[k]];
        try_arrangement(c, "in the alphabetical order of the pictures' names, where 10 stands before 9");
        const float *strength = c->fit.strength;
        for (int k = 0; k < count; k++)
            c->trial[k] = vec3_scale(c->fit.light[k], strength[place[k]] / strength[k]);
        try_arrangement(c, "with their strengths in the alphabetical order of the pictures' names");
    }
    free(place);
    return s;
}

static void try_orders(check *c)
{
    const vec3 *light = c->fit.light;
    int count = c->fit.total;
    for (int k = 0; k < count; k++)
        c->trial[k] = light[count - 1 - k];
    try_arrangement(c, "in reverse order");
    for (int shift = 1; shift < count; shift++) {
        for (int k = 0; k < count; k++)
            c->trial[k] = light[(k + shift) % count];
        int by = shift <= count / 2 ? shift : shift - count;
        try_arrangement(c, "moved by %d (light %d for the first picture)", by, shift + 1);
    }
    for (int k = 0; k < count; k++)
        c->trial[k] = vec3_scale(light[k], c->fit.strength[count - 1 - k] / c->fit.strength[k]);
    try_arrangement(c, "with their strengths in reverse order");
    for (int k = 0; k < count; k++)
        c->trial[k] = vec3_scale(light[k], 1 / c->fit.strength[k]);
    try_arrangement(c, "as lights of one strength");
}

static void try_pairs(check *c)
{
    int count = c->fit.total;
    if (count > PAIRED) return;
    memcpy(c->trial, c->fit.light, (size_t)count * sizeof *c->trial);
    for (int j = 0; j < count; j++)
        for (int k = 0; k < j; k++) {
            c->trial[j] = c->fit.light[k];
            c->trial[k] = c->fit.light[j];
            try_arrangement(c, "with those of pictures %d and %d exchanged", k + 1, j + 1);
            c->trial[j] = c->fit.light[j];
            c->trial[k] = c->fit.light[k];
        }
}

/* ---- strengths ---- */

/* Multiplies one light's strength as long as that explains more. */
static bool step_strength(check *c, int picture, float factor, double *left)
{
    vec3 *light = &c->trial[c->fit.picture[picture]];
    const vec3 before = *light;
    *light = vec3_scale(before, factor);
    const double there = pst_light_fit_unexplained(&c->fit, c->trial, -1);
    if (there < *left) {
        *left = there;
        return true;
    }
    *light = before;
    return false;
}

/* Finds the strengths of lights in these directions that explain most, by steps in turn; returns what they leave. */
static double find_strengths(check *c)
{
    static const float steps[] = {1.6f, 1.25f, 1.1f, 1.04f};
    enum { STEPS = sizeof steps / sizeof *steps, ROUNDS = 6 };
    double left = c->own;
    memcpy(c->trial, c->fit.light, (size_t)c->fit.total * sizeof *c->trial);
    for (int i = 0; i < STEPS; i++) {
        bool moved = true;
        for (int round = 0; round < ROUNDS && moved; round++) {
            moved = false;
            for (int k = 0; k < c->fit.count; k++)
                moved |= step_strength(c, k, steps[i], &left) || step_strength(c, k, 1 / steps[i], &left);
        }
    }
    return left;
}

/* Tells whether the surface leaves more of the pictures than lights of the right strengths do. */
static bool leaves_much(const check *c)
{
    double left = HUGE_VAL;
    if (c->surface->residual.data && pst_typical_residual(c->capture, c->surface, &left) != OK) return false;
    return left > explained;
}

/* Tells whether what is wrong with the list is that it says nothing of strengths, which differ, rather than another
 * arrangement that was found. Of lights that are
 * equally strong others than theirs explain at most 0.008 more in five real captures; in these, with a third of the
 * pictures 0.7 times as bright, 0.06 to 0.09. */
static bool are_strengths(check *c)
{
    const float *strength = c->fit.strength;
    if (c->capture->lighting != MERLIN_DISTANT_LIGHTS || c->fit.count < FEWEST_STRENGTHS) return false;
    if (c->surface->method == MERLIN_STEREO_SEMI) return false;
    for (int k = 1; k < c->fit.total; k++)
        if (strength[k] != strength[0]) return false;
    if (!(c->own - c->least > plainly_less)) return false; /* no lights leave less than those */
    if (!leaves_much(c)) return false;
    const double left = find_strengths(c);
    return c->own - left > plainly_less && c->best - c->least > times_less * (left - c->least);
}

/* ---- axes ---- */

static void name_turn(const pst_light_turn *t, char words[WORDS])
{
    int degrees = (int)lround(t->degrees);
    const double *m = t->at;
    if (t->axes)
        snprintf(words, WORDS, "with other axes: x is %c%c, y %c%c, z %c%c of the list",
                 m[0] + m[1] + m[2] < 0 ? '-' : '+',
                 m[0]   ? 'x'
                 : m[1] ? 'y'
                        : 'z',
                 m[3] + m[4] + m[5] < 0 ? '-' : '+',
                 m[3]   ? 'x'
                 : m[4] ? 'y'
                        : 'z',
                 m[6] + m[7] + m[8] < 0 ? '-' : '+',
                 m[6]   ? 'x'
                 : m[7] ? 'y'
                        : 'z');
    else if (t->mirrored && t->either)
        snprintf(words, WORDS, "with y (or x) reversed: y points up here, and x to the right");
    else if (t->mirrored && degrees == 0)
        snprintf(words, WORDS, "with y reversed: it points up here");
    else if (t->mirrored && abs(degrees) == 180)
        snprintf(words, WORDS, "with x reversed: it points to the right here");
    else if (t->mirrored && abs(degrees) == 90)
        snprintf(words, WORDS, "with x and y exchanged%s", degrees < 0 ? " and reversed" : "");
    else if (abs(degrees) == 180)
        snprintf(words, WORDS, "with x and y reversed, unless the object is a hollow");
    else
        snprintf(words, WORDS, "with %sdirections turned by about %d degrees %sclockwise in the picture",
                 t->mirrored ? "y reversed and " : "", abs(degrees), degrees > 0 ? "anti" : "");
}

/* Tells whether the axes are unambiguous: reversed in x and y a ball is a bowl, and only the outline of an object that
 * is not one tells. */
static bool is_plain(const pst_light_turn *t)
{
    bool bowl = !t->axes && !t->mirrored && fabs(t->degrees) > 135;
    return t->better > turned && (!bowl || t->hollow > inward);
}

static status check_axes(check *c, bool *doubt)
{
    pst_light_turn turn;
    char words[WORDS];
    vec3 *b = malloc((size_t)c->fit.small.width * (size_t)c->fit.small.height * sizeof *b);
    if (!b) return fail(MERLIN_NO_MEMORY, "no memory for normals");
    pst_light_fit_surface(&c->fit, c->light, b);
    status s = pst_light_turn_find(&c->fit, b, &turn);
    free(b);
    if (s != OK || !is_plain(&turn)) return s;
    name_turn(&turn, words);
    size_t length = strlen(c->remedy);
    snprintf(c->remedy + length, sizeof c->remedy - length, "%s%s", length ? ", and " : "", words);
    *doubt = true;
    return OK;
}

/* ---- the whole ---- */

static status check_arrangement(check *c)
{
    memcpy(c->light, c->fit.light, (size_t)c->fit.total * sizeof *c->light);
    if (c->fit.count < FEWEST) return OK;
    c->own = c->best = pst_light_fit_unexplained(&c->fit, c->fit.light, -1);
    c->least = pst_light_fit_least(&c->fit, -1);
    status s = try_alphabet(c);
    if (s != OK) return s;
    try_orders(c);
    if (!c->remedy[0]) try_pairs(c);
    return OK;
}

static void report(const check *c, warnings *out)
{
    const char *worst = "and normals may be many degrees off";
    if (c->remedy[0])
        warnings_add(out, "lights_do_not_fit", "the lights do not fit the pictures, %s: they fit %s", worst, c->remedy);
    else
        warnings_add(
            out, "lights_do_not_fit",
            "the lights do not fit the pictures, %s: is their list in the order of the pictures' names, 9 before "
            "10, with x to the right, y up and z toward the camera?",
            worst);
}

static status check_all(check *c, warnings *out)
{
    size_t bytes = (size_t)c->fit.total * sizeof *c->light;
    c->light = malloc(bytes);
    c->trial = malloc(bytes);
    if (!c->light || !c->trial) return fail(MERLIN_NO_MEMORY, "no memory for %d lights", c->fit.total);
    status s = check_arrangement(c);
    const bool strengths = s == OK && are_strengths(c);
    if (strengths) {
        pst_warn_strengths(out);
        memcpy(c->light, c->trial, bytes);
        c->remedy[0] = 0;
    }
    bool doubt = c->remedy[0] != 0;
    bool near = c->capture->lighting == MERLIN_NEAR_LIGHTS;
    bool lost = !doubt && !strengths && c->own - c->least > fmax(near ? most_beyond_near : most_beyond, c->least);
    if (s == OK && !lost) s = check_axes(c, &doubt);
    if (s == OK && (doubt || lost)) report(c, out);
    return s;
}

status pst_check_lights(const merlin_capture *c, const merlin_surface *s, warnings *out)
{
    check all = {.capture = c, .surface = s};
    status result = pst_light_fit_new(c, s, &all.fit);
    if (result != OK) return result;
    if (all.fit.energy > 0) result = check_all(&all, out);
    free(all.light);
    free(all.trial);
    pst_light_fit_free(&all.fit);
    return result;
}
