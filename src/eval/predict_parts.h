/* What the files of eval/predict.h share. */
#ifndef MERLIN_EVAL_PREDICT_PARTS_H
#define MERLIN_EVAL_PREDICT_PARTS_H

#include "eval/predict.h"

struct eval_model {
    model_config config;
    nn_params *params;
    nn_graph *graph, *indirect_graph;
    nn_program *program;  /* of EVAL_LIGHTS pictures, as is */
    nn_program *indirect; /* NULL for a variant without global illumination */
    int size, views;
};

/* Copies picture i of an output; nothing if the variant lacks it. */
void eval_take(const nn_program *p, const char *name, size_t i, img *out);

/* Maps and what is rendered from them over again, from the mean of the model's views. */
status eval_predict_views(eval_model *m, const img *image, const img *mask, const eval_lighting lights[EVAL_LIGHTS],
                          eval_prediction *out);

#endif
