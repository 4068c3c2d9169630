/* SPDX-License-Identifier: MIT */
#include "photo_stereo/prior_stereo.h"

#include <stdbool.h>
#include <stdlib.h>

#include "merlin/lights.h"
#include "photo_stereo/measured_albedo.h"
#include "photo_stereo/near_refine.h"
#include "photo_stereo/refit_depth.h"
#include "stereo/methods/solve.h"

/* Least number of pictures whose lights a network has compared, and largest one of which the networks' normals stay in
 * part. */
enum { FEWEST = 2, FEW = 4 };

/* Least share of the network's slopes that a surface's have along them, and that its have in all; less in both is too
 * flat. Measured (docs/notes/several_photographs.md): 0.7 to 1.4, and 1 to 1.7, with lights that were found, 0.2 to
 * 0.3, and 0.3 to 0.7, of near ones on a ring with errors of 40 degrees. */
static const double least_along = 0.6, least_in_all = 0.8;

/* Converts a vector from the lens's space (merlin_maps_lens_place) back to the maps', in which the lens's axes are the
 * rows of the rotation. */
static vec3 from_lens(const merlin_maps *maps, vec3 v)
{
    const camera_plane plane = camera_plane_of((camera_slant){maps->slant[0], maps->slant[1]});
    const vec3 x = plane.right, y = plane.up, z = vec3_cross(x, y);
    return vec3_fma(vec3_fma(vec3_scale(x, v.x), v.y, y), v.z, z);
}

static void take_spread(const img *spread, merlin_maps *maps)
{
    for (size_t i = 0; i < img_value_count(spread) && maps->spread.data; i++)
        if (maps->mask.data[i] >= 0.5f) maps->spread.data[i] = spread->data[i];
}

/* Returns the share of the networks' normals that stays: under a few near lights they are as good as what is found, and
 * err differently (docs/notes/several_photographs.md). */
static float kept_share(const merlin_surface *found, int pictures)
{
    return found->lights_near && pictures <= FEW ? 1 / (float)pictures : 0;
}

static void take(const merlin_surface *found, const merlin_capture *c, merlin_maps *maps)
{
    const int pictures = c->count;
    const float kept = kept_share(found, pictures);
    for (size_t i = 0; i < img_value_count(&maps->mask); i++) {
        if (!(maps->mask.data[i] >= 0.5f)) continue;
        const vec3 n = from_lens(maps, vec3_of(found->normal.data + 3 * i));
        float *normal = maps->normal.data + 3 * i;
        if (vec3_dot(n, n) > 0) vec3_put(vec3_normalize(vec3_lerp(n, vec3_of(normal), kept)), normal);
    }
    if (found->spread.data) take_spread(&found->spread, maps);
    /* each pixel of fewer pictures is dark in too many of them to tell its albedo better than a network guesses it */
    if (pictures >= PST_FEWEST_UNKNOWN) measured_albedo_take(&found->albedo, maps);
    maps->refined = 1;
    maps->doubts &= ~(unsigned)MERLIN_DOUBT_NOT_REFINED;
    if (found->strengths_unsure) maps->doubts |= MERLIN_DOUBT_STRENGTHS_UNEQUAL;
    if (!pinhole_is_near(&c->camera)) maps->doubts |= MERLIN_DOUBT_LIGHTS_FAR;
}

/* Surface and lights that are expected, in the space of the capture's camera. */
typedef struct expectation {
    img mask;
    vec3 *light, *compared; /* compared: NULL if nobody compared them */
    const float *near;
} expectation;

static void turn(const merlin_maps *maps, const vec3 *from, int count, vec3 *to)
{
    for (int i = 0; i < count; i++) {
        float way[3];
        vec3_put(from[i], way);
        merlin_maps_lens_place(maps, way, way);
        to[i] = vec3_of(way);
    }
}

static status expect(const merlin_maps *maps, const prior_lights *lights, int count, expectation *out)
{
    *out = (expectation){.near = lights->near};
    out->light = malloc(2 * (size_t)count * sizeof *out->light);
    if (!out->light) return fail(MERLIN_NO_MEMORY, "no memory for %d lights", count);
    turn(maps, lights->light, count, out->light);
    if (lights->compared) {
        out->compared = out->light + count;
        turn(maps, lights->compared, count, out->compared);
    }
    status s = img_copy(&out->mask, &maps->mask);
    for (size_t i = 0; s == OK && i < img_value_count(&out->mask); i++)
        out->mask.data[i] = out->mask.data[i] >= 0.5f;
    return s;
}

static void expectation_free(expectation *e)
{
    img_free(&e->mask);
    free(e->light);
}

/* Turns the maps' normals into the lens's space, or back, in place: a copy of a large photograph's is much memory. */
static void turn_normals(merlin_maps *maps, bool back)
{
    for (size_t i = 0; i < img_value_count(&maps->mask); i++) {
        float *normal = maps->normal.data + 3 * i;
        if (!(maps->mask.data[i] > 0)) continue;
        if (back)
            vec3_put(from_lens(maps, vec3_of(normal)), normal);
        else
            merlin_maps_lens_place(maps, normal, normal);
    }
}

/* Tells whether a surface is plainly flatter than the network says, as under near lights on a ring, which a relief of
 * any height explains. maps: with normals in the lens's space. */
static bool is_flattened(const merlin_surface *found, const merlin_maps *maps)
{
    double told = 0, both = 0, own = 0;
    for (size_t i = 0; i < img_value_count(&maps->mask); i++) {
        const vec3 a = vec3_of(maps->normal.data + 3 * i), b = vec3_of(found->normal.data + 3 * i);
        if (!(maps->mask.data[i] >= 0.5f) || !(vec3_dot(b, b) > 0)) continue;
        told += (double)(a.x * a.x + a.y * a.y);
        both += (double)(a.x * b.x + a.y * b.y);
        own += (double)(b.x * b.x + b.y * b.y);
    }
    return both < least_along * told && own < least_in_all * least_in_all * told;
}

/* Solves the maps' object as if its lights were unknown. maps: with normals in the lens's space. */
static status solve(const prior_stereo *p, const merlin_maps *maps, const expectation *e, merlin_surface *out)
{
    merlin_capture c = *p->capture;
    const pst_expected expected = {.normal = &maps->normal,
                                   .depth = &maps->depth,
                                   .light = e->light,
                                   .compared = e->compared,
                                   .near = e->near,
                                   .lights_alone = p->near != NULL};
    c.lighting = MERLIN_UNKNOWN_LIGHTS;
    c.mask = e->mask;
    status s = pst_solve_expecting(
        &c, &(merlin_stereo_params){.method = MERLIN_STEREO_UNCALIBRATED, .unchecked = 1, .stop = p->stop}, &expected,
        out);
    return s == OK ? near_refine(&(near_refinement){p->near, &c, p->stop}, out) : s;
}

status prior_stereo_refine(const prior_stereo *p, merlin_maps *maps)
{
    const int count = p->capture->count;
    if (count < (p->lights.compared ? FEWEST : PST_FEWEST_UNKNOWN)) return OK;
    expectation e;
    merlin_surface found = {0};
    status s = expect(maps, &p->lights, count, &e);
    if (s == OK) {
        turn_normals(maps, false);
        s = solve(p, maps, &e, &found);
        if (s == OK) found.lights_unsure |= is_flattened(&found, maps);
        turn_normals(maps, true);
    }
    const bool taken = s == OK && !found.lights_unsure;
    if (taken) take(&found, p->capture, maps);
    merlin_surface_free(&found); /* before the depth is integrated, as that needs as much memory again */
    expectation_free(&e);
    if (taken) s = refit_depth(maps);
    return s == MERLIN_BAD_INPUT ? OK : s; /* the pictures do not tell where the lights are */
}
