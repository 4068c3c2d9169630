/* SPDX-License-Identifier: MIT */
/* Prepares a sample for one presentation to the network of near lights (model/nfps.h).
 *
 *     status s = train_dataset_get(data, i, orientation, &view);           with targets, of twice the size
 *     if (s == OK) s = nfps_sample_fill(&view, &rng, &place);
 *
 * The first scale sees the whole object at a quarter of the sample's size; the other one a window of half of the
 * sample's size: the whole object at half the resolution, or a part of it at the full one, as finer scales see it.
 * Its normals and depth of the scale before are the true ones with errors, of all sizes up to those that a poor
 * estimate has, so that either learns without the other. */
#ifndef MERLIN_LAB_TRAIN_SAMPLES_NFPS_SAMPLE_H
#define MERLIN_LAB_TRAIN_SAMPLES_NFPS_SAMPLE_H

#include "base/rng.h"
#include "lab/train/samples/dataset.h"
#include "nfps/nfps_inputs.h"

/* One stage's inputs in the batch for one object. */
typedef struct nfps_stage_place {
    nfps_arrays in;
    float *mask, *normal, *normal_true, *loss_mask; /* normal: NULL of the first scale */
} nfps_stage_place;

typedef struct nfps_place {
    int size, pictures;               /* of the program: half of the sample's */
    nfps_stage_place first, refining; /* first: of half of the size */
} nfps_place;

/* MERLIN_BAD_INPUT if the sample has fewer targets than pictures; MERLIN_NO_MEMORY. */
status nfps_sample_fill(const train_view *v, rng *r, const nfps_place *place);

#endif
