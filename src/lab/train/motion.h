/* SPDX-License-Identifier: MIT */
/* Other photographs of the same object that are physically as right as the rendered one: the camera turned about its
 * lens, and everything nearer or farther.
 *
 * A turned camera sees the same light along the same lines, so that its picture is the rendered one resampled; the
 * flash stays where it is. An object s times as far and s times as large covers the same pixels, and its radiance by
 * the flash is 1/s² of what it was, bounces included. A crop, in contrast, is a longer lens, which the network's camera
 * of 60 degrees is not: to it, the object would be stretched sideways, with normals that its shading contradicts.
 *
 *     trn_motion m = trn_motion_draw(config, &rng);
 *     if (trn_motion_moves(&m)) status s = trn_move(&view, &m);      between trn_dataset_get and trn_prepare */
#ifndef MERLIN_LAB_TRAIN_MOTION_H
#define MERLIN_LAB_TRAIN_MOTION_H

#include <stdbool.h>

#include "base/rng.h"
#include "lab/train/config.h"
#include "lab/train/dataset.h"

typedef struct trn_motion {
    bool turned;
    float turn[3][3]; /* camera space before to after: a rotation */
    float distance;   /* times as far and as large */
} trn_motion;

/* Pan, tilt and roll each of at most camera_turn degrees; distance within distance_jitter. */
trn_motion trn_motion_draw(const train_config *c, rng *r);
bool trn_motion_moves(const trn_motion *m);

/* Moves an unpacked sample. An object that the frame cuts off is not turned: nothing is known of what would come into
 * view. MERLIN_NO_MEMORY. */
status trn_move(const trn_view *v, const trn_motion *m);

#endif
