/* SPDX-License-Identifier: MIT */
#include "lab/train/feed.h"

#include <stdlib.h>
#include <string.h>

#include "base/parallel.h"
#include "lab/train/mixture.h"
#include "lab/train/motion.h"
#include "lab/train/prepare.h"
#include "optics/orientation.h"

enum { POINT_BUFFERS = 12, BOTH_BUFFERS = 15, BUFFERS = 24 };

/* What one thread does for one place of the batch. */
typedef struct item {
    trn_view view;
    size_t sample;
    uint64_t presentation;
} item;

struct trn_feed {
    trn_source source;
    bool validation;
    size_t batch;
    item *items;
    float *light_code;     /* the program's input "light", or NULL */
    float *spare[BUFFERS]; /* for targets the model has no input for */
};

/* Where the program wants each of the view's fields; a vector's pixels count as one. */
typedef struct field {
    const char *input; /* NULL: none */
    int channels;
    bool vector;
    size_t offset; /* of the pointer in trn_view */
} field;

static const field fields[BUFFERS] = {
    {"albedo_true", 3, false, offsetof(trn_view, albedo)},
    {"normal_true", 3, false, offsetof(trn_view, normal)},
    {"roughness_true", 1, false, offsetof(trn_view, roughness)},
    {"depth_true", 1, false, offsetof(trn_view, depth)},
    {"mask", 1, false, offsetof(trn_view, mask)},
    {"direct_true", 3, false, offsetof(trn_view, direct)},
    {"indirect_true", 3, false, offsetof(trn_view, indirect)},
    {"image", 3, false, offsetof(trn_view, image)},
    {"reconstruction_true", 3, false, offsetof(trn_view, reconstruction)},
    {"relit_true", 3, false, offsetof(trn_view, relit)},
    {"loss_mask", 1, false, offsetof(trn_view, loss_mask)},
    {"light_position", 3, true, offsetof(trn_view, light)},
    /* for both lights only: */
    {NULL, 3, false, offsetof(trn_view, env)},
    {"environment_true", MODEL_SH, true, offsetof(trn_view, sh)},
    {NULL, MODEL_SH, true, offsetof(trn_view, target_sh)},
    /* for any light only: */
    {NULL, TRN_LAMPS *TRN_LAMP_VALUES, false, offsetof(trn_view, lamps)},
    {NULL, 3, false, offsetof(trn_view, photo)},
    {"sight", MODEL_SIGHT, false, offsetof(trn_view, sight)},
    {"lens", 3, true, offsetof(trn_view, lens_values)},
    {"lights_true", MODEL_LIGHTS, true, offsetof(trn_view, lights)},
    {"lamp_weight", 1, true, offsetof(trn_view, lamp_weight)},
    {"rest_weight", 1, true, offsetof(trn_view, rest_weight)},
    {"visibility_true", 1, false, offsetof(trn_view, visibility)},
    {"visibility_weight", 1, false, offsetof(trn_view, visibility_weight)},
};

/* How many of them a kind of training has. */
static int buffer_count(const trn_source *source)
{
    if (source->any) return BUFFERS;
    return source->environment ? BOTH_BUFFERS : POINT_BUFFERS;
}

static status connect(trn_feed *f, nn_program *program, int which)
{
    const field *d = &fields[which];
    size_t size = (size_t)f->source.config->size;
    size_t stride = (size_t)d->channels * (d->vector ? 1 : size * size);
    float *data = d->input ? nn_input_data(program, d->input) : NULL;
    if (!data) data = f->spare[which] = calloc(f->batch * stride, sizeof *data);
    if (!data) return fail(MERLIN_NO_MEMORY, "out of memory for a batch of %zu", f->batch);
    for (size_t i = 0; i < f->batch; i++) {
        float *place = data + i * stride;
        memcpy((char *)&f->items[i].view + d->offset, &place, sizeof place);
        f->items[i].view.size = (int)size;
    }
    return OK;
}

status trn_feed_new(nn_program *program, const trn_source *source, trn_feed **out)
{
    *out = NULL;
    trn_feed *f = calloc(1, sizeof *f);
    if (!f) return fail(MERLIN_NO_MEMORY, "out of memory for a batch");
    f->source = *source;
    f->batch = (size_t)source->batch;
    f->items = calloc(f->batch, sizeof *f->items);
    status s = f->items ? OK : fail(MERLIN_NO_MEMORY, "out of memory for a batch");
    for (int i = 0; i < buffer_count(source) && s == OK; i++)
        s = connect(f, program, i);
    f->light_code = nn_input_data(program, "light");
    if (s != OK) {
        trn_feed_free(f);
        return s;
    }
    *out = f;
    return OK;
}

void trn_feed_free(trn_feed *f)
{
    if (!f) return;
    for (int i = 0; i < BUFFERS; i++)
        free(f->spare[i]);
    free(f->items);
    free(f);
}

/* Validation's draws do not depend on the configuration, so that its losses compare between runs. */
static uint64_t seed_of(const trn_feed *f)
{
    return f->validation ? 0 : (uint64_t)f->source.config->seed;
}

/* The target's environment is another sample's, turned and exposed at random. Draws are of a stream of their own, so
 * that the point setting's stay what they are. */
static status draw_environments(const trn_feed *f, const item *it, trn_lighting *out)
{
    const trn_source *from = &f->source;
    rng r = rng_at(seed_of(f), 2 * it->presentation + f->validation, TRN_STREAM_ENVIRONMENT);
    size_t first = f->validation ? from->training_count : 0;
    size_t count = f->validation ? trn_dataset_count(from->data) - first : from->training_count;
    size_t other = first + (size_t)rng_below(&r, (int)count);
    int orientation = rng_below(&r, ORIENTATIONS);
    out->strength = trn_draw_strength(&r);
    float strength = trn_draw_target_strength(f->validation ? 0 : (float)from->config->dark_target, &r);
    status s = trn_dataset_sh(from->data, other, orientation, out->target_sh);
    for (int i = 0; i < MODEL_SH; i++)
        out->target_sh[i / 3][i % 3] *= strength;
    return s;
}

/* What configurations may ask for beside: draws of streams of their own, so that the others stay what they are. */
static status add_faults(const trn_feed *f, const item *it, trn_camera *lens)
{
    const train_config *c = f->source.config;
    rng faults = rng_at((uint64_t)c->seed, it->presentation, TRN_STREAM_FAULTS);
    rng moving = rng_at((uint64_t)c->seed, it->presentation, TRN_STREAM_MOTION);
    trn_camera_spoil(c, &faults, lens);
    trn_motion motion = trn_motion_draw(c, &moving);
    return trn_motion_moves(&motion) ? trn_move(&it->view, &motion) : OK;
}

/* Under any light. Validation has the mixtures of every kind, too, by a perfect camera that exposes and balances. */
static status fill_any(trn_feed *f, item *it)
{
    const train_config *c = f->source.config;
    rng r = rng_at(seed_of(f), it->presentation, f->validation ? TRN_STREAM_VALIDATION : TRN_STREAM_PRESENTATION);
    rng light = rng_at(seed_of(f), 2 * it->presentation + f->validation, TRN_STREAM_MIXTURE);
    const vec3 target = trn_draw_light(&r);
    int orientation = f->validation ? 0 : rng_below(&r, ORIENTATIONS);
    trn_camera lens = f->validation ? trn_camera_perfect() : trn_camera_draw(c, &r);
    status s = trn_dataset_get(f->source.data, it->sample, orientation, &it->view);
    if (s == OK && !f->validation) s = add_faults(f, it, &lens);
    if (s != OK) return s;
    trn_mixture mixture;
    trn_mixture_draw(&it->view, &light, &lens, &mixture);
    if (!f->validation) trn_camera_develop(&light, &lens);
    return trn_prepare_any(&it->view, &mixture, &lens, target, &r);
}

static status fill_item(void *context, size_t i)
{
    trn_feed *f = context;
    item *it = &f->items[i];
    if (f->source.any) return fill_any(f, it);
    const train_config *c = f->source.config;
    rng r = rng_at(seed_of(f), it->presentation, f->validation ? TRN_STREAM_VALIDATION : TRN_STREAM_PRESENTATION);
    trn_lighting lighting = {.target = trn_draw_light(&r)};
    int orientation = f->validation ? 0 : rng_below(&r, ORIENTATIONS);
    trn_camera lens = f->validation ? trn_camera_perfect() : trn_camera_draw(c, &r);
    status s = trn_dataset_get(f->source.data, it->sample, orientation, &it->view);
    if (s == OK && f->source.environment) s = draw_environments(f, it, &lighting);
    if (s == OK && !f->validation) s = add_faults(f, it, &lens);
    return s == OK ? trn_prepare(&it->view, f->source.input_global, &lens, &lighting, &r) : s;
}

static status fill(trn_feed *f)
{
    status s = parallel_try(f->batch, fill_item, f);
    if (s != OK) return s;
    size_t code = f->source.environment ? 3 + MODEL_SH : 3;
    for (size_t i = 0; i < f->batch && f->light_code; i++) {
        memcpy(f->light_code + code * i, f->items[i].view.light, 3 * sizeof(float));
        if (f->source.environment)
            memcpy(f->light_code + code * i + 3, f->items[i].view.target_sh, MODEL_SH * sizeof(float));
    }
    return OK;
}

status trn_feed_training(trn_feed *f, trn_order *order, uint64_t first)
{
    f->validation = false;
    for (size_t i = 0; i < f->batch; i++) {
        f->items[i].presentation = first + i;
        f->items[i].sample = trn_order_at(order, first + i);
    }
    return fill(f);
}

status trn_feed_validation(trn_feed *f, size_t first)
{
    f->validation = true;
    for (size_t i = 0; i < f->batch; i++) {
        f->items[i].presentation = first + i;
        f->items[i].sample = f->source.training_count + first + i;
    }
    return fill(f);
}
