/* merlin eval stereo: the paper's Table 3. */
#include <getopt.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>

#include "cli/cli.h"
#include "cli/eval_commands.h"
#include "cli/photos.h"
#include "eval/stereo_table.h"

static const char help[] =
    "usage: merlin eval stereo --data DIR [options]\n\n"
    "How far normals are off, as in the paper's Table 3: the network's own from a single photograph, those of\n"
    "photometric stereo from that photograph relit, and from real pictures; with the lights known and not. 32 of 50\n"
    "relit pictures and 32 of the real ones are drawn five times.\n\n"
    "  --data DIR         samples with many targets (merlin render --targets 52), an object's folder in the LUCES or\n"
    "                     DiLiGenT layout, or a folder of such folders\n"
    "  --model W          weights to measure (default: merlin-point)\n"
    "  --count N          only the first N objects\n"
    "  --figure F.png     a picture of the normals and where they are off\n"
    "      --json         report on standard output as JSON\n"
    "      --quiet        no progress\n"
    "  -h, --help         this text\n\n"
    "The rendered near-field set of docs/evaluation.md is made by\n"
    "  merlin render --count 14 --seed 52 --size 256 --targets 52 --paths 16 --no-env -o near-field\n";

enum { OPTION_DATA = 256, OPTION_MODEL, OPTION_COUNT, OPTION_FIGURE, OPTION_JSON, OPTION_QUIET };

static const struct option long_options[] = {
    {"data", required_argument, NULL, OPTION_DATA},
    {"model", required_argument, NULL, OPTION_MODEL},
    {"count", required_argument, NULL, OPTION_COUNT},
    {"figure", required_argument, NULL, OPTION_FIGURE},
    {"json", no_argument, NULL, OPTION_JSON},
    {"quiet", no_argument, NULL, OPTION_QUIET},
    {"help", no_argument, NULL, 'h'},
    {0},
};

typedef struct request {
    stereo_options options;
    const char *model;
    bool json, help;
} request;

static status take_option(int option, const char *value, request *r)
{
    long number = 0;
    status s;
    switch (option) {
    case OPTION_DATA:
        r->options.data = value;
        return OK;
    case OPTION_MODEL:
        r->model = value;
        return OK;
    case OPTION_COUNT:
        s = cli_int("--count", value, 1, 100000000, &number);
        r->options.count = (size_t)number;
        return s;
    case OPTION_FIGURE:
        r->options.figure = value;
        return OK;
    case OPTION_JSON:
        r->json = true;
        return OK;
    case OPTION_QUIET:
        r->options.quiet = true;
        return OK;
    case 'h':
        r->help = true;
        return OK;
    default:
        return fail(ERROR_USAGE, "unknown option, or its value is missing");
    }
}

static status parse(int argc, char **argv, request *r)
{
    int option;
    opterr = 0;
    optind = 1;
    while ((option = getopt_long(argc, argv, "h", long_options, NULL)) != -1) {
        status s = take_option(option, optarg, r);
        if (s != OK || r->help) return s;
    }
    if (optind < argc) return fail(ERROR_USAGE, "unexpected argument \"%s\"", argv[optind]);
    return r->options.data ? OK : fail(ERROR_USAGE, "--data DIR is missing");
}

static status announce(const request *r, const stereo_table *t)
{
    if (!r->json) {
        stereo_table_print(t, stdout);
        return OK;
    }
    char *json = stereo_table_json(t);
    if (!json) return fail(ERROR_MEMORY, "no memory for the report");
    puts(json);
    free(json);
    return OK;
}

int eval_stereo(int argc, char **argv)
{
    request r = {.options = {.stopped = cli_interrupted}};
    if (parse(argc, argv, &r) != OK) return cli_usage("eval stereo", "%s", status_message());
    if (r.help) return fputs(help, stdout) < 0;
    char *weights;
    status s = photo_find_model(r.model, &weights);
    if (s != OK) return cli_fail("eval stereo", s);
    r.options.weights = weights;
    cli_catch_interrupts();
    stereo_table table;
    s = stereo_table_run(&r.options, &table);
    free(weights);
    if (s == OK) {
        s = announce(&r, &table);
        stereo_table_free(&table);
    }
    return s == OK ? 0 : cli_fail("eval stereo", s);
}
