/* SPDX-License-Identifier: MIT */
/* merlin info: shows the content of a weights file. */
#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/json/json_put.h"
#include "base/text/report.h"
#include "cli/commands.h"
#include "command/cli.h"
#include "command/json_line.h"
#include "command/options.h"
#include "command/photos.h"
#include "merlin/weights.h"

static const char help[] =
    "usage: merlin info WEIGHTS [--tensors] [--json] [--quiet]\n\n"
    "Says what is in a weights file, or in the shipped merlin-any, merlin-point or merlin-env: the model's\n"
    "configuration, where the weights come from, their number, and what one picture of 256x256\n"
    "costs.\n\n"
    "      --tensors    every tensor with its type and shape\n"
    "      --json       as JSON\n"
    "  -t, --threads N  how many threads work (default: one a processor)\n"
    "  -q, --quiet      no other output than errors\n"
    "  -h, --help       this text\n";

/* Metadata that merlin-lab train writes beside the configuration. */
static const char *const provenance[] = {"presentations",   "samples", "size",    "generator_version",
                                         "validation_loss", "note",    "training"};
enum { PROVENANCE = sizeof provenance / sizeof provenance[0] };

static void format_shape(const merlin_tensor *t, char *out, size_t size)
{
    size_t used = 0;
    out[0] = 0;
    for (int i = 0; i < t->rank && used < size; i++)
        used += (size_t)snprintf(out + used, size - used, i ? "x%lld" : "%lld", (long long)t->shape[i]);
}

static void print_text(const merlin_weights *info, bool tensors)
{
    printf("model              %s\n", info->name);
    printf("parameters         %zu (and %zu running statistics)\n", info->parameters, info->statistics);
    printf("cost at %dx%d    %.2f GMAC\n", MERLIN_COST_SIDE, MERLIN_COST_SIDE, info->gmac);
    for (int i = 0; i < PROVENANCE; i++) {
        const char *value = merlin_weights_metadata(info, provenance[i]);
        if (value && *value) printf("%-18s %s\n", provenance[i], value);
    }
    printf("config             %s\n", merlin_weights_metadata(info, "config"));
    printf("tensors            %zu\n", info->tensor_count);
    for (size_t i = 0; tensors && i < info->tensor_count; i++) {
        const merlin_tensor *t = &info->tensors[i];
        char shape[96];
        format_shape(t, shape, sizeof shape);
        printf("  %-48s %-5s %s\n", t->name, t->type, shape);
    }
}

/* Adds numbers and objects as such if the whole text is JSON of them, else text, as notes always are: a commit may look
 * like a number. */
static void add_text(cJSON *o, const char *key, const char *text)
{
    errno = 0;
    cJSON *value = strcmp(key, "note") != 0 ? cJSON_ParseWithOpts(text, NULL, true) : NULL;
    if (cJSON_IsNumber(value) || cJSON_IsObject(value) || (!value && status_by_errno(OK) == MERLIN_NO_MEMORY)) {
        json_put_item(o, key, value);
        return;
    }
    cJSON_Delete(value);
    json_put_text(o, key, text);
}

static void add_tensors(cJSON *o, const merlin_weights *info)
{
    cJSON *list = json_put_array(o, "tensors");
    for (size_t i = 0; i < info->tensor_count; i++) {
        const merlin_tensor *t = &info->tensors[i];
        cJSON *entry = json_append_object(list);
        json_put_text(entry, "name", t->name);
        json_put_text(entry, "type", t->type);
        cJSON *shape = json_put_array(entry, "shape");
        for (int k = 0; k < t->rank; k++)
            json_append(shape, cJSON_CreateNumber((double)t->shape[k]));
    }
}

static status print_json(const merlin_weights *info, bool tensors)
{
    cJSON *o = report_begin(&(warnings){0});
    json_put_text(o, "model", info->name);
    json_put_number(o, "parameters", (double)info->parameters);
    json_put_number(o, "statistics", (double)info->statistics);
    json_put_number(o, "gmac_256", info->gmac);
    add_text(o, "config", merlin_weights_metadata(info, "config"));
    for (int i = 0; i < PROVENANCE; i++) {
        const char *value = merlin_weights_metadata(info, provenance[i]);
        if (value) add_text(o, provenance[i], value);
    }
    if (tensors) add_tensors(o, info);
    const status s = json_line_print(o);
    cJSON_Delete(o);
    return s;
}

int cmd_info(int argc, char **argv)
{
    bool tensors = false, json = false, quiet = false, wants_help = false;
    const cli_option options[] = {
        {"tensors", .flag = &tensors},
        {"json", .flag = &json},
        {"quiet", 'q', .flag = &quiet},
        {"help", 'h', .flag = &wants_help},
        {0},
    };
    if (cli_read_options(&argc, &argv, options) != OK) return cli_usage("info", "%s", status_message());
    if (wants_help) return fputs(help, stdout) < 0;
    if (argc != 1) return cli_usage("info", "one weights file wanted");
    merlin_weights info = {.file = NULL};
    char *path;
    status s = photo_find_model(argv[0], &path);
    if (s == OK) s = merlin_weights_read(path, &info);
    free(path);
    if (s == OK && json) s = print_json(&info, tensors);
    if (s == OK && !json && !quiet) print_text(&info, tensors);
    merlin_weights_free(&info);
    return s == OK ? 0 : cli_fail("info", s);
}
