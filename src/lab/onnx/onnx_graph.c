/* SPDX-License-Identifier: MIT */
#include "lab/onnx/onnx_graph.h"

#include <stdio.h>
#include <string.h>

#include "nn/params.h"

/* Constants of nn.h: what batch norm adds to a variance, and the length below which a vector is not normalized. */
static const float norm_epsilon = 1e-5f, least_length = 1e-6f;

/* Tells whether an operation only converts numbers, which is left to the runtime. */
static bool is_conversion(nn_op op)
{
    return op == OP_COMPUTE || op == OP_FLOAT;
}

const char *onnx_value_name(const nn_node *x, char name[ONNX_NAME])
{
    while (is_conversion(x->op))
        x = x->in[0];
    if (x->op == OP_INPUT)
        snprintf(name, ONNX_NAME, "%s", x->name);
    else
        snprintf(name, ONNX_NAME, "v%d", x->index);
    return name;
}

/* Composes the name of what belongs to a node alone, such as "v7.scale", and returns it. */
static const char *step_name(const nn_node *x, const char *what, char whole[ONNX_NAME + 16])
{
    char name[ONNX_NAME];
    snprintf(whole, ONNX_NAME + 16, "%s.%s", onnx_value_name(x, name), what);
    return whole;
}

/* ---- constants ---- */

/* Adds a constant as a node's next input: "v7.scale". */
static void put_constant(onnx_graph *g, protobuf *node, const nn_node *x, const char *what, const onnx_tensor *values)
{
    char whole[ONNX_NAME + 16];
    onnx_tensor named = *values;
    named.name = step_name(x, what, whole);
    onnx_put_tensor(&g->message, &named);
    onnx_put_input(node, whole);
}

static void put_floats(onnx_graph *g, protobuf *node, const nn_node *x, const char *what, int count,
                       const float *values)
{
    put_constant(g, node, x, what, &(onnx_tensor){.type = ONNX_FLOAT, .rank = 1, .shape = {count}, .data = values});
}

static void put_int64s(onnx_graph *g, protobuf *node, const nn_node *x, const char *what, int count,
                       const int64_t *values)
{
    put_constant(g, node, x, what, &(onnx_tensor){.type = ONNX_INT64, .rank = 1, .shape = {count}, .data = values});
}

/* Adds a parameter; if it is stored as half floats, these are the constant, and a node converts them. */
static void write_parameter(onnx_graph *g, const nn_param *p)
{
    char half_name[ONNX_NAME + 8];
    onnx_tensor t = {.name = p->name, .type = ONNX_FLOAT, .rank = p->rank, .data = p->value};
    memcpy(t.shape, p->shape, sizeof t.shape);
    if (p->rank == 2) { /* fully connected: a convolution of one pixel */
        t.rank = 4;
        t.shape[2] = t.shape[3] = 1;
    }
    if (!p->half) {
        onnx_put_tensor(&g->message, &t);
        return;
    }
    snprintf(half_name, sizeof half_name, "%s.half", p->name);
    t.name = half_name;
    t.type = ONNX_FLOAT16;
    t.data = p->half;
    onnx_put_tensor(&g->message, &t);
    protobuf cast = onnx_node("Cast", p->name);
    onnx_put_input(&cast, half_name);
    onnx_put_integer(&cast, "to", ONNX_FLOAT);
    protobuf_message(&g->message, ONNX_GRAPH_NODE, &cast);
}

static void put_parameter(onnx_graph *g, protobuf *node, const nn_param *p)
{
    bool *written = &g->written[p - nn_params_at(g->params, 0)];
    if (!*written) write_parameter(g, p);
    *written = true;
    onnx_put_input(node, p->name);
}

/* ---- nodes ---- */

static void add(onnx_graph *g, protobuf *node)
{
    protobuf_message(&g->message, ONNX_GRAPH_NODE, node);
}

/* Begins a node with the inputs of x. */
static protobuf begin(const nn_node *x, const char *operation)
{
    char name[ONNX_NAME];
    protobuf node = onnx_node(operation, onnx_value_name(x, name));
    for (int i = 0; i < x->inputs; i++)
        onnx_put_input(&node, onnx_value_name(x->in[i], name));
    return node;
}

/* Begins an intermediate node of x, whose value is called "v7.what", with one input, from. */
static protobuf begin_step(const nn_node *x, const char *operation, const char *what, const char *from)
{
    char whole[ONNX_NAME + 16];
    protobuf node = onnx_node(operation, step_name(x, what, whole));
    onnx_put_input(&node, from);
    return node;
}

static void put_plain(onnx_graph *g, const nn_node *x)
{
    static const char *const names[OP_COUNT] = {
        [OP_RELU] = "Relu", [OP_TANH] = "Tanh", [OP_SIGMOID] = "Sigmoid",
        [OP_ADD] = "Add",   [OP_GATE] = "Mul",  [OP_SPATIAL_MEAN] = "GlobalAveragePool",
    };
    protobuf node = begin(x, names[x->op]);
    add(g, &node);
}

/* Finds a node's parameters; returns false, and notes the error, if they are another network's. */
static bool find_params(onnx_graph *g, const nn_node *x, node_params *of)
{
    g->error = params_of_node(g->params, x, of);
    return g->error == OK;
}

static void put_conv(onnx_graph *g, const nn_node *x)
{
    node_params of;
    if (!find_params(g, x, &of)) return;
    protobuf node = begin(x, "Conv");
    put_parameter(g, &node, of.weight);
    if (of.bias) put_parameter(g, &node, of.bias);
    const int64_t kernel = x->at.kernel, stride = x->at.stride, dilation = x->at.dilation;
    const int64_t wide = (kernel - 1) * dilation + 1, before = (wide - 1) / 2, rest = wide - stride - before;
    const int64_t behind = rest > 0 ? rest : 0;
    onnx_put_integers(&node, "kernel_shape", 2, (const int64_t[]){kernel, kernel});
    onnx_put_integers(&node, "strides", 2, (const int64_t[]){stride, stride});
    if (dilation > 1) onnx_put_integers(&node, "dilations", 2, (const int64_t[]){dilation, dilation});
    onnx_put_integers(&node, "pads", 4, (const int64_t[]){before, before, behind, behind});
    add(g, &node);
}

static void put_conv_transposed(onnx_graph *g, const nn_node *x)
{
    node_params of;
    if (!find_params(g, x, &of)) return;
    protobuf node = begin(x, "ConvTranspose");
    put_parameter(g, &node, of.weight);
    const int64_t kernel = x->at.kernel, stride = x->at.stride, around = (kernel - stride) / 2;
    onnx_put_integers(&node, "kernel_shape", 2, (const int64_t[]){kernel, kernel});
    onnx_put_integers(&node, "strides", 2, (const int64_t[]){stride, stride});
    onnx_put_integers(&node, "pads", 4, (const int64_t[]){around, around, around, around});
    add(g, &node);
}

static void put_norm(onnx_graph *g, const nn_node *x)
{
    node_params of;
    if (!find_params(g, x, &of)) return;
    protobuf node = begin(x, "BatchNormalization");
    put_parameter(g, &node, of.weight);
    put_parameter(g, &node, of.bias);
    put_parameter(g, &node, of.running_mean);
    put_parameter(g, &node, of.running_var);
    onnx_put_float(&node, "epsilon", norm_epsilon);
    add(g, &node);
}

static void put_with_integer(onnx_graph *g, const nn_node *x, const char *operation, const char *name, int64_t value)
{
    protobuf node = begin(x, operation);
    onnx_put_integer(&node, name, value);
    add(g, &node);
}

static void put_concat(onnx_graph *g, const nn_node *x)
{
    put_with_integer(g, x, "Concat", "axis", 1);
}

static void put_space_to_depth(onnx_graph *g, const nn_node *x)
{
    put_with_integer(g, x, "SpaceToDepth", "blocksize", x->at.block);
}

static void put_depth_to_space(onnx_graph *g, const nn_node *x)
{
    put_with_integer(g, x, "DepthToSpace", "blocksize", x->at.block);
}

static void put_slice(onnx_graph *g, const nn_node *x)
{
    protobuf node = begin(x, "Slice");
    put_int64s(g, &node, x, "first", 1, (const int64_t[]){x->at.first});
    put_int64s(g, &node, x, "end", 1, (const int64_t[]){x->at.first + x->channels});
    put_int64s(g, &node, x, "axis", 1, (const int64_t[]){1});
    add(g, &node);
}

static void put_upsample(onnx_graph *g, const nn_node *x)
{
    protobuf node = begin(x, "Resize");
    onnx_put_input(&node, ""); /* no region of interest */
    put_floats(g, &node, x, "factors", 4, (const float[]){1, 1, 2, 2});
    onnx_put_text(&node, "mode", "linear");
    onnx_put_text(&node, "coordinate_transformation_mode", "half_pixel");
    add(g, &node);
}

/* Computes scale·x + shift under this name. */
static void put_affine(onnx_graph *g, const nn_node *x, const char *name)
{
    char from[ONNX_NAME], scaled[ONNX_NAME + 16];
    protobuf product = begin_step(x, "Mul", "scaled", onnx_value_name(x->in[0], from));
    put_floats(g, &product, x, "scale", 1, &x->at.scale);
    add(g, &product);
    protobuf sum = onnx_node("Add", name);
    onnx_put_input(&sum, step_name(x, "scaled", scaled));
    put_floats(g, &sum, x, "shift", 1, &x->at.shift);
    add(g, &sum);
}

static void put_scale_shift(onnx_graph *g, const nn_node *x)
{
    char name[ONNX_NAME];
    put_affine(g, x, onnx_value_name(x, name));
}

static void put_reciprocal(onnx_graph *g, const nn_node *x)
{
    char name[ONNX_NAME], below[ONNX_NAME + 16];
    put_affine(g, x, step_name(x, "below", below));
    protobuf node = onnx_node("Reciprocal", onnx_value_name(x, name));
    onnx_put_input(&node, below);
    add(g, &node);
}

static void put_normalize(onnx_graph *g, const nn_node *x)
{
    char from[ONNX_NAME], length[ONNX_NAME + 16], divisor[ONNX_NAME + 16];
    protobuf norm = begin_step(x, "ReduceL2", "length", onnx_value_name(x->in[0], from));
    onnx_put_integers(&norm, "axes", 1, (const int64_t[]){1});
    add(g, &norm);
    protobuf most = begin_step(x, "Max", "divisor", step_name(x, "length", length));
    put_floats(g, &most, x, "least", 1, &least_length);
    add(g, &most);
    protobuf node = begin(x, "Div");
    onnx_put_input(&node, step_name(x, "divisor", divisor));
    add(g, &node);
}

/* Returns an input of the network that has the pictures' size, or a part of it. */
static const nn_node *any_picture(const nn_graph *g)
{
    for (int i = 0; i < g->count; i++)
        if (g->nodes[i]->op == OP_INPUT && g->nodes[i]->reduction != NN_VECTOR) return g->nodes[i];
    return NULL;
}

/* Computes the shape 1 × 1 × H/reduction × W/reduction from an input's, and gives it to a node. */
static void put_shape(onnx_graph *g, protobuf *node, const nn_node *x)
{
    const nn_node *like = any_picture(g->source);
    char from[ONNX_NAME], whole[ONNX_NAME + 16];
    if (!like) {
        g->error = fail(MERLIN_WRONG_USE, "a network without pictures has no size");
        return;
    }
    protobuf shape = begin_step(x, "Shape", "like", onnx_value_name(like, from));
    add(g, &shape);
    protobuf sides = begin_step(x, "Slice", "sides", step_name(x, "like", whole));
    put_int64s(g, &sides, x, "two", 1, (const int64_t[]){2});
    put_int64s(g, &sides, x, "four", 1, (const int64_t[]){4});
    add(g, &sides);
    protobuf whole_sides = begin_step(x, "Mul", "whole", step_name(x, "sides", whole));
    put_int64s(g, &whole_sides, x, "times", 1, (const int64_t[]){like->reduction});
    add(g, &whole_sides);
    protobuf part = begin_step(x, "Div", "part", step_name(x, "whole", whole));
    put_int64s(g, &part, x, "by", 1, (const int64_t[]){x->reduction});
    add(g, &part);
    protobuf all = onnx_node("Concat", step_name(x, "shape", whole));
    put_int64s(g, &all, x, "ones", 2, (const int64_t[]){1, 1});
    onnx_put_input(&all, step_name(x, "part", whole));
    onnx_put_integer(&all, "axis", 0);
    add(g, &all);
    onnx_put_input(node, step_name(x, "shape", whole));
}

static void put_tile(onnx_graph *g, const nn_node *x)
{
    protobuf node = begin(x, "Expand");
    if (g->size == 0)
        put_shape(g, &node, x);
    else
        put_int64s(g, &node, x, "shape", 4,
                   (const int64_t[]){1, x->channels, g->size / x->reduction, g->size / x->reduction});
    add(g, &node);
}

typedef void put_operation(onnx_graph *g, const nn_node *x);

static void put_nothing(onnx_graph *g, const nn_node *x)
{
    (void)g;
    (void)x;
}

/* Functions that add the counterparts of operations; the rendering layer, its environment and losses have none. */
static put_operation *const counterpart[OP_COUNT] = {
    [OP_INPUT] = put_nothing,
    [OP_COMPUTE] = put_nothing,
    [OP_FLOAT] = put_nothing,
    [OP_CONV] = put_conv,
    [OP_CONV_TRANSPOSED] = put_conv_transposed,
    [OP_LINEAR] = put_conv,
    [OP_NORM] = put_norm,
    [OP_RELU] = put_plain,
    [OP_TANH] = put_plain,
    [OP_SIGMOID] = put_plain,
    [OP_CONCAT] = put_concat,
    [OP_SLICE] = put_slice,
    [OP_ADD] = put_plain,
    [OP_GATE] = put_plain,
    [OP_SCALE_SHIFT] = put_scale_shift,
    [OP_UPSAMPLE_BILINEAR] = put_upsample,
    [OP_TILE] = put_tile,
    [OP_SPACE_TO_DEPTH] = put_space_to_depth,
    [OP_DEPTH_TO_SPACE] = put_depth_to_space,
    [OP_SPATIAL_MEAN] = put_plain,
    [OP_NORMALIZE] = put_normalize,
    [OP_RECIPROCAL] = put_reciprocal,
};

bool onnx_knows(nn_op op)
{
    return counterpart[op] != NULL;
}

void onnx_put_node(onnx_graph *g, const nn_node *x)
{
    if (g->error == OK) counterpart[x->op](g, x);
}
