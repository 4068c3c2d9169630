/* SPDX-License-Identifier: MIT */
#include "recorded_networks.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "estimate/photo/network.h"
#include "estimate/photo/network_parts.h"
#include "model/model.h"

enum { NETWORKS_MOST = 4, RUNS_MOST = 32, NAME = 64 };

/* A network as far as it is known: its values, sides of which are not known yet. */
typedef struct description {
    char name[NAME];
    network_run values;
} description;

static description networks[NETWORKS_MOST];
static int network_count;

/* The runs that were wanted so far: all but the last have been answered, if `waiting`. */
static network_run runs[RUNS_MOST];
static int run_count, run_next;
static bool waiting;

struct nn_graph {
    const description *network;
};

struct nn_program {
    const description *network;
    network_run now; /* its inputs and outputs, channels last */
    float lens[3];   /* an input that the rendering layer has, and these networks do not */
};

/* ---- descriptions ---- */

static description *find_network(const char *name)
{
    for (int i = 0; i < network_count; i++)
        if (strcmp(networks[i].name, name) == 0) return &networks[i];
    return NULL;
}

static description *find_part(const char *model, model_part part)
{
    char name[NAME];
    snprintf(name, sizeof name, "%s/%s", model, part == MODEL_INDIRECT ? "bounces" : "maps");
    return find_network(name);
}

static const network_value *find_value(const network_value *values, int count, const char *name)
{
    for (int i = 0; i < count; i++)
        if (strcmp(values[i].name, name) == 0) return &values[i];
    return NULL;
}

status network_value_add(const char *network, const char *name, int channels, int reduction, bool is_input)
{
    description *d = find_network(network);
    if (!d && network_count < NETWORKS_MOST) {
        d = &networks[network_count++];
        snprintf(d->name, sizeof d->name, "%s", network);
        d->values.network = d->name;
    }
    int *count = !d ? NULL : is_input ? &d->values.input_count : &d->values.output_count;
    if (!count || *count == NETWORK_VALUES_MOST) return fail(MERLIN_WRONG_USE, "too many networks, or values of one");
    network_value *v = (is_input ? d->values.inputs : d->values.outputs) + (*count)++;
    snprintf(v->name, sizeof v->name, "%s", name);
    v->channels = channels;
    v->side = reduction;
    return OK;
}

/* ---- models ---- */

status model_load_config(const char *weights, model_config *config)
{
    const description *maps = find_part(weights, MODEL_MAPS);
    *config = (model_config){.relight = MODEL_RELIGHT_BRDF, .global_illumination = find_part(weights, MODEL_INDIRECT)};
    if (!maps) return fail(MERLIN_BAD_INPUT, "there is no network %s", weights);
    snprintf(config->name, sizeof config->name, "%s", weights);
    bool any = find_value(maps->values.outputs, maps->values.output_count, "lights");
    config->lighting = any ? MODEL_LIGHT_ANY : MODEL_LIGHT_POINT;
    return OK;
}

/* Nothing but the configuration is loaded: parameters are the browser's. */
status model_load(const char *weights, model_config *config, nn_params **params)
{
    *params = NULL;
    return model_load_config(weights, config);
}

char *model_config_write(const model_config *config)
{
    return strdup(config->name);
}

status model_build(const model_config *config, model_part part, nn_graph **out)
{
    *out = calloc(1, sizeof **out);
    if (!*out) return fail(MERLIN_NO_MEMORY, "no memory for a network");
    (*out)->network = find_part(config->name, part);
    return (*out)->network ? OK : fail(MERLIN_BAD_INPUT, "%s has no such network", config->name);
}

void nn_graph_free(nn_graph *g)
{
    free(g);
}

void nn_params_free(nn_params *params)
{
    (void)params;
}

nn_type nn_fastest_type(void)
{
    return NN_FLOAT32;
}

/* The relighting decoder is not among a browser's networks. */
status network_features_new(network *n, const img *photo, const img *mask, const sight *how, int views,
                            network_features **out)
{
    (void)photo, (void)mask, (void)how, (void)views;
    *out = NULL;
    return fail(MERLIN_WRONG_USE, "%s has no relighting decoder here", n->weights);
}

void network_features_free(network_features *features)
{
    (void)features;
}

/* ---- programs ---- */

static size_t value_count(const network_value *v)
{
    return (size_t)v->channels * (size_t)v->side * (size_t)v->side;
}

static void run_free(network_run *run)
{
    for (int i = 0; i < NETWORK_VALUES_MOST; i++) {
        free(run->inputs[i].data);
        free(run->outputs[i].data);
    }
    *run = (network_run){0};
}

/* Adds room for a described value of a picture of this size. */
static status add_room(const network_value *described, int size, network_value *values, int *count)
{
    network_value *v = &values[(*count)++];
    *v = *described;
    v->side = described->side ? size / described->side : 1;
    v->data = calloc(value_count(v), sizeof *v->data);
    return v->data ? OK : fail(MERLIN_NO_MEMORY, "no memory for a network's %s", v->name);
}

static bool is_wanted(const char *const *names, const char *name)
{
    for (; names && *names; names++)
        if (strcmp(*names, name) == 0) return true;
    return !names;
}

/* Makes room for all inputs and the outputs that are asked for (names; NULL: all). */
static status run_new(const description *d, const char *const *names, int size, network_run *out)
{
    *out = (network_run){.network = d->name};
    status s = OK;
    for (int i = 0; s == OK && i < d->values.input_count; i++)
        s = add_room(&d->values.inputs[i], size, out->inputs, &out->input_count);
    for (int i = 0; s == OK && i < d->values.output_count; i++)
        if (is_wanted(names, d->values.outputs[i].name))
            s = add_room(&d->values.outputs[i], size, out->outputs, &out->output_count);
    if (s != OK) run_free(out);
    return s;
}

status nn_compile(const nn_graph *g, nn_params *params, const nn_options *options, nn_program **out)
{
    (void)params;
    nn_program *p = calloc(1, sizeof *p);
    *out = NULL;
    if (!p) return fail(MERLIN_NO_MEMORY, "no memory for a network");
    p->network = g->network;
    status s = run_new(g->network, options->outputs, options->height, &p->now);
    if (s != OK)
        free(p);
    else
        *out = p;
    return s;
}

void nn_program_free(nn_program *p)
{
    if (!p) return;
    run_free(&p->now);
    free(p);
}

nn_cost nn_program_cost(const nn_program *p)
{
    (void)p;
    return (nn_cost){0};
}

float *nn_input_data(nn_program *p, const char *name)
{
    const network_value *v = find_value(p->now.inputs, p->now.input_count, name);
    return v ? v->data : strcmp(name, "lens") == 0 ? p->lens : NULL;
}

const float *nn_output_data(nn_program *p, const char *name)
{
    const network_value *v = find_value(p->now.outputs, p->now.output_count, name);
    return v ? v->data : NULL;
}

/* Copy values from channels last to channels first, and back. */
static void to_planes(const network_value *from, network_value *to)
{
    size_t channels = (size_t)from->channels, pixels = value_count(from) / channels;
    for (size_t c = 0; c < channels; c++)
        for (size_t i = 0; i < pixels; i++)
            to->data[c * pixels + i] = from->data[i * channels + c];
}

static void to_pixels(const network_value *from, network_value *to)
{
    size_t channels = (size_t)from->channels, pixels = value_count(from) / channels;
    for (size_t i = 0; i < pixels; i++)
        for (size_t c = 0; c < channels; c++)
            to->data[i * channels + c] = from->data[c * pixels + i];
}

/* Asks for the results of a run with the program's inputs. */
static status ask(const nn_program *p)
{
    if (run_count == RUNS_MOST) return fail(MERLIN_WRONG_USE, "an estimate has no more than %d runs", RUNS_MOST);
    network_run *run = &runs[run_count];
    const char *names[NETWORK_VALUES_MOST + 1] = {NULL};
    for (int i = 0; i < p->now.output_count; i++)
        names[i] = p->now.outputs[i].name;
    status s = run_new(p->network, names, p->now.inputs[0].side, run);
    if (s != OK) return s;
    for (int i = 0; i < run->input_count; i++)
        to_planes(&p->now.inputs[i], &run->inputs[i]);
    run_count++;
    waiting = true;
    return fail(MERLIN_STOPPED, "a network's results are waited for");
}

status nn_forward(nn_program *p)
{
    if (run_next == run_count) return ask(p);
    const network_run *run = &runs[run_next++];
    for (int i = 0; i < p->now.output_count; i++)
        to_pixels(&run->outputs[i], &p->now.outputs[i]);
    return OK;
}

/* ---- runs ---- */

network_run *networks_wanted(void)
{
    return waiting ? &runs[run_count - 1] : NULL;
}

void networks_answered(void)
{
    network_run *run = networks_wanted();
    for (int i = 0; run && i < run->input_count; i++) {
        free(run->inputs[i].data);
        run->inputs[i].data = NULL;
    }
    waiting = false;
}

void networks_rewind(void)
{
    run_next = 0;
}

void networks_forget(void)
{
    for (int i = 0; i < run_count; i++)
        run_free(&runs[i]);
    run_count = run_next = 0;
    waiting = false;
}
