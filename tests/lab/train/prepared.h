/* SPDX-License-Identifier: MIT */
/* A data set of three samples of a sphere, and room for one of them as training sees it. */
#ifndef MERLIN_TESTS_PREPARED_H
#define MERLIN_TESTS_PREPARED_H

#include "lab/train/samples/dataset.h"
#include "scratch.h"
#include "synthetic.h"

enum { SIZE = 64, PIXELS = SIZE * SIZE, FLOATS = 28 * PIXELS + 3 + 2 * MODEL_SH };

static const train_dataset_options usual = {.size = SIZE, .memory_gib = 1};

typedef struct fixture {
    char *folder;
    train_dataset *data;
    float *memory;
    train_view view;
} fixture;

static inline void place(fixture *f)
{
    float *at = f->memory;
    train_view *v = &f->view;
    v->size = SIZE;
    float **const three[] = {&v->albedo, &v->normal,         &v->direct, &v->indirect,
                             &v->image,  &v->reconstruction, &v->relit};
    float **const one[] = {&v->roughness, &v->depth, &v->mask, &v->loss_mask};
    for (int i = 0; i < 7; i++, at += 3 * PIXELS)
        *three[i] = at;
    for (int i = 0; i < 4; i++, at += PIXELS)
        *one[i] = at;
    v->light = at;
}

static inline int set_up(void **state)
{
    fixture *f = calloc(1, sizeof *f);
    assert_non_null(f);
    f->folder = scratch_new();
    for (int i = 0; i < 3; i++)
        sphere_write(f->folder, SIZE, i);
    f->memory = malloc(FLOATS * sizeof(float));
    assert_non_null(f->memory);
    place(f);
    if (train_dataset_open(f->folder, &usual, &f->data) != OK) fail_msg("%s", status_message());
    *state = f;
    return 0;
}

static inline int tear_down(void **state)
{
    fixture *f = *state;
    train_dataset_close(f->data);
    scratch_remove(f->folder);
    free(f->memory);
    free(f);
    return 0;
}

#endif
