/* SPDX-License-Identifier: MIT */
#include "lab/train/samples/loader.h"

#include <stdlib.h>
#include <string.h>

#include "base/parallel.h"
#include "lab/train/samples/mixture.h"
#include "lab/train/samples/motion.h"
#include "lab/train/samples/nfps_batch.h"
#include "lab/train/samples/prepare.h"
#include "optics/orientation.h"

enum { POINT_BUFFERS = 12, BOTH_BUFFERS = 15, BUFFERS = 24 };

/* The sample for one position of the batch, prepared by one thread. */
typedef struct item {
    train_view view;
    size_t sample;
    uint64_t presentation, first; /* first: the presentation of the object's first picture */
} item;

struct train_loader {
    train_source source;
    bool validation;
    size_t batch;
    item *items;
    float *light_code;     /* the program's input "light", or NULL */
    float *shares;         /* its input "share", or NULL */
    const float *images;   /* its input "image" */
    nfps_batch *near;      /* inputs of the network of near lights, or NULL */
    float *spare[BUFFERS]; /* for targets that are no inputs of the model */
};

/* The program's input for a field of the view; a vector counts as one pixel. */
typedef struct field {
    const char *input; /* NULL: none */
    int channels;
    bool vector, of_object; /* of_object: the same for all pictures of an object */
    size_t offset;          /* offset of the pointer in train_view */
} field;

static const field fields[BUFFERS] = {
    {"albedo_true", 3, false, true, offsetof(train_view, albedo)},
    {"normal_true", 3, false, true, offsetof(train_view, normal)},
    {"roughness_true", 1, false, true, offsetof(train_view, roughness)},
    {"depth_true", 1, false, true, offsetof(train_view, depth)},
    {"mask", 1, false, true, offsetof(train_view, mask)},
    {"direct_true", 3, false, true, offsetof(train_view, direct)},
    {"indirect_true", 3, false, true, offsetof(train_view, indirect)},
    {"image", 3, false, false, offsetof(train_view, image)},
    {"reconstruction_true", 3, false, true, offsetof(train_view, reconstruction)},
    {"relit_true", 3, false, true, offsetof(train_view, relit)},
    {"loss_mask", 1, false, true, offsetof(train_view, loss_mask)},
    {"light_position", 3, true, true, offsetof(train_view, light)},
    /* for both lights only: */
    {NULL, 3, false, false, offsetof(train_view, env)},
    {"environment_true", MODEL_SH, true, false, offsetof(train_view, sh)},
    {NULL, MODEL_SH, true, false, offsetof(train_view, target_sh)},
    /* for any light only: */
    {NULL, TRAIN_LAMPS *TRAIN_LAMP_VALUES, false, false, offsetof(train_view, lamps)},
    {NULL, 3, false, false, offsetof(train_view, photo)},
    {"sight", MODEL_SIGHT, false, false, offsetof(train_view, sight)},
    {"lens", 3, true, true, offsetof(train_view, lens_values)},
    {"lights_true", MODEL_LIGHTS, true, false, offsetof(train_view, lights)},
    {"lamp_weight", 1, true, false, offsetof(train_view, lamp_weight)},
    {"rest_weight", 1, true, false, offsetof(train_view, rest_weight)},
    {"visibility_true", 1, false, false, offsetof(train_view, visibility)},
    {"visibility_weight", 1, false, false, offsetof(train_view, visibility_weight)},
};

/* Returns how many of them this kind of training has. */
static int buffer_count(const train_source *source)
{
    if (source->nfps) return 0;
    if (source->any) return BUFFERS;
    return source->environment ? BOTH_BUFFERS : POINT_BUFFERS;
}

static status connect(train_loader *l, nn_program *program, int which)
{
    const field *d = &fields[which];
    size_t size = (size_t)l->source.config->size;
    size_t stride = (size_t)d->channels * (d->vector ? 1 : size * size);
    const size_t pictures = d->of_object ? (size_t)l->source.pictures : 1;
    float *data = d->input ? nn_input_data(program, d->input) : NULL;
    if (!data || pictures > 1) l->spare[which] = calloc(l->batch * stride, sizeof *data);
    if ((!data || pictures > 1) && !l->spare[which])
        return fail(MERLIN_NO_MEMORY, "out of memory for a batch of %zu", l->batch);
    for (size_t i = 0; i < l->batch; i++) {
        float *place = data && i % pictures == 0 ? data + i / pictures * stride : l->spare[which] + i * stride;
        memcpy((char *)&l->items[i].view + d->offset, &place, sizeof place);
        l->items[i].view.size = (int)size;
    }
    return OK;
}

status train_loader_new(nn_program *program, const train_source *source, train_loader **out)
{
    *out = NULL;
    train_loader *l = calloc(1, sizeof *l);
    if (!l) return fail(MERLIN_NO_MEMORY, "out of memory for a batch");
    l->source = *source;
    l->batch = (size_t)source->batch;
    l->items = calloc(l->batch, sizeof *l->items);
    status s = l->items ? OK : fail(MERLIN_NO_MEMORY, "out of memory for a batch");
    for (int i = 0; i < buffer_count(source) && s == OK; i++)
        s = connect(l, program, i);
    if (s == OK && source->nfps)
        s = nfps_batch_new(program, source->config->size, source->pictures, l->batch / (size_t)source->pictures,
                           &l->near);
    l->light_code = source->nfps ? NULL : nn_input_data(program, "light");
    l->shares = nn_input_data(program, "share");
    l->images = nn_input_data(program, "image");
    if (s != OK) {
        train_loader_free(l);
        return s;
    }
    *out = l;
    return OK;
}

void train_loader_free(train_loader *l)
{
    if (!l) return;
    for (int i = 0; i < BUFFERS; i++)
        free(l->spare[i]);
    nfps_batch_free(l->near);
    free(l->items);
    free(l);
}

/* Returns the seed; validation's does not depend on the configuration, so that its losses are comparable between runs.
 */
static uint64_t seed_of(const train_loader *l)
{
    return l->validation ? 0 : (uint64_t)l->source.config->seed;
}

/* Chooses the target's environment: another sample's, turned and exposed at random. It has a random stream of its own,
 * so that the numbers of the point setting stay the same. */
static status draw_environments(const train_loader *l, const item *it, train_lighting *out)
{
    const train_source *from = &l->source;
    rng r = rng_at(seed_of(l), 2 * it->presentation + l->validation, TRAIN_STREAM_ENVIRONMENT);
    size_t first = l->validation ? from->training_count : 0;
    size_t count = l->validation ? train_dataset_count(from->data) - first : from->training_count;
    size_t other = first + (size_t)rng_below(&r, (int)count);
    int orientation = rng_below(&r, ORIENTATIONS);
    out->strength = train_draw_strength(&r);
    float strength = train_draw_target_strength(l->validation ? 0 : (float)from->config->dark_target, &r);
    status s = train_dataset_sh(from->data, other, orientation, out->target_sh);
    for (int i = 0; i < MODEL_SH; i++)
        out->target_sh[i / 3][i % 3] *= strength;
    return s;
}

/* Adds optional faults. They have random streams of their own, so that all other numbers stay the same. */
static status add_faults(const train_loader *l, const item *it, train_camera *lens)
{
    const train_config *c = l->source.config;
    rng faults = rng_at((uint64_t)c->seed, it->first, TRAIN_STREAM_FAULTS);
    rng moving = rng_at((uint64_t)c->seed, it->first, TRAIN_STREAM_MOTION);
    train_camera_degrade(c, &faults, lens);
    train_motion motion = train_motion_draw(c, &moving);
    return train_motion_moves(&motion) ? train_move(&it->view, &motion) : OK;
}

/* Choices that all pictures of an object share. */
typedef struct shared {
    vec3 target;
    int orientation;
} shared;

static shared draw_shared(const train_loader *l, rng *r)
{
    const vec3 target = train_draw_light(r);
    return (shared){target, l->validation ? 0 : rng_below(r, ORIENTATIONS)};
}

/* Moves a picture against the object's first one. */
static void move_hand(const train_loader *l, const item *it, train_mixture *mixture)
{
    rng steady = rng_at(seed_of(l), 2 * it->first, TRAIN_STREAM_HAND);
    rng r = rng_at(seed_of(l), 2 * it->presentation + 1, TRAIN_STREAM_HAND);
    train_mixture_move(l->source.config->size, &steady, &r, mixture);
}

/* Prepares a sample under any light. Validation uses all kinds of mixtures, too, by a perfect camera with exposure and
 * white balance. */
static status fill_any(train_loader *l, item *it)
{
    const train_config *c = l->source.config;
    const uint64_t stream = l->validation ? TRAIN_STREAM_VALIDATION : TRAIN_STREAM_PRESENTATION;
    rng r = rng_at(seed_of(l), it->presentation, stream), object = rng_at(seed_of(l), it->first, stream);
    rng light = rng_at(seed_of(l), 2 * it->presentation + l->validation, TRAIN_STREAM_MIXTURE);
    const shared common = draw_shared(l, &object);
    draw_shared(l, &r); /* the camera's numbers come behind these */
    train_camera lens = l->validation ? train_camera_perfect() : train_camera_draw(c, &r);
    status s = train_dataset_get(l->source.data, it->sample, common.orientation, &it->view);
    if (s == OK && !l->validation) s = add_faults(l, it, &lens);
    if (s != OK) return s;
    train_mixture mixture;
    rng steady = rng_at(seed_of(l), 2 * it->first + l->validation, TRAIN_STREAM_CAPTURE);
    const bool one = l->source.pictures == 1;
    const train_capture capture = train_capture_draw(&steady, (int)(it->presentation - it->first));
    train_mixture_draw(&it->view, c, &light, one ? NULL : &capture, &lens, &mixture);
    if (capture.picture > 0 && !l->validation) move_hand(l, it, &mixture);
    /* one camera took all pictures of an object */
    if (!l->validation) train_camera_add_response(one ? &light : &steady, &lens);
    return train_prepare_any(&it->view, &mixture, &lens, common.target, &r);
}

static status fill_item(void *context, size_t i)
{
    train_loader *l = context;
    item *it = &l->items[i];
    if (l->source.any) return fill_any(l, it);
    const train_config *c = l->source.config;
    rng r = rng_at(seed_of(l), it->presentation, l->validation ? TRAIN_STREAM_VALIDATION : TRAIN_STREAM_PRESENTATION);
    train_lighting lighting = {.target = train_draw_light(&r)};
    int orientation = l->validation ? 0 : rng_below(&r, ORIENTATIONS);
    train_camera lens = l->validation ? train_camera_perfect() : train_camera_draw(c, &r);
    status s = train_dataset_get(l->source.data, it->sample, orientation, &it->view);
    if (s == OK && l->source.environment) s = draw_environments(l, it, &lighting);
    if (s == OK && !l->validation) s = add_faults(l, it, &lens);
    return s == OK ? train_prepare(&it->view, l->source.input_global, &lens, &lighting, &r) : s;
}

/* Prepares an object for the network of near lights. */
static status fill_near(void *context, size_t object)
{
    train_loader *l = context;
    const item *it = &l->items[object * (size_t)l->source.pictures];
    rng r = rng_at(seed_of(l), 2 * it->first + l->validation, TRAIN_STREAM_NFPS);
    const int orientation = l->validation ? 0 : rng_below(&r, ORIENTATIONS);
    return nfps_batch_fill(l->near, object, l->source.data, it->sample, orientation, &r);
}

/* Fills in an object's "share", once its pictures are there. */
static void fill_shares(void *context, size_t object)
{
    train_loader *l = context;
    const size_t size = (size_t)l->source.config->size, pixels = size * size;
    const size_t first = object * (size_t)l->source.pictures * pixels;
    model_encode_shares(l->images + 3 * first, l->source.pictures, pixels, l->shares + first);
}

static status fill(train_loader *l)
{
    if (l->near) return parallel_try(l->batch / (size_t)l->source.pictures, fill_near, l);
    status s = parallel_try(l->batch, fill_item, l);
    if (s != OK) return s;
    if (l->shares) parallel_for(l->batch / (size_t)l->source.pictures, fill_shares, l);
    size_t code = l->source.environment ? 3 + MODEL_SH : 3;
    for (size_t i = 0; i < l->batch && l->light_code; i++) {
        memcpy(l->light_code + code * i, l->items[i].view.light, 3 * sizeof(float));
        if (l->source.environment)
            memcpy(l->light_code + code * i + 3, l->items[i].view.target_sh, MODEL_SH * sizeof(float));
    }
    return OK;
}

/* Numbers the presentations of a batch. */
static void number(train_loader *l, uint64_t first)
{
    const uint64_t pictures = (uint64_t)l->source.pictures;
    for (size_t i = 0; i < l->batch; i++) {
        l->items[i].presentation = first + i;
        l->items[i].first = first + i / pictures * pictures;
    }
}

status train_loader_training(train_loader *l, train_order *order, uint64_t first)
{
    l->validation = false;
    number(l, first);
    for (size_t i = 0; i < l->batch; i++)
        l->items[i].sample = train_order_at(order, l->items[i].first);
    return fill(l);
}

status train_loader_validation(train_loader *l, size_t first)
{
    l->validation = true;
    number(l, first);
    for (size_t i = 0; i < l->batch; i++)
        l->items[i].sample = l->source.training_count + (size_t)l->items[i].first;
    return fill(l);
}
