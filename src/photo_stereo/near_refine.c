/* SPDX-License-Identifier: MIT */
#include "photo_stereo/near_refine.h"

#include <math.h>
#include <stdbool.h>
#include <stdlib.h>

#include "nfps/nfps_stereo.h"
#include "stereo/fit/problem.h"
#include "stereo/methods/solve.h"

/* Numbers of pictures from which on the network's surface is the better one, and lights are not found better again;
 * share of the network in the mean with the fit of few pictures; share of the weight of expected lights where those
 * that were found take their place, so that they can move (docs/notes/several_photographs.md). */
enum { FEWEST = 3, PLENTY = 24 };
static const float share = 0.6f, doubt = 0.1f;
/* Side up to which the network sees pictures whose lights are searched for, on a coarse grid, and for a beginning. */
enum { COARSE = 256 };

/* The capture under the lights that were found. */
static merlin_capture lit_capture(const near_refinement *n, const merlin_surface *found)
{
    merlin_capture c = *n->capture;
    c.lighting = MERLIN_NEAR_LIGHTS;
    c.light = found->lights;
    c.intensities_known = true;
    if (!(c.camera.distance > 0)) c.camera.distance = 1;
    return c;
}

static status ask_network(const near_refinement *n, const merlin_surface *found, int largest, img *normal, img *depth)
{
    const merlin_capture c = lit_capture(n, found);
    const watch w = {.stop = n->stop};
    return nfps_stereo(n->network, &c, &(nfps_options){.largest = largest, .estimated = true, .watch = &w}, normal,
                       depth);
}

static void replace(merlin_surface *found, merlin_surface *by)
{
    merlin_surface_free(found);
    *found = *by;
    *by = (merlin_surface){0};
}

/* Lists the lights' directions and inverse distances from the object's middle, as pst_expected has them. */
static void list_lights(const merlin_capture *c, vec3 *way, float *near)
{
    const float distance = c->camera.distance;
    for (int k = 0; k < c->count; k++) {
        const vec3 from = vec3_sub(vec3_of(c->light[k].position), vec3_make(0, 0, -distance));
        way[k] = vec3_normalize(from);
        near[k] = distance / fmaxf(vec3_length(from), 1e-6f);
    }
}

/* Solves with a surface and lights as what is expected. BAD_INPUT: the pictures do not tell where the lights are. */
static status solve_expecting(const near_refinement *n, const merlin_surface *found, const img *normal,
                              const img *depth, merlin_surface *out)
{
    const merlin_stereo_params how = {.method = MERLIN_STEREO_UNCALIBRATED, .unchecked = 1, .stop = n->stop};
    const merlin_capture c = lit_capture(n, found);
    vec3 *way = calloc((size_t)c.count, sizeof *way);
    float *near = calloc((size_t)c.count, sizeof *near);
    status s = way && near ? OK : fail(MERLIN_NO_MEMORY, "no memory for %d lights", c.count);
    if (s == OK) {
        list_lights(&c, way, near);
        const pst_expected expected = {normal, depth, way, way, near, doubt, .near_alone = true, .lights_alone = true};
        s = pst_solve_expecting(n->capture, &how, &expected, out);
    }
    free(way);
    free(near);
    return s;
}

/* Finds the lights again, with the network's surface as what is expected. */
static status find_again(const near_refinement *n, merlin_surface *found)
{
    merlin_surface again = {0};
    img normal, depth;
    status s = ask_network(n, found, COARSE, &normal, &depth);
    if (s != OK) return s;
    s = solve_expecting(n, found, &normal, &depth, &again);
    if (s == OK && again.lights_near && !again.lights_unsure) replace(found, &again);
    merlin_surface_free(&again);
    img_free(&normal);
    img_free(&depth);
    return s == MERLIN_BAD_INPUT ? OK : s;
}

static void mix(const img *mask, const img *with, img *normal)
{
    for (size_t i = 0; i < img_value_count(mask); i++) {
        const vec3 n = vec3_of(normal->data + 3 * i);
        if (!(mask->data[i] > 0.5f) || !(vec3_dot(n, n) > 0)) continue;
        vec3_put(vec3_normalize(vec3_fma(vec3_scale(n, share), 1 - share, vec3_of(with->data + 3 * i))),
                 normal->data + 3 * i);
    }
}

static status take_network(const near_refinement *n, merlin_surface *found)
{
    img normal, depth;
    status s = ask_network(n, found, 0, &normal, &depth);
    if (s != OK) return s;
    mix(&n->capture->mask, &found->normal, &normal);
    img_free(&found->normal);
    found->normal = normal;
    img_free(&depth);
    return OK;
}

static status begin(const void *network, const merlin_capture *c, const watch *w, img *normal, img *depth)
{
    return nfps_stereo(network, c, &(nfps_options){.largest = COARSE, .watch = w}, normal, depth);
}

/* Solves under the lights that were found, beginning with the network's surface. */
static status solve_near(const near_refinement *n, merlin_surface *found)
{
    const merlin_stereo_params how = {.method = MERLIN_STEREO_NEAR, .unchecked = 1, .stop = n->stop};
    const merlin_capture c = lit_capture(n, found);
    const pst_guide guide = {begin, n->network, true};
    const int unsure = found->lights_unsure, unequal = found->strengths_unsure;
    merlin_surface solved = {0};
    status s = pst_solve_guided(&c, &how, &guide, &solved);
    if (s != OK) return s;
    replace(found, &solved);
    found->lights_unsure = unsure;
    found->strengths_unsure = unequal;
    return OK;
}

status near_refine(const near_refinement *n, merlin_surface *found)
{
    const int count = n->capture->count;
    if (!n->network || !found->lights_near || count < FEWEST) return OK;
    /* under doubtful lights of any strength the network makes a surface that speaks for them */
    if (found->lights_unsure && found->strengths_unsure) return OK;
    status s = count < PLENTY ? find_again(n, found) : OK;
    if (s != OK || found->lights_unsure) return s;
    if (count < PST_FEWEST_UNKNOWN) return take_network(n, found);
    s = solve_near(n, found);
    if (s == MERLIN_BAD_INPUT) found->lights_unsure = 1;
    return s == MERLIN_BAD_INPUT ? OK : s;
}
