/* SPDX-License-Identifier: MIT */
#include <string.h>

#include "estimate/light/bounce.h"
#include "estimate/light/shadow.h"
#include "estimate/photo/view.h"
#include "estimate/surface/smooth.h"
#include "lab/eval/predict.h"
#include "lab/eval/predict_parts.h"

static float clip(float x)
{
    return x > 0 ? (x < 1 ? x : 1) : 0;
}

/* Clipped. */
static void add(const img *direct, const img *bounces, img *out)
{
    for (size_t i = 0, n = (size_t)out->width * (size_t)out->height * 3; i < n; i++)
        out->data[i] = clip(direct->data[i] + bounces->data[i]);
}

static void put(nn_program *p, const char *name, size_t slot, const img *from)
{
    float *to = nn_input_data(p, name);
    size_t values = img_value_count(from);
    if (to) memcpy(to + slot * values, from->data, values * sizeof *to);
}

void eval_put_bounce(nn_program *p, size_t slot, const eval_maps *maps, const img *mask, const img *direct,
                     const img *ambient)
{
    put(p, "albedo", slot, &maps->albedo);
    put(p, "normal", slot, &maps->normal);
    put(p, "roughness", slot, &maps->roughness);
    put(p, "depth", slot, &maps->depth);
    put(p, "mask", slot, mask);
    put(p, "direct", slot, direct);
    float *environment = nn_input_data(p, "environment");
    size_t values = img_value_count(direct);
    if (ambient)
        put(p, "environment", slot, ambient);
    else if (environment)
        memset(environment + slot * values, 0, values * sizeof *environment);
}

/* The network's bounces for four pictures of bounce 1; dark for a variant without. */
static status find_bounces(eval_model *m, const eval_maps *maps, const img *mask, const img direct[EVAL_LIGHTS])
{
    nn_program *p = m->indirect.program;
    for (size_t i = 0; p && i < EVAL_LIGHTS; i++)
        eval_put_bounce(p, i, maps, mask, &direct[i], NULL);
    return p ? nn_forward(p) : OK;
}

/* full = direct + bounces, as merlin relight adds them. */
static status add_bounces(eval_model *m, const eval_prediction *p, const img *mask, const img direct[EVAL_LIGHTS],
                          img full[EVAL_LIGHTS])
{
    img bounces = {0};
    status s = find_bounces(m, &p->maps, mask, direct);
    if (s == OK) s = img_new(&bounces, m->size, m->size, 3);
    for (size_t i = 0; i < EVAL_LIGHTS && s == OK; i++) {
        if (m->indirect.program) eval_take(m->indirect.program, "indirect", i, &bounces);
        s = bounce_follow(&p->flash, &direct[i], NULL, &bounces);
        if (s == OK) add(&direct[i], &bounces, &full[i]);
    }
    img_free(&bounces);
    return s;
}

/* By the network, in one orientation; added to what the others say. */
static status relight_view(eval_model *m, const img *mask, const illumination lights[EVAL_LIGHTS], int view,
                           eval_prediction *out)
{
    nn_program *p = m->relit.program;
    img relit = {0};
    for (size_t i = 0; i < EVAL_LIGHTS; i++) {
        view_features_put(&out->seen[view], p, i);
        view_put_mask(p, i, view, mask);
        view_put_light(p, &m->config, i, view, &lights[i]);
    }
    status s = nn_forward(p);
    if (s == OK) s = img_new(&relit, m->size, m->size, 3);
    for (size_t i = 0; i < EVAL_LIGHTS && s == OK; i++) {
        eval_take(p, "relit_direct", i, &relit);
        view_add(&out->by_network[i], &relit, view, 1 / (float)m->views);
    }
    img_free(&relit);
    return s;
}

static void clear(img *image)
{
    memset(image->data, 0, img_value_count(image) * sizeof *image->data);
}

static status relight(eval_model *m, const img *mask, const illumination lights[EVAL_LIGHTS], eval_prediction *out)
{
    status s = OK;
    for (int i = 0; i < EVAL_LIGHTS; i++)
        clear(&out->by_network[i]);
    for (int view = 0; view < m->views && s == OK; view++)
        s = relight_view(m, mask, lights, view, out);
    return s;
}

status eval_relight(eval_model *m, const img *mask, const illumination lights[EVAL_LIGHTS], eval_prediction *out)
{
    status s = m->relit.program ? relight(m, mask, lights, out) : OK;
    for (int i = 0; i < EVAL_LIGHTS && s == OK; i++)
        s = eval_show(&out->maps, mask, &lights[i], &out->by_brdf[i]);
    if (s == OK) s = add_bounces(m, out, mask, out->by_brdf, out->full_by_brdf);
    if (s == OK && eval_model_relights(m)) s = add_bounces(m, out, mask, out->by_network, out->full_by_network);
    return s;
}

/* From shape as estimate gives it. */
static status caster_of(const eval_maps *maps, const img *mask, float fov, shadow_caster *out)
{
    img depth = {0}, normal = {0};
    status s = img_copy(&depth, &maps->depth);
    if (s == OK) s = img_copy(&normal, &maps->normal);
    if (s == OK) s = smooth_inside(&depth, mask);
    if (s == OK) s = smooth_inside(&normal, mask);
    if (s == OK) s = shadow_caster_new(&depth, &normal, mask, (camera_lens){.fov = fov}, out);
    img_free(&depth);
    img_free(&normal);
    return s;
}

static status cast_shadow(const shadow_caster *caster, vec3 light, img *image)
{
    img seen = {0};
    status s = shadow_cast(caster, light, image->width, image->height, &seen);
    if (s == OK) shadow_darken(&seen, image);
    img_free(&seen);
    return s;
}

status eval_relight_shadows(eval_model *m, const img *mask, float fov, const illumination lights[EVAL_LIGHTS],
                            eval_prediction *p)
{
    shadow_caster caster;
    status s = caster_of(&p->maps, mask, fov, &caster);
    if (s != OK) return s;
    for (int i = 0; i < EVAL_LIGHTS && s == OK; i++) {
        memcpy(p->shadowed[i].data, p->by_brdf[i].data, 3 * (size_t)m->size * (size_t)m->size * sizeof(float));
        s = cast_shadow(&caster, lights[i].place, &p->shadowed[i]);
    }
    shadow_caster_free(&caster);
    return s == OK ? add_bounces(m, p, mask, p->shadowed, p->shadowed) : s;
}
