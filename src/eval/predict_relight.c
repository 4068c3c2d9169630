#include <string.h>

#include "estimate/bounce.h"
#include "estimate/shadow.h"
#include "estimate/smooth.h"
#include "estimate/view.h"
#include "eval/predict_parts.h"

/* The target's lighting code: the light's place and, in setting B, its surroundings. */
static void fill_code(const eval_model *m, const float light[3], const float (*sh)[3], float *code)
{
    static const float dark[9][3];
    memcpy(code, light, 3 * sizeof *light);
    if (m->config.lighting == MODEL_LIGHT_BOTH) model_encode_sh(sh ? sh : dark, code + 3);
}

static void fill_inputs(eval_model *m, const img *image, const img *mask, const eval_lighting *lights)
{
    nn_program *p = m->relit.program;
    float *code = nn_input_data(p, "light"), *position = nn_input_data(p, "light_position");
    size_t code_size = (size_t)model_light_size(&m->config);
    for (size_t i = 0; i < EVAL_LIGHTS; i++) {
        const float light[3] = {lights[i].light.x, lights[i].light.y, lights[i].light.z};
        eval_put_picture(p, image, mask, i);
        if (position) memcpy(position + 3 * i, light, sizeof light);
        if (code) fill_code(m, light, lights[i].sh, code + i * code_size);
    }
}

static float clip(float x)
{
    return x > 0 ? (x < 1 ? x : 1) : 0;
}

static void clip_image(img *image)
{
    for (size_t i = 0, n = (size_t)image->width * (size_t)image->height * 3; i < n; i++)
        image->data[i] = clip(image->data[i]);
}

/* Clipped. */
static void add(const img *direct, const img *bounces, img *out)
{
    for (size_t i = 0, n = (size_t)out->width * (size_t)out->height * 3; i < n; i++)
        out->data[i] = clip(direct->data[i] + bounces->data[i]);
}

static void put_indirect(eval_model *m, const char *name, size_t slot, const img *from)
{
    float *to = nn_input_data(m->indirect.program, name);
    size_t values = (size_t)m->size * (size_t)m->size * (size_t)from->channels;
    if (to) memcpy(to + slot * values, from->data, values * sizeof *to);
}

status eval_run_indirect(eval_model *m, const eval_maps *maps, const img *mask, const img direct[EVAL_LIGHTS],
                         const img *ambient, const float **indirect)
{
    *indirect = NULL;
    if (!m->indirect.program) return OK;
    float *environment = nn_input_data(m->indirect.program, "environment");
    if (environment) memset(environment, 0, EVAL_LIGHTS * 3 * (size_t)m->size * (size_t)m->size * sizeof *environment);
    for (size_t i = 0; i < EVAL_LIGHTS; i++) {
        put_indirect(m, "albedo", i, &maps->albedo);
        put_indirect(m, "normal", i, &maps->normal);
        put_indirect(m, "roughness", i, &maps->roughness);
        put_indirect(m, "depth", i, &maps->depth);
        put_indirect(m, "mask", i, mask);
        put_indirect(m, "direct", i, &direct[i]);
        if (ambient) put_indirect(m, "environment", i, ambient);
    }
    status s = nn_forward(m->indirect.program);
    if (s == OK) *indirect = nn_output_data(m->indirect.program, "indirect");
    return s;
}

/* full = direct + bounces, as merlin relight adds them. */
static status add_bounces(eval_model *m, const eval_prediction *p, const img *mask, const img direct[EVAL_LIGHTS],
                          img full[EVAL_LIGHTS])
{
    const float *indirect;
    size_t values = 3 * (size_t)m->size * (size_t)m->size;
    img bounces = {0};
    status s = eval_run_indirect(m, &p->maps, mask, direct, NULL, &indirect);
    if (s == OK) s = img_new(&bounces, m->size, m->size, 3);
    for (size_t i = 0; i < EVAL_LIGHTS && s == OK; i++) {
        if (indirect) memcpy(bounces.data, indirect + i * values, values * sizeof *indirect);
        s = bounce_follow(&p->flash, &direct[i], NULL, &bounces);
        if (s == OK) add(&direct[i], &bounces, &full[i]);
    }
    img_free(&bounces);
    return s;
}

/* By the network, in one orientation; added to what the others say. */
static status relight_view(eval_model *m, const img *image, const img *mask, const eval_lighting lights[EVAL_LIGHTS],
                           int view, eval_prediction *out)
{
    float sh[EVAL_LIGHTS][9][3];
    eval_lighting turned[EVAL_LIGHTS];
    img turned_image = {0}, turned_mask = {0}, relit = {0};
    for (int i = 0; i < EVAL_LIGHTS; i++) {
        network_light light = view_turn_light(&(network_light){lights[i].light, lights[i].sh}, view, sh[i]);
        turned[i] = (eval_lighting){light.place, light.sh};
    }
    status s = view_turn(image, view, &turned_image);
    if (s == OK) s = view_turn(mask, view, &turned_mask);
    if (s == OK) s = img_new(&relit, m->size, m->size, 3);
    if (s == OK) {
        fill_inputs(m, &turned_image, &turned_mask, turned);
        s = nn_forward(m->relit.program);
    }
    for (size_t i = 0; i < EVAL_LIGHTS && s == OK; i++) {
        eval_take(m->relit.program, "relit_direct", i, &relit);
        view_add(&out->by_network[i], &relit, view, 1 / (float)m->views);
    }
    img_free(&turned_image);
    img_free(&turned_mask);
    img_free(&relit);
    return s;
}

static void clear(img *image)
{
    memset(image->data, 0, img_value_count(image) * sizeof *image->data);
}

/* By the network, and while maps are of a single view by its rendering layer, too. */
static status relight(eval_model *m, const img *image, const img *mask, const eval_lighting lights[EVAL_LIGHTS],
                      eval_prediction *out)
{
    status s = OK;
    for (int i = 0; i < EVAL_LIGHTS; i++)
        clear(&out->by_network[i]);
    for (int view = 0; view < m->views && s == OK; view++)
        s = relight_view(m, image, mask, lights, view, out);
    for (size_t i = 0; i < EVAL_LIGHTS && s == OK && m->views == 1; i++) {
        eval_take(m->relit.program, "relit_brdf", i, &out->by_brdf[i]);
        clip_image(&out->by_brdf[i]);
    }
    return s;
}

status eval_relight(eval_model *m, const img *image, const img *mask, const eval_lighting lights[EVAL_LIGHTS],
                    eval_prediction *out)
{
    status s = m->relit.program ? relight(m, image, mask, lights, out) : OK;
    for (int i = 0; i < EVAL_LIGHTS && s == OK && m->views > 1; i++)
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
    if (s == OK) s = shadow_caster_new(&depth, &normal, mask, fov, out);
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

status eval_relight_shadows(eval_model *m, const img *mask, float fov, const eval_lighting lights[EVAL_LIGHTS],
                            eval_prediction *p)
{
    shadow_caster caster;
    status s = caster_of(&p->maps, mask, fov, &caster);
    if (s != OK) return s;
    for (int i = 0; i < EVAL_LIGHTS && s == OK; i++) {
        memcpy(p->shadowed[i].data, p->by_brdf[i].data, 3 * (size_t)m->size * (size_t)m->size * sizeof(float));
        s = cast_shadow(&caster, lights[i].light, &p->shadowed[i]);
    }
    shadow_caster_free(&caster);
    return s == OK ? add_bounces(m, p, mask, p->shadowed, p->shadowed) : s;
}
