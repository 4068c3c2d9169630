/* SPDX-License-Identifier: MIT */
#include <string.h>

#include "estimate/photo/network.h"
#include "estimate/photo/view.h"
#include "lab/eval/predict.h"
#include "lab/eval/predict_parts.h"

static status take(const eval_model *m, const char *name, int channels, img *out)
{
    status s = img_new(out, m->size, m->size, channels);
    if (s == OK) eval_take(m->maps.program, name, 0, out);
    return s;
}

/* What the network says of the picture in this orientation, as it lies there. */
static status look(eval_model *m, const img *image, const img *mask, int view, view_features *seen,
                   network_estimation *out)
{
    view_put(m->maps.program, 0, view, image, mask);
    view_put_light(m->maps.program, &m->config, 0, view, &(illumination){{0, 0, 0}, NULL});
    status s = nn_forward(m->maps.program);
    if (s == OK) s = take(m, "albedo", 3, &out->maps.albedo);
    if (s == OK) s = take(m, "normal", 3, &out->maps.normal);
    if (s == OK) s = take(m, "roughness", 1, &out->maps.roughness);
    if (s == OK) s = take(m, "depth", 1, &out->maps.depth);
    if (s == OK && m->relit.program) s = view_features_take(m->maps.program, &m->config, m->size, seen);
    const float *code = nn_output_data(m->maps.program, "environment_code");
    if (code) model_decode_sh(code, out->environment);
    return s;
}

static status mean_of_views(eval_model *m, const img *image, const img *mask, view_features *seen,
                            network_estimation *mean)
{
    status s = view_mean_new(&m->config, m->size, mean);
    for (int view = 0; view < m->views && s == OK; view++) {
        network_estimation turned = {0};
        s = look(m, image, mask, view, &seen[view], &turned);
        if (s == OK) view_mean_add(mean, &turned, view, 1 / (float)m->views);
        network_estimation_free(&turned);
    }
    if (s == OK && m->views > 1) eval_make_unit(&mean->maps.normal);
    return s;
}

static void move(img *from, img *to)
{
    img_free(to);
    *to = *from;
    *from = (img){0};
}

static void keep(network_estimation *mean, eval_prediction *out)
{
    move(&mean->maps.albedo, &out->maps.albedo);
    move(&mean->maps.normal, &out->maps.normal);
    move(&mean->maps.roughness, &out->maps.roughness);
    move(&mean->maps.depth, &out->maps.depth);
    memcpy(out->sh, mean->environment, sizeof out->sh);
}

/* By the network's rendering layer; what the surroundings light is taken out of the flash's light afterwards. */
static status show_by_network(const eval_model *m, const img *mask, eval_prediction *out)
{
    const float *lit = nn_output_data(m->maps.program, "environment");
    eval_take(m->maps.program, "direct", 0, &out->flash);
    eval_take(m->maps.program, "indirect", 0, &out->indirect);
    img_free(&out->reconstruction);
    status s = eval_picture(&out->flash, &out->indirect, mask, &out->reconstruction);
    for (size_t i = 0, n = 3 * (size_t)m->size * (size_t)m->size; lit && i < n; i++)
        out->flash.data[i] -= lit[i];
    return s;
}

/* Given all that lights the maps, and the surroundings' share of it. */
static status bounces_of_mean(eval_model *m, const img *mask, const img *lit, const img *ambient, eval_prediction *out)
{
    nn_program *p = m->mean_indirect.program;
    if (!p) return OK;
    eval_put_bounce(p, 0, &out->maps, mask, lit, ambient);
    status s = nn_forward(p);
    if (s == OK) eval_take(p, "indirect", 0, &out->indirect);
    return s;
}

/* Means of several views are rendered over again, and so are bounces: what the network adds makes up for the false
 * highlights of the view's own maps (estimate/photo/estimate.c). */
static status show_by_rendering(eval_model *m, const img *mask, eval_prediction *out)
{
    const illumination flash = {{0, 0, 0}, NULL}, both = {{0, 0, 0}, (const float(*)[3])out->sh};
    img lit = {0}, ambient = {0};
    status s = eval_show(&out->maps, mask, &flash, &out->flash);
    if (s == OK) s = eval_show(&out->maps, mask, &both, &lit);
    if (s == OK) s = img_copy(&ambient, &lit);
    for (size_t i = 0, n = 3 * (size_t)m->size * (size_t)m->size; s == OK && i < n; i++)
        ambient.data[i] -= out->flash.data[i];
    if (s == OK) s = bounces_of_mean(m, mask, &lit, &ambient, out);
    img_free(&out->reconstruction);
    if (s == OK) s = eval_picture(&lit, &out->indirect, mask, &out->reconstruction);
    img_free(&lit);
    img_free(&ambient);
    return s;
}

status eval_estimate(eval_model *m, const img *image, const img *mask, eval_prediction *out)
{
    if (image->width != m->size || image->height != m->size)
        return fail(MERLIN_BAD_INPUT, "a picture of %dx%d does not fit a model prepared for %dx%d", image->width,
                    image->height, m->size, m->size);
    network_estimation mean = {0};
    status s = mean_of_views(m, image, mask, out->seen, &mean);
    if (s == OK) keep(&mean, out);
    network_estimation_free(&mean);
    if (s == OK) s = m->views == 1 ? show_by_network(m, mask, out) : show_by_rendering(m, mask, out);
    return s;
}
