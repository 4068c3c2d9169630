/* SPDX-License-Identifier: MIT */
#include "lab/train/samples/nfps_batch.h"

#include <stdio.h>
#include <stdlib.h>

#include "model/nfps.h"

/* Floats a pixel of an unpacked sample: four maps of three channels, three of one, and the targets. */
enum { VIEW_VALUES = 4 * 3 + 3 + TRAIN_LAMPS * TRAIN_LAMP_VALUES };

typedef struct object {
    train_view view;
    nfps_place place;
} object;

struct nfps_batch {
    size_t count;
    object *objects;
    float *memory; /* of the views */
};

static float *place_of(nn_program *program, const char *prefix, const char *name, size_t before)
{
    char full[32];
    snprintf(full, sizeof full, "%s%s", prefix, name);
    float *data = nn_input_data(program, full);
    return data ? data + before : NULL;
}

/* Returns where a stage's inputs are of an object behind so many pixels of others. */
static nfps_stage_place stage_of(nn_program *program, const char *prefix, size_t before, size_t pictures)
{
    return (nfps_stage_place){
        .in = {.picture = place_of(program, prefix, "picture", before * pictures * NFPS_PICTURE),
               .light = place_of(program, prefix, "light", before * pictures * NFPS_LIGHT),
               .matte = place_of(program, prefix, "matte", before * NFPS_MATTE)},
        .mask = place_of(program, prefix, "mask", before),
        .normal = place_of(program, prefix, "normal", 3 * before),
        .normal_true = place_of(program, prefix, "normal_true", 3 * before),
        .loss_mask = place_of(program, prefix, "loss_mask", before),
    };
}

static train_view view_in(float *memory, int size)
{
    const size_t n = (size_t)size * (size_t)size;
    return (train_view){.size = size,
                        .albedo = memory,
                        .normal = memory + 3 * n,
                        .direct = memory + 6 * n,
                        .indirect = memory + 9 * n,
                        .roughness = memory + 12 * n,
                        .depth = memory + 13 * n,
                        .mask = memory + 14 * n,
                        .lamps = memory + 15 * n};
}

status nfps_batch_new(nn_program *program, int size, int pictures, size_t objects, nfps_batch **out)
{
    const size_t pixels = (size_t)size * (size_t)size, values = VIEW_VALUES * 4 * pixels;
    nfps_batch *b = calloc(1, sizeof *b);
    *out = b;
    if (b) {
        b->count = objects;
        b->objects = calloc(objects, sizeof *b->objects);
        b->memory = calloc(objects * values, sizeof *b->memory);
    }
    if (!b || !b->objects || !b->memory) {
        nfps_batch_free(b);
        *out = NULL;
        return fail(MERLIN_NO_MEMORY, "out of memory for a batch of %zu objects", objects);
    }
    for (size_t i = 0; i < objects; i++)
        b->objects[i] = (object){view_in(b->memory + i * values, 2 * size),
                                 {size, pictures, stage_of(program, "first_", i * pixels / 4, (size_t)pictures),
                                  stage_of(program, "", i * pixels, (size_t)pictures)}};
    return OK;
}

void nfps_batch_free(nfps_batch *b)
{
    if (!b) return;
    free(b->memory);
    free(b->objects);
    free(b);
}

status nfps_batch_fill(nfps_batch *b, size_t i, train_dataset *data, size_t sample, int orientation, rng *r)
{
    object *o = &b->objects[i];
    status s = train_dataset_get(data, sample, orientation, &o->view);
    return s == OK ? nfps_sample_fill(&o->view, r, &o->place) : s;
}
