/* SPDX-License-Identifier: MIT */
/* Graph construction: every builder function checks its arguments, infers channels and reduction, appends a node. */
#include "nn/graph.h"

#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

nn_graph *nn_graph_new(void)
{
    return calloc(1, sizeof(nn_graph));
}

void nn_graph_free(nn_graph *g)
{
    if (!g) return;
    for (int i = 0; i < g->count; i++) {
        free(g->nodes[i]->name);
        free(g->nodes[i]);
    }
    for (int i = 0; i < g->output_count; i++)
        free(g->outputs[i].name);
    free(g->nodes);
    free(g->outputs);
    free(g);
}

status graph_check(const nn_graph *g)
{
    if (!g) return fail(MERLIN_NO_MEMORY, "no memory for a graph");
    return g->error == OK ? OK : fail(g->error, "%s", g->message);
}

nn_node *graph_reject(nn_graph *g, const char *format, ...)
{
    if (g->error == OK) {
        g->error = MERLIN_WRONG_USE;
        va_list list;
        va_start(list, format);
        vsnprintf(g->message, sizeof g->message, format, list);
        va_end(list);
    }
    return NULL;
}

static nn_node *out_of_memory(nn_graph *g)
{
    if (g->error == OK) {
        g->error = MERLIN_NO_MEMORY;
        snprintf(g->message, sizeof g->message, "no memory for a graph node");
    }
    return NULL;
}

/* Grows an array of `size`-byte elements by doubling. */
static bool reserve(void **array, int count, int *capacity, size_t size)
{
    if (count < *capacity) return true;
    int wanted = *capacity ? 2 * *capacity : 64;
    void *grown = realloc(*array, (size_t)wanted * size);
    if (!grown) return false;
    *array = grown;
    *capacity = wanted;
    return true;
}

static bool check_inputs(nn_graph *g, nn_op op, nn_node *const *in, int inputs, bool mixed)
{
    for (int i = 0; i < inputs; i++) {
        if (!in[i]) return graph_reject(g, "%s: input %d is NULL", op_name(op), i);
        if (in[i]->graph != g) return graph_reject(g, "%s: input %d belongs to another graph", op_name(op), i);
        if (!mixed && in[i]->of_object != in[0]->of_object)
            return graph_reject(g, "%s: inputs 0 and %d are of pictures and of objects", op_name(op), i);
    }
    return true;
}

nn_node *graph_append(nn_graph *g, nn_op op, nn_node *const *in, int inputs, bool mixed)
{
    if (!g || g->error != OK || !check_inputs(g, op, in, inputs, mixed)) return NULL;
    if (!reserve((void **)&g->nodes, g->count, &g->capacity, sizeof(nn_node *))) return out_of_memory(g);
    nn_node *node = calloc(1, sizeof *node);
    if (!node) return out_of_memory(g);
    node->graph = g;
    node->index = g->count;
    node->op = op;
    node->inputs = inputs;
    for (int i = 0; i < inputs; i++)
        node->in[i] = in[i];
    if (inputs) {
        node->channels = in[0]->channels;
        node->reduction = in[0]->reduction;
        node->is_float = in[0]->is_float;
        node->of_object = in[0]->of_object;
    }
    g->nodes[g->count++] = node;
    return node;
}

static nn_node *append(nn_graph *g, nn_op op, nn_node *const *in, int inputs)
{
    return graph_append(g, op, in, inputs, false);
}

static nn_node *append1(nn_graph *g, nn_op op, nn_node *x)
{
    return append(g, op, &x, 1);
}

static bool same_name_space(nn_op a, nn_op b)
{
    if (a == OP_INPUT || b == OP_INPUT) return a == b;
    return op_is_loss(a) == op_is_loss(b);
}

nn_node *graph_give_name(nn_node *node, const char *name)
{
    if (!node) return NULL;
    nn_graph *g = node->graph;
    if (!name || !*name) return graph_reject(g, "%s: a name is needed", op_name(node->op));
    for (int i = 0; i < node->index; i++) {
        const nn_node *other = g->nodes[i];
        if (other->name && same_name_space(node->op, other->op) && strcmp(other->name, name) == 0)
            return graph_reject(g, "%s: the name \"%s\" is already taken by a %s", op_name(node->op), name,
                                op_name(other->op));
    }
    node->name = strdup(name);
    return node->name ? node : out_of_memory(g);
}

nn_node *nn_input(nn_graph *g, const char *name, int channels, int reduction)
{
    if (!g || g->error != OK) return NULL;
    if (channels < 1 || reduction < NN_POINTS)
        return graph_reject(g, "input: \"%s\" needs channels and a reduction", name);
    nn_node *node = append(g, OP_INPUT, NULL, 0);
    if (!node) return NULL;
    node->channels = channels;
    node->reduction = reduction;
    node->is_float = true;
    return graph_give_name(node, name);
}

void nn_output(nn_graph *g, nn_node *x, const char *name)
{
    if (!g || g->error != OK) return;
    if (!x) {
        graph_reject(g, "output: \"%s\" is NULL", name ? name : "");
        return;
    }
    for (int i = 0; i < g->output_count; i++) {
        if (strcmp(g->outputs[i].name, name) == 0) {
            graph_reject(g, "output: the name \"%s\" is already taken", name);
            return;
        }
    }
    char *copy = strdup(name);
    graph_output *grown = realloc(g->outputs, (size_t)(g->output_count + 1) * sizeof *grown);
    if (grown) g->outputs = grown;
    if (!grown || !copy) {
        free(copy);
        out_of_memory(g);
        return;
    }
    g->outputs[g->output_count++] = (graph_output){x, copy};
}

nn_node *nn_compute(nn_graph *g, nn_node *x)
{
    if (x && !x->is_float) return x;
    nn_node *node = append1(g, OP_COMPUTE, x);
    if (node) node->is_float = false;
    return node;
}

nn_node *nn_float(nn_graph *g, nn_node *x)
{
    if (x && x->is_float) return x;
    nn_node *node = append1(g, OP_FLOAT, x);
    if (node) node->is_float = true;
    return node;
}

nn_node *graph_append_named(nn_graph *g, nn_op op, nn_node *x, const char *name, int channels)
{
    nn_node *node = append1(g, op, x);
    if (!x || !node) return NULL;
    if (x->is_float) return graph_reject(g, "%s \"%s\": convert the input with nn_compute first", op_name(op), name);
    if (channels < 1) return graph_reject(g, "%s \"%s\": %d output channels", op_name(op), name, channels);
    node->channels = channels;
    return graph_give_name(node, name);
}

nn_node *nn_conv2d(nn_graph *g, nn_node *x, const char *name, int out, int kernel, int stride, nn_bias bias)
{
    nn_node *node = graph_append_named(g, OP_CONV, x, name, out);
    if (!node) return NULL;
    if (kernel < 1 || kernel > 31 || stride < 1 || stride > 8)
        return graph_reject(g, "conv2d \"%s\": kernel %d, stride %d", name, kernel, stride);
    if (x->reduction == NN_VECTOR) return graph_reject(g, "conv2d \"%s\": the input is a vector, use nn_linear", name);
    if (x->reduction == NN_POINTS && (kernel > 1 || stride > 1))
        return graph_reject(g, "conv2d \"%s\": points have no neighbours", name);
    node->reduction = x->reduction * stride;
    node->at.kernel = kernel;
    node->at.stride = stride;
    node->at.dilation = 1;
    node->at.bias = bias == NN_BIAS;
    return node;
}

nn_node *nn_conv2d_dilated(nn_graph *g, nn_node *x, const char *name, int out, int kernel, int dilation, nn_bias bias)
{
    nn_node *node = nn_conv2d(g, x, name, out, kernel, 1, bias);
    if (!node) return NULL;
    if (dilation < 1 || dilation > 16) return graph_reject(g, "conv2d \"%s\": dilation %d", name, dilation);
    node->at.dilation = dilation;
    return node;
}

/* Checks that a node's size can be multiplied by factor. */
static nn_node *enlarge(nn_node *node, int factor)
{
    if (!node) return NULL;
    if (node->reduction < 1 || node->reduction % factor)
        return graph_reject(node->graph, "%s: size 1/%d cannot be enlarged %d times", op_name(node->op),
                            node->reduction, factor);
    node->reduction /= factor;
    return node;
}

nn_node *nn_conv2d_zero(nn_graph *g, nn_node *x, const char *name, int out, int kernel, int stride, nn_bias bias)
{
    nn_node *node = nn_conv2d(g, x, name, out, kernel, stride, bias);
    if (node) node->at.zero = true;
    return node;
}

nn_node *nn_conv2d_transposed(nn_graph *g, nn_node *x, const char *name, int out, int kernel, int stride)
{
    nn_node *node = graph_append_named(g, OP_CONV_TRANSPOSED, x, name, out);
    if (!node) return NULL;
    if (stride < 2 || stride > 8 || kernel < stride || kernel > 31 || (kernel - stride) % 2)
        return graph_reject(g, "conv2d_transposed \"%s\": kernel %d, stride %d", name, kernel, stride);
    node->at.kernel = kernel;
    node->at.stride = stride;
    node->at.dilation = 1;
    return enlarge(node, stride);
}

nn_node *nn_linear(nn_graph *g, nn_node *x, const char *name, int out)
{
    nn_node *node = graph_append_named(g, OP_LINEAR, x, name, out);
    if (!node) return NULL;
    if (x->reduction != NN_VECTOR) return graph_reject(g, "linear \"%s\": the input is not a vector", name);
    node->at.kernel = node->at.stride = node->at.dilation = 1;
    node->at.bias = true;
    return node;
}

nn_node *nn_batch_norm_zero(nn_graph *g, nn_node *x, const char *name)
{
    return graph_append_named(g, OP_NORM, x, name, x ? x->channels : 1);
}

nn_node *nn_batch_norm(nn_graph *g, nn_node *x, const char *name)
{
    nn_node *node = nn_batch_norm_zero(g, x, name);
    if (node) node->at.first_weight = 1;
    return node;
}

nn_node *nn_relu(nn_graph *g, nn_node *x)
{
    return append1(g, OP_RELU, x);
}

nn_node *nn_tanh(nn_graph *g, nn_node *x)
{
    return append1(g, OP_TANH, x);
}

nn_node *nn_sigmoid(nn_graph *g, nn_node *x)
{
    return append1(g, OP_SIGMOID, x);
}

/* Tells whether b can be combined with the node's first input pixel by pixel. */
static bool matches(const nn_node *node, const nn_node *b, bool channels)
{
    const nn_node *a = node->in[0];
    if (a->reduction == b->reduction && a->is_float == b->is_float && (!channels || a->channels == b->channels))
        return true;
    graph_reject(node->graph, "%s: inputs differ: %d channels at 1/%d (%s) and %d channels at 1/%d (%s)",
                 op_name(node->op), a->channels, a->reduction, a->is_float ? "float" : "compute", b->channels,
                 b->reduction, b->is_float ? "float" : "compute");
    return false;
}

nn_node *nn_concat(nn_graph *g, nn_node *const *x, int count)
{
    if (!g || g->error != OK) return NULL;
    if (count < 1 || count > NN_MAX_INPUTS) return graph_reject(g, "concat: of %d (1 to %d)", count, NN_MAX_INPUTS);
    nn_node *node = append(g, OP_CONCAT, x, count);
    for (int i = 1; node && i < count; i++) {
        if (!matches(node, x[i], false)) return NULL;
        node->channels += x[i]->channels;
    }
    return node;
}

nn_node *nn_slice(nn_graph *g, nn_node *x, int first, int channels)
{
    nn_node *node = append1(g, OP_SLICE, x);
    if (!node) return NULL;
    if (first < 0 || channels < 1 || first > x->channels - channels)
        return graph_reject(g, "slice: channels %d to %d of %d", first, first + channels, x->channels);
    node->at.first = first;
    node->channels = channels;
    return node;
}

nn_node *nn_add(nn_graph *g, nn_node *a, nn_node *b)
{
    nn_node *node = append(g, OP_ADD, (nn_node *[]){a, b}, 2);
    return node && matches(node, b, true) ? node : NULL;
}

nn_node *nn_stop(nn_graph *g, nn_node *x)
{
    return append1(g, OP_STOP, x);
}

nn_node *nn_gate(nn_graph *g, nn_node *x, nn_node *gate)
{
    nn_node *node = append(g, OP_GATE, (nn_node *[]){x, gate}, 2);
    if (!node) return NULL;
    if (gate->channels != 1) return graph_reject(g, "gate: the gate has %d channels, not 1", gate->channels);
    return matches(node, gate, false) ? node : NULL;
}

static nn_node *affine(nn_node *node, float scale, float shift)
{
    if (!node) return NULL;
    node->at.scale = scale;
    node->at.shift = shift;
    return node;
}

nn_node *nn_scale_shift(nn_graph *g, nn_node *x, float scale, float shift)
{
    return affine(append1(g, OP_SCALE_SHIFT, x), scale, shift);
}

nn_node *nn_upsample_bilinear(nn_graph *g, nn_node *x)
{
    return enlarge(append1(g, OP_UPSAMPLE_BILINEAR, x), 2);
}

nn_node *nn_tile(nn_graph *g, nn_node *x, nn_node *like)
{
    nn_node *node = append1(g, OP_TILE, x);
    if (!node) return NULL;
    if (!like || x->reduction != NN_VECTOR || like->reduction == NN_VECTOR)
        return graph_reject(g, "tile: takes a vector to the size of a node that is not one");
    node->reduction = like->reduction;
    return node;
}

nn_node *nn_space_to_depth(nn_graph *g, nn_node *x, int block)
{
    nn_node *node = append1(g, OP_SPACE_TO_DEPTH, x);
    if (!node) return NULL;
    if (block < 1 || block > 16 || x->reduction < 1) return graph_reject(g, "space_to_depth: block %d", block);
    node->at.block = block;
    node->channels *= block * block;
    node->reduction *= block;
    return node;
}

nn_node *nn_depth_to_space(nn_graph *g, nn_node *x, int block)
{
    nn_node *node = append1(g, OP_DEPTH_TO_SPACE, x);
    if (!node) return NULL;
    if (block < 1 || block > 16 || x->channels % (block * block))
        return graph_reject(g, "depth_to_space: %d channels by block %d", x->channels, block);
    node->at.block = block;
    node->channels /= block * block;
    return enlarge(node, block);
}

nn_node *nn_spatial_mean(nn_graph *g, nn_node *x)
{
    nn_node *node = append1(g, OP_SPATIAL_MEAN, x);
    if (!node) return NULL;
    if (x->reduction == NN_VECTOR) return graph_reject(g, "spatial_mean: the input is a vector already");
    node->reduction = NN_VECTOR;
    return node;
}

static bool is_float_of(const nn_node *node, const nn_node *x, int channels, const char *what)
{
    if (x->is_float && x->channels == channels) return true;
    graph_reject(node->graph, "%s: %s must be float (nn_float) with %d channels, has %d", op_name(node->op), what,
                 channels, x->channels);
    return false;
}

nn_node *nn_normalize(nn_graph *g, nn_node *x)
{
    nn_node *node = append1(g, OP_NORMALIZE, x);
    return node && is_float_of(node, x, 3, "the input") ? node : NULL;
}

nn_node *nn_reciprocal(nn_graph *g, nn_node *x, float scale, float shift)
{
    return affine(append1(g, OP_RECIPROCAL, x), scale, shift);
}

nn_node *nn_render(nn_graph *g, const nn_render_inputs *in, float fov, float light_power)
{
    nn_node *inputs[] = {in->albedo, in->normal, in->roughness, in->depth, in->mask, in->light, in->lens};
    static const struct {
        const char *name;
        int channels;
    } expected[] = {{"albedo", 3}, {"normal", 3}, {"roughness", 1}, {"depth", 1},
                    {"mask", 1},   {"light", 3},  {"lens", 3}};
    const int count = in->lens ? 7 : 6;
    nn_node *node = append(g, OP_RENDER, inputs, count);
    for (int i = 0; node && i < count; i++) {
        if (!is_float_of(node, inputs[i], expected[i].channels, expected[i].name)) return NULL;
        if (i < 5 && !matches(node, inputs[i], false)) return NULL;
    }
    if (!node) return NULL;
    if (in->light->reduction != NN_VECTOR) return graph_reject(g, "render: the light must be a vector");
    if (in->lens && in->lens->reduction != NN_VECTOR) return graph_reject(g, "render: the lens must be a vector");
    node->at.fov = fov;
    node->at.light_power = light_power;
    return node;
}

nn_node *nn_environment(nn_graph *g, nn_node *albedo, nn_node *normal, nn_node *mask, nn_node *sh)
{
    nn_node *node = append(g, OP_ENVIRONMENT, (nn_node *[]){albedo, normal, sh, mask}, 4);
    if (!node || !matches(node, normal, true) || !matches(node, mask, false)) return NULL;
    if (!is_float_of(node, albedo, 3, "albedo") || !is_float_of(node, mask, 1, "mask")) return NULL;
    if (!is_float_of(node, sh, 27, "sh")) return NULL;
    if (sh->reduction != NN_VECTOR) return graph_reject(g, "environment: the coefficients must be a vector");
    return node;
}

static void append_loss(nn_graph *g, nn_op op, nn_node *const in[3], const char *name, float weight)
{
    nn_node *node = append(g, op, in, 3);
    if (!node || !matches(node, in[1], true) || !matches(node, in[2], false)) return;
    if (!is_float_of(node, in[0], in[0]->channels, "the prediction")) return;
    if (!is_float_of(node, in[2], 1, "the mask")) return;
    if (in[0]->reduction < 1 && op != OP_MASKED_L2) {
        graph_reject(g, "%s \"%s\": the prediction is not an image", op_name(op), name);
        return;
    }
    node->at.weight = weight;
    graph_give_name(node, name);
}

void nn_masked_l2(nn_graph *g, nn_node *prediction, nn_node *target, nn_node *mask, const char *name, float weight)
{
    append_loss(g, OP_MASKED_L2, (nn_node *[]){prediction, target, mask}, name, weight);
}

void nn_masked_gradient_l2(nn_graph *g, nn_node *prediction, nn_node *target, nn_node *mask, const char *name,
                           float weight)
{
    append_loss(g, OP_MASKED_GRADIENT_L2, (nn_node *[]){prediction, target, mask}, name, weight);
}

void nn_masked_dssim(nn_graph *g, nn_node *prediction, nn_node *target, nn_node *mask, const char *name, float weight)
{
    append_loss(g, OP_MASKED_DSSIM, (nn_node *[]){prediction, target, mask}, name, weight);
}
