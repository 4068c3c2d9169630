/* SPDX-License-Identifier: MIT */
/* The programs that a run trains with: one, or for a model of several pictures one for each number of pictures that an
 * object may have. All have the same batch of pictures and share their memory. */
#ifndef MERLIN_LAB_TRAIN_TRAIN_PROGRAMS_H
#define MERLIN_LAB_TRAIN_TRAIN_PROGRAMS_H

#include "lab/train/samples/loader.h"
#include "nn/nn.h"

enum { TRAIN_PROGRAMS = 16 };

typedef struct train_program {
    nn_program *program;
    train_loader *loader;
} train_program;

typedef struct train_programs {
    train_program at[TRAIN_PROGRAMS]; /* by number of pictures, ascending */
    int count;
} train_programs;

/* Compiles them for numbers of pictures up to `most` that divide the batch and leave two objects in it; source.pictures
 * is ignored. MERLIN_NO_MEMORY, and what nn_compile returns. */
status train_programs_new(const nn_graph *g, nn_params *params, const nn_options *options, const train_source *source,
                          int most, train_programs *out);
void train_programs_free(train_programs *programs);
/* Returns the program of a step, the same on all ranks. */
const train_program *train_programs_at(const train_programs *programs, uint64_t seed, uint64_t step);

#endif
