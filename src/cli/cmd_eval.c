/* merlin eval: the paper's measures on held-out samples, beside trivial answers. */
#include <getopt.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "cli/cli.h"
#include "cli/eval_commands.h"
#include "eval/evaluate.h"
#include "eval/report.h"
#include "eval/trivial.h"

static const char help[] =
    "usage: merlin eval --data DIR --model W [options]\n"
    "       merlin eval --means DIR -o FILE.exr\n"
    "       merlin eval stereo --data DIR [options]\n"
    "       merlin eval photos PHOTO|FOLDER... --model W [--model W2] -o FILE.png\n\n"
    "Measures a model on samples it was not trained on (a folder made by merlin render), beside two trivial answers:\n"
    "the data set's mean maps, and maps inflated from the mask. The second form computes the mean maps of a folder of\n"
    "training data, to be given to the first. The third measures photometric stereo (merlin eval stereo --help), the "
    "fourth\n"
    "shows photographs taken apart by several weights side by side (merlin eval photos --help).\n\n"
    "  --data DIR         held-out samples\n"
    "  --model W          weights to measure\n"
    "  --means-file FILE  mean maps of the training data; without it those of the held-out samples are taken\n"
    "  --count N          only the first N samples\n"
    "  --precision P      float32 (default) or bfloat16\n"
    "  --figure F.png     a picture of predictions beside the truth\n"
    "  --figure-rows N    samples shown in it (default 8)\n"
    "  --means DIR        compute mean maps over this folder\n"
    "  -o, --output FILE  where to write them\n"
    "      --json         report on standard output as JSON\n"
    "      --quiet        no progress\n"
    "  -h, --help         this text\n";

enum {
    OPTION_DATA = 256,
    OPTION_MODEL,
    OPTION_MEANS_FILE,
    OPTION_COUNT,
    OPTION_PRECISION,
    OPTION_FIGURE,
    OPTION_FIGURE_ROWS,
    OPTION_MEANS,
    OPTION_JSON,
    OPTION_QUIET
};

static const struct option long_options[] = {
    {"data", required_argument, NULL, OPTION_DATA},
    {"model", required_argument, NULL, OPTION_MODEL},
    {"means-file", required_argument, NULL, OPTION_MEANS_FILE},
    {"count", required_argument, NULL, OPTION_COUNT},
    {"precision", required_argument, NULL, OPTION_PRECISION},
    {"figure", required_argument, NULL, OPTION_FIGURE},
    {"figure-rows", required_argument, NULL, OPTION_FIGURE_ROWS},
    {"means", required_argument, NULL, OPTION_MEANS},
    {"output", required_argument, NULL, 'o'},
    {"json", no_argument, NULL, OPTION_JSON},
    {"quiet", no_argument, NULL, OPTION_QUIET},
    {"help", no_argument, NULL, 'h'},
    {0},
};

typedef struct eval_request {
    eval_options options;
    const char *means_folder, *output;
    bool json, help;
} eval_request;

static status parse_precision(const char *text, nn_type *out)
{
    if (strcmp(text, "float32") == 0)
        *out = NN_FLOAT32;
    else if (strcmp(text, "bfloat16") == 0)
        *out = NN_BFLOAT16;
    else
        return fail(ERROR_USAGE, "--precision wants float32 or bfloat16, not \"%s\"", text);
    return OK;
}

static status parse_option(int option, const char *value, eval_request *r)
{
    long number = 0;
    status s = OK;
    switch (option) {
    case OPTION_DATA:
        r->options.data = value;
        break;
    case OPTION_MODEL:
        r->options.weights = value;
        break;
    case OPTION_MEANS_FILE:
        r->options.means = value;
        break;
    case OPTION_COUNT:
        s = cli_int("--count", value, 1, 100000000, &number);
        r->options.count = (size_t)number;
        break;
    case OPTION_PRECISION:
        s = parse_precision(value, &r->options.type);
        break;
    case OPTION_FIGURE:
        r->options.figure = value;
        break;
    case OPTION_FIGURE_ROWS:
        s = cli_int("--figure-rows", value, 1, 64, &number);
        r->options.figure_rows = (int)number;
        break;
    case OPTION_MEANS:
        r->means_folder = value;
        break;
    case 'o':
        r->output = value;
        break;
    case OPTION_JSON:
        r->json = true;
        break;
    case OPTION_QUIET:
        r->options.quiet = true;
        break;
    case 'h':
        r->help = true;
        break;
    default:
        break;
    }
    return s;
}

static int run_means(const eval_request *r)
{
    if (!r->output) return cli_usage("eval", "--means needs -o FILE.exr");
    eval_means means;
    status s = eval_means_of_folder(r->means_folder, r->options.count, r->options.quiet, &means);
    if (s != OK) return cli_fail("eval", s);
    s = eval_means_write(&means, r->output);
    if (s == OK && !r->options.quiet) printf("%s: means over %zu samples\n", r->output, means.samples);
    eval_means_free(&means);
    return s == OK ? 0 : cli_fail("eval", s);
}

static int run_evaluation(const eval_request *r)
{
    if (!r->options.data) return cli_usage("eval", "--data DIR is missing");
    if (!r->options.weights) return cli_usage("eval", "--model W is missing");
    eval_report report;
    status s = eval_run(&r->options, &report);
    if (s != OK) return cli_fail("eval", s);
    if (!r->json) {
        eval_print_table(&report, stdout);
        return 0;
    }
    char *json = eval_report_json(&report);
    if (!json) return cli_fail("eval", fail(ERROR_MEMORY, "no memory for the report"));
    puts(json);
    free(json);
    return 0;
}

int cmd_eval(int argc, char **argv)
{
    if (argc > 1 && strcmp(argv[1], "stereo") == 0) return eval_stereo(argc - 1, argv + 1);
    if (argc > 1 && strcmp(argv[1], "photos") == 0) return eval_photos(argc - 1, argv + 1);
    eval_request r = {.options = {.figure_rows = 8, .stopped = cli_interrupted}};
    opterr = 0;
    for (int option; (option = getopt_long(argc, argv, ":o:h", long_options, NULL)) != -1;) {
        if (option == ':') return cli_usage("eval", "%s wants a value", argv[optind - 1]);
        if (option == '?') return cli_usage("eval", "unknown option %s", argv[optind - 1]);
        status s = parse_option(option, optarg, &r);
        if (s != OK) return cli_fail("eval", s);
    }
    if (r.help) return fputs(help, stdout) < 0;
    if (optind < argc) return cli_usage("eval", "unexpected argument \"%s\"", argv[optind]);
    cli_catch_interrupts();
    return r.means_folder ? run_means(&r) : run_evaluation(&r);
}
