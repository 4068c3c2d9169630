/* SPDX-License-Identifier: MIT */
#include "estimate/photo/model_pair.h"

#include <stdlib.h>
#include <string.h>

#include "base/api_needs.h"
#include "estimate/photo/params.h"

void merlin_maps_free(merlin_maps *maps)
{
    if (!maps) return;
    merlin_image *images[] = {&maps->albedo, &maps->normal, &maps->roughness,      &maps->depth,
                              &maps->mask,   &maps->photo,  &maps->reconstruction, &maps->spread};
    for (size_t i = 0; i < sizeof images / sizeof images[0]; i++)
        merlin_image_free(images[i]);
    free(maps->noticed);
    *maps = (merlin_maps){0};
}

merlin_status merlin_model_open(const char *weights, merlin_model **out)
{
    if (out) *out = NULL;
    status s = api_needs(__func__, weights && out);
    if (s != OK) return s;
    merlin_model *model = calloc(1, sizeof *model);
    if (!model) return fail(MERLIN_NO_MEMORY, "no memory for a model");
    s = network_open(weights, &model->network);
    if (s != OK)
        free(model);
    else
        *out = model;
    return s;
}

merlin_status merlin_model_add_flash(merlin_model *model, const char *weights)
{
    status s = api_needs(__func__, model && weights);
    if (s == OK && model->flash) s = fail(MERLIN_WRONG_USE, "the model has another for flashes already");
    if (s == OK && network_config(model->network)->lighting != MODEL_LIGHT_ANY)
        s = fail(MERLIN_WRONG_USE, "%s tells no flash from other light, so that no other model can see flashes for it",
                 network_config(model->network)->name);
    if (s == OK) s = network_open_later(weights, &model->flash);
    return s;
}

merlin_status merlin_model_add_several(merlin_model *model, const char *weights)
{
    status s = api_needs(__func__, model && weights);
    if (s == OK && model->several) s = fail(MERLIN_WRONG_USE, "the model has another for several photographs already");
    if (s == OK && network_config(model->network)->lighting != MODEL_LIGHT_ANY)
        s = fail(MERLIN_WRONG_USE, "%s is for flashes, and takes no photographs under other lights",
                 network_config(model->network)->name);
    return s == OK ? network_open_several(weights, &model->several) : s;
}

/* Opens a model with another one that is added to it; further: its weights, or NULL. */
static status open_with(const char *weights, const char *further,
                        merlin_status (*add)(merlin_model *model, const char *weights), merlin_model **out)
{
    status s = merlin_model_open(weights, out);
    if (s == OK && further) s = add(*out, further);
    if (s == OK) return OK;
    merlin_model_close(*out);
    *out = NULL;
    return s;
}

status model_open_pair(const char *weights, const char *flash, merlin_model **out)
{
    return open_with(weights, flash, merlin_model_add_flash, out);
}

status model_open_several(const char *weights, const char *several, merlin_model **out)
{
    return open_with(weights, several, merlin_model_add_several, out);
}

network *model_network(const merlin_model *model, const merlin_maps *maps, merlin_relighting how)
{
    if (!model->flash) return model->network;
    if (how == MERLIN_BY_NETWORK && network_config(model->network)->relight != MODEL_RELIGHT_NETWORK)
        return model->flash;
    return strcmp(maps->model, network_config(model->network)->name) == 0 ? model->network : model->flash;
}

merlin_status merlin_model_prepare(merlin_model *model, const merlin_params *params)
{
    const merlin_params usual = merlin_params_default();
    status s = api_needs(__func__, model);
    if (!params) params = &usual;
    const int size = network_side(params->size);
    if (s == OK) s = params_check(params);
    if (s != OK) return s;
    if (!model->flash) return network_prepare(model->network, size, params->views);
    return params->flash ? network_prepare(model->flash, size, params->views)
                         : network_prepare_lights(model->network, size);
}

void model_keep(merlin_model *model, network *kept)
{
    if (!model->flash) return;
    network_close(kept == model->flash ? model->network : model->flash);
    model->network = kept;
    model->flash = NULL;
}

void merlin_model_close(merlin_model *model)
{
    if (!model) return;
    network_close(model->several);
    network_close(model->flash);
    network_close(model->network);
    free(model);
}

const char *merlin_model_name(const merlin_model *model)
{
    return model ? network_config(model->network)->name : "";
}
