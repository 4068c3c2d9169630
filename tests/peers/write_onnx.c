/* SPDX-License-Identifier: MIT */
/* Writes the network of a weights file as an ONNX model, with an input and what this project makes of it, and how long
 * that takes, to be held against another engine (tools/compare-onnxruntime).
 *
 *     write_onnx WEIGHTS SIDE FOLDER      network.onnx; tensors.txt, "in|out NAME N C H W" a line; and of all inputs
 *                                         and outputs NAME.in and NAME.out, float32 with channels first, as ONNX has
 *     write_onnx WEIGHTS SIDE             milliseconds of the best and the median of 20 runs in float32
 */
#include <stdio.h>

#include "base/half.h"
#include "base/progress.h"
#include "base/rng.h"
#include "estimate/photo/view.h"
#include "model/model.h"
#include "nn/graph.h"
#include "protobuf.h"

enum { RUNS = 20, OPSET = 13, ONNX_FLOAT = 1, ONNX_INT64 = 7 };
/* Fields of ONNX's messages (onnx.proto). */
enum { MODEL_VERSION = 1, MODEL_GRAPH = 7, MODEL_OPSET = 8 };
enum { GRAPH_NODE = 1, GRAPH_NAME = 2, GRAPH_TENSOR = 5, GRAPH_INPUT = 11, GRAPH_OUTPUT = 12 };
enum { NODE_INPUT = 1, NODE_OUTPUT = 2, NODE_TYPE = 4, NODE_ATTRIBUTE = 5 };
enum {
    ATTRIBUTE_NAME = 1,
    ATTRIBUTE_FLOAT = 2,
    ATTRIBUTE_INT = 3,
    ATTRIBUTE_TEXT = 4,
    ATTRIBUTE_INTS = 8,
    ATTRIBUTE_TYPE = 20
};
enum { TENSOR_SHAPE = 1, TENSOR_TYPE = 2, TENSOR_NAME = 8, TENSOR_DATA = 9 };

typedef struct writer {
    pb graph;
    nn_params *params;
    int side, extra; /* extra: constants so far */
} writer;

/* ---- messages ---- */

static void put_tensor(pb *graph, const char *name, int type, const int64_t *shape, int rank, const void *data,
                       size_t size)
{
    pb t = {0};
    for (int i = 0; i < rank; i++)
        pb_integer(&t, TENSOR_SHAPE, shape[i]);
    pb_integer(&t, TENSOR_TYPE, type);
    pb_text(&t, TENSOR_NAME, name);
    pb_bytes(&t, TENSOR_DATA, data, size);
    pb_message(graph, GRAPH_TENSOR, &t);
}

static void put_value(pb *graph, int field, const char *name, const int shape[4])
{
    pb dims = {0}, tensor = {0}, type = {0}, value = {0};
    for (int i = 0; i < 4; i++) {
        pb dim = {0};
        pb_integer(&dim, 1, shape[i]);
        pb_message(&dims, 1, &dim);
    }
    pb_integer(&tensor, 1, ONNX_FLOAT);
    pb_message(&tensor, 2, &dims);
    pb_message(&type, 1, &tensor);
    pb_text(&value, 1, name);
    pb_message(&value, 2, &type);
    pb_message(graph, field, &value);
}

static void put_integer(pb *node, const char *name, int64_t value)
{
    pb a = {0};
    pb_text(&a, ATTRIBUTE_NAME, name);
    pb_integer(&a, ATTRIBUTE_INT, value);
    pb_integer(&a, ATTRIBUTE_TYPE, 2);
    pb_message(node, NODE_ATTRIBUTE, &a);
}

static void put_integers(pb *node, const char *name, const int64_t *values, int count)
{
    pb a = {0};
    pb_text(&a, ATTRIBUTE_NAME, name);
    for (int i = 0; i < count; i++)
        pb_integer(&a, ATTRIBUTE_INTS, values[i]);
    pb_integer(&a, ATTRIBUTE_TYPE, 7);
    pb_message(node, NODE_ATTRIBUTE, &a);
}

static void put_text(pb *node, const char *name, const char *value)
{
    pb a = {0};
    pb_text(&a, ATTRIBUTE_NAME, name);
    pb_text(&a, ATTRIBUTE_TEXT, value);
    pb_integer(&a, ATTRIBUTE_TYPE, 3);
    pb_message(node, NODE_ATTRIBUTE, &a);
}

/* ---- nodes ---- */

static const char *value_name(const nn_node *x, char name[32])
{
    snprintf(name, 32, "v%d", x->index);
    return name;
}

static pb node_begin(const nn_node *x, const char *type)
{
    pb node = {0};
    char name[32];
    pb_text(&node, NODE_TYPE, type);
    pb_text(&node, NODE_OUTPUT, value_name(x, name));
    for (int i = 0; i < x->inputs; i++)
        pb_text(&node, NODE_INPUT, value_name(x->in[i], name));
    return node;
}

static void add_constant(writer *w, pb *node, int type, const int64_t *shape, int rank, const void *data, size_t size)
{
    char name[32];
    snprintf(name, sizeof name, "c%d", w->extra++);
    put_tensor(&w->graph, name, type, shape, rank, data, size);
    pb_text(node, NODE_INPUT, name);
}

/* Adds a parameter, in float32; rank 0: its own shape. */
static void add_parameter(writer *w, pb *node, const char *of, const char *part, int rank)
{
    char name[160];
    snprintf(name, sizeof name, "%s.%s", of, part);
    const nn_param *p = nn_params_find(w->params, name);
    if (!p) abort();
    float *values = malloc(p->count * sizeof *values);
    for (size_t i = 0; i < p->count; i++)
        values[i] = p->value ? p->value[i] : half_to_float(p->half[i]);
    int64_t shape[4] = {1, 1, 1, 1};
    for (int i = 0; i < p->rank; i++)
        shape[i] = p->shape[i];
    put_tensor(&w->graph, name, ONNX_FLOAT, shape, rank ? rank : p->rank, values, p->count * sizeof *values);
    pb_text(node, NODE_INPUT, name);
    free(values);
}

static int height(const writer *w, const nn_node *x)
{
    return x->reduction ? w->side / x->reduction : 1;
}

static pb conv(writer *w, const nn_node *x)
{
    pb node = node_begin(x, "Conv");
    int k = x->op == OP_CONV ? x->at.kernel : 1, stride = x->op == OP_CONV ? x->at.stride : 1, before = (k - 1) / 2;
    int behind = k - stride - before > 0 ? k - stride - before : 0;
    const int64_t kernel[2] = {k, k}, strides[2] = {stride, stride};
    const int64_t pads[4] = {before, before, behind, behind};
    add_parameter(w, &node, x->name, "weight", 4);
    if (x->op == OP_LINEAR || x->at.bias) add_parameter(w, &node, x->name, "bias", 0);
    put_integers(&node, "kernel_shape", kernel, 2);
    put_integers(&node, "strides", strides, 2);
    put_integers(&node, "pads", pads, 4);
    return node;
}

static pb norm(writer *w, const nn_node *x)
{
    pb node = node_begin(x, "BatchNormalization");
    static const char *const parts[] = {"weight", "bias", "running_mean", "running_var"};
    for (int i = 0; i < 4; i++)
        add_parameter(w, &node, x->name, parts[i], 0);
    return node;
}

static pb slice(writer *w, const nn_node *x)
{
    pb node = node_begin(x, "Slice");
    const int64_t first = x->at.first, end = x->at.first + x->channels, axis = 1, one[1] = {1};
    add_constant(w, &node, ONNX_INT64, one, 1, &first, sizeof first);
    add_constant(w, &node, ONNX_INT64, one, 1, &end, sizeof end);
    add_constant(w, &node, ONNX_INT64, one, 1, &axis, sizeof axis);
    return node;
}

static pb upsample(writer *w, const nn_node *x)
{
    pb node = node_begin(x, "Resize");
    const float scales[4] = {1, 1, 2, 2};
    pb_text(&node, NODE_INPUT, ""); /* no region of interest */
    add_constant(w, &node, ONNX_FLOAT, (const int64_t[]){4}, 1, scales, sizeof scales);
    put_text(&node, "mode", "linear");
    put_text(&node, "coordinate_transformation_mode", "half_pixel");
    return node;
}

static pb tile(writer *w, const nn_node *x)
{
    pb node = {0};
    char name[32];
    const int64_t shape[4] = {1, x->channels, height(w, x), height(w, x)};
    pb_text(&node, NODE_TYPE, "Expand");
    pb_text(&node, NODE_OUTPUT, value_name(x, name));
    pb_text(&node, NODE_INPUT, value_name(x->in[0], name));
    add_constant(w, &node, ONNX_INT64, (const int64_t[]){4}, 1, shape, sizeof shape);
    return node;
}

/* scale·x + shift, under another name. */
static void put_affine(writer *w, const nn_node *x, const char *name)
{
    char product[40], from[32];
    pb mul = {0}, add = {0};
    snprintf(product, sizeof product, "%s.scaled", name);
    pb_text(&mul, NODE_TYPE, "Mul");
    pb_text(&mul, NODE_OUTPUT, product);
    pb_text(&mul, NODE_INPUT, value_name(x->in[0], from));
    add_constant(w, &mul, ONNX_FLOAT, NULL, 0, &x->at.scale, sizeof x->at.scale);
    pb_message(&w->graph, GRAPH_NODE, &mul);
    pb_text(&add, NODE_TYPE, "Add");
    pb_text(&add, NODE_OUTPUT, name);
    pb_text(&add, NODE_INPUT, product);
    add_constant(w, &add, ONNX_FLOAT, NULL, 0, &x->at.shift, sizeof x->at.shift);
    pb_message(&w->graph, GRAPH_NODE, &add);
}

static pb reciprocal(writer *w, const nn_node *x)
{
    char name[32], below[40];
    pb node = {0};
    snprintf(below, sizeof below, "%s.below", value_name(x, name));
    put_affine(w, x, below);
    pb_text(&node, NODE_TYPE, "Reciprocal");
    pb_text(&node, NODE_OUTPUT, name);
    pb_text(&node, NODE_INPUT, below);
    return node;
}

static pb with_integer(const nn_node *x, const char *type, const char *name, int64_t value)
{
    pb node = node_begin(x, type);
    put_integer(&node, name, value);
    return node;
}

static pb normalize(const nn_node *x)
{
    pb node = with_integer(x, "LpNormalization", "axis", 1);
    put_integer(&node, "p", 2);
    return node;
}

static pb node_of(writer *w, const nn_node *x)
{
    switch (x->op) {
    case OP_CONV:
    case OP_LINEAR:
        return conv(w, x);
    case OP_NORM:
        return norm(w, x);
    case OP_RELU:
        return node_begin(x, "Relu");
    case OP_TANH:
        return node_begin(x, "Tanh");
    case OP_SIGMOID:
        return node_begin(x, "Sigmoid");
    case OP_CONCAT:
        return with_integer(x, "Concat", "axis", 1);
    case OP_SLICE:
        return slice(w, x);
    case OP_ADD:
        return node_begin(x, "Add");
    case OP_GATE:
        return node_begin(x, "Mul");
    case OP_UPSAMPLE_BILINEAR:
        return upsample(w, x);
    case OP_TILE:
        return tile(w, x);
    case OP_SPACE_TO_DEPTH:
        return with_integer(x, "SpaceToDepth", "blocksize", x->at.block);
    case OP_DEPTH_TO_SPACE:
        return with_integer(x, "DepthToSpace", "blocksize", x->at.block);
    case OP_SPATIAL_MEAN:
        return node_begin(x, "GlobalAveragePool");
    case OP_NORMALIZE:
        return normalize(x);
    case OP_RECIPROCAL:
        return reciprocal(w, x);
    case OP_COMPUTE:
    case OP_FLOAT:
        return node_begin(x, "Identity");
    default:
        fprintf(stderr, "write_onnx: ONNX has no %s\n", op_name(x->op));
        exit(1);
    }
}

static void put_node(writer *w, const nn_node *x)
{
    char name[32];
    const int shape[4] = {1, x->channels, height(w, x), height(w, x)};
    if (x->op == OP_INPUT) {
        put_value(&w->graph, GRAPH_INPUT, value_name(x, name), shape);
    } else if (x->op == OP_SCALE_SHIFT) {
        put_affine(w, x, value_name(x, name));
    } else {
        pb node = node_of(w, x);
        pb_message(&w->graph, GRAPH_NODE, &node);
    }
}

/* ---- what is needed, files ---- */

static void mark(const nn_node *x, bool *needed)
{
    if (needed[x->index]) return;
    needed[x->index] = true;
    for (int i = 0; i < x->inputs; i++)
        if (x->op != OP_TILE || i == 0) mark(x->in[i], needed);
}

static bool is_wanted(const char *name)
{
    for (int i = 0; view_outputs[i]; i++)
        if (strcmp(view_outputs[i], name) == 0) return true;
    return false;
}

static FILE *open_in(const char *folder, const char *name, const char *ending)
{
    char path[512];
    snprintf(path, sizeof path, "%s/%s%s", folder, name, ending);
    FILE *f = fopen(path, "wb");
    if (f) return f;
    perror(path);
    exit(1);
}

/* Channels last to channels first. */
static void write_values(const char *folder, const char *name, const char *ending, const float *from, int channels,
                         int side)
{
    FILE *f = open_in(folder, name, ending);
    for (int c = 0; c < channels; c++)
        for (int i = 0; i < side * side; i++)
            fwrite(from + (size_t)i * (size_t)channels + c, sizeof *from, 1, f);
    fclose(f);
}

static void write_model(writer *w, const nn_graph *g, const bool *needed, const char *folder)
{
    pb model = {0}, opset = {0};
    pb_text(&w->graph, GRAPH_NAME, "merlin");
    for (int i = 0; i < g->count; i++)
        if (needed[i]) put_node(w, g->nodes[i]);
    for (int i = 0; i < g->output_count; i++) {
        const nn_node *x = g->outputs[i].node;
        char name[32];
        const int shape[4] = {1, x->channels, height(w, x), height(w, x)};
        if (is_wanted(g->outputs[i].name)) put_value(&w->graph, GRAPH_OUTPUT, value_name(x, name), shape);
    }
    pb_integer(&model, MODEL_VERSION, 7);
    pb_integer(&opset, 2, OPSET);
    pb_message(&model, MODEL_OPSET, &opset);
    pb_message(&model, MODEL_GRAPH, &w->graph);
    FILE *f = open_in(folder, "network", ".onnx");
    fwrite(model.data, 1, model.size, f);
    fclose(f);
    free(model.data);
}

static void write_tensors(const writer *w, const nn_graph *g, const bool *needed, nn_program *p, const char *folder)
{
    FILE *list = open_in(folder, "tensors", ".txt");
    char name[32];
    for (int i = 0; i < g->count; i++) {
        const nn_node *x = g->nodes[i];
        int side = height(w, x);
        if (!needed[i] || x->op != OP_INPUT) continue;
        write_values(folder, value_name(x, name), ".in", nn_input_data(p, x->name), x->channels, side);
        fprintf(list, "in %s 1 %d %d %d\n", name, x->channels, side, side);
    }
    for (int i = 0; i < g->output_count; i++) {
        const nn_node *x = g->outputs[i].node;
        int side = height(w, x);
        if (!is_wanted(g->outputs[i].name)) continue;
        write_values(folder, value_name(x, name), ".out", nn_output_data(p, g->outputs[i].name), x->channels, side);
        fprintf(list, "out %s 1 %d %d %d\n", name, x->channels, side, side);
    }
    fclose(list);
}

/* ---- this engine ---- */

static void put_inputs(const writer *w, const nn_graph *g, nn_program *p)
{
    rng r = rng_at(1, 2, 3);
    for (int i = 0; i < g->count; i++) {
        const nn_node *x = g->nodes[i];
        float *to = x->op == OP_INPUT ? nn_input_data(p, x->name) : NULL;
        if (!to) continue;
        size_t count = (size_t)x->channels * (size_t)height(w, x) * (size_t)height(w, x);
        for (size_t k = 0; k < count; k++)
            to[k] = strcmp(x->name, "mask") == 0 ? 1 : rng_uniform(&r);
    }
}

static int by_value(const void *a, const void *b)
{
    double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

static status measure(nn_program *p)
{
    double ms[RUNS];
    status s = nn_forward(p);
    for (int i = 0; i < RUNS && s == OK; i++) {
        double began = clock_seconds();
        s = nn_forward(p);
        ms[i] = 1e3 * (clock_seconds() - began);
    }
    qsort(ms, RUNS, sizeof *ms, by_value);
    if (s == OK) printf("%.1f %.1f\n", ms[0], ms[RUNS / 2]);
    return s;
}

static status run(const char *weights, int side, const char *folder)
{
    writer w = {.side = side};
    model_config config;
    nn_graph *g = NULL;
    nn_program *p = NULL;
    const nn_options options = {
        .batch = 1, .height = side, .width = side, .purpose = NN_INFER, .outputs = view_outputs};
    status s = model_load(weights, &config, &w.params);
    if (s == OK) s = model_build(&config, MODEL_MAPS, &g);
    if (s == OK) s = nn_compile(g, w.params, &options, &p);
    if (s == OK) put_inputs(&w, g, p);
    if (s == OK) s = folder ? nn_forward(p) : measure(p);
    bool *needed = s == OK ? calloc((size_t)g->count, sizeof *needed) : NULL;
    for (int i = 0; needed && i < g->output_count; i++)
        if (is_wanted(g->outputs[i].name)) mark(g->outputs[i].node, needed);
    if (needed && folder) write_model(&w, g, needed, folder);
    if (needed && folder) write_tensors(&w, g, needed, p, folder);
    free(needed);
    nn_program_free(p);
    nn_graph_free(g);
    nn_params_free(w.params);
    return s;
}

int main(int argc, char **argv)
{
    int side = argc > 2 ? atoi(argv[2]) : 0;
    if (argc < 3 || argc > 4 || side < 64 || side % MODEL_SIZE_MULTIPLE) {
        fprintf(stderr, "usage: write_onnx WEIGHTS SIDE [FOLDER]\n");
        return 2;
    }
    if (run(argv[1], side, argc > 3 ? argv[3] : NULL) == OK) return 0;
    fprintf(stderr, "write_onnx: %s\n", status_message());
    return 1;
}
