/* SPDX-License-Identifier: MIT */
#include "model/model.h"

#include <stdio.h>

#include "model/blocks.h"
#include "model/model_network.h"
#include "model/nfps.h"
#include "model/rivals/rival.h"
#include "model/rivals/rival_li.h"
#include "model/sh_bands.h"
#include "optics/light.h"

enum { LIGHT_CODE = 128, ENVIRONMENT_FEATURES = 128 };

const char *const model_losses[MODEL_LOSSES] = {"albedo",
                                                "normal",
                                                "depth",
                                                "roughness",
                                                "roughness_gradient",
                                                "direct",
                                                "indirect",
                                                "reconstruction",
                                                "relight",
                                                "environment",
                                                "relight_brdf",
                                                "relight_ssim",
                                                "relight_brdf_ssim",
                                                "flash",
                                                "lamp",
                                                "lamp_distance",
                                                "lamp_light",
                                                "visibility",
                                                "first_normal"};

const char *const model_features[MODEL_FEATURES + 1] = {
    "encoder_features0",  "encoder_features1",  "encoder_features2",  "encoder_features3",  "encoder_features4",
    "material_features0", "material_features1", "material_features2", "material_features3", NULL};

/* Adds model_decode_sh to the graph. */
static nn_node *decode_sh(nn_graph *g, nn_node *code)
{
    nn_node *parts[SH_BANDS];
    for (int band = 0; band < SH_BANDS; band++)
        parts[band] = nn_scale_shift(g, nn_slice(g, code, sh_first[band], sh_count[band]), 1 / sh_scale[band], 0.0f);
    return nn_concat(g, parts, SH_BANDS);
}

static void decode_material(model_nodes *n, const char *name, nn_node *features[MODEL_LEVELS - 1])
{
    block_decoder_inputs in = {.name = name,
                               .widths = n->config->widths,
                               .blocks = n->config->material_blocks,
                               .gated = n->config->gated_attention,
                               .bottleneck = n->encoder[MODEL_LEVELS - 1],
                               .skips = n->encoder};
    block_decoder(n->g, &in, features);
}

static void material_by_one_decoder(model_nodes *n)
{
    nn_graph *g = n->g;
    decode_material(n, "material", n->material);
    nn_node *y = block_head(g, n->material[0], "material.head", 8);
    if (n->config->several) {
        const block_pixel_inputs in = {n->pixels, n->seen[0], n->material[0], n->lights};
        y = nn_add(g, y, block_pixels(g, &in, "pixels", 8));
    }
    n->maps.albedo = nn_tanh(g, nn_slice(g, y, 0, 3));
    n->maps.normal = nn_normalize(g, nn_slice(g, y, 3, 3));
    n->maps.roughness = nn_tanh(g, nn_slice(g, y, 6, 1));
    n->maps.depth = model_shape_depth(g, nn_tanh(g, nn_slice(g, y, 7, 1)));
}

static void material_by_four_decoders(model_nodes *n)
{
    nn_graph *g = n->g;
    static const char *const decoders[4] = {"material_albedo", "material_normal", "material_roughness",
                                            "material_depth"};
    static const char *const heads[4] = {"material_albedo.head", "material_normal.head", "material_roughness.head",
                                         "material_depth.head"};
    static const int channels[4] = {3, 3, 1, 1};
    nn_node *y[4];
    for (int k = 0; k < 4; k++) {
        nn_node *features[MODEL_LEVELS - 1];
        decode_material(n, decoders[k], features);
        y[k] = block_head(g, features[0], heads[k], channels[k]);
        for (int i = 0; i < MODEL_LEVELS - 1; i++)
            n->material[i] = k ? nn_add(g, n->material[i], features[i]) : features[i];
    }
    n->maps.albedo = nn_tanh(g, y[0]);
    n->maps.normal = nn_normalize(g, y[1]);
    n->maps.roughness = nn_tanh(g, y[2]);
    n->maps.depth = model_shape_depth(g, nn_tanh(g, y[3]));
}

static void relight_by_network(model_nodes *n)
{
    nn_graph *g = n->g;
    /* three fully connected layers, repeated over the bottleneck (Sang & Chandraker 2020) */
    nn_node *code = nn_compute(g, n->light);
    code = nn_tanh(g, nn_linear(g, code, "lighting.fc1", 8));
    code = nn_tanh(g, nn_linear(g, code, "lighting.fc2", 32));
    code = nn_tanh(g, nn_linear(g, code, "lighting.fc3", LIGHT_CODE));
    nn_node *deepest = n->encoder[MODEL_LEVELS - 1];
    nn_node *parts[2] = {deepest, nn_tile(g, code, deepest)};
    block_decoder_inputs in = {.name = "relight",
                               .widths = n->config->widths,
                               .gated = n->config->gated_attention,
                               .bottleneck = nn_concat(g, parts, 2),
                               .skips = n->encoder,
                               .shared = n->config->feature_sharing ? n->material : NULL};
    nn_node *features[MODEL_LEVELS - 1];
    block_decoder(g, &in, features);
    nn_node *y = nn_sigmoid(g, block_head(g, features[0], "relight.head", 3));
    n->relit_direct = nn_gate(g, y, n->mask);
}

/* Adds a vector predicted from the encoder's two deepest features, averaged over the image: the photograph's light. It
 * is scaled to be small at first, lest a bright prediction teach the maps to be black. */
static nn_node *estimate_light(model_nodes *n, const char *first, const char *second, int values)
{
    nn_graph *g = n->g;
    nn_node *parts[2];
    for (int i = 0; i < 2; i++)
        parts[i] = nn_spatial_mean(g, n->seen[MODEL_LEVELS - 2 + i]);
    nn_node *y = nn_relu(g, nn_linear(g, nn_concat(g, parts, 2), first, ENVIRONMENT_FEATURES));
    return nn_float(g, nn_scale_shift(g, nn_linear(g, y, second, values), 0.1f, 0.0f));
}

/* Inputs of the global-illumination network that one point light does not give: direct is all of bounce 1, environment
 * (or NULL) the part of it from an environment. */
typedef struct first_bounce {
    nn_node *direct, *environment;
} first_bounce;

/* Adds the network that predicts the residual light of bounces 2 and up (under an environment also its shadows), from
 * the image of bounce 1 and the maps. */
static nn_node *global_illumination(nn_graph *g, const model_config *config, const first_bounce *light,
                                    const model_maps *m, nn_node *mask)
{
    nn_node *parts[7] = {light->direct, m->albedo, m->normal, m->roughness, m->depth, mask, light->environment};
    /* maps are undefined outside the mask */
    nn_node *x = nn_gate(g, nn_concat(g, parts, light->environment ? 7 : 6), mask);
    nn_node *encoder[MODEL_LEVELS], *features[MODEL_LEVELS - 1];
    block_encoder(g, x, "indirect.encoder", &(block_encoder_shape){.widths = config->gi_widths}, encoder);
    block_decoder_inputs in = {.name = "indirect.decoder",
                               .widths = config->gi_widths,
                               .gated = config->gated_attention,
                               .bottleneck = encoder[MODEL_LEVELS - 1],
                               .skips = encoder};
    block_decoder(g, &in, features);
    nn_node *y = block_head(g, features[0], "indirect.head", 3);
    /* indirect light is a few percent of direct: small from the first step on */
    return nn_gate(g, nn_scale_shift(g, y, 0.1f, 0.0f), mask);
}

static nn_node *render_environment(model_nodes *n, nn_node *code)
{
    return nn_environment(n->g, n->maps.albedo, n->maps.normal, n->mask, decode_sh(n->g, code));
}

/* Adds what shows where each picture's strongest lamp is blocked: by the object's features and, of several pictures,
 * its own. */
static nn_node *estimate_visibility(model_nodes *n)
{
    nn_graph *g = n->g;
    nn_node *x = n->material[0];
    if (n->config->several)
        x = nn_add(g, nn_group_repeat(g, x),
                   nn_conv2d_zero(g, n->seen[0], "visibility.own", n->config->widths[0], 1, 1, NN_BIAS));
    return nn_sigmoid(g, block_head(g, x, "visibility.head", 1));
}

static void add_light(model_nodes *n)
{
    n->light = nn_input(n->g, "light", model_light_size(n->config), NN_VECTOR);
}

static void build_lights(model_nodes *n, model_part part)
{
    nn_graph *g = n->g;
    bool both = n->config->lighting == MODEL_LIGHT_BOTH, any = n->config->lighting == MODEL_LIGHT_ANY;
    bool by_network = n->config->relight == MODEL_RELIGHT_NETWORK;
    n->direct = model_render(n, nn_scale_shift(g, n->light_position, 0.0f, 0.0f)); /* the flash is at the origin */
    if (both) {
        n->environment_code = estimate_light(n, "environment.fc1", "environment.fc2", MODEL_SH);
        n->environment = render_environment(n, n->environment_code);
        n->direct = nn_add(g, n->direct, n->environment);
    }
    if (any) n->visibility = estimate_visibility(n);
    first_bounce first = {n->direct, n->environment};
    if (n->config->global_illumination) n->indirect = global_illumination(g, n->config, &first, &n->maps, n->mask);
    if (part == MODEL_MAPS) return;
    if (both || by_network) add_light(n);
    if (by_network) relight_by_network(n);
    if (part == MODEL_TRAINING && by_network) return;
    n->relit_brdf = model_render(n, n->light_position);
    if (both) n->relit_brdf = nn_add(g, n->relit_brdf, render_environment(n, nn_slice(g, n->light, 3, MODEL_SH)));
}

/* Adds the encoder, which sees every picture. */
static void encode(model_nodes *n)
{
    nn_graph *g = n->g;
    const model_config *c = n->config;
    nn_node *image = nn_input(g, "image", 3, 1);
    nn_node *parts[2] = {image, c->several ? nn_group_repeat(g, n->mask) : n->mask};
    nn_node *share = c->several ? nn_input(g, "share", 1, 1) : NULL, *pixel[2] = {image, share};
    if (c->several && !c->only_lights) n->pixels = nn_space_to_depth(g, nn_compute(g, nn_concat(g, pixel, 2)), 2);
    const block_encoder_shape shape = {c->widths, c->encoder_blocks, n->sight, share, c->several};
    block_encoder(g, nn_concat(g, parts, 2), "encoder", &shape, n->seen);
    for (int i = 0; i < MODEL_LEVELS && !c->only_lights; i++) {
        char name[32];
        snprintf(name, sizeof name, "encoder.level%d.fuse", i);
        n->encoder[i] = c->several ? block_fuse(g, n->seen[i], name, c->widths[i]) : n->seen[i];
    }
}

static void build_network(model_nodes *n, model_part part)
{
    n->mask = model_object_input(n, "mask", 1, 1);
    n->light_position = model_object_input(n, "light_position", 3, NN_VECTOR);
    if (n->config->lighting == MODEL_LIGHT_ANY) {
        n->sight = nn_input(n->g, "sight", MODEL_SIGHT, 1);
        n->lens = model_object_input(n, "lens", 3, NN_VECTOR);
    }
    encode(n);
    if (n->config->lighting == MODEL_LIGHT_ANY) n->lights = estimate_light(n, "lights.fc1", "lights.fc2", MODEL_LIGHTS);
    if (n->config->only_lights) return;
    if (n->config->material_decoders == 1)
        material_by_one_decoder(n);
    else
        material_by_four_decoders(n);
    build_lights(n, part);
}

static int feature_level(int feature)
{
    return feature % MODEL_LEVELS;
}

/* Returns where one of model_features is stored in the network. */
static nn_node **feature_node(model_nodes *n, int feature)
{
    return feature < MODEL_LEVELS ? &n->encoder[feature] : &n->material[feature_level(feature)];
}

size_t model_feature_values(const model_config *config, int feature, int size)
{
    int level = feature_level(feature);
    size_t side = (size_t)(size >> (level + 1));
    return side * side * (size_t)config->widths[level];
}

static int feature_count(const model_config *config)
{
    if (config->relight != MODEL_RELIGHT_NETWORK) return 0;
    return config->feature_sharing ? MODEL_FEATURES : MODEL_LEVELS;
}

static void name_features(model_nodes *n)
{
    for (int i = 0; i < feature_count(n->config); i++)
        nn_output(n->g, *feature_node(n, i), model_features[i]);
}

static void name_outputs(const model_nodes *n)
{
    nn_graph *g = n->g;
    if (n->config->only_lights) {
        nn_output(g, n->lights, "lights");
        return;
    }
    nn_output(g, n->maps.albedo, "albedo");
    nn_output(g, n->maps.normal, "normal");
    nn_output(g, n->maps.roughness, "roughness");
    nn_output(g, n->maps.depth, "depth");
    nn_output(g, n->direct, "direct");
    if (n->environment) nn_output(g, n->environment, "environment");
    if (n->environment) nn_output(g, n->environment_code, "environment_code");
    if (n->lights) nn_output(g, n->lights, "lights");
    if (n->visibility) nn_output(g, n->visibility, "visibility");
    if (n->indirect) nn_output(g, n->indirect, "indirect");
    if (n->relit_direct) nn_output(g, n->relit_direct, "relit_direct");
    if (n->relit_brdf) nn_output(g, n->relit_brdf, "relit_brdf");
}

static status build_indirect(nn_graph *g, const model_config *config)
{
    if (!config->global_illumination)
        return fail(MERLIN_WRONG_USE, "model \"%s\" has no global-illumination network", config->name);
    nn_node *direct = nn_input(g, "direct", 3, 1);
    model_maps m = {.albedo = nn_input(g, "albedo", 3, 1)};
    m.normal = nn_input(g, "normal", 3, 1);
    m.roughness = nn_input(g, "roughness", 1, 1);
    m.depth = nn_input(g, "depth", 1, 1);
    if (config->rival) {
        const model_nodes n = {
            .g = g, .config = config, .mask = nn_input(g, "mask", 1, 1), .maps = m, .direct = direct};
        nn_output(g, rival_bounces(&n), "indirect");
        return OK;
    }
    first_bounce first = {direct, config->lighting == MODEL_LIGHT_BOTH ? nn_input(g, "environment", 3, 1) : NULL};
    nn_output(g, global_illumination(g, config, &first, &m, nn_input(g, "mask", 1, 1)), "indirect");
    return OK;
}

static status build_relighting(nn_graph *g, const model_config *config)
{
    if (config->relight != MODEL_RELIGHT_NETWORK)
        return fail(MERLIN_WRONG_USE, "model \"%s\" has no relighting decoder", config->name);
    if (config->rival) return fail(MERLIN_WRONG_USE, "model \"%s\" relights with all of its stages", config->name);
    model_nodes n = {.g = g, .config = config, .mask = nn_input(g, "mask", 1, 1)};
    for (int i = 0; i < feature_count(config); i++) {
        int level = feature_level(i);
        *feature_node(&n, i) = nn_compute(g, nn_input(g, model_features[i], config->widths[level], 2 << level));
    }
    add_light(&n);
    relight_by_network(&n);
    nn_output(g, n.relit_direct, "relit_direct");
    return OK;
}

status model_build(const model_config *config, model_part part, nn_graph **out)
{
    *out = NULL;
    nn_graph *g = nn_graph_new();
    if (!g) return fail(MERLIN_NO_MEMORY, "out of memory while building model \"%s\"", config->name);
    status s = OK;
    if (config->nfps_width) {
        s = nfps_build(g, config, part);
    } else if (part == MODEL_INDIRECT) {
        s = build_indirect(g, config);
    } else if (part == MODEL_RELIGHT) {
        s = build_relighting(g, config);
    } else {
        model_nodes n = {.g = g, .config = config};
        if (config->rival)
            rival_build(&n, part);
        else
            build_network(&n, part);
        name_outputs(&n);
        if (part == MODEL_MAPS && !config->rival) name_features(&n);
        if (part != MODEL_WHOLE && part != MODEL_MAPS) model_add_losses(&n, part);
    }
    if (s != OK) {
        nn_graph_free(g);
        return s;
    }
    *out = g;
    return OK;
}
