/* SPDX-License-Identifier: MIT */
/* Tiny samples and runs for the tests of training. */
#ifndef MERLIN_TESTS_TRAIN_TRAIN_FIXTURE_H
#define MERLIN_TESTS_TRAIN_TRAIN_FIXTURE_H

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "base/file.h"
#include "lab/train/curves.h"
#include "lab/train/train.h"
#include "model/model.h"
#include "nn/safetensors.h"

/* last, as cmocka defines a macro named fail */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "scratch.h"
#include "synthetic.h"

enum { SIZE = 64, SAMPLES = 6 };

typedef struct fixture {
    char *data, *root, config[4200];
} fixture;

static const char *const jitter = "\"exposure_jitter\": 0.2, \"colour_jitter\": 0.05";
static const char *const no_jitter = "\"exposure_jitter\": 0, \"colour_jitter\": 0";

typedef struct experiment {
    int presentations, batch, validation;
    const char *lighting, *more;
    int minutes; /* between checkpoints */
} experiment;

/* Writes the configuration of a model of a few thousand parameters. */
static inline void write_experiment(const fixture *f, const experiment *e)
{
    char text[2048];
    int n =
        snprintf(text, sizeof text,
                 "{\"model\": {\"name\": \"tiny\", \"input_global\": true, \"material_decoders\": 1, "
                 "\"feature_sharing\": true, \"gated_attention\": true, \"relight\": \"network\", "
                 "\"global_illumination\": true, \"lighting\": \"%s\", \"widths\": [16, 16, 16, 16, 16], "
                 "\"gi_widths\": [8, 8, 8, 8, 8]}, \"training\": {\"size\": %d, \"batch\": %d, \"presentations\": %d, "
                 "\"learning_rate\": 3e-3, \"encoder_rate_scale\": 1, \"halve_every_epochs\": 30, "
                 "\"warmup_steps\": 2, \"beta1\": 0.9, \"beta2\": 0.99, \"clip_norm\": 5, \"depth_weight\": 2, "
                 "\"type\": \"f32\", "
                 "\"seed\": 1, %s, \"memory_gib\": 1, \"validation_count\": %d, "
                 "\"validation_steps\": 2, \"curve_steps\": 4, \"checkpoint_minutes\": %d}}",
                 e->lighting, SIZE, e->batch, e->presentations, e->more, e->validation, e->minutes);
    if (file_write(f->config, text, (size_t)n) != OK) fail_msg("%s", status_message());
}

static inline void write_config(const fixture *f, int presentations, int batch, int validation, const char *more)
{
    write_experiment(f, &(experiment){presentations, batch, validation, "point", more, 100});
}

static inline int set_up(void **state)
{
    fixture *f = calloc(1, sizeof *f);
    assert_non_null(f);
    f->data = scratch_new();
    f->root = scratch_new();
    snprintf(f->config, sizeof f->config, "%s/tiny.json", f->root);
    for (int i = 0; i < SAMPLES; i++)
        sphere_write(f->data, SIZE, i);
    *state = f;
    return 0;
}

static inline int tear_down(void **state)
{
    fixture *f = *state;
    scratch_remove(f->data);
    scratch_remove(f->root);
    free(f);
    return 0;
}

static int steps_left;

static inline int stop_after_steps(void)
{
    return --steps_left <= 0;
}

static inline status train_asked(const fixture *f, const char *name, bool resume, int (*interrupted)(void))
{
    char *output = file_join(f->root, name);
    train_options o = {.config = f->config,
                       .data = f->data,
                       .output = output,
                       .resume = resume,
                       .quiet = true,
                       .interrupted = interrupted};
    status s = train_run(&o);
    free(output);
    return s;
}

static inline status train(const fixture *f, const char *name, bool resume, int stop_after)
{
    steps_left = stop_after;
    return train_asked(f, name, resume, stop_after ? stop_after_steps : NULL);
}

static inline char *contents(const fixture *f, const char *run, const char *name, size_t *size)
{
    char path[600], *data;
    snprintf(path, sizeof path, "%s/%s/%s", f->root, run, name);
    if (file_read(path, 1 << 28, &data, size) != OK) fail_msg("%s", status_message());
    return data;
}

static inline void same_file(const fixture *f, const char *a, const char *b, const char *name)
{
    size_t size_a, size_b;
    char *data_a = contents(f, a, name, &size_a), *data_b = contents(f, b, name, &size_b);
    assert_int_equal(size_a, size_b);
    assert_memory_equal(data_a, data_b, size_a);
    free(data_a);
    free(data_b);
}

#endif
