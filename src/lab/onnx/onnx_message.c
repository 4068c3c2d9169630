/* SPDX-License-Identifier: MIT */
#include "lab/onnx/onnx_message.h"

#include "merlin/status.h"

/* Numbers of the other messages' fields, and of an attribute's kinds. */
enum { MODEL_VERSION = 1, MODEL_PRODUCER = 2, MODEL_PRODUCER_VERSION = 3, MODEL_ABOUT = 6, MODEL_GRAPH = 7 };
enum { MODEL_OPERATORS = 8, MODEL_METADATA = 14 };
enum { OPERATORS_VERSION = 2, PAIR_KEY = 1, PAIR_VALUE = 2 };
enum { NODE_INPUT = 1, NODE_OUTPUT = 2, NODE_NAME = 3, NODE_OPERATION = 4, NODE_ATTRIBUTE = 5 };
enum { ATTRIBUTE_NAME = 1, ATTRIBUTE_FLOAT = 2, ATTRIBUTE_INTEGER = 3, ATTRIBUTE_TEXT = 4, ATTRIBUTE_INTEGERS = 8 };
enum { ATTRIBUTE_KIND = 20, KIND_FLOAT = 1, KIND_INTEGER = 2, KIND_TEXT = 3, KIND_INTEGERS = 7 };
enum { TENSOR_SHAPE = 1, TENSOR_TYPE = 2, TENSOR_NAME = 8, TENSOR_DATA = 9 };
enum { VALUE_NAME = 1, VALUE_TYPE = 2, TYPE_TENSOR = 1, TYPE_ELEMENT = 1, TYPE_SHAPE = 2 };
enum { SHAPE_DIMENSION = 1, DIMENSION_NUMBER = 1, DIMENSION_NAME = 2 };
/* The format of November 2020, with its set of operators: what every runtime since reads. */
enum { FORMAT_VERSION = 7, OPERATOR_SET = 13 };

static size_t type_size(onnx_type type)
{
    return type == ONNX_FLOAT16 ? 2 : type == ONNX_FLOAT ? 4 : 8;
}

void onnx_put_tensor(protobuf *graph, const onnx_tensor *tensor)
{
    protobuf t = {0};
    size_t size = type_size(tensor->type);
    for (int i = 0; i < tensor->rank; i++) {
        protobuf_integer(&t, TENSOR_SHAPE, tensor->shape[i]);
        size *= (size_t)tensor->shape[i];
    }
    protobuf_integer(&t, TENSOR_TYPE, tensor->type);
    protobuf_text(&t, TENSOR_NAME, tensor->name);
    protobuf_bytes(&t, TENSOR_DATA, tensor->data, size);
    protobuf_message(graph, ONNX_GRAPH_TENSOR, &t);
}

protobuf onnx_node(const char *operation, const char *output)
{
    protobuf node = {0};
    protobuf_text(&node, NODE_OPERATION, operation);
    protobuf_text(&node, NODE_OUTPUT, output);
    protobuf_text(&node, NODE_NAME, output);
    return node;
}

void onnx_put_input(protobuf *node, const char *name)
{
    protobuf_text(node, NODE_INPUT, name);
}

static protobuf attribute_begin(const char *name, int kind)
{
    protobuf a = {0};
    protobuf_text(&a, ATTRIBUTE_NAME, name);
    protobuf_integer(&a, ATTRIBUTE_KIND, kind);
    return a;
}

void onnx_put_integer(protobuf *node, const char *attribute, int64_t value)
{
    protobuf a = attribute_begin(attribute, KIND_INTEGER);
    protobuf_integer(&a, ATTRIBUTE_INTEGER, value);
    protobuf_message(node, NODE_ATTRIBUTE, &a);
}

void onnx_put_integers(protobuf *node, const char *attribute, int count, const int64_t *values)
{
    protobuf a = attribute_begin(attribute, KIND_INTEGERS);
    for (int i = 0; i < count; i++)
        protobuf_integer(&a, ATTRIBUTE_INTEGERS, values[i]);
    protobuf_message(node, NODE_ATTRIBUTE, &a);
}

void onnx_put_float(protobuf *node, const char *attribute, float value)
{
    protobuf a = attribute_begin(attribute, KIND_FLOAT);
    protobuf_float(&a, ATTRIBUTE_FLOAT, value);
    protobuf_message(node, NODE_ATTRIBUTE, &a);
}

void onnx_put_text(protobuf *node, const char *attribute, const char *value)
{
    protobuf a = attribute_begin(attribute, KIND_TEXT);
    protobuf_text(&a, ATTRIBUTE_TEXT, value);
    protobuf_message(node, NODE_ATTRIBUTE, &a);
}

void onnx_put_value(protobuf *graph, int field, const char *name, const onnx_dimension shape[4])
{
    protobuf dimensions = {0}, tensor = {0}, type = {0}, value = {0};
    for (int i = 0; i < 4; i++) {
        protobuf dimension = {0};
        if (shape[i].name)
            protobuf_text(&dimension, DIMENSION_NAME, shape[i].name);
        else
            protobuf_integer(&dimension, DIMENSION_NUMBER, shape[i].number);
        protobuf_message(&dimensions, SHAPE_DIMENSION, &dimension);
    }
    protobuf_integer(&tensor, TYPE_ELEMENT, ONNX_FLOAT);
    protobuf_message(&tensor, TYPE_SHAPE, &dimensions);
    protobuf_message(&type, TYPE_TENSOR, &tensor);
    protobuf_text(&value, VALUE_NAME, name);
    protobuf_message(&value, VALUE_TYPE, &type);
    protobuf_message(graph, field, &value);
}

protobuf onnx_model(protobuf *graph, const char *about, const char *const (*metadata)[2])
{
    protobuf model = {0}, operators = {0};
    protobuf_integer(&model, MODEL_VERSION, FORMAT_VERSION);
    protobuf_text(&model, MODEL_PRODUCER, "merlin");
    protobuf_text(&model, MODEL_PRODUCER_VERSION, merlin_version());
    if (about) protobuf_text(&model, MODEL_ABOUT, about);
    protobuf_message(&model, MODEL_GRAPH, graph);
    protobuf_integer(&operators, OPERATORS_VERSION, OPERATOR_SET);
    protobuf_message(&model, MODEL_OPERATORS, &operators);
    for (; metadata && (*metadata)[0]; metadata++) {
        protobuf pair = {0};
        protobuf_text(&pair, PAIR_KEY, (*metadata)[0]);
        protobuf_text(&pair, PAIR_VALUE, (*metadata)[1]);
        protobuf_message(&model, MODEL_METADATA, &pair);
    }
    return model;
}
