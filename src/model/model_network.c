/* SPDX-License-Identifier: MIT */
#include "model/model_network.h"

#include <stdio.h>

#include "optics/camera.h"
#include "optics/light.h"

nn_node *model_object_input(const model_nodes *n, const char *name, int channels, int reduction)
{
    return n->config->several ? nn_group_input(n->g, name, channels, reduction)
                              : nn_input(n->g, name, channels, reduction);
}

nn_node *model_shape_depth(nn_graph *g, nn_node *x)
{
    return nn_reciprocal(g, x, 1.2f, 1.45f);
}

nn_node *model_render(const model_nodes *n, nn_node *light)
{
    nn_render_inputs in = {n->maps.albedo, n->maps.normal, n->maps.roughness, n->maps.depth, n->mask, light, n->lens};
    return nn_render(n->g, &in, CAMERA_FOV, LIGHT_POWER);
}

/* Adds the inputs that predictions are compared with, once. */
static const model_truth *truth_of(model_nodes *n)
{
    model_truth *t = &n->truth;
    if (t->mask) return t;
    t->mask = model_object_input(n, "loss_mask", 1, 1);
    t->albedo = model_object_input(n, "albedo_true", 3, 1);
    t->normal = model_object_input(n, "normal_true", 3, 1);
    t->roughness = model_object_input(n, "roughness_true", 1, 1);
    t->depth = model_object_input(n, "depth_true", 1, 1);
    t->relit = model_object_input(n, "relit_true", 3, 1);
    return t;
}

/* Adds the losses of relighting: by the network, and by the maps' BRDF where that has a loss of its own. */
static void add_relighting_losses(model_nodes *n, model_part part)
{
    nn_graph *g = n->g;
    const model_truth *t = truth_of(n);
    bool both = n->relit_direct && n->relit_brdf;
    nn_node *relit = n->relit_direct ? n->relit_direct : n->relit_brdf;
    nn_masked_l2(g, relit, t->relit, t->mask, "relight", 1.0f);
    if (both) nn_masked_l2(g, n->relit_brdf, t->relit, t->mask, "relight_brdf", 1.0f);
    if (part != MODEL_TRAINING_SSIM) return;
    nn_masked_dssim(g, relit, t->relit, t->mask, "relight_ssim", 1.0f);
    if (both) nn_masked_dssim(g, n->relit_brdf, t->relit, t->mask, "relight_brdf_ssim", 1.0f);
}

/* Adds the losses of the predicted light and of the visibility of the strongest lamp. A vector's weight depends on how
 * much there is to predict. */
static void add_light_losses(model_nodes *n)
{
    nn_graph *g = n->g;
    nn_node *truth = nn_input(g, "lights_true", MODEL_LIGHTS, NN_VECTOR);
    nn_node *one = nn_scale_shift(g, nn_slice(g, truth, 0, 1), 0.0f, 1.0f);
    nn_node *lamp_weight = nn_input(g, "lamp_weight", 1, NN_VECTOR),
            *rest_weight = nn_input(g, "rest_weight", 1, NN_VECTOR);
    const struct {
        const char *name;
        int first, count;
        nn_node *weight;
    } parts[] = {{"flash", MODEL_LIGHTS_FLASH, 1, one},
                 {"lamp", MODEL_LIGHTS_LAMP, 3, one},
                 {"lamp_distance", MODEL_LIGHTS_DISTANCE, 1, lamp_weight},
                 {"lamp_light", MODEL_LIGHTS_STRENGTH, 3, one},
                 {"environment", MODEL_LIGHTS_REST, MODEL_SH, rest_weight}};
    for (size_t i = 0; i < sizeof parts / sizeof *parts; i++)
        nn_masked_l2(g, nn_slice(g, n->lights, parts[i].first, parts[i].count),
                     nn_slice(g, truth, parts[i].first, parts[i].count), parts[i].weight, parts[i].name, 0.25f);
    if (!n->visibility) return;
    nn_masked_l2(g, n->visibility, nn_input(g, "visibility_true", 1, 1), nn_input(g, "visibility_weight", 1, 1),
                 "visibility", 1.0f);
}

void model_add_stage_losses(model_nodes *n, int stage)
{
    const model_truth *t = truth_of(n);
    const struct {
        const char *name;
        nn_node *value, *truth;
        float weight;
    } losses[] = {{"albedo", n->maps.albedo, t->albedo, 1},
                  {"normal", n->maps.normal, t->normal, 2},
                  {"depth", n->maps.depth, t->depth, 1},
                  {"roughness", n->maps.roughness, t->roughness, 1},
                  {"relight", n->relit_direct, t->relit, 1}};
    for (size_t i = 0; i < sizeof losses / sizeof *losses; i++) {
        char name[32];
        snprintf(name, sizeof name, "stage%d.%s", stage, losses[i].name);
        if (losses[i].value) nn_masked_l2(n->g, losses[i].value, losses[i].truth, t->mask, name, losses[i].weight);
    }
}

void model_add_losses(model_nodes *n, model_part part)
{
    nn_graph *g = n->g;
    if (n->config->only_lights) {
        add_light_losses(n);
        return;
    }
    const model_truth *t = truth_of(n);
    nn_masked_l2(g, n->maps.albedo, t->albedo, t->mask, "albedo", 1.0f);
    nn_masked_l2(g, n->maps.normal, t->normal, t->mask, "normal", 2.0f);
    nn_masked_l2(g, n->maps.depth, t->depth, t->mask, "depth", 1.0f);
    nn_masked_l2(g, n->maps.roughness, t->roughness, t->mask, "roughness", 1.0f);
    nn_masked_gradient_l2(g, n->maps.roughness, t->roughness, t->mask, "roughness_gradient", 1.0f);
    nn_masked_l2(g, n->direct, model_object_input(n, "direct_true", 3, 1), t->mask, "direct", 1.0f);
    if (n->indirect) {
        nn_masked_l2(g, n->indirect, model_object_input(n, "indirect_true", 3, 1), t->mask, "indirect", 1.0f);
        nn_node *image = nn_add(g, n->direct, n->indirect), *truth = model_object_input(n, "reconstruction_true", 3, 1);
        nn_masked_l2(g, image, truth, t->mask, "reconstruction", 1.0f);
    }
    if (n->environment) {
        nn_node *one = nn_scale_shift(g, nn_slice(g, n->light_position, 0, 1), 0.0f, 1.0f);
        nn_node *code = nn_input(g, "environment_true", MODEL_SH, NN_VECTOR);
        nn_masked_l2(g, n->environment_code, code, one, "environment", 1.0f);
    }
    if (n->lights) add_light_losses(n);
    add_relighting_losses(n, part);
}
