/* SPDX-License-Identifier: MIT */
#include "lab/train/mean_weights.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/file.h"
#include "model/model.h"
#include "model/model_export.h"
#include "nn/safetensors.h"

/* Reads a network's configuration, as text, and its parameters. */
static status read_network(const char *path, char **json, nn_params **params)
{
    model_config config;
    nn_graph *g = NULL;
    status s = model_load_config(path, &config);
    if (s == OK) s = model_build(&config, MODEL_WHOLE, &g);
    if (s == OK) s = nn_params_new(g, 0, params);
    if (s == OK) s = nn_params_load(*params, path);
    nn_graph_free(g);
    if (s != OK) return s;
    *json = model_config_write(&config);
    return *json ? OK : fail(MERLIN_NO_MEMORY, "no memory for a configuration");
}

static void add_share(nn_params *to, nn_params *from, double share)
{
    for (size_t i = 0; i < nn_params_count(to); i++) {
        nn_param *p = nn_params_at(to, i);
        const nn_param *q = nn_params_at(from, i);
        for (size_t k = 0; k < p->count; k++)
            p->value[k] = (float)((1 - share) * (double)p->value[k] + share * (double)q->value[k]);
    }
}

/* Writes parameters with the provenance of a weights file. */
static status write_as(const char *path, nn_params *params, const char *json, const char *note, const char *from)
{
    static const char *const kept[] = {"training", "presentations", "samples", "size", "generator_version"};
    enum { KEPT = sizeof kept / sizeof *kept };
    const char *metadata[KEPT + 2][2] = {{"config", json}, {"note", note}};
    size_t count = 2;
    safetensors_file *f;
    status s = safetensors_open(from, &f);
    if (s != OK) return s;
    for (size_t i = 0; i < KEPT; i++) {
        const char *value = safetensors_metadata(f, kept[i]);
        if (!value) continue;
        metadata[count][0] = kept[i];
        metadata[count++][1] = value;
    }
    s = model_export(path, params, (const char *const(*)[2])metadata, count);
    safetensors_close(f);
    return s;
}

status train_mean_weights(const char *first, const char *second, double share, const char *output)
{
    nn_params *a = NULL, *b = NULL;
    char *json = NULL, *other = NULL, note[256];
    snprintf(note, sizeof note, "(1 - %g) times %.80s plus %g times %.80s", share, file_name_of(first), share,
             file_name_of(second));
    status s = read_network(first, &json, &a);
    if (s == OK) s = read_network(second, &other, &b);
    if (s == OK && strcmp(json, other) != 0)
        s = fail(MERLIN_BAD_INPUT, "%s and %s are of different networks", first, second);
    if (s == OK) {
        add_share(a, b, share);
        s = write_as(output, a, json, note, second);
    }
    nn_params_free(a);
    nn_params_free(b);
    free(json);
    free(other);
    return s;
}
