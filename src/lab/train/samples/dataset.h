/* SPDX-License-Identifier: MIT */
/* A folder of rendered samples for training: read once, kept packed in memory, unpacked into a batch in any of the
 * eight orientations.
 *
 *     train_dataset *d;
 *     status s = train_dataset_open("data/train", &(train_dataset_options){.size = 128, .memory_gib = 11}, &d);
 *     train_view v = ...;                                    positions in the batch
 *     if (s == OK) s = train_dataset_get(d, 17, 0, &v);
 *     train_dataset_close(d);
 *
 * Samples are files in the order of their names. Only pixels inside the object's outline are kept, as the half floats
 * of the file, so that a sample from memory equals one from disk bit for bit. */
#ifndef MERLIN_LAB_TRAIN_SAMPLES_DATASET_H
#define MERLIN_LAB_TRAIN_SAMPLES_DATASET_H

#include <stdbool.h>
#include <stddef.h>

#include "base/status.h"
#include "optics/camera.h"

typedef struct train_dataset train_dataset;

/* Properties of a sample's lamp, or of a target's light. */
typedef struct train_lamp {
    vec3 at; /* as in sample_lamp */
    bool distant;
    vec3 axis; /* as in sample_target */
    float lobe;
} train_lamp;

/* Lamps of a sample that are read, and values of each at a pixel. */
enum { TRAIN_LAMPS = 16, TRAIN_LAMP_VALUES = 4 };

/* Positions of one sample in the batch, each size × size × channels floats, channels last. */
typedef struct train_view {
    int size;
    float *albedo;    /* 3, [0, 1] until train_prepare turns it to [-1, 1] */
    float *normal;    /* 3 */
    float *roughness; /* 1, like albedo */
    float *depth;     /* 1 */
    float *mask;      /* 1, coverage until train_prepare makes it 0 or 1 */
    float *direct;    /* 3 */
    float *indirect;  /* 3 */
    /* of a data set with environments, else NULL: */
    float *env; /* 3, the object under its environment alone */
    float *sh;  /* 27 values: that environment; model_encode_sh of it after train_prepare */
    /* of a data set with lamps or targets, else NULL: */
    float *lamps; /* TRAIN_LAMPS images of TRAIN_LAMP_VALUES: the object under each, bounces included, and its
                   * visibility */
    train_lamp lamp[TRAIN_LAMPS];
    int lamp_count;
    camera lens; /* size × size */
    /* filled in by train_prepare: */
    float *image, *reconstruction, *relit; /* 3 */
    float *loss_mask;                      /* 1 */
    float *light;                          /* 3 values */
    float *target_sh;                      /* 27 values, model_encode_sh: the target's environment; or NULL */
    /* for any light, else NULL: */
    float *photo;                              /* 3: radiance of the mixture of lights, before the camera */
    float *sight, *lens_values;                /* MODEL_SIGHT; 3 values, as the model's inputs "sight" and "lens" */
    float *lights, *lamp_weight, *rest_weight; /* MODEL_LIGHTS values, 1 and 1 */
    float *visibility, *visibility_weight;     /* 1 */
} train_view;

typedef struct train_dataset_options {
    int size;          /* required width and height of every sample */
    double memory_gib; /* samples are kept in memory until they fill this */
    bool environment;  /* also read images under environments; samples without are refused */
    bool lamps;        /* also read those and images under lamps, through any lens; samples without are refused */
    bool targets; /* read the targets instead, whose visibility is 1, through any lens; samples without are refused */
} train_dataset_options;

/* Opens a folder of samples. Refuses an empty one. */
status train_dataset_open(const char *folder, const train_dataset_options *options, train_dataset **out);
void train_dataset_close(train_dataset *d);
size_t train_dataset_count(const train_dataset *d);
/* Unpacks a sample in an orientation of optics/orientation.h. Everything outside the outline becomes zero. Refuses a
 * sample of another size, or of another flash or camera (unless it is read with lamps) than the model's. Thread-safe.
 */
status train_dataset_get(train_dataset *d, size_t i, int orientation, train_view *out);
/* Reads only the coefficients of a sample's environment, turned. Thread-safe. */
status train_dataset_sh(train_dataset *d, size_t i, int orientation, float sh[9][3]);
/* Returns the generator's version of the folder's first sample. */
int train_dataset_generator_version(const train_dataset *d);

#endif
