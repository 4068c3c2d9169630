/* SPDX-License-Identifier: MIT */
/* merlin_relight, merlin_relight_environment and merlin_relight_found: a picture of maps under other light; and which
 * network makes it. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/warnings.h"
#include "estimate/light/found_light.h"
#include "estimate/photo/model_pair.h"
#include "estimate/relight/maps_surface.h"
#include "estimate/relight/reconstruct.h"
#include "estimate/relight/relighter.h"

/* Copies the light, if there is one. */
static status take_light(const float *light, lamp *place)
{
    if (!light) return OK;
    *place = lamp_at(vec3_of(light));
    if (isfinite(light[0]) && isfinite(light[1]) && isfinite(light[2])) return OK;
    return fail(MERLIN_WRONG_USE, "the light's position is not finite");
}

/* Copies a square picture into the photograph's frame. */
static status place_square(const merlin_maps *maps, const img *square, const img *mask, merlin_image *out)
{
    img whole = {0};
    status s = img_new(&whole, maps->albedo.width, maps->albedo.height, 3);
    if (s == OK) crop_put(square, crop_of(maps), mask, &whole);
    *out = whole;
    return s;
}

/* The light by which maps are relit: lamps together, and an environment or NULL. */
typedef struct lighting {
    const lamp *lamps;
    int count;
    const env_map *environment;
} lighting;

static status relight_maps(merlin_model *model, const merlin_maps *maps, const lighting *by, merlin_relighting how,
                           merlin_image *out)
{
    relighter st;
    network *n = model_network(model, maps, how);
    img square = {0};
    status s = relighter_check(how, by->count ? by->lamps : NULL, by->environment);
    if (s == OK) s = relighter_new(n, maps, 0, how, &st);
    if (s != OK) return s;
    s = relighter_surround(&st, by->environment);
    if (s == OK) s = relighter_render(n, &st, by->lamps, by->count, &square);
    img mask = st.full.mask;
    st.full.mask = (img){0};
    relighter_free(&st); /* frees memory before a large photograph's frame is allocated */
    if (s == OK) s = place_square(maps, &square, &mask, out);
    img_free(&mask);
    img_free(&square);
    return s;
}

/* Relights by the point light, the environment, or both. */
static status relight_by(merlin_model *model, const merlin_maps *maps, const float *light, const env_map *environment,
                         merlin_relighting how, merlin_image *out)
{
    lamp place;
    status s = take_light(light, &place);
    const lighting by = {&place, light != NULL, environment};
    return s == OK ? relight_maps(model, maps, &by, how, out) : s;
}

merlin_status merlin_relight(merlin_model *model, const merlin_maps *maps, const float light[3], merlin_relighting how,
                             merlin_image *out)
{
    if (out) *out = (merlin_image){0};
    status s = api_needs(__func__, model && maps && light && out);
    return s == OK ? relight_by(model, maps, light, NULL, how, out) : s;
}

merlin_status merlin_relight_environment(merlin_model *model, const merlin_maps *maps, const merlin_environment *env,
                                         const float *light, merlin_relighting how, merlin_image *out)
{
    if (out) *out = (merlin_image){0};
    status s = api_needs(__func__, model && maps && env && out);
    return s == OK ? relight_by(model, maps, light, &env->map, how, out) : s;
}

/* Relights by a light that was estimated, turned. */
static status relight_by_found(merlin_model *model, const merlin_maps *maps, const merlin_found_light *light,
                               float turn, merlin_relighting how, merlin_image *out)
{
    found_lights lights = {.count = 0};
    status s = found_light_stand(light, turn, &lights);
    const lighting by = {lights.lamps, lights.count, found_lights_rest(&lights)};
    if (s == OK) s = relight_maps(model, maps, &by, how, out);
    env_map_free(&lights.rest);
    return s;
}

merlin_status merlin_relight_found(merlin_model *model, const merlin_maps *maps, float turn, merlin_relighting how,
                                   merlin_image *out)
{
    if (out) *out = (merlin_image){0};
    status s = api_needs(__func__, model && maps && out);
    if (s == OK && how == MERLIN_BY_NETWORK)
        s = fail(MERLIN_WRONG_USE, "the relighting decoder knows one lamp alone; relight by BRDF");
    if (s == OK && !isfinite(turn)) s = fail(MERLIN_WRONG_USE, "the light's turn must be finite");
    return s == OK ? relight_by_found(model, maps, &maps->light, turn, how, out) : s;
}

status maps_reconstruct(merlin_model *model, const merlin_maps *maps, merlin_image *out)
{
    merlin_found_light light = maps->light;
    *out = (merlin_image){0};
    if (!light.known) {
        light = (merlin_found_light){.known = 1, .flash = 1};
        if (maps->has_environment) memcpy(light.rest, maps->environment, sizeof light.rest);
    }
    return relight_by_found(model, maps, &light, 0, MERLIN_BY_BRDF, out);
}

/* ---- the network ---- */

const char *merlin_relighting_model(const merlin_model *model, const merlin_maps *maps, merlin_relighting how)
{
    return model && maps ? network_config(model_network(model, maps, how))->name : "";
}

void merlin_relighting_warnings(const merlin_model *model, const merlin_maps *maps, merlin_relighting how,
                                merlin_warnings *list)
{
    if (!model || !maps || !list || maps->captured || how == MERLIN_BY_BRDF_DIRECT) return;
    const char *name = merlin_relighting_model(model, maps, how);
    if (strcmp(name, maps->model) == 0) return;
    if (how == MERLIN_BY_NETWORK)
        warnings_add(list, "other_model", "the maps are of %s, and the decoder that relights them of %s", maps->model,
                     name);
    else
        warnings_add(list, "other_model", "the maps are of %s, and the bounces of their light of %s", maps->model,
                     name);
}
