/* SPDX-License-Identifier: MIT */
/* Parameters: float32 masters by name, their initial values, their gradients. */
#include "nn/params.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "base/rng.h"
#include "nn/safetensors.h"

enum { PARAMS_PER_NODE = 4, NAME_LIMIT = 256 };

typedef struct param_spec {
    char name[NAME_LIMIT];
    int rank;
    int64_t shape[4];
    double fan_in; /* 0: constants instead of random weights */
    float constant;
    bool trained, zero; /* zero: initial weights are 0 */
} param_spec;

static param_spec vector_spec(const nn_node *node, const char *suffix, float constant, bool trained)
{
    param_spec spec = {.rank = 1, .shape = {node->channels}, .constant = constant, .trained = trained};
    snprintf(spec.name, sizeof spec.name, "%s.%s", node->name, suffix);
    return spec;
}

static param_spec weight_spec(const nn_node *node)
{
    int64_t in = node->in[0]->channels, out = node->channels, k = node->at.kernel;
    param_spec spec = {
        .rank = node->op == OP_LINEAR ? 2 : 4, .shape = {out, in, k, k}, .trained = true, .zero = node->at.zero};
    spec.fan_in = (double)(in * k * k);
    if (node->op == OP_CONV_TRANSPOSED) { /* each result gets a part of the kernel only */
        spec.shape[0] = in, spec.shape[1] = out;
        spec.fan_in /= (double)node->at.stride * node->at.stride;
    }
    if (node->op == OP_LINEAR) spec.shape[2] = spec.shape[3] = 0;
    snprintf(spec.name, sizeof spec.name, "%s.weight", node->name);
    return spec;
}

/* Fills in specs in the order of node_params; returns how many there are. */
static int node_specs(const nn_node *node, param_spec specs[PARAMS_PER_NODE])
{
    int count = 0;
    if (op_is_conv(node->op) || node->op == OP_CONV_TRANSPOSED) {
        specs[count++] = weight_spec(node);
        if (node->at.bias) specs[count++] = vector_spec(node, "bias", 0, true);
    } else if (node->op == OP_NORM) {
        specs[count++] = vector_spec(node, "weight", node->at.first_weight, true);
        specs[count++] = vector_spec(node, "bias", 0, true);
        specs[count++] = vector_spec(node, "running_mean", 0, false);
        specs[count++] = vector_spec(node, "running_var", 1, false);
    } else if (node->op == OP_LAYER_NORM) {
        specs[count++] = vector_spec(node, "weight", 1, true);
        specs[count++] = vector_spec(node, "bias", 0, true);
    } else if (node->op == OP_GROUP_POOL) {
        specs[count++] = vector_spec(node, "weight", 0, true);
    }
    return count;
}

static uint64_t hash_name(const char *name)
{
    uint64_t hash = 0xcbf29ce484222325u; /* FNV-1a */
    for (; *name; name++)
        hash = (hash ^ (unsigned char)*name) * 0x100000001b3u;
    return hash;
}

enum { LINE_FLOATS = MEMORY_ALIGNMENT / sizeof(float) };

/* Returns a number of floats rounded up so that the next parameter starts on a cache line. */
static size_t padded(size_t count)
{
    return (count + LINE_FLOATS - 1) / LINE_FLOATS * LINE_FLOATS;
}

/* The source of initial values. */
typedef struct source {
    const uint64_t *seed;         /* NULL: zeros instead of random numbers */
    const safetensors_file *file; /* NULL, or the file that decides which weights are kept as half floats */
} source;

static bool stays_half(const source *from, const param_spec *spec)
{
    const safetensors_tensor *t = from->file && spec->fan_in > 0 ? safetensors_find(from->file, spec->name) : NULL;
    return t && t->type == SAFETENSORS_F16;
}

/* Numbers of values of all parameters as floats, as half floats and of gradients, or where the next parameter's begin.
 */
typedef struct room {
    size_t values, halves, gradients;
} room;

static status add_param(nn_params *params, const param_spec *spec, const source *from, room *needed)
{
    nn_param *p = &params->items[params->count++];
    *p = (nn_param){.rank = spec->rank, .count = 1, .decays = spec->fan_in > 0, .learning_rate_scale = 1};
    memcpy(p->shape, spec->shape, sizeof p->shape);
    for (int i = 0; i < p->rank; i++)
        p->count *= (size_t)p->shape[i];
    p->name = strdup(spec->name);
    if (!p->name) return fail(MERLIN_NO_MEMORY, "no memory for parameter %s", spec->name);
    p->place = needed->values;
    *(stays_half(from, spec) ? &needed->halves : &needed->values) += padded(p->count);
    if (spec->trained) needed->gradients += padded(p->count);
    return OK;
}

static void fill_param(nn_param *p, const param_spec *spec, const uint64_t *seed)
{
    if (!seed && spec->fan_in > 0) return;
    rng random = rng_at(seed ? *seed : 0, hash_name(spec->name), 0);
    float deviation = spec->fan_in > 0 && !spec->zero ? (float)sqrt(2 / spec->fan_in) : 0;
    for (size_t i = 0; i < p->count; i++)
        p->value[i] = spec->fan_in > 0 ? deviation * rng_normal(&random) : spec->constant;
}

static status fill_params(nn_params *params, const nn_graph *g, const source *from, const room *needed)
{
    /* gradients of a model that is not trained are pages that are never touched */
    params->values = memory_new(needed->values * sizeof *params->values);
    uint16_t *halves = params->halves = needed->halves ? memory_new(needed->halves * sizeof *halves) : NULL;
    float *gradients = params->gradients = memory_new(needed->gradients * sizeof *gradients);
    if (!params->values || !gradients || (needed->halves && !halves))
        return fail(MERLIN_NO_MEMORY, "no memory for parameters");
    params->value_count = needed->values;
    params->gradient_count = needed->gradients;
    nn_param *p = params->items;
    for (int i = 0; i < g->count; i++) {
        param_spec specs[PARAMS_PER_NODE];
        int count = node_specs(g->nodes[i], specs);
        for (int k = 0; k < count; k++, p++) {
            if (specs[k].trained) {
                p->gradient = gradients;
                gradients += padded(p->count);
            }
            if (stays_half(from, &specs[k])) {
                p->half = halves;
                halves += padded(p->count);
                continue;
            }
            p->value = params->values + p->place;
            fill_param(p, &specs[k], from->seed);
        }
    }
    return OK;
}

static int compare_names(const void *a, const void *b)
{
    return strcmp((*(nn_param *const *)a)->name, (*(nn_param *const *)b)->name);
}

static status index_names(nn_params *params)
{
    params->by_name = malloc((params->count + 1) * sizeof *params->by_name);
    if (!params->by_name) return fail(MERLIN_NO_MEMORY, "no memory for parameters");
    for (size_t i = 0; i < params->count; i++)
        params->by_name[i] = &params->items[i];
    qsort(params->by_name, params->count, sizeof *params->by_name, compare_names);
    return OK;
}

static status make_params(const nn_graph *g, const source *from, nn_params **out)
{
    *out = NULL;
    status s = graph_check(g);
    if (s != OK) return s;
    nn_params *params = calloc(1, sizeof *params);
    if (params) params->items = calloc((size_t)g->count * PARAMS_PER_NODE + 1, sizeof *params->items);
    if (!params || !params->items) {
        nn_params_free(params);
        return fail(MERLIN_NO_MEMORY, "no memory for parameters");
    }
    params->version = 1;
    room needed = {0};
    for (int i = 0; i < g->count; i++) {
        param_spec specs[PARAMS_PER_NODE];
        int count = node_specs(g->nodes[i], specs);
        for (int k = 0; k < count && s == OK; k++)
            s = add_param(params, &specs[k], from, &needed);
    }
    if (s == OK) s = index_names(params);
    if (s == OK) s = fill_params(params, g, from, &needed);
    if (s == OK)
        *out = params;
    else
        nn_params_free(params);
    return s;
}

status nn_params_new(const nn_graph *g, uint64_t seed, nn_params **out)
{
    return make_params(g, &(source){.seed = &seed}, out);
}

status params_like(const nn_graph *g, const safetensors_file *f, nn_params **out)
{
    return make_params(g, &(source){.file = f}, out);
}

void nn_params_free(nn_params *params)
{
    if (!params) return;
    for (size_t i = 0; params->items && i < params->count; i++)
        free((void *)params->items[i].name);
    memory_free(params->values);
    memory_free(params->halves);
    memory_free(params->gradients);
    free(params->by_name);
    free(params->items);
    free(params);
}

size_t nn_params_count(const nn_params *params)
{
    return params->count;
}

nn_param *nn_params_at(nn_params *params, size_t i)
{
    return i < params->count ? &params->items[i] : NULL;
}

size_t nn_params_values(const nn_params *params)
{
    return params->value_count;
}

nn_param *nn_params_find(nn_params *params, const char *name)
{
    const nn_param sought = {.name = name}, *key = &sought;
    nn_param **found = bsearch(&key, params->by_name, params->count, sizeof *params->by_name, compare_names);
    return found ? *found : NULL;
}

void nn_params_scale_rate(nn_params *params, const char *prefix, float scale)
{
    for (size_t i = 0; i < params->count; i++)
        if (strncmp(params->items[i].name, prefix, strlen(prefix)) == 0) params->items[i].learning_rate_scale = scale;
}

void nn_params_touch(nn_params *params)
{
    params->version++;
}

status params_of_node(nn_params *params, const nn_node *node, node_params *out)
{
    param_spec specs[PARAMS_PER_NODE];
    nn_param **slots[PARAMS_PER_NODE] = {&out->weight, &out->bias, &out->running_mean, &out->running_var};
    int count = node_specs(node, specs);
    *out = (node_params){0};
    for (int k = 0; k < count; k++) {
        nn_param *p = nn_params_find(params, specs[k].name);
        if (!p) return fail(MERLIN_WRONG_USE, "the parameters lack %s, which the graph needs", specs[k].name);
        if (p->rank != specs[k].rank || memcmp(p->shape, specs[k].shape, sizeof p->shape) != 0)
            return fail(MERLIN_WRONG_USE, "parameter %s has another shape than the graph's", specs[k].name);
        *slots[k] = p;
    }
    return OK;
}
