/* SPDX-License-Identifier: MIT */
/* What the files of network.h share. */
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
    nn_params *params;                                     /* NULL until they are asked for, */
    char *weights;                                         /* their file */
    pthread_mutex_t lock;                                  /* guards the programs, whose buffers a run uses */
    compiled lights, maps, normals, look, relit, indirect; /* lights, normals: alone; these of larger pictures */
    nn_type type;
    double compile_seconds;
};

/* A photograph as all views show it. */
typedef struct network_subject {
    const img *photo, *mask;
    const sight *how;
} network_subject;

/* Makes a program, unless it is there. outputs: as of nn_options. */
status network_compile(struct network *n, model_part part, const char *const *outputs, int size, compiled *c);
/* Takes scale·x + shift of an output of size × size pixels. */
status network_take(nn_program *p, const char *name, int size, int channels, float scale, float shift, img *out);
/* Runs the network on a photograph by its flash, in an orientation. */
status network_run_view(struct network *n, const network_subject *at, int view, const char *const *outputs,
                        compiled *c);
status network_check_views(int views);

#endif
