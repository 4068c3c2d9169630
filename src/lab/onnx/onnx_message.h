/* SPDX-License-Identifier: MIT */
/* The messages that an ONNX model consists of (onnx.proto): tensors, nodes with their attributes, shapes of values. */
#ifndef MERLIN_LAB_ONNX_ONNX_MESSAGE_H
#define MERLIN_LAB_ONNX_ONNX_MESSAGE_H

#include "lab/onnx/protobuf.h"

/* Numbers of a graph's fields, to which the messages are added. */
enum { ONNX_GRAPH_NODE = 1, ONNX_GRAPH_NAME = 2, ONNX_GRAPH_TENSOR = 5, ONNX_GRAPH_INPUT = 11, ONNX_GRAPH_OUTPUT = 12 };

typedef enum onnx_type { ONNX_FLOAT = 1, ONNX_INT64 = 7, ONNX_FLOAT16 = 10 } onnx_type;

enum { ONNX_NAME = 192, ONNX_MOST_RANK = 4 };

typedef struct onnx_tensor {
    const char *name;
    onnx_type type;
    int rank; /* 0: a single number */
    int64_t shape[ONNX_MOST_RANK];
    const void *data; /* little-endian */
} onnx_tensor;

/* Adds a constant to a graph. */
void onnx_put_tensor(protobuf *graph, const onnx_tensor *tensor);

/* Begins a node; inputs, in their order, and attributes are then added. */
protobuf onnx_node(const char *operation, const char *output);
void onnx_put_input(protobuf *node, const char *name);
void onnx_put_integer(protobuf *node, const char *attribute, int64_t value);
void onnx_put_integers(protobuf *node, const char *attribute, int count, const int64_t *values);
void onnx_put_float(protobuf *node, const char *attribute, float value);
void onnx_put_text(protobuf *node, const char *attribute, const char *value);

/* A dimension of a value's shape: a number, or a name for one that is not known before. */
typedef struct onnx_dimension {
    const char *name; /* NULL: by number */
    int64_t number;
} onnx_dimension;

/* Declares a float32 value of rank 4 as an input or output of a graph, by the field's number. */
void onnx_put_value(protobuf *graph, int field, const char *name, const onnx_dimension shape[4]);

/* Composes the whole model around a graph, which it takes over. metadata as of onnx_options. */
protobuf onnx_model(protobuf *graph, const char *about, const char *const (*metadata)[2]);

#endif
