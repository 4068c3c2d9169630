/* SPDX-License-Identifier: MIT */
/* merlin-lab eval: the paper's measures on held-out samples, beside trivial answers. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/file.h"
#include "command/check_files.h"
#include "command/cli.h"
#include "command/json_line.h"
#include "command/options.h"
#include "command/photos.h"
#include "lab/cli/eval/eval_commands.h"
#include "lab/cli/lab_commands.h"
#include "lab/eval/samples/evaluate.h"
#include "lab/eval/samples/sample_report.h"
#include "lab/eval/samples/trivial.h"

static const char help[] =
    "usage: merlin-lab eval --data DIR --model W [options]\n"
    "       merlin-lab eval --means DIR -o FILE.exr\n"
    "       merlin-lab eval stereo --data DIR [options]\n"
    "       merlin-lab eval doubts [--right P] [--wrong P] [--data DIR] [options]\n"
    "       merlin-lab eval masks [PHOTO|FOLDER...] [--data DIR] [options]\n"
    "       merlin-lab eval solvers [options]\n"
    "       merlin-lab eval detail --data DIR [options]\n"
    "       merlin-lab eval lights --data DIR [options]\n"
    "       merlin-lab eval several --data DIR [options]\n"
    "       merlin-lab eval unknown [--data DIR] [options]\n"
    "       merlin-lab eval pictures FOLDER... [options]\n"
    "       merlin-lab eval table1 --data DIR WEIGHTS... [options]\n"
    "       merlin-lab eval table2 --data DIR WEIGHTS... [options]\n"
    "       merlin-lab eval table3 --data DIR WEIGHTS... [options]\n"
    "       merlin-lab eval photos PHOTO|FOLDER... --model W [--model W2] -o FILE.png\n\n"
    "Measures what merlin estimate and merlin relight make by a model of samples it was not trained on (a folder made "
    "by\n"
    "merlin-lab render), or with --raw its network alone, beside two trivial answers: the data set's mean maps, and "
    "maps\n"
    "inflated from the mask. The second form computes the mean maps of a folder of training data, to be given to the "
    "first.\n"
    "The others have a --help of their own: photometric stereo from one photograph, its solvers where the truth is "
    "known,\n"
    "what more pixels add to an estimate's shape, what an estimate is worth by the kind of light and from every "
    "picture "
    "of a\n"
    "capture, the paper's tables, and photographs taken apart by several weights side by side.\n\n"
    "  --data DIR         held-out samples\n"
    "  --model W          weights to measure: a file, or merlin-point, merlin-env or merlin-any\n"
    "  --means-file FILE  mean maps of the training data; without it those of the held-out samples are taken\n"
    "  --count N          only the first N samples\n"
    "  --raw              the network alone, as in the paper: the sample at its size, its exposure known, nothing "
    "refined\n"
    "  --white W          the photograph is exposed so that radiance W saturates (default 1.568, a camera's; with "
    "--raw\n"
    "                     1, as in the paper)\n"
    "  --given MAP        with --raw: the true albedo, normal, roughness or depth in place of the network's; may be\n"
    "                     repeated: how well a model relights that errs in the others alone\n"
    "  --environments N   relight the first N samples by environments, too (seconds each)\n"
    "  --views N          maps as merlin estimate --views N makes them (default 4, as there)\n"
    "  --precision P      with --raw: float32 (default) or bfloat16\n"
    "  --figure F.png     a picture of predictions beside the truth\n"
    "  --figure-rows N    samples shown in it (default 8)\n"
    "  --means DIR        compute mean maps over this folder\n"
    "  -o, --output FILE  where to write them\n"
    "      --json         report on standard output as JSON\n"
    "  -t, --threads N    how many threads work (default: one a processor)\n"
    "  -q, --quiet        no progress, and with --means no other output than errors\n"
    "  -h, --help         this text\n";

enum { USUAL_ROWS = 8 };

typedef struct request {
    eval_options options;
    const char *means_folder, *output;
    bool json, help;
} request;

static status take_precision(const char *text, void *into)
{
    nn_type *out = into;
    if (strcmp(text, "float32") == 0)
        *out = NN_FLOAT32;
    else if (strcmp(text, "bfloat16") == 0)
        *out = NN_BFLOAT16;
    else
        return fail(MERLIN_WRONG_USE, "--precision wants float32 or bfloat16, not \"%s\"", text);
    return OK;
}

static status take_given(const char *text, void *into)
{
    int map = eval_given_of(text), *set = into;
    *set |= map;
    return map ? OK : fail(MERLIN_WRONG_USE, "--given wants albedo, normal, roughness or depth, not \"%s\"", text);
}

/* Refuses to write means into the folder of samples: every EXR there is taken for a sample, so that training would
 * fail. */
static status check_means_apart(const request *r)
{
    char *folder = file_folder_of(r->output);
    if (!folder) return fail(MERLIN_NO_MEMORY, "no memory for a file name");
    bool among = file_is_same(folder, r->means_folder);
    free(folder);
    if (!among) return OK;
    return fail(MERLIN_WRONG_USE, "-o %s would be taken for a sample of %s: name another folder", r->output,
                r->means_folder);
}

static status check_raw(const eval_options *o)
{
    if (o->raw) return OK;
    if (o->given) return fail(MERLIN_WRONG_USE, "--given goes with --raw: merlin estimate knows no true maps");
    if (o->type != NN_FLOAT32)
        return fail(MERLIN_WRONG_USE, "--precision goes with --raw: merlin estimate computes in what is fastest");
    return OK;
}

/* Checks that the report can be written before the evaluation begins. */
static status check(const request *r)
{
    const eval_options *o = &r->options;
    if (!r->means_folder && r->output)
        return fail(MERLIN_WRONG_USE, "-o is for --means; an evaluation prints its report, with --json for a program");
    if (!r->means_folder) return check_raw(o);
    bool evaluates = o->data || o->weights || o->means || o->environments || o->white > 0 || o->given || o->views ||
                     o->figure || o->figure_rows || o->raw || o->type != NN_FLOAT32;
    if (evaluates || r->json) return fail(MERLIN_WRONG_USE, "--means goes with -o, --count and --quiet alone");
    if (!r->output) return fail(MERLIN_WRONG_USE, "--means needs -o FILE.exr");
    if (!file_ends_in(r->output, ".exr"))
        return fail(MERLIN_WRONG_USE, "-o names mean maps to write, an EXR: let %s end in .exr", r->output);
    return check_means_apart(r);
}

static status parse(int argc, char **argv, request *r)
{
    const cli_option options[] = {
        {"data", .text = &r->options.data},
        {"model", .text = &r->options.weights},
        {"means-file", .text = &r->options.means},
        {"count", .count = &r->options.count, .low = 1, .high = 100000000},
        {"environments", .count = &r->options.environments, .low = 1, .high = 100000000},
        {"raw", .flag = &r->options.raw},
        {"white", .real = &r->options.white, .low = 1, .high = 16},
        {"given", .take = take_given, .into = &r->options.given, .many = true},
        {"views", .integer = &r->options.views, .low = 1, .high = 8},
        {"precision", .take = take_precision, .into = &r->options.type},
        {"figure", .picture = &r->options.figure},
        {"figure-rows", .integer = &r->options.figure_rows, .low = 1, .high = 64},
        {"means", .text = &r->means_folder},
        {"output", 'o', .text = &r->output},
        {"json", .flag = &r->json},
        {"quiet", 'q', .flag = &r->options.quiet},
        {"help", 'h', .flag = &r->help},
        {0},
    };
    status s = cli_read_options(&argc, &argv, options);
    if (s != OK || r->help) return s;
    return argc == 0 ? check(r) : fail(MERLIN_WRONG_USE, "unexpected argument \"%s\"", argv[0]);
}

static int run_means(const request *r)
{
    eval_means means;
    const eval_options *o = &r->options;
    status s = file_check_writable(r->output);
    if (s == OK) s = eval_means_of_folder(r->means_folder, o->count, o->quiet, o->stopped, &means);
    if (s != OK) return cli_fail("eval", s);
    s = eval_means_write(&means, r->output);
    if (s == OK && !r->options.quiet) printf("%s: means over %zu samples\n", r->output, means.samples);
    eval_means_free(&means);
    return s == OK ? 0 : cli_fail("eval", s);
}

static int run_evaluation(request *r)
{
    if (!r->options.data) return cli_usage("eval", "--data DIR is missing");
    if (!r->options.weights) return cli_usage("eval", "--model W is missing");
    eval_report report;
    char *weights;
    status s = photo_find_model(r->options.weights, &weights);
    if (s == OK) s = check_named("file of means", r->options.means);
    r->options.weights = weights;
    if (s == OK) s = eval_run(&r->options, &report);
    free(weights);
    if (s != OK) return cli_fail("eval", s);
    if (r->json) s = json_report_print(eval_report_json(&report));
    if (s != OK) return cli_fail("eval", s);
    if (!r->json) eval_print_table(&report, stdout);
    return 0;
}

/* Verbs that have a file of their own. */
static const struct {
    const char *name;
    int (*run)(int argc, char **argv);
} verbs[] = {{"stereo", eval_stereo},   {"solvers", eval_solvers}, {"pictures", eval_pictures}, {"lights", eval_lights},
             {"several", eval_several}, {"unknown", eval_unknown}, {"detail", eval_detail},     {"doubts", eval_doubts},
             {"masks", eval_masks},     {"photos", eval_photos},   {"table1", eval_table1},     {"table2", eval_table2},
             {"table3", eval_table3}};

int cmd_eval(int argc, char **argv)
{
    for (size_t i = 0; argc > 1 && i < sizeof verbs / sizeof *verbs; i++)
        if (strcmp(argv[1], verbs[i].name) == 0) return verbs[i].run(argc - 1, argv + 1);
    request r = {.options = {.stopped = cli_interrupted}};
    if (parse(argc, argv, &r) != OK) return cli_usage("eval", "%s", status_message());
    if (r.help) return fputs(help, stdout) < 0;
    if (!r.options.figure_rows) r.options.figure_rows = USUAL_ROWS;
    cli_catch_interrupts();
    return r.means_folder ? run_means(&r) : run_evaluation(&r);
}
