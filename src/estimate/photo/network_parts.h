/* SPDX-License-Identifier: MIT */
/* Declarations shared by the files of network.h. */
#ifndef MERLIN_ESTIMATE_PHOTO_NETWORK_PARTS_H
#define MERLIN_ESTIMATE_PHOTO_NETWORK_PARTS_H

#include <pthread.h>

#include "estimate/surface/estimation.h"
#include "estimate/surface/sight.h"
#include "image/image.h"
#include "model/model.h"

typedef struct compiled {
    nn_graph *graph;
    nn_program *program;
    int size, pictures;
    const char *const *outputs;
} compiled;

struct network {
    model_config config;
    nn_params *params;    /* parameters; NULL until they are needed */
    char *weights;        /* path of their file */
    pthread_mutex_t lock; /* guards the programs, whose buffers a run uses */
    compiled lights, maps, normals, features, relit,
        indirect; /* lights and normals: programs with only these outputs; normals for larger pictures */
    nn_type type;
    double compile_seconds;
};

/* A photograph, the same for all views. */
typedef struct network_subject {
    const img *photo, *mask;
    const sight *how;
} network_subject;

/* Compiles a program, unless that is done. outputs: as of nn_options. */
status network_compile(struct network *n, model_part part, const char *const *outputs, int size, compiled *c);
/* Compiles one for several pictures of an object (model.h, "several"). */
status network_compile_several(struct network *n, const char *const *outputs, int size, int pictures, compiled *c);
/* Reads maps, lights and visibility of a program of MODEL_MAPS; of several pictures, those of the first. */
status network_take_estimation(nn_program *p, int size, network_estimation *out);
/* Does what network_estimate does after the network. */
status network_finish(const struct network *n, surface *maps);
/* Reads scale·x + shift of an output of size × size pixels. */
status network_take(nn_program *p, const char *name, int size, int channels, float scale, float shift, img *out);
/* Runs the network on a photograph, lit by its flash, in one orientation. */
status network_run_view(struct network *n, const network_subject *at, int view, const char *const *outputs,
                        compiled *c);
status network_check_views(int views);

#endif
