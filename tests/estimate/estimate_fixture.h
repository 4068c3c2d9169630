/* SPDX-License-Identifier: MIT */
/* A photograph of a disc, and a model of random weights that takes it. */
#ifndef MERLIN_TESTS_ESTIMATE_ESTIMATE_FIXTURE_H
#define MERLIN_TESTS_ESTIMATE_ESTIMATE_FIXTURE_H

#include "base/file.h"
#include "base/parallel.h"
#include "base/rng.h"
#include "image/exr/exr.h"
#include "image/read/read.h"
#include "merlin/merlin.h"
#include "scratch.h"
#include "weights.h"

#include <limits.h>
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include <cmocka.h>

enum { WIDTH = 150, HEIGHT = 110 };

typedef struct fixture {
    char *folder, weights[96], output[96];
    merlin_model *model;
    merlin_image photo, mask;
} fixture;

static inline merlin_image image_new(int width, int height, int channels)
{
    return (merlin_image){width, height, channels, calloc((size_t)(width * height * channels), sizeof(float))};
}

/* A noisy disc off the centre, its background not black. */
static inline void draw(fixture *f)
{
    f->photo = image_new(WIDTH, HEIGHT, 3);
    f->mask = image_new(WIDTH, HEIGHT, 1);
    rng r = rng_at(1, 2, 3);
    for (int i = 0; i < WIDTH * HEIGHT; i++) {
        float x = ((float)(i % WIDTH) - 90) / 40, y = ((float)(i / WIDTH) - 50) / 40, d = x * x + y * y;
        f->mask.data[i] = d < 1;
        for (int c = 0; c < 3; c++)
            f->photo.data[3 * i + c] = d < 1 ? (0.3f + 0.2f * (float)c) * sqrtf(1 - d) + 0.1f * rng_uniform(&r) : 0.02f;
    }
}

static inline int set_up(void **state)
{
    fixture *f = calloc(1, sizeof *f);
    *state = f;
    f->folder = scratch_new();
    snprintf(f->weights, sizeof f->weights, "%s/random.safetensors", f->folder);
    snprintf(f->output, sizeof f->output, "%s/out", f->folder);
    draw(f);
    if (write_random_weights(f->weights) != OK) return -1;
    return merlin_model_open(f->weights, &f->model) == MERLIN_OK ? 0 : -1;
}

static inline int tear_down(void **state)
{
    fixture *f = *state;
    merlin_model_close(f->model);
    merlin_image_free(&f->photo);
    merlin_image_free(&f->mask);
    scratch_remove(f->folder);
    free(f);
    return 0;
}

static inline merlin_params small(void)
{
    merlin_params p = merlin_params_default();
    p.size = 64;
    return p;
}

static inline void estimate(const fixture *f, merlin_maps *maps)
{
    merlin_params p = small();
    if (merlin_estimate(f->model, &f->photo, &f->mask, &p, maps) != MERLIN_OK) fail_msg("%s", merlin_error());
}

#endif
