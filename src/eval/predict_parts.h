/* What the files of eval/predict.h share. */
#ifndef MERLIN_EVAL_PREDICT_PARTS_H
#define MERLIN_EVAL_PREDICT_PARTS_H

#include "eval/predict.h"

typedef struct eval_program {
    nn_graph *graph;
    nn_program *program;
} eval_program;

struct eval_model {
    model_config config;
    nn_params *params;
    eval_program maps;     /* of one picture */
    eval_program relit;    /* of EVAL_LIGHTS; empty where nothing is relit by the network */
    eval_program indirect; /* of EVAL_LIGHTS; empty for a variant without global illumination */
    int size, views;
};

/* A picture and its mask into slot i. */
void eval_put_picture(nn_program *p, const img *image, const img *mask, size_t i);
/* Copies picture i of an output; nothing if there is no such output. */
void eval_take(const nn_program *p, const char *name, size_t i, img *out);

/* The network's bounces for four pictures of bounce 1, given the maps: borrowed until the next call; NULL for a variant
 * without. ambient: an environment's part of them, for all four, or NULL. */
status eval_run_indirect(eval_model *m, const eval_maps *maps, const img *mask, const img direct[EVAL_LIGHTS],
                         const img *ambient, const float **indirect);

/* The maps lit by the training data's lamp and camera; what out held before is freed. */
status eval_show(const eval_maps *maps, const img *mask, const eval_lighting *lighting, img *out);

#endif
