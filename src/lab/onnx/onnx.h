/* SPDX-License-Identifier: MIT */
/* Networks as ONNX models, for other runtimes.
 *
 *     const onnx_options any_size = {.name = "merlin-any", .about = "from a photograph to maps"};
 *     status s = onnx_write("maps.onnx", graph, params, &any_size);
 *
 * Inputs and outputs have the graph's names and are float32 with channels first, N × C × H × W, as ONNX has them; a
 * vector is N × C × 1 × 1. Weights that are half floats stay so, and are made float32 by the runtime as it loads. An
 * output that stands on the rendering layer, for which ONNX has no operation, is left out. Source: onnx.proto and
 * Operators.md of ONNX, operator set 13. */
#ifndef MERLIN_LAB_ONNX_ONNX_H
#define MERLIN_LAB_ONNX_ONNX_H

#include "nn/nn.h"

typedef struct onnx_options {
    const char *name;                 /* the graph's */
    const char *about;                /* description of the model for people; may be NULL */
    int size;                         /* pixels a side of the pictures, one at a time; 0: any number of any multiple of
                                       * MODEL_SIZE_MULTIPLE, whose dimensions are named "batch", "height", "width" */
    const char *const (*metadata)[2]; /* pairs of key and value that the file carries, ended by a NULL key; may be
                                       * NULL */
} onnx_options;

/* Called for each input and output that was written, in the graph's order. */
typedef struct onnx_value {
    const char *name;
    bool is_input;
    int channels, reduction; /* it is 1/reduction of the pictures' size; NN_VECTOR: 1 × 1 */
} onnx_value;
typedef void onnx_value_seen(void *context, const onnx_value *value);

/* Writes a graph with the values of its parameters, atomically. MERLIN_WRONG_USE for a graph none of whose outputs can
 * be written, and for parameters of another one. */
status onnx_write(const char *path, const nn_graph *g, nn_params *params, const onnx_options *options,
                  onnx_value_seen *seen, void *context);

#endif
