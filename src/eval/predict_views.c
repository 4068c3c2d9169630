#include <string.h>

#include "estimate/view.h"
#include "eval/predict_parts.h"
#include "optics/orientation.h"

static void clear(img *image)
{
    memset(image->data, 0, sizeof(float) * (size_t)image->channels * (size_t)image->width * (size_t)image->height);
}

/* The picture's view into slot i of the program. */
static status put_view(eval_model *m, const img *image, const img *mask, int view, size_t i)
{
    size_t pixels = (size_t)m->size * (size_t)m->size;
    img turned = {0}, turned_mask = {0};
    status s = view_turn(image, view, &turned);
    if (s == OK) s = view_turn(mask, view, &turned_mask);
    if (s == OK) {
        model_encode_image(turned.data, nn_input_data(m->program, "image") + 3 * i * pixels, 3 * pixels);
        memcpy(nn_input_data(m->program, "mask") + i * pixels, turned_mask.data, pixels * sizeof(float));
    }
    img_free(&turned);
    img_free(&turned_mask);
    return s;
}

/* Slot i's outputs are turned back and added. */
static void add_view(const eval_model *m, int view, size_t i, eval_maps *spare, img *spare_indirect,
                     eval_prediction *out)
{
    float weight = 1 / (float)m->views, sh[9][3];
    const float *code = nn_output_data(m->program, "environment_code");
    eval_take(m->program, "albedo", i, &spare->albedo);
    eval_take(m->program, "normal", i, &spare->normal);
    eval_take(m->program, "roughness", i, &spare->roughness);
    eval_take(m->program, "depth", i, &spare->depth);
    eval_take(m->program, "indirect", i, spare_indirect);
    view_add(&out->maps.albedo, &spare->albedo, view, weight);
    view_add_normals(&out->maps.normal, &spare->normal, view, weight);
    view_add(&out->maps.roughness, &spare->roughness, view, weight);
    view_add(&out->maps.depth, &spare->depth, view, weight);
    view_add(&out->indirect, spare_indirect, view, weight);
    if (!code) return;
    model_decode_sh(code + i * MODEL_SH, sh);
    orientation_turn_sh(orientation_inverse(view), sh);
    for (int k = 0; k < 27; k++)
        out->sh[k / 3][k % 3] += weight * sh[k / 3][k % 3];
}

static void clear_maps(eval_prediction *out)
{
    clear(&out->maps.albedo);
    clear(&out->maps.normal);
    clear(&out->maps.roughness);
    clear(&out->maps.depth);
    clear(&out->indirect);
    memset(out->sh, 0, sizeof out->sh);
}

static status mean_of_views(eval_model *m, const img *image, const img *mask, eval_prediction *out)
{
    eval_maps spare;
    img spare_indirect = {0};
    status s = eval_maps_new(&spare, m->size, m->size);
    if (s == OK) s = img_new(&spare_indirect, m->size, m->size, 3);
    if (s == OK) clear_maps(out);
    for (int first = 0; s == OK && first < m->views; first += EVAL_LIGHTS) {
        for (int i = 0; s == OK && i < EVAL_LIGHTS && first + i < m->views; i++)
            s = put_view(m, image, mask, first + i, (size_t)i);
        if (s == OK) s = nn_forward(m->program);
        for (int i = 0; s == OK && i < EVAL_LIGHTS && first + i < m->views; i++)
            add_view(m, first + i, (size_t)i, &spare, &spare_indirect, out);
    }
    eval_make_unit(&out->maps.normal);
    eval_maps_free(&spare);
    img_free(&spare_indirect);
    return s;
}

static status render(const eval_prediction *p, const img *mask, const eval_lighting *lighting, img *out)
{
    img_free(out);
    return eval_render(&p->maps, mask, MODEL_FOV, MODEL_LIGHT_POWER, lighting, out);
}

status eval_predict_views(eval_model *m, const img *image, const img *mask, const eval_lighting lights[EVAL_LIGHTS],
                          eval_prediction *out)
{
    const eval_lighting flash = {{0, 0, 0}, NULL}, both = {{0, 0, 0}, (const float(*)[3])out->sh};
    img lit = {0};
    status s = mean_of_views(m, image, mask, out);
    if (s == OK) s = render(out, mask, &flash, &out->flash);
    if (s == OK) s = render(out, mask, &both, &lit);
    img_free(&out->reconstruction);
    if (s == OK) s = eval_picture(&lit, &out->indirect, mask, &out->reconstruction);
    img_free(&lit);
    for (int i = 0; i < EVAL_LIGHTS && s == OK; i++)
        s = render(out, mask, &lights[i], &out->by_brdf[i]);
    return s;
}
