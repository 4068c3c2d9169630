/* SPDX-License-Identifier: MIT */
#include "stereo/methods/place_lights.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "stereo/capture/shrink.h"
#include "stereo/methods/solution_cost.h"
#include "stereo/methods/solve.h"

/* SMALL, VALUES: number of pixels on which the distance is searched, fewer with many pictures, and of their values;
 * ROUNDS: of each solution; COARSE, FINE: numbers of distances to try; APART: steps between the best one and those that
 * must cost more. */
enum { SMALL = 900, VALUES = 90000, ROUNDS = 6, COARSE = 13, FINE = 10, APART = 2, VALLEYS = 2 };
/* Half the object's extent relative to the lights' distance from it. The least is equivalent to distant lights. */
static const float least_extent = 0.01f, first_extent = 0.03f, step = 1.35f;
/* Field of view in degrees if it is unknown: from 25 to 63 an error of it changes normals by some tenths of a degree.
 */
static const float usual_view = 45;
/* Ratios of costs relative to near lights, below which distant lights, and other distances, are equally good. */
static const double better = 1.3, sharper = 1.1;

typedef struct search {
    merlin_capture small;
    const vec3 *about; /* positions of the lights relative to the object */
    float unit;        /* distance at which the object is as large as the lights' distance */
    const watch *watch;
    int tried;
    bool unsure; /* whether the last solution's distance is unreliable */
} search;

/* Interpretation of the lights. */
typedef struct placing {
    float distance;  /* distance from the camera to their centre */
    bool held, near; /* held: whether the object's mean distance is the same */
} placing;

static void put_lights(const vec3 *about, float distance, bool held, merlin_capture *c)
{
    c->lighting = MERLIN_NEAR_LIGHTS;
    c->camera.distance = held ? distance : 0;
    for (int k = 0; k < c->count; k++)
        vec3_put(vec3_add(about[k], vec3_make(0, 0, -distance)), c->light[k].position);
}

/* Computes the cost of a solution; held: the object's mean distance is that of the lights' centre. */
static status cost_at(search *s, float extent, bool held, double *cost)
{
    merlin_surface found;
    put_lights(s->about, extent * s->unit, held, &s->small);
    watch_tell(s->watch, "finding the distance", (double)s->tried++ / (2 + COARSE + VALLEYS * FINE));
    if (watch_stops(s->watch)) return fail(MERLIN_STOPPED, "stopped");
    status result =
        pst_solve(&s->small, &(merlin_stereo_params){.method = MERLIN_STEREO_NEAR, .iterations = ROUNDS}, &found);
    if (result != OK) return result;
    result = pst_solution_cost(&s->small, &found, cost);
    s->unsure = found.distance_unsure;
    merlin_surface_free(&found);
    return result;
}

/* Refines by halving the steps, on the side of lower cost. */
static status refine(search *s, float *extent, double *cost)
{
    float ratio = sqrtf(step);
    status result = OK;
    for (int k = 0; k < FINE && result == OK; k += 2, ratio = sqrtf(ratio)) {
        const float side[2] = {*extent / ratio, *extent * ratio};
        for (int j = 0; j < 2 && result == OK; j++) {
            double there;
            result = cost_at(s, side[j], false, &there);
            if (result != OK || !(there < *cost)) continue;
            *cost = there;
            *extent = side[j];
        }
    }
    return result;
}

/* Returns the least distance whose cost is lower than its neighbours', among those greater than `above`; -1: none. */
static int next_valley(const double cost[COARSE], double above)
{
    int best = -1;
    for (int k = 0; k < COARSE; k++) {
        bool valley = (k == 0 || cost[k] < cost[k - 1]) && (k + 1 == COARSE || cost[k] <= cost[k + 1]);
        if (valley && cost[k] > above && (best < 0 || cost[k] < cost[best])) best = k;
    }
    return best;
}

/* Finds the distance; *determined: whether other distances explain the pictures less well. An object nearer to the
 * lights than their centre also explains some pictures, so that the two best distances are refined. */
static status find_distance(search *s, float *distance, bool *determined)
{
    double cost[COARSE], least = HUGE_VAL, above = -1;
    status result = OK;
    *determined = false;
    for (int k = 0; k < COARSE && result == OK; k++)
        result = cost_at(s, first_extent * powf(step, (float)k), false, &cost[k]);
    for (int n = 0; n < VALLEYS && result == OK; n++) {
        int k = next_valley(cost, above);
        if (k < 0) break;
        above = cost[k];
        float extent = first_extent * powf(step, (float)k);
        double closely = cost[k];
        result = refine(s, &extent, &closely);
        if (!(closely < least)) continue;
        double nearer = k < APART ? 0 : cost[k - APART], further = k + APART < COARSE ? cost[k + APART] : 0;
        least = closely;
        *determined = fmin(nearer, further) > sharper * least;
        *distance = extent * s->unit;
    }
    return result;
}

/* Returns half the larger side of the object's bounding box in the picture. */
static float half_extent(const merlin_capture *c)
{
    int left = c->width, right = 0, top = c->height, bottom = 0;
    for (int y = 0; y < c->height; y++)
        for (int x = 0; x < c->width; x++) {
            if (c->mask.data[(size_t)y * (size_t)c->width + (size_t)x] <= 0.5f) continue;
            left = x < left ? x : left;
            right = x > right ? x : right;
            top = y < top ? y : top;
            bottom = y > bottom ? y : bottom;
        }
    int across = right - left + 1, down = bottom - top + 1;
    return 0.5f * (float)(across > down ? across : down);
}

static size_t object_pixels(const merlin_capture *c)
{
    size_t count = 0;
    for (size_t i = 0; i < img_value_count(&c->mask); i++)
        count += c->mask.data[i] > 0.5f;
    return count;
}

static float reach_of(const vec3 *about, int count)
{
    float sum = 0;
    for (int k = 0; k < count; k++)
        sum += vec3_length(about[k]) / (float)count;
    return sum;
}

static bool are_units(const vec3 *about, int count)
{
    for (int k = 0; k < count; k++)
        if (fabsf(vec3_length(about[k]) - 1) > 0.02f) return false;
    return true;
}

static status search_new(const merlin_capture *c, const vec3 *about, const watch *shown, search *s)
{
    int factor = (int)sqrtf((float)object_pixels(c) / fminf(SMALL, (float)VALUES / (float)c->count));
    *s = (search){.about = about, .watch = shown, .unit = reach_of(about, c->count) * c->camera.focal / half_extent(c)};
    return pst_shrink(c, pst_blocks_of(c, factor > 1 ? factor : 1), PST_SATURATED, &s->small);
}

static void report(const placing *p, const vec3 *about, merlin_capture *c)
{
    float reach = reach_of(about, c->count);
    if (p->near)
        warnings_add(&c->noticed, "lights_have_places",
                     "the lights are listed as places, %.3g from the object, and were taken for near ones: the camera "
                     "then is %.3g from there, and depth is in their unit",
                     (double)reach, (double)p->distance);
    else
        warnings_add(&c->noticed, "lights_have_places",
                     "the lights are listed as places, %.3g from the object, and were taken for directions, which "
                     "explain the pictures as well",
                     (double)reach);
}

static status refuse(const merlin_capture *c)
{
    return fail(MERLIN_BAD_INPUT,
                "the lights of %s and the others are listed by their places about the object, and the pictures do not "
                "tell how far the camera is from it: say so by --distance and --fov, or list them from the camera in a "
                ".txt file, or take them for distant lights without --near",
                c->name[0]);
}

/* Chooses whether the object is at the lights' centre, or in front of or behind it. */
static status choose(const merlin_capture *c, search *s, placing *p)
{
    double afar = 0, free = 0, held = 0;
    bool determined = true, asked = p->near, known = p->distance > 0;
    status result = known ? OK : find_distance(s, &p->distance, &determined);
    if (result == OK && asked && !determined && are_units(s->about, c->count)) p->distance = 1, determined = true;
    if (result == OK && asked && !determined) return refuse(c);
    if (!determined) return result;
    float extent = p->distance / s->unit;
    if (result == OK) result = cost_at(s, extent, false, &free);
    bool unsure = s->unsure;
    if (result == OK) result = cost_at(s, extent, true, &held);
    if (result == OK && !asked) result = cost_at(s, least_extent, true, &afar);
    p->held = unsure || !(free < held);
    p->near = asked || (!unsure && afar > better * fmin(free, held));
    return result;
}

status pst_place_lights(merlin_capture *c, const watch *shown)
{
    bool asked = c->lighting == MERLIN_NEAR_LIGHTS;
    placing p = {.distance = c->camera.distance, .near = asked};
    pinhole camera = c->camera;
    vec3 *about = malloc((size_t)c->count * sizeof *about);
    if (!about) return fail(MERLIN_NO_MEMORY, "no memory for %d lights", c->count);
    for (int k = 0; k < c->count; k++)
        about[k] = vec3_of(c->light[k].position);
    if (!(camera.focal > 0)) c->camera = pinhole_of(c->width, c->height, usual_view);
    search s;
    status result = search_new(c, about, shown, &s);
    if (result == OK) result = choose(c, &s, &p);
    if (result == MERLIN_BAD_INPUT && !asked) { /* near lights have further requirements */
        p.near = false;
        result = OK;
    }
    pst_capture_free(&s.small);
    if (result == OK && p.near)
        put_lights(about, p.distance, p.held, c);
    else
        c->camera = camera;
    c->about_object = false;
    if (result == OK && !asked) report(&p, about, c);
    free(about);
    return result;
}
