/* SPDX-License-Identifier: MIT */
/* What the files of eval/predict.h share. */
#ifndef MERLIN_LAB_EVAL_PREDICT_PARTS_H
#define MERLIN_LAB_EVAL_PREDICT_PARTS_H

#include "lab/eval/maps.h"
#include "model/model.h"
#include "optics/light.h"

typedef struct eval_program {
    nn_graph *graph;
    nn_program *program;
} eval_program;

struct eval_model {
    model_config config;
    nn_params *params;
    eval_program maps;          /* of one picture */
    eval_program relit;         /* the decoder, of EVAL_LIGHTS; empty where nothing is relit by the network */
    eval_program mean_indirect; /* of one picture, the mean of several views; empty for one view */
    eval_program indirect;      /* of EVAL_LIGHTS; both empty for a variant without global illumination */
    int size, views;
};

/* Copies picture i of an output; nothing if there is no such output. */
void eval_take(const nn_program *p, const char *name, size_t i, img *out);

/* Picture `slot` of a program of MODEL_INDIRECT: its bounce 1, and an environment's part of that or NULL. */
void eval_put_bounce(nn_program *p, size_t slot, const eval_maps *maps, const img *mask, const img *direct,
                     const img *ambient);

/* The maps lit by the training data's lamp and camera; what out held before is freed. */
status eval_show(const eval_maps *maps, const img *mask, const illumination *light, img *out);

#endif
