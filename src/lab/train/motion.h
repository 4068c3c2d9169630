/* SPDX-License-Identifier: MIT */
/* Other photographs of the same object that are physically as right as the rendered one: the camera turned about its
 * lens, and everything nearer or farther.
 *
 * A turned camera sees the same light along the same lines, so that its picture is the rendered one resampled; the
 * flash stays where it is. An object s times as far and s times as large covers the same pixels, and its radiance by
 * the flash is 1/s² of what it was, bounces included. A crop, in contrast, is a longer lens, which the network's camera
 * of 60 degrees is not: to it, the object would be stretched sideways, with normals that its shading contradicts.
 *
 *     train_motion m = train_motion_draw(config, &rng);
 *     if (train_motion_moves(&m)) status s = train_move(&view, &m);      between train_dataset_get and train_prepare */
#ifndef MERLIN_LAB_TRAIN_MOTION_H
#define MERLIN_LAB_TRAIN_MOTION_H

#include <stdbool.h>

#include "base/rng.h"
#include "lab/train/dataset.h"
#include "lab/train/train_config.h"

typedef struct train_motion {
    bool turned;
    float turn[3][3]; /* camera space before to after: a rotation */
    float distance;   /* times as far and as large */
} train_motion;

/* Pan, tilt and roll each of at most camera_turn degrees; distance within distance_jitter. */
train_motion train_motion_draw(const train_config *c, rng *r);
bool train_motion_moves(const train_motion *m);

/* Moves an unpacked sample. An object that the frame cuts off is not turned: nothing is known of what would come into
 * view. MERLIN_NO_MEMORY. */
status train_move(const train_view *v, const train_motion *m);

#endif
