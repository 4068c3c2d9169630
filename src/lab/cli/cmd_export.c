/* SPDX-License-Identifier: MIT */
/* merlin-lab export: the networks of a weights file for other runtimes. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/file.h"
#include "base/messages.h"
#include "base/staging.h"
#include "base/text/report.h"
#include "command/check_files.h"
#include "command/cli.h"
#include "command/json_line.h"
#include "command/options.h"
#include "command/photos.h"
#include "lab/cli/lab_commands.h"
#include "lab/onnx/onnx.h"
#include "model/model.h"
#include "nn/safetensors.h"

static const char help[] =
    "usage: merlin-lab export [WEIGHTS] -o FOLDER [options]\n\n"
    "Writes the networks of a weights file (default: those merlin estimate takes) as ONNX models, for other runtimes\n"
    "(docs/onnx.md says what goes in and what comes out): maps.onnx, from a photograph to maps and light; "
    "bounces.onnx,\n"
    "what light does between an object's parts; relight.onnx, the relighting decoder, where the model has one; and\n"
    "networks.json, their inputs and outputs.\n\n"
    "      --onnx          the format: ONNX, operator set 13 (the only one so far)\n"
    "  -o, --output DIR    folder to write\n"
    "      --size N        for pictures of N pixels a side, one at a time (a multiple of 32, from 64 to 512; default:\n"
    "                      any number of any such size)\n"
    "      --json          report on standard output as JSON\n"
    "  -t, --threads N     how many threads work (default: one a processor)\n"
    "  -q, --quiet         no other output than errors\n"
    "  -h, --help          this text\n";

enum { LEAST_SIZE = 64, LARGEST_SIZE = 512 };

typedef struct request {
    const char *output;
    int size;
    bool onnx, json, quiet, help;
} request;

/* A network of the model, as a file of its own. */
typedef struct network_file {
    const char *name, *about;
    model_part part;
} network_file;

#define LIST "networks.json"

static const network_file network_files[] = {
    {"maps.onnx", "From one photograph of an object to its maps, and the light it was taken under", MODEL_MAPS},
    {"bounces.onnx", "From direct light and maps to what light does between the object's parts", MODEL_INDIRECT},
    {"relight.onnx", "From the features of maps.onnx to the object under another light", MODEL_RELIGHT},
};
enum { NETWORKS = sizeof network_files / sizeof *network_files };

static status parse(int *argc, char ***argv, request *r)
{
    const cli_option options[] = {
        {"onnx", .flag = &r->onnx},
        {"output", 'o', .folder = &r->output},
        {"size", .integer = &r->size, .low = LEAST_SIZE, .high = LARGEST_SIZE},
        {"json", .flag = &r->json},
        {"quiet", 'q', .flag = &r->quiet},
        {"help", 'h', .flag = &r->help},
        {0},
    };
    status s = cli_read_options(argc, argv, options);
    if (s != OK || r->help) return s;
    if (*argc > 1) return fail(MERLIN_WRONG_USE, "unexpected argument \"%s\"", (*argv)[1]);
    if (!r->output) return fail(MERLIN_WRONG_USE, "no folder to write (-o DIR)");
    if (r->size % MODEL_SIZE_MULTIPLE)
        return fail(MERLIN_WRONG_USE, "--size %d is not a multiple of %d", r->size, MODEL_SIZE_MULTIPLE);
    return OK;
}

static bool has_part(const model_config *config, model_part part)
{
    if (part == MODEL_INDIRECT) return config->global_illumination;
    return part != MODEL_RELIGHT || config->relight == MODEL_RELIGHT_NETWORK;
}

typedef struct value_lists {
    cJSON *inputs, *outputs;
} value_lists;

static void list_value(void *context, const onnx_value *value)
{
    const value_lists *lists = context;
    cJSON *entry = json_append_object(value->is_input ? lists->inputs : lists->outputs);
    json_put_text(entry, "name", value->name);
    json_put_number(entry, "channels", value->channels);
    json_put_number(entry, "reduction", value->reduction);
}

typedef struct export_job {
    const request *asked;
    const char *weights;
    model_config config;
    char *config_json;
    nn_params *params;
    staging *files;
    cJSON *networks; /* the list of networks.json */
} export_job;

static status export_network(const export_job *job, const network_file *file)
{
    const char *const metadata[][2] = {
        {"model", job->config.name}, {"config", job->config_json}, {"license", "MIT"}, {NULL, NULL}};
    const onnx_options options = {
        .name = job->config.name, .about = file->about, .size = job->asked->size, .metadata = metadata};
    char path[PATH_MAX];
    nn_graph *g = NULL;
    cJSON *entry = json_append_object(job->networks);
    json_put_text(entry, "file", file->name);
    json_put_text(entry, "about", file->about);
    value_lists lists = {json_put_array(entry, "inputs"), json_put_array(entry, "outputs")};
    status s = model_build(&job->config, file->part, &g);
    if (s == OK)
        s = onnx_write(staging_path(job->files, file->name, path), g, job->params, &options, list_value, &lists);
    nn_graph_free(g);
    return s;
}

static status write_list(const export_job *job, cJSON *list)
{
    char path[PATH_MAX], *text = json_print(list);
    if (!text) return fail(MERLIN_NO_MEMORY, "no memory for networks.json");
    status s = file_write(staging_path(job->files, LIST, path), text, strlen(text));
    free(text);
    return s;
}

/* Removes a network that another model had, by its list, and that this one does not have. */
static status drop_earlier(const export_job *job, const char *name)
{
    return file_is_in(job->asked->output, LIST) ? staging_drop(job->files, name) : OK;
}

static status export_all(export_job *job, staged_files *written)
{
    const char *const inputs[STAGING_MOST_INPUTS] = {job->weights};
    status s = staging_begin(job->asked->output, inputs, &job->files);
    if (s != OK) return s;
    cJSON *list = report_begin(&(warnings){0});
    json_put_text(list, "model", job->config.name);
    json_put_number(list, "size", job->asked->size);
    job->networks = json_put_array(list, "networks");
    for (int i = 0; s == OK && i < NETWORKS; i++) {
        s = has_part(&job->config, network_files[i].part) ? export_network(job, &network_files[i])
                                                          : drop_earlier(job, network_files[i].name);
        if (s == OK && cli_interrupted()) s = fail(MERLIN_STOPPED, "interrupted; nothing was written");
    }
    if (s == OK) s = write_list(job, list);
    cJSON_Delete(list);
    return s == OK ? staging_commit(job->files, written) : staging_abort(job->files, s);
}

static status report(const export_job *job, const staged_files *written)
{
    const request *r = job->asked;
    if (r->json) {
        cJSON *line = report_begin(&(warnings){0});
        json_put_text(line, "input", job->weights);
        json_put_text(line, "model", job->config.name);
        json_line_files(line, r->output, written);
        status s = json_line_print(line);
        cJSON_Delete(line);
        return s;
    }
    for (size_t i = 0; !r->quiet && i < written->count; i++)
        printf("%s\n", written->at[i]);
    return OK;
}

static status run(const request *r, const char *asked)
{
    char *path;
    staged_files written = {0};
    char *flash;
    status s = photo_find_models(asked, &path, &flash);
    if (s != OK) return s;
    free(flash);
    export_job job = {.asked = r, .weights = path};
    s = check_named("weights file", path);
    if (s == OK) s = model_load(path, &job.config, &job.params);
    if (s == OK && !(job.config_json = model_config_write(&job.config)))
        s = fail(MERLIN_NO_MEMORY, "no memory for a configuration");
    if (s == OK) s = export_all(&job, &written);
    if (s == OK) s = report(&job, &written);
    merlin_files_free(&written);
    nn_params_free(job.params);
    free(job.config_json);
    free(path);
    return s;
}

int cmd_export(int argc, char **argv)
{
    request r = {0};
    if (parse(&argc, &argv, &r) != OK) return cli_usage("export", "%s", status_message());
    if (r.help) return fputs(help, stdout) < 0;
    cli_catch_interrupts();
    status s = run(&r, argc ? argv[0] : NULL);
    return s == OK ? 0 : cli_fail("export", s);
}
