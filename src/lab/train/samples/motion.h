/* SPDX-License-Identifier: MIT */
/* Data augmentation: other photographs of the same object that are physically as correct as the rendered one, with the
 * camera turned about its lens, and everything nearer or farther.
 *
 * A turned camera sees the same light along the same rays, so that its picture is the rendered one resampled; the flash
 * stays where it is. An object s times as far and s times as large covers the same pixels, and its radiance under the
 * flash is 1/s² of what it was, bounces included. A crop, in contrast, is a longer lens than the network's 60 degrees:
 * to the network the object would be stretched, with normals that contradict its shading.
 *
 *     train_motion m = train_motion_draw(config, &rng);
 *     if (train_motion_moves(&m)) status s = train_move(&view, &m);      between train_dataset_get and train_prepare
 */
#ifndef MERLIN_LAB_TRAIN_SAMPLES_MOTION_H
#define MERLIN_LAB_TRAIN_SAMPLES_MOTION_H

#include <stdbool.h>

#include "base/rng.h"
#include "lab/train/config/train_config.h"
#include "lab/train/samples/dataset.h"

typedef struct train_motion {
    bool turned;
    float turn[3][3]; /* rotation of camera space */
    float distance;   /* factor of distance and size */
} train_motion;

/* Chooses pan, tilt and roll of at most camera_turn degrees each, and a distance within distance_jitter. */
train_motion train_motion_draw(const train_config *c, rng *r);
bool train_motion_moves(const train_motion *m);

/* Moves an unpacked sample. An object cut off by the frame is not turned, as what would come into view is unknown.
 * MERLIN_NO_MEMORY. */
status train_move(const train_view *v, const train_motion *m);

#endif
