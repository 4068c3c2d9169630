/* SPDX-License-Identifier: MIT */
#include <stdio.h>
#include <stdlib.h>

#include "base/file.h"
#include "lab/onnx/onnx.h"
#include "lab/onnx/onnx_graph.h"

/* Nodes of a graph to be written. */
typedef struct onnx_choice {
    bool *possible; /* whether ONNX has all operations that a node depends on */
    bool *needed;   /* whether a possible output needs it */
} onnx_choice;

static void find_possible(const nn_graph *g, bool *possible)
{
    for (int i = 0; i < g->count; i++) {
        const nn_node *x = g->nodes[i];
        possible[i] = onnx_knows(x->op);
        for (int k = 0; k < x->inputs; k++)
            possible[i] = possible[i] && possible[x->in[k]->index];
    }
}

/* Goes back from the outputs, as nodes follow their inputs. Returns the number of outputs. */
static int find_needed(const nn_graph *g, const onnx_choice *choice)
{
    int outputs = 0;
    for (int i = 0; i < g->output_count; i++) {
        int node = g->outputs[i].node->index;
        choice->needed[node] = choice->needed[node] || choice->possible[node];
        outputs += choice->possible[node];
    }
    for (int i = g->count - 1; i >= 0; i--)
        for (int k = 0; choice->needed[i] && k < g->nodes[i]->inputs; k++)
            choice->needed[g->nodes[i]->in[k]->index] = true;
    return outputs;
}

static void declare(onnx_graph *o, int field, const nn_node *x, const char *name)
{
    char height[32], width[32];
    onnx_dimension shape[4] = {{"batch", 0}, {NULL, x->channels}, {NULL, 1}, {NULL, 1}};
    if (o->size) shape[0] = (onnx_dimension){NULL, 1};
    if (x->reduction != NN_VECTOR && o->size) {
        shape[2].number = shape[3].number = o->size / x->reduction;
    } else if (x->reduction != NN_VECTOR) {
        snprintf(height, sizeof height, x->reduction == 1 ? "height" : "height/%d", x->reduction);
        snprintf(width, sizeof width, x->reduction == 1 ? "width" : "width/%d", x->reduction);
        shape[2].name = height;
        shape[3].name = width;
    }
    onnx_put_value(&o->message, field, name, shape);
}

static void put_values(onnx_graph *o, const onnx_choice *choice, onnx_value_seen *seen, void *context)
{
    const nn_graph *g = o->source;
    for (int i = 0; i < g->count; i++) {
        const nn_node *x = g->nodes[i];
        if (!choice->needed[i] || x->op != OP_INPUT) continue;
        declare(o, ONNX_GRAPH_INPUT, x, x->name);
        if (seen) seen(context, &(onnx_value){x->name, true, x->channels, x->reduction});
    }
    for (int i = 0; i < g->output_count; i++) {
        const nn_node *x = g->outputs[i].node;
        const char *name = g->outputs[i].name;
        char from[ONNX_NAME];
        if (!choice->possible[x->index]) continue;
        protobuf same = onnx_node("Identity", name);
        onnx_put_input(&same, onnx_value_name(x, from));
        protobuf_message(&o->message, ONNX_GRAPH_NODE, &same);
        declare(o, ONNX_GRAPH_OUTPUT, x, name);
        if (seen) seen(context, &(onnx_value){name, false, x->channels, x->reduction});
    }
}

static status write_model(const char *path, onnx_graph *o, const onnx_options *options)
{
    protobuf model = onnx_model(&o->message, options->about, options->metadata);
    status s = model.lost ? fail(MERLIN_NO_MEMORY, "no memory for %s", path) : file_write(path, model.data, model.size);
    protobuf_free(&model);
    return s;
}

status onnx_write(const char *path, const nn_graph *g, nn_params *params, const onnx_options *options,
                  onnx_value_seen *seen, void *context)
{
    onnx_graph o = {.source = g, .params = params, .size = options->size};
    status s = graph_check(g);
    if (s != OK) return s;
    onnx_choice choice = {calloc((size_t)g->count, sizeof(bool)), calloc((size_t)g->count, sizeof(bool))};
    o.written = calloc(nn_params_count(params) + 1, sizeof *o.written);
    if (!choice.possible || !choice.needed || !o.written) {
        s = fail(MERLIN_NO_MEMORY, "no memory for %s", path);
    } else {
        find_possible(g, choice.possible);
        if (find_needed(g, &choice) == 0)
            s = fail(MERLIN_WRONG_USE, "none of the network's outputs can be written as ONNX: those of merlin-point, "
                                       "merlin-any and merlin-env can");
    }
    if (s == OK) {
        protobuf_text(&o.message, ONNX_GRAPH_NAME, options->name);
        for (int i = 0; i < g->count; i++)
            if (choice.needed[i]) onnx_put_node(&o, g->nodes[i]);
        s = o.error;
    }
    if (s == OK) put_values(&o, &choice, seen, context);
    if (s == OK) s = write_model(path, &o, options);
    protobuf_free(&o.message);
    free(o.written);
    free(choice.needed);
    free(choice.possible);
    return s;
}
