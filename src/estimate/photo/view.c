/* SPDX-License-Identifier: MIT */
#include "estimate/photo/view.h"

#include <stdlib.h>
#include <string.h>

#include "base/parallel.h"
#include "optics/orientation.h"

const char *const view_outputs[] = {"albedo",           "normal", "roughness",  "depth",
                                    "environment_code", "lights", "visibility", NULL};

status view_mean_new(const model_config *config, int size, network_estimation *mean)
{
    *mean = (network_estimation){0};
    status s = surface_new(size, size, &mean->maps);
    return s == OK && config->lighting == MODEL_LIGHT_ANY ? img_new(&mean->visibility, size, size, 1) : s;
}

static size_t pixel_count(const img *image)
{
    return (size_t)image->width * (size_t)image->height;
}

static void turn_into(const img *image, int view, float *turned)
{
    size_t channels = (size_t)image->channels;
    for (size_t i = 0, n = pixel_count(image); i < n; i++)
        memcpy(turned + channels * orientation_place(view, image->width, i), image->data + channels * i,
               channels * sizeof(float));
}

void view_put_photo(nn_program *p, size_t slot, int view, const img *photo)
{
    size_t pixels = pixel_count(photo);
    float *image = nn_input_data(p, "image") + 3 * slot * pixels;
    turn_into(photo, view, image);
    model_encode_image(image, image, 3 * pixels);
}

void view_put(nn_program *p, size_t slot, int view, const img *photo, const img *mask)
{
    view_put_photo(p, slot, view, photo);
    view_put_mask(p, slot, view, mask);
}

void view_put_mask(nn_program *p, size_t slot, int view, const img *mask)
{
    turn_into(mask, view, nn_input_data(p, "mask") + slot * pixel_count(mask));
}

void view_put_light(nn_program *p, const model_config *config, size_t slot, int view, const illumination *light)
{
    float place[3] = {light->place.x, light->place.y, light->place.z}, sh[9][3] = {0};
    orientation_turn(view, place);
    float *position = nn_input_data(p, "light_position"), *code = nn_input_data(p, "light");
    if (position) memcpy(position + 3 * slot, place, sizeof place);
    if (!code) return;
    code += slot * (size_t)model_light_size(config);
    memcpy(code, place, sizeof place);
    if (config->lighting != MODEL_LIGHT_BOTH) return;
    if (light->sh) memcpy(sh, light->sh, sizeof sh);
    orientation_turn_sh(view, sh);
    model_encode_sh((const float(*)[3])sh, code + 3);
}

/* Returns the lens of the rotated photograph. */
static camera_lens lens_in(const sight *how, int view)
{
    camera_lens lens = how && how->lens.fov > 0 ? how->lens : (camera_lens){.fov = CAMERA_FOV};
    float slant[3] = {lens.slant.right, lens.slant.up, 0};
    orientation_turn(view, slant);
    lens.slant = (camera_slant){slant[0], slant[1]};
    return lens;
}

void view_put_known(nn_program *p, size_t slot, int view, const sight *how, int size)
{
    const camera seen = camera_through(lens_in(how, view), size, size);
    const bool known = how && how->lens.fov > 0;
    float *told = nn_input_data(p, "sight") + slot * MODEL_SIGHT * (size_t)size * (size_t)size;
    model_sight(known ? &seen : NULL, how && how->flash, size, told);
}

void view_put_lens(nn_program *p, size_t slot, int view, const sight *how)
{
    const camera_lens lens = lens_in(how, view);
    float *values = nn_input_data(p, "lens") + 3 * slot;
    values[0] = camera_tangent(lens.fov);
    values[1] = lens.slant.right;
    values[2] = lens.slant.up;
}

void view_put_sight(nn_program *p, size_t slot, int view, const sight *how, int size)
{
    view_put_known(p, slot, view, how, size);
    view_put_lens(p, slot, view, how);
}

void view_put_shares(nn_program *p, int pictures, int size)
{
    float *shares = nn_input_data(p, "share");
    if (shares) model_encode_shares(nn_input_data(p, "image"), pictures, (size_t)size * (size_t)size, shares);
}

status view_features_take(nn_program *maps, const model_config *config, int size, view_features *out)
{
    size_t total = 0;
    view_features_free(out);
    for (int i = 0; i < MODEL_FEATURES; i++) {
        out->counts[i] = nn_output_data(maps, model_features[i]) ? model_feature_values(config, i, size) : 0;
        total += out->counts[i];
    }
    float *to = out->values = malloc(total * sizeof *to);
    if (!to) return fail(MERLIN_NO_MEMORY, "no memory for what the network sees");
    for (int i = 0; i < MODEL_FEATURES; to += out->counts[i++])
        if (out->counts[i]) memcpy(to, nn_output_data(maps, model_features[i]), out->counts[i] * sizeof *to);
    return OK;
}

void view_features_put(const view_features *f, nn_program *relight, size_t slot)
{
    const float *from = f->values;
    for (int i = 0; i < MODEL_FEATURES; from += f->counts[i++])
        if (f->counts[i])
            memcpy(nn_input_data(relight, model_features[i]) + slot * f->counts[i], from, f->counts[i] * sizeof *from);
}

void view_features_free(view_features *f)
{
    free(f->values);
    *f = (view_features){0};
}

/* A picture that is rotated back while it is added. */
typedef struct addition {
    img *mean;
    const img *turned;
    int view;
    float weight;
} addition;

static void add_values(void *context, size_t begin, size_t end)
{
    const addition *a = context;
    size_t channels = (size_t)a->mean->channels;
    for (size_t i = begin; i < end; i++) {
        const float *from = a->turned->data + channels * orientation_place(a->view, a->mean->width, i);
        float *to = a->mean->data + channels * i;
        for (size_t c = 0; c < channels; c++)
            to[c] += a->weight * from[c];
    }
}

static void add_normals(void *context, size_t begin, size_t end)
{
    const addition *a = context;
    int back = orientation_inverse(a->view);
    for (size_t i = begin; i < end; i++) {
        float normal[3], *to = a->mean->data + 3 * i;
        memcpy(normal, a->turned->data + 3 * orientation_place(a->view, a->mean->width, i), sizeof normal);
        orientation_turn(back, normal);
        for (size_t c = 0; c < 3; c++)
            to[c] += a->weight * normal[c];
    }
}

void view_add(img *mean, const img *turned, int view, float weight)
{
    parallel_blocks(pixel_count(mean), add_values, &(addition){mean, turned, view, weight});
}

void view_add_normals(img *mean, const img *turned, int view, float weight)
{
    parallel_blocks(pixel_count(mean), add_normals, &(addition){mean, turned, view, weight});
}

void view_add_lights(float mean[MODEL_LIGHTS], const float turned[MODEL_LIGHTS], int view, float weight)
{
    float lights[MODEL_LIGHTS], sh[9][3];
    memcpy(lights, turned, sizeof lights);
    orientation_turn(orientation_inverse(view), lights + MODEL_LIGHTS_LAMP);
    model_decode_sh(lights + MODEL_LIGHTS_REST, sh);
    orientation_turn_sh(orientation_inverse(view), sh);
    model_encode_sh((const float(*)[3])sh, lights + MODEL_LIGHTS_REST);
    for (int i = 0; i < MODEL_LIGHTS; i++)
        mean[i] += weight * lights[i];
}

void view_mean_add(network_estimation *mean, const network_estimation *turned, int view, float weight)
{
    float sh[9][3];
    memcpy(sh, turned->environment, sizeof sh);
    orientation_turn_sh(orientation_inverse(view), sh);
    for (int i = 0; i < 27; i++)
        mean->environment[i / 3][i % 3] += weight * sh[i / 3][i % 3];
    if (mean->visibility.data) {
        view_add_lights(mean->lights, turned->lights, view, weight);
        view_add(&mean->visibility, &turned->visibility, view, weight);
    }
    view_add(&mean->maps.albedo, &turned->maps.albedo, view, weight);
    view_add_normals(&mean->maps.normal, &turned->maps.normal, view, weight);
    view_add(&mean->maps.roughness, &turned->maps.roughness, view, weight);
    view_add(&mean->maps.depth, &turned->maps.depth, view, weight);
}
