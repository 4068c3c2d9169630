/* SPDX-License-Identifier: MIT */
#include "photo_stereo/prior_stereo.h"

#include <stdbool.h>
#include <stdlib.h>

#include "estimate/relight/maps_surface.h"
#include "estimate/surface/fuse.h"
#include "merlin/lights.h"
#include "stereo/integrate/integrate.h"
#include "stereo/methods/solve.h"

/* Number of pictures from which near lights are found so exactly that the network's normals have no share in the result
 * (docs/notes/several_photographs.md). */
enum { MANY_NEAR = 12 };

/* Converts a vector from the lens's space (merlin_maps_lens_place) back to the maps', in which the lens's axes are the
 * rows of the rotation. */
static vec3 from_lens(const merlin_maps *maps, vec3 v)
{
    const camera_plane plane = camera_plane_of((camera_slant){maps->slant[0], maps->slant[1]});
    const vec3 x = plane.right, y = plane.up, z = vec3_cross(x, y);
    return vec3_fma(vec3_fma(vec3_scale(x, v.x), v.y, y), v.z, z);
}

/* Integrates normals as of a lens whose axis goes through the crop's middle, at the mean distance of the present depth.
 */
static status integrate(surface *part)
{
    const int side = part->mask.width;
    pinhole seen_by = pinhole_of(side, side, (float)surface_lens(part).fov);
    double sum = 0, count = 0;
    img depth = {0};
    for (size_t i = 0; i < img_value_count(&part->mask); i++) {
        part->mask.data[i] = part->mask.data[i] >= 0.5f;
        sum += part->mask.data[i] > 0 ? (double)part->depth.data[i] : 0;
        count += part->mask.data[i] > 0;
    }
    seen_by.distance = count > 0 ? (float)(sum / count) : 1;
    status s = pst_integrate(&part->normal, &part->mask, &seen_by, &(pst_integration){.preserve_edges = false}, &depth);
    if (s != OK) return s;
    img_free(&part->depth);
    part->depth = depth;
    return OK;
}

/* Makes depth agree with the new normals: the network's has its shape, so that it is integrated anew; then fused, which
 * knows the true lines of sight. */
static status refit_depth(merlin_maps *maps)
{
    surface part = {0};
    status s = maps_as_photographed(maps, &part);
    if (s == OK) s = integrate(&part);
    if (s == OK) s = fuse_depth(&part.normal, &part.mask, surface_lens(&part), &part.depth);
    if (s == OK) crop_put(&part.depth, crop_of(maps), &part.mask, &maps->depth);
    surface_free(&part);
    return s;
}

/* Takes the solved normals; with few pictures under near lights their mean with the network's, as both have errors then
 * and other ones. */
static status take(const merlin_surface *found, bool alone, merlin_maps *maps)
{
    for (size_t i = 0; i < img_value_count(&maps->mask); i++) {
        if (!(maps->mask.data[i] >= 0.5f)) continue;
        float *normal = maps->normal.data + 3 * i;
        vec3 n = from_lens(maps, vec3_of(found->normal.data + 3 * i));
        if (!alone) n = vec3_normalize(vec3_add(n, vec3_of(normal)));
        if (vec3_dot(n, n) > 0) vec3_put(n, normal);
    }
    img_free(&maps->reconstruction);
    maps->refined = 1;
    maps->doubts &= ~(unsigned)MERLIN_DOUBT_NOT_REFINED;
    return refit_depth(maps);
}

/* Surface and lights that are expected, in the space of the capture's camera. */
typedef struct expectation {
    img mask, normal;
    vec3 *light;
} expectation;

static status expect(const merlin_maps *maps, const vec3 *light, int count, expectation *out)
{
    *out = (expectation){.light = malloc((size_t)count * sizeof *light)};
    if (!out->light) return fail(MERLIN_NO_MEMORY, "no memory for %d lights", count);
    for (int i = 0; i < count; i++) {
        float to[3];
        vec3_put(light[i], to);
        merlin_maps_lens_place(maps, to, to);
        out->light[i] = vec3_of(to);
    }
    status s = img_copy(&out->mask, &maps->mask);
    if (s == OK) s = img_copy(&out->normal, &maps->normal);
    for (size_t i = 0; s == OK && i < img_value_count(&out->mask); i++) {
        float *normal = out->normal.data + 3 * i;
        out->mask.data[i] = out->mask.data[i] >= 0.5f;
        merlin_maps_lens_place(maps, normal, normal);
    }
    return s;
}

static void expectation_free(expectation *e)
{
    img_free(&e->mask);
    img_free(&e->normal);
    free(e->light);
}

/* Solves the maps' object as if its lights were unknown. */
static status solve(const merlin_capture *capture, const expectation *e, int (*stop)(void), merlin_surface *out)
{
    merlin_capture c = *capture;
    const pst_expected expected = {&e->normal, e->light};
    c.lighting = MERLIN_UNKNOWN_LIGHTS;
    c.mask = e->mask;
    return pst_solve_expecting(
        &c, &(merlin_stereo_params){.method = MERLIN_STEREO_UNCALIBRATED, .unchecked = 1, .stop = stop}, &expected,
        out);
}

status prior_stereo_refine(const merlin_capture *capture, const vec3 *light, int (*stop)(void), merlin_maps *maps)
{
    if (capture->count < PST_FEWEST_UNKNOWN) return OK;
    expectation e;
    merlin_surface found = {0};
    status s = expect(maps, light, capture->count, &e);
    if (s == OK) s = solve(capture, &e, stop, &found);
    const bool alone = !found.lights_near || capture->count >= MANY_NEAR;
    if (s == OK && !found.lights_unsure) s = take(&found, alone, maps);
    merlin_surface_free(&found);
    expectation_free(&e);
    return s == MERLIN_BAD_INPUT ? OK : s; /* the pictures do not tell where the lights are */
}
