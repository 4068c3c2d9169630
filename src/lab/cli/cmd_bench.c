/* SPDX-License-Identifier: MIT */
/* merlin-lab bench: the cost of model, estimate and renderer on this machine. */
#include <errno.h>
#include <limits.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "base/file.h"
#include "command/check_files.h"
#include "command/cli.h"
#include "command/json_line.h"
#include "command/options.h"
#include "command/photos.h"
#include "lab/bench/bench.h"
#include "lab/bench/bench_layers.h"
#include "lab/bench/bench_stereo.h"
#include "lab/cli/lab_commands.h"
#include "lab/train/checkpoint.h"
#include "model/model.h"

static const char help[] =
    "usage: merlin-lab bench [options]\n\n"
    "Measures merlin estimate as a whole, this machine's peak rate of convolutions, and against it the network's\n"
    "inference and training, what each light costs that an object is shown under, and the renderer.\n\n"
    "      --model W       weights (default: those merlin estimate takes)\n"
    "      --config C.json random weights of this configuration instead\n"
    "      --batch N       pictures in a training step (default 16)\n"
    "      --stereo        photometric stereo by least squares instead: 8 and 32 pictures of 12 megapixels, against\n"
    "                      the rate at which this machine copies memory\n"
    "      --layers        where the network's time goes instead: every layer's GFLOP, milliseconds and share of the\n"
    "                      peak, slowest first, of inference and training in either precision\n"
    "      --quick         fewer runs, smaller pictures\n"
    "      --json          report on standard output as JSON\n"
    "  -t, --threads N     how many threads work (default: one a processor)\n"
    "  -q, --quiet         no progress\n"
    "  -h, --help          this text\n";

typedef struct request {
    bench_options options;
    const char *model, *config;
    bool stereo, layers, json, help;
} request;

static status parse(int argc, char **argv, request *r)
{
    const cli_option options[] = {
        {"model", .text = &r->model},
        {"config", .text = &r->config},
        {"batch", .integer = &r->options.batch, .low = 1, .high = 256},
        {"layers", .flag = &r->layers},
        {"quick", .flag = &r->options.quick},
        {"stereo", .flag = &r->stereo},
        {"json", .flag = &r->json},
        {"quiet", 'q', .flag = &r->options.quiet},
        {"help", 'h', .flag = &r->help},
        {0},
    };
    status s = cli_read_options(&argc, &argv, options);
    if (s != OK || r->help) return s;
    if (argc > 0) return fail(MERLIN_WRONG_USE, "unexpected argument \"%s\"", argv[0]);
    if (r->stereo && (r->model || r->config || r->options.batch || r->layers))
        return fail(MERLIN_WRONG_USE, "--stereo goes without --model, --config, --batch and --layers");
    if (r->model && r->config) return fail(MERLIN_WRONG_USE, "--model and --config exclude each other");
    return OK;
}

/* Writes random weights, as the cost does not depend on their values. */
static status write_random_weights(const char *config_path, const char *path)
{
    model_config config;
    nn_graph *g = NULL;
    nn_params *params = NULL;
    char *json = NULL;
    status s = model_config_read(config_path, &config);
    if (s == OK) s = model_build(&config, MODEL_WHOLE, &g);
    if (s == OK) s = nn_params_new(g, 1, &params);
    if (s == OK && !(json = model_config_write(&config))) s = fail(MERLIN_NO_MEMORY, "no memory for a configuration");
    train_provenance none = {.config = json, .training = "{}", .note = "random weights of merlin-lab bench"};
    if (s == OK) s = train_export(path, params, &none);
    free(json);
    nn_params_free(params);
    nn_graph_free(g);
    return s;
}

static status run_layers(const request *r, const char *weights)
{
    const bench_options *o = &r->options;
    bench_layers layers;
    status s =
        bench_layers_measure(&(bench_layers_options){weights, o->batch, o->quick, o->quiet, o->stopped}, &layers);
    if (s == OK && r->json)
        s = json_report_print(bench_layers_json(&layers));
    else if (s == OK)
        bench_layers_print(&layers, stdout);
    bench_layers_free(&layers);
    return s;
}

static status run(const request *r, const char *weights)
{
    if (r->layers) return run_layers(r, weights);
    bench_options options = r->options;
    options.weights = weights;
    bench_report report;
    status s = bench_run(&options, &report);
    if (s != OK) return s;
    if (r->json) return json_report_print(bench_report_json(&report));
    bench_print_table(&report, stdout);
    return OK;
}

static status run_with_random_weights(const request *r)
{
    char *path = file_in_scratch("merlin-bench-XXXXXX.safetensors");
    if (!path) return fail(MERLIN_NO_MEMORY, "no memory for a file name");
    int file = mkstemps(path, (int)strlen(".safetensors"));
    status s = OK;
    if (file < 0) {
        s = fail_by_errno(MERLIN_CANNOT_WRITE, "cannot make the file %s (TMPDIR says where)", path);
    } else {
        close(file);
        s = write_random_weights(r->config, path);
        if (s == OK) s = run(r, path);
        unlink(path);
    }
    free(path);
    return s;
}

static status run_with_model(const request *r)
{
    char *path;
    status s = photo_find_model(r->model, &path);
    if (s == OK) s = check_named("weights file", path);
    if (s == OK) s = run(r, path);
    free(path);
    return s;
}

static status run_stereo(const request *r)
{
    const bench_options *o = &r->options;
    bench_stereo_report report;
    status s = bench_stereo(&(bench_stereo_options){o->quick, o->quiet, o->stopped}, &report);
    if (s != OK) return s;
    if (r->json) return json_report_print(bench_stereo_json(&report));
    bench_stereo_print(&report, stdout);
    return OK;
}

int cmd_bench(int argc, char **argv)
{
    char folder[PATH_MAX], merlin[PATH_MAX + 8];
    bool known = file_program_folder(folder);
    snprintf(merlin, sizeof merlin, "%s/merlin", known ? folder : "."); /* beside merlin-lab */
    request r = {.options = {.program = merlin, .stopped = cli_interrupted}};
    if (parse(argc, argv, &r) != OK) return cli_usage("bench", "%s", status_message());
    if (r.help) return fputs(help, stdout) < 0;
    cli_catch_interrupts();
    status s = r.stereo ? run_stereo(&r) : r.config ? run_with_random_weights(&r) : run_with_model(&r);
    return s == OK ? 0 : cli_fail("bench", s);
}
