/* SPDX-License-Identifier: MIT */
/* Declarations shared by the files of network.h. */
#ifndef MERLIN_ESTIMATE_PHOTO_NETWORK_PARTS_H
#define MERLIN_ESTIMATE_PHOTO_NETWORK_PARTS_H

#include <pthread.h>

#include "estimate/surface/sight.h"
#include "image/image.h"
#include "model/model.h"

typedef struct compiled {
    nn_graph *graph;
    nn_program *program;
    int size;
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
/* Reads scale·x + shift of an output of size × size pixels. */
status network_take(nn_program *p, const char *name, int size, int channels, float scale, float shift, img *out);
/* Runs the network on a photograph, lit by its flash, in one orientation. */
status network_run_view(struct network *n, const network_subject *at, int view, const char *const *outputs,
                        compiled *c);
status network_check_views(int views);

#endif
