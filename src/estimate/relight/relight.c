/* SPDX-License-Identifier: MIT */
/* Renders a relighter's pictures under its lights. */
#include <math.h>
#include <stdbool.h>

#include "base/number.h"
#include "estimate/light/bounce.h"
#include "estimate/light/relight_env.h"
#include "estimate/relight/relighter.h"

/* Largest number of points per side from which shadow rays start. */
enum { SHADOW_SIDE = 512 };

/* Distances from the object's middle of lamps that the relighting decoder may stand for by one at distance 1, which all
 * of its training's were; and, beside an environment, whose light it does not part from the lamp's, by one unchanged.
 */
static const float NEAREST = 0.5f, FARTHEST = 2, LITTLE_NEARER = 0.8f, LITTLE_FARTHER = 1.25f;

/* Multiplies by the mask. Zeros are not written to, here and below (image.h). */
static void multiply_mask(img *image, const img *mask)
{
    for (size_t i = 0; i < img_value_count(image); i++)
        if (image->data[i] != 0) image->data[i] *= mask->data[i / 3];
}

/* Casts shadows at twice as many points per side as the occluder has, unless the picture has fewer. */
static status cast_shadows(const relighter *s, const lamp *light, img *full, img *low)
{
    bool flash = !light->distant && vec3_dot(light->at, light->at) < 1e-12f;
    if (flash) return OK; /* the flash is at the camera, which sees no shadow of it */
    int side = min_int(full->width, min_int(2 * s->occluder.depth.width, SHADOW_SIDE));
    img seen = {0};
    status result = shadow_cast_lamp(&s->occluder, light, side, side, &seen);
    if (result != OK) return result;
    shadow_darken(&seen, full);
    shadow_darken(&seen, low);
    img_free(&seen);
    return OK;
}

/* Computes bounce 1 at both sizes. */
static status light_by_brdf(const relighter *s, const lamp *light, img *full, img *low)
{
    status result = surface_shade_lamp(&s->full, light, full);
    if (result == OK) result = surface_shade_lamp(&s->low, light, low);
    if (result == OK && relighter_casts_shadows(s)) result = cast_shadows(s, light, full, low);
    return result;
}

/* Multiplies by a lamp's tint. All light is proportional to the lamp's, and the network is evaluated for a white one of
 * its training power. */
static void apply_tint(vec3 tint, img *radiance)
{
    if (tint.x == 1 && tint.y == 1 && tint.z == 1) return;
    for (size_t i = 0; i < img_value_count(radiance); i += 3) {
        float *value = radiance->data + i;
        if (value[0] != 0 || value[1] != 0 || value[2] != 0) vec3_put(vec3_mul(vec3_of(value), tint), value);
    }
}

static status light_by_network(network *n, const relighter *s, const lamp *light, img *full, img *low)
{
    const vec3 way = vec3_sub(light->at, object_middle);
    const float distance = s->environment ? 1 : vec3_length(way);
    illumination both = {vec3_fma(object_middle, 1 / distance, way),
                         s->environment ? (const float(*)[3])s->environment->sh : NULL};
    status result = network_relight(n, s->features, &both, low);
    const float share = 1 / (distance * distance);
    if (result == OK) apply_tint(vec3_make(share, share, share), low);
    if (result == OK) result = surface_resize_image(low, &s->low.mask, &s->full.mask, full);
    /* whether enlarged or not, it continues outside the object */
    if (result == OK) multiply_mask(full, &s->full.mask);
    return result;
}

/* Adds an environment's light without shadows: its diffuse part at the network's size, and all of it to `full`. The
 * output of the relighting decoder (then in `low` and `full`) already contains the diffuse part. */
static status add_environment(const relighter *s, img *low, img *full, img *ambient)
{
    const env_map *env = s->environment;
    const float(*sh)[3] = (const float(*)[3])env->sh;
    status result = img_new(ambient, low->width, low->height, 3);
    if (result != OK) return result;
    surface_add_ambient(&s->low, sh, ambient);
    if (s->how == MERLIN_BY_NETWORK) {
        for (size_t i = 0; i < img_value_count(low); i++)
            low->data[i] -= ambient->data[i];
    } else {
        surface_add_ambient(&s->full, sh, full);
    }
    if (!s->full.matte) surface_add_reflections(&s->full, env, NULL, full);
    return OK;
}

/* Adds the network's bounces 2 and up for `low` and `ambient`, resized, to `full`. */
static status add_indirect(network *n, const relighter *s, const img *low, const img *ambient, img *full)
{
    img indirect = {0}, large = {0};
    const img *more = ambient->data ? ambient : NULL;
    status result = network_indirect(n, &s->low, low, more, &indirect);
    if (result == OK) result = bounce_follow(&s->flash, low, more, &indirect);
    if (result == OK) result = surface_resize_indirect(&indirect, &s->low.mask, &s->full.mask, &large);
    if (result == OK) {
        multiply_mask(&large, &s->full.mask);
        img_add(&large, full);
    }
    img_free(&indirect);
    img_free(&large);
    return result;
}

static void expose(img *radiance, float white)
{
    for (size_t i = 0; i < img_value_count(radiance); i++)
        if (radiance->data[i] != 0) radiance->data[i] = clamp(radiance->data[i] / white, 0, 1);
}

static status light_by_lamp(network *n, const relighter *s, const lamp *light, img *full, img *low)
{
    return s->how == MERLIN_BY_NETWORK ? light_by_network(n, s, light, full, low) : light_by_brdf(s, light, full, low);
}

static bool is_plain(const lamp *light)
{
    return !light->distant && light->tint.x == 1 && light->tint.y == 1 && light->tint.z == 1;
}

static status dark(const relighter *s, img *full, img *low)
{
    status result = img_new(full, s->full.mask.width, s->full.mask.height, 3);
    return result == OK ? img_new(low, s->low.mask.width, s->low.mask.height, 3) : result;
}

/* Refuses lamps that are not where those of the relighting decoder's training were. */
static status check_place(vec3 at, bool environment)
{
    const float distance = vec3_length(vec3_sub(at, object_middle));
    const float least = environment ? LITTLE_NEARER : NEAREST, most = environment ? LITTLE_FARTHER : FARTHEST;
    if (distance >= least && distance <= most && at.z >= object_middle.z) return OK;
    return fail(
        MERLIN_WRONG_USE,
        "the relighting decoder knows lamps in front of the object (z from -1 on), %g to %g away from 0,0,-1%s, "
        "and %g,%g,%g is not: relight by BRDF",
        (double)least, (double)most, environment ? " beside an environment" : "", (double)at.x, (double)at.y,
        (double)at.z);
}

status relighter_check(merlin_relighting how, const lamp *light, bool environment)
{
    if (how < MERLIN_BY_BRDF || how > MERLIN_BY_BRDF_DIRECT)
        return fail(MERLIN_WRONG_USE, "no way of relighting has the number %d", (int)how);
    if (how != MERLIN_BY_NETWORK) return OK;
    if (!light)
        return fail(MERLIN_WRONG_USE,
                    "the relighting decoder needs a point light beside the environment; relight by BRDF");
    if (light->distant)
        return fail(MERLIN_WRONG_USE, "the relighting decoder knows no distant lights; relight by BRDF");
    if (environment && !is_plain(light))
        return fail(MERLIN_WRONG_USE,
                    "beside an environment the relighting decoder knows white light of power 1 alone; "
                    "relight by BRDF");
    return check_place(light->at, environment);
}

/* Adds a lamp's light, with its bounces if these can be separated from the environment's, so that each part can be
 * tinted. */
static status add_lamp(network *n, const relighter *s, const lamp *light, bool alone, img *full, img *low)
{
    const img none = {0};
    status result = light_by_lamp(n, s, light, full, low);
    if (result == OK && alone && s->how != MERLIN_BY_BRDF_DIRECT) result = add_indirect(n, s, low, &none, full);
    if (result != OK) return result;
    apply_tint(light->tint, full);
    if (!alone) apply_tint(light->tint, low);
    return OK;
}

/* Adds the light of several lamps. */
static status add_lamps(network *n, const relighter *s, const lamp *lights, int count, bool alone, img *full, img *low)
{
    status result = count ? add_lamp(n, s, &lights[0], alone, full, low) : dark(s, full, low);
    for (int i = 1; i < count && result == OK; i++) {
        img more = {0}, more_low = {0};
        result = add_lamp(n, s, &lights[i], alone, &more, &more_low);
        if (result == OK) img_add(&more, full);
        if (result == OK) img_add(&more_low, low);
        img_free(&more);
        img_free(&more_low);
    }
    return result;
}

status relighter_render(network *n, const relighter *s, const lamp *lights, int count, img *out)
{
    *out = (img){0};
    img low = {0}, ambient = {0};
    bool shadows = s->environment && relighter_casts_shadows(s), joint = s->environment && !shadows;
    status result = add_lamps(n, s, lights, count, !joint, out, &low);
    if (result == OK && joint) result = add_environment(s, &low, out, &ambient);
    if (result == OK && joint) result = add_indirect(n, s, &low, &ambient, out);
    /* with its shadows and a bounce, no light of an environment is left for the network to add */
    if (result == OK && shadows)
        result = surface_add_shadowed_environment(&s->full, &s->low, &s->horizon, s->environment, out);
    if (result == OK) expose(out, s->white);
    img_free(&low);
    img_free(&ambient);
    if (result != OK) img_free(out);
    return result;
}
