/* SPDX-License-Identifier: MIT */
/* The inputs of a training program of the network of near lights, object by object.
 *
 *     nfps_batch *b;
 *     status s = nfps_batch_new(program, size, pictures, objects, &b);
 *     if (s == OK) s = nfps_batch_fill(b, i, data, sample, orientation, &rng);     for each object i */
#ifndef MERLIN_LAB_TRAIN_SAMPLES_NFPS_BATCH_H
#define MERLIN_LAB_TRAIN_SAMPLES_NFPS_BATCH_H

#include "lab/train/samples/nfps_sample.h"
#include "nn/nn.h"

typedef struct nfps_batch nfps_batch;

/* Binds a program of size × size pixels, `pictures` pictures of each of its objects. MERLIN_NO_MEMORY. */
status nfps_batch_new(nn_program *program, int size, int pictures, size_t objects, nfps_batch **out);
void nfps_batch_free(nfps_batch *b);
/* Fills in object i from a sample of twice the size. Objects may be filled at the same time. Returns what
 * train_dataset_get and nfps_sample_fill do. */
status nfps_batch_fill(nfps_batch *b, size_t i, train_dataset *data, size_t sample, int orientation, rng *r);

#endif
