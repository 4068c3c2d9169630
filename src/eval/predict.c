#include "eval/predict_parts.h"

#include <stdlib.h>
#include <string.h>

#include "estimate/black.h"
#include "estimate/bounce.h"
#include "estimate/shadow.h"
#include "estimate/smooth.h"

static status build_programs(eval_model *m, nn_type type)
{
    nn_options options = {.batch = EVAL_LIGHTS, .height = m->size, .width = m->size, .type = type, .purpose = NN_INFER};
    status s = model_build(&m->config, MODEL_WHOLE, &m->graph);
    if (s == OK) s = nn_compile(m->graph, m->params, &options, &m->program);
    if (s != OK || !m->config.global_illumination) return s;
    s = model_build(&m->config, MODEL_INDIRECT, &m->indirect_graph);
    if (s == OK) s = nn_compile(m->indirect_graph, m->params, &options, &m->indirect);
    return s;
}

status eval_model_open(const char *weights, int size, nn_type type, int views, eval_model **out)
{
    *out = NULL;
    if (size < MODEL_SIZE_MULTIPLE || size % MODEL_SIZE_MULTIPLE)
        return fail(ERROR_INPUT, "samples of %d pixels a side do not fit the model: the side must be a multiple of %d",
                    size, MODEL_SIZE_MULTIPLE);
    eval_model *m = calloc(1, sizeof *m);
    if (!m) return fail(ERROR_MEMORY, "no memory for a model");
    m->size = size;
    m->views = views;
    status s = model_load(weights, &m->config, &m->params);
    if (s == OK) s = build_programs(m, type);
    if (s != OK) {
        eval_model_close(m);
        return s;
    }
    *out = m;
    return OK;
}

void eval_model_close(eval_model *m)
{
    if (!m) return;
    nn_program_free(m->program);
    nn_program_free(m->indirect);
    nn_params_free(m->params);
    nn_graph_free(m->graph);
    nn_graph_free(m->indirect_graph);
    free(m);
}

const model_config *eval_model_config(const eval_model *m)
{
    return &m->config;
}

bool eval_model_relights(const eval_model *m)
{
    return m->config.relight == MODEL_RELIGHT_NETWORK;
}

status eval_prediction_new(const eval_model *m, eval_prediction *out)
{
    *out = (eval_prediction){0};
    status s = eval_maps_new(&out->maps, m->size, m->size);
    if (s == OK) s = img_new(&out->flash, m->size, m->size, 3);
    if (s == OK) s = img_new(&out->indirect, m->size, m->size, 3);
    if (s == OK) s = img_new(&out->reconstruction, m->size, m->size, 3);
    for (int i = 0; i < EVAL_LIGHTS; i++) {
        if (s == OK) s = img_new(&out->by_network[i], m->size, m->size, 3);
        if (s == OK) s = img_new(&out->by_brdf[i], m->size, m->size, 3);
        if (s == OK) s = img_new(&out->full_by_network[i], m->size, m->size, 3);
        if (s == OK) s = img_new(&out->full_by_brdf[i], m->size, m->size, 3);
        if (s == OK) s = img_new(&out->shadowed[i], m->size, m->size, 3);
    }
    if (s != OK) eval_prediction_free(out);
    return s;
}

void eval_prediction_free(eval_prediction *p)
{
    eval_maps_free(&p->maps);
    img_free(&p->flash);
    img_free(&p->indirect);
    img_free(&p->reconstruction);
    for (int i = 0; i < EVAL_LIGHTS; i++) {
        img_free(&p->by_network[i]);
        img_free(&p->by_brdf[i]);
        img_free(&p->full_by_network[i]);
        img_free(&p->full_by_brdf[i]);
        img_free(&p->shadowed[i]);
    }
}

/* The target's lighting code: the light's place and, in setting B, its surroundings. */
static void fill_code(const eval_model *m, const float light[3], const float (*sh)[3], float *code)
{
    static const float dark[9][3];
    memcpy(code, light, 3 * sizeof *light);
    if (m->config.lighting == MODEL_LIGHT_BOTH) model_encode_sh(sh ? sh : dark, code + 3);
}

static void fill_inputs(eval_model *m, const img *image, const img *mask, const eval_lighting *lights)
{
    size_t pixels = (size_t)m->size * (size_t)m->size;
    float *network_image = nn_input_data(m->program, "image"), *network_mask = nn_input_data(m->program, "mask");
    float *code = nn_input_data(m->program, "light"), *position = nn_input_data(m->program, "light_position");
    size_t code_size = (size_t)model_light_size(&m->config);
    for (size_t i = 0; i < EVAL_LIGHTS; i++) {
        const float light[3] = {lights[i].light.x, lights[i].light.y, lights[i].light.z};
        model_encode_image(image->data, network_image + i * pixels * 3, pixels * 3);
        memcpy(network_mask + i * pixels, mask->data, pixels * sizeof *network_mask);
        if (position) memcpy(position + 3 * i, light, sizeof light);
        if (code) fill_code(m, light, lights[i].sh, code + i * code_size);
    }
}

void eval_take(const nn_program *p, const char *name, size_t i, img *out)
{
    const float *data = nn_output_data((nn_program *)p, name);
    size_t count = (size_t)out->width * (size_t)out->height * (size_t)out->channels;
    if (data) memcpy(out->data, data + i * count, count * sizeof *data);
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

/* out = direct + indirect, clipped; indirect may be NULL. */
static void add_indirect(const img *direct, const float *indirect, img *out)
{
    for (size_t i = 0, n = (size_t)out->width * (size_t)out->height * 3; i < n; i++)
        out->data[i] = clip(direct->data[i] + (indirect ? indirect[i] : 0));
}

/* The network's bounces for the four pictures in `direct`, given the maps; NULL for a variant without. */
static status run_indirect(eval_model *m, const eval_maps *maps, const img *mask, const img direct[EVAL_LIGHTS],
                           const float **indirect)
{
    const struct {
        const char *name;
        const img *image;
    } inputs[] = {{"albedo", &maps->albedo},
                  {"normal", &maps->normal},
                  {"roughness", &maps->roughness},
                  {"depth", &maps->depth},
                  {"mask", mask}};
    size_t pixels = (size_t)m->size * (size_t)m->size;
    *indirect = NULL;
    if (!m->indirect) return OK;
    for (size_t i = 0; i < EVAL_LIGHTS; i++) {
        for (size_t k = 0; k < sizeof inputs / sizeof inputs[0]; k++) {
            size_t values = pixels * (size_t)inputs[k].image->channels;
            memcpy(nn_input_data(m->indirect, inputs[k].name) + i * values, inputs[k].image->data,
                   values * sizeof(float));
        }
        memcpy(nn_input_data(m->indirect, "direct") + i * pixels * 3, direct[i].data, pixels * 3 * sizeof(float));
    }
    status s = nn_forward(m->indirect);
    if (s == OK) *indirect = nn_output_data(m->indirect, "indirect");
    return s;
}

/* full = direct + bounces, as merlin relight adds them. */
static status add_bounces(eval_model *m, const eval_prediction *p, const img *mask, const img direct[EVAL_LIGHTS],
                          img full[EVAL_LIGHTS])
{
    const float *indirect;
    size_t values = 3 * (size_t)m->size * (size_t)m->size;
    img bounces = {0};
    status s = run_indirect(m, &p->maps, mask, direct, &indirect);
    if (s == OK) s = img_new(&bounces, m->size, m->size, 3);
    for (size_t i = 0; i < EVAL_LIGHTS && s == OK; i++) {
        if (indirect) memcpy(bounces.data, indirect + i * values, values * sizeof *indirect);
        s = bounce_follow(&p->flash, &direct[i], NULL, &bounces);
        if (s == OK) add_indirect(&direct[i], bounces.data, &full[i]);
    }
    img_free(&bounces);
    return s;
}

/* What the network takes the surroundings for; their light is taken out of the flash's. */
static void take_surroundings(eval_model *m, eval_prediction *out)
{
    const float *code = nn_output_data(m->program, "environment_code");
    const float *lit = nn_output_data(m->program, "environment");
    if (!code || !lit) return;
    model_decode_sh(code, out->sh);
    for (size_t i = 0, n = 3 * (size_t)m->size * (size_t)m->size; i < n; i++)
        out->flash.data[i] -= lit[i];
}

status eval_predict(eval_model *m, const img *image, const img *mask, const eval_lighting lights[EVAL_LIGHTS],
                    eval_prediction *out)
{
    if (image->width != m->size || image->height != m->size)
        return fail(ERROR_INPUT, "a picture of %dx%d does not fit a model prepared for %dx%d", image->width,
                    image->height, m->size, m->size);
    fill_inputs(m, image, mask, lights);
    status s = nn_forward(m->program);
    if (s != OK) return s;
    eval_take(m->program, "albedo", 0, &out->maps.albedo);
    eval_take(m->program, "normal", 0, &out->maps.normal);
    eval_take(m->program, "roughness", 0, &out->maps.roughness);
    eval_take(m->program, "depth", 0, &out->maps.depth);
    eval_take(m->program, "direct", 0, &out->flash);
    eval_take(m->program, "indirect", 0, &out->indirect);
    add_indirect(&out->flash, out->indirect.data, &out->reconstruction);
    take_surroundings(m, out);
    for (size_t i = 0; i < EVAL_LIGHTS; i++) {
        eval_take(m->program, "relit_direct", i, &out->by_network[i]);
        eval_take(m->program, "relit_brdf", i, &out->by_brdf[i]);
        if (!lights[i].sh) relit_black_level(&out->by_network[i]); /* surroundings leave nothing black */
        clip_image(&out->by_network[i]);
        clip_image(&out->by_brdf[i]);
    }
    if (m->views > 1) s = eval_predict_views(m, image, mask, lights, out);
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

status eval_predict_shadows(eval_model *m, const img *mask, float fov, const eval_lighting lights[EVAL_LIGHTS],
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
