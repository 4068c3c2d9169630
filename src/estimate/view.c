#include "estimate/view.h"

#include <string.h>

#include "optics/orientation.h"

const char *const view_outputs[] = {"albedo", "normal", "roughness", "depth", "environment_code", NULL};

status view_mean_new(int size, network_estimation *mean)
{
    *mean = (network_estimation){0};
    return surface_new(size, size, &mean->maps);
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

void view_put(nn_program *p, size_t slot, int view, const img *photo, const img *mask)
{
    size_t pixels = pixel_count(photo);
    float *image = nn_input_data(p, "image") + 3 * slot * pixels;
    turn_into(photo, view, image);
    model_encode_image(image, image, 3 * pixels);
    turn_into(mask, view, nn_input_data(p, "mask") + slot * pixels);
}

void view_put_light(nn_program *p, const model_config *config, size_t slot, int view, const illumination *light)
{
    float place[3] = {light->place.x, light->place.y, light->place.z}, sh[9][3] = {0};
    orientation_turn(view, place);
    memcpy(nn_input_data(p, "light_position") + 3 * slot, place, sizeof place);
    float *code = nn_input_data(p, "light");
    if (!code) return;
    code += slot * (size_t)model_light_size(config);
    memcpy(code, place, sizeof place);
    if (config->lighting != MODEL_LIGHT_BOTH) return;
    if (light->sh) memcpy(sh, light->sh, sizeof sh);
    orientation_turn_sh(view, sh);
    model_encode_sh((const float(*)[3])sh, code + 3);
}

void view_add(img *mean, const img *turned, int view, float weight)
{
    size_t channels = (size_t)mean->channels;
    for (size_t i = 0, n = pixel_count(mean); i < n; i++) {
        const float *from = turned->data + channels * orientation_place(view, mean->width, i);
        for (size_t c = 0; c < channels; c++)
            mean->data[channels * i + c] += weight * from[c];
    }
}

void view_add_normals(img *mean, const img *turned, int view, float weight)
{
    for (size_t i = 0, n = pixel_count(mean); i < n; i++) {
        float normal[3];
        memcpy(normal, turned->data + 3 * orientation_place(view, mean->width, i), sizeof normal);
        orientation_turn(orientation_inverse(view), normal);
        for (size_t c = 0; c < 3; c++)
            mean->data[3 * i + c] += weight * normal[c];
    }
}

void view_mean_add(network_estimation *mean, const network_estimation *turned, int view, float weight)
{
    float sh[9][3];
    memcpy(sh, turned->environment, sizeof sh);
    orientation_turn_sh(orientation_inverse(view), sh);
    for (int i = 0; i < 27; i++)
        mean->environment[i / 3][i % 3] += weight * sh[i / 3][i % 3];
    view_add(&mean->maps.albedo, &turned->maps.albedo, view, weight);
    view_add_normals(&mean->maps.normal, &turned->maps.normal, view, weight);
    view_add(&mean->maps.roughness, &turned->maps.roughness, view, weight);
    view_add(&mean->maps.depth, &turned->maps.depth, view, weight);
}
