/* SPDX-License-Identifier: MIT */
/* Shapes, live nodes, fusion and the flow of gradients. */
#include "nn/lower.h"

#include <stdlib.h>
#include <string.h>

enum { SIZE_LIMIT = 1 << 15 };

int lower_resolve(nn_type compute, const nn_node *x)
{
    while (compute == NN_FLOAT32 && (x->op == OP_COMPUTE || x->op == OP_FLOAT))
        x = x->in[0];
    return x->index;
}

static status check_options(const nn_options *o)
{
    if (o->batch < 1 || o->height < 1 || o->width < 1 || o->batch > SIZE_LIMIT || o->height > SIZE_LIMIT ||
        o->width > SIZE_LIMIT)
        return fail(MERLIN_WRONG_USE, "a program of batch %d, height %d, width %d (1 to %d each)", o->batch, o->height,
                    o->width, SIZE_LIMIT);
    if (o->group < 0 || o->group > NN_LARGEST_GROUP || (o->group > 0 && o->batch % o->group))
        return fail(MERLIN_WRONG_USE, "a batch of %d pictures, %d of each object (up to %d, a divisor)", o->batch,
                    o->group, NN_LARGEST_GROUP);
    if (o->points < 0 || o->points > SIZE_LIMIT)
        return fail(MERLIN_WRONG_USE, "%d points (0 to %d)", o->points, SIZE_LIMIT);
    return OK;
}

static status infer_shape(const nn_options *o, lowered_value *v)
{
    const nn_node *node = v->node;
    const int images = node->of_object && o->group > 1 ? o->batch / o->group : o->batch;
    v->tensor =
        (nn_tensor){.type = node->is_float ? NN_FLOAT32 : o->type, .n = images, .h = 1, .w = 1, .c = node->channels};
    if (node->reduction == NN_VECTOR) return OK;
    if (node->reduction == NN_POINTS) {
        v->tensor.w = o->points;
        return o->points > 0 ? OK : fail(MERLIN_WRONG_USE, "%s works on points, and there are none", op_name(node->op));
    }
    if (o->height % node->reduction || o->width % node->reduction)
        return fail(MERLIN_WRONG_USE, "%s %s works at 1/%d of the size, which %d by %d is not a multiple of",
                    op_name(node->op), node->name ? node->name : "", node->reduction, o->height, o->width);
    v->tensor.h = o->height / node->reduction;
    v->tensor.w = o->width / node->reduction;
    return OK;
}

bool lower_wants_output(const nn_options *o, const char *name)
{
    if (!o->outputs) return true;
    for (const char *const *wanted = o->outputs; *wanted; wanted++)
        if (strcmp(*wanted, name) == 0) return true;
    return false;
}

static void find_live(lowering *l)
{
    const nn_graph *g = l->graph;
    for (int i = 0; i < g->output_count; i++) {
        if (!lower_wants_output(&l->options, g->outputs[i].name)) continue;
        lowered_value *v = &l->values[lower_resolve(l->options.type, g->outputs[i].node)];
        v->live = v->is_output = true;
    }
    for (int i = g->count; i-- > 0;) {
        lowered_value *v = &l->values[i];
        if (op_is_loss(v->node->op)) v->live = true;
        for (int k = 0; v->live && k < v->node->inputs; k++) {
            lowered_value *x = &l->values[v->in[k]];
            x->live = true;
            x->consumers++;
            if (x->consumer < i) x->consumer = i;
        }
    }
}

static void find_differentiable(lowering *l)
{
    if (l->options.purpose != NN_TRAIN) return;
    int count = l->graph->count;
    for (int i = 0; i < count; i++) { /* it depends on a parameter */
        lowered_value *v = &l->values[i];
        v->differentiable = op_has_params(v->node->op);
        for (int k = 0; k < v->node->inputs; k++)
            if (op_passes_gradient(v->node->op, k) && l->values[v->in[k]].differentiable) v->differentiable = true;
    }
    for (int i = count; i-- > 0;) { /* and a loss depends on it */
        lowered_value *v = &l->values[i];
        if (op_is_loss(v->node->op)) v->reaches_loss = true;
        for (int k = 0; v->reaches_loss && k < v->node->inputs; k++)
            if (op_passes_gradient(v->node->op, k)) l->values[v->in[k]].reaches_loss = true;
        v->differentiable = v->differentiable && v->reaches_loss;
    }
}

/* Returns the only node that uses i if it has this operation, or -1. */
static int sole_consumer(const lowering *l, int i, nn_op op)
{
    const lowered_value *v = &l->values[i];
    if (v->consumers != 1 || v->is_output) return -1;
    return l->values[v->consumer].node->op == op ? v->consumer : -1;
}

/* Returns the node that adds another value to this convolution's result, and which value in *beside; or -1. */
static int sum_behind(const lowering *l, const lowered_step *step, int *beside)
{
    int sum = sole_consumer(l, step->result, OP_ADD);
    if (sum < 0) return -1;
    const lowered_value *v = &l->values[sum];
    *beside = v->in[0] == step->result ? v->in[1] : v->in[0];
    bool is_there = *beside < step->head, is_alike = l->values[*beside].tensor.type == l->options.type;
    return is_there && is_alike && v->tensor.type == l->options.type ? sum : -1;
}

/* Extends a step that starts at a convolution or batch norm by the operations that can be fused with it. */
static void fuse(const lowering *l, lowered_step *step)
{
    nn_op op = l->values[step->head].node->op;
    bool train = l->options.purpose == NN_TRAIN;
    if (op_is_conv(op) && !train) {
        step->norm = sole_consumer(l, step->result, OP_NORM);
        if (step->norm >= 0) step->result = step->norm;
        int beside, sum = sum_behind(l, step, &beside);
        if (sum >= 0) step->result = sum, step->beside = beside;
    }
    if (op_is_conv(op) || op == OP_NORM) {
        int relu = sole_consumer(l, step->result, OP_RELU);
        step->relu = relu >= 0;
        if (step->relu) step->result = relu;
    }
    /* a convolution writes float32 as fast as bfloat16, which saves a pass; batch norm does not */
    if (op_is_conv(op) && !(train && step->relu)) {
        int converted = sole_consumer(l, step->result, OP_FLOAT);
        if (converted >= 0) step->result = converted;
    }
}

static void make_steps(lowering *l)
{
    for (int i = 0; i < l->graph->count; i++) {
        lowered_value *v = &l->values[i];
        if (!v->live || v->covered || v->node->op == OP_INPUT) continue;
        lowered_step *step = &l->steps[l->step_count++];
        *step = (lowered_step){.head = i, .norm = -1, .result = i, .beside = -1};
        fuse(l, step);
        for (int k = i; k != step->result; k = l->values[k].consumer)
            l->values[l->values[k].consumer].covered = true;
    }
}

status lower_graph(const nn_graph *g, const nn_options *options, lowering *out)
{
    *out = (lowering){.options = *options};
    out->graph = g;
    status s = graph_check(g);
    if (s == OK) s = check_options(options);
    if (s != OK) return s;
    out->values = calloc((size_t)g->count + 1, sizeof *out->values);
    out->steps = calloc((size_t)g->count + 1, sizeof *out->steps);
    if (!out->values || !out->steps) s = fail(MERLIN_NO_MEMORY, "no memory to compile %d nodes", g->count);
    for (int i = 0; s == OK && i < g->count; i++) {
        lowered_value *v = &out->values[i];
        *v = (lowered_value){.node = g->nodes[i], .consumer = -1, .buffer = -1, .gradient_buffer = -1};
        for (int k = 0; k < v->node->inputs; k++)
            v->in[k] = lower_resolve(options->type, v->node->in[k]);
        s = infer_shape(options, v);
    }
    if (s != OK) {
        lowering_free(out);
        return s;
    }
    find_live(out);
    find_differentiable(out);
    make_steps(out);
    return OK;
}

void lowering_free(lowering *l)
{
    free(l->values);
    free(l->steps);
    *l = (lowering){0};
}
