/* SPDX-License-Identifier: MIT */
/* merlin-lab eval several: the accuracy of maps by the number of photographs. */
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>

#include "command/cli.h"
#include "command/json_line.h"
#include "command/options.h"
#include "command/photos.h"
#include "estimate/photo/network.h"
#include "lab/cli/eval/eval_commands.h"
#include "lab/eval/tables/several_table.h"

static const char help[] =
    "usage: merlin-lab eval several --data DIR [options]\n\n"
    "The errors of maps from 1, 2, 4, 8 and 16 photographs of an object, each under a lamp of its own of which "
    "nothing\n"
    "is known, on samples of 256 pixels that merlin-lab render made with --lamps. Weights of one photograph give the\n"
    "mean of what they make of each.\n\n"
    "  --data DIR       held-out samples\n"
    "  --model W        weights (default: merlin-any)\n"
    "  --several W      weights that compare the photographs besides, as merlin stereo does (default: none)\n"
    "  --count N        only the first N samples\n"
    "  --size N         side of the photographs that the network sees, a multiple of 32 (default 256)\n"
    "  --views N        maps as merlin estimate --views N makes them (default 4, as there)\n"
    "      --json       report on standard output as JSON\n"
    "  -t, --threads N  how many threads work (default: one a processor)\n"
    "  -q, --quiet      no progress\n"
    "  -h, --help       this text\n";

typedef struct request {
    several_options options;
    bool json, help;
} request;

static status parse(int argc, char **argv, request *r)
{
    const cli_option options[] = {
        {"data", .text = &r->options.data},
        {"model", .text = &r->options.weights},
        {"several", .text = &r->options.several},
        {"count", .count = &r->options.count, .low = 1, .high = 1000000},
        {"size", .integer = &r->options.size, .low = MERLIN_LEAST_SIZE, .high = NETWORK_SIZE},
        {"views", .integer = &r->options.views, .low = 1, .high = 8},
        {"json", .flag = &r->json},
        {"quiet", 'q', .flag = &r->options.quiet},
        {"help", 'h', .flag = &r->help},
        {0},
    };
    status s = cli_read_options(&argc, &argv, options);
    if (s != OK || r->help) return s;
    if (argc > 0) return fail(MERLIN_WRONG_USE, "unexpected argument \"%s\"", argv[0]);
    if (r->options.size % MERLIN_SIZE_STEP)
        return fail(MERLIN_WRONG_USE, "--size wants a multiple of %d, not %d", MERLIN_SIZE_STEP, r->options.size);
    return r->options.data ? OK : fail(MERLIN_WRONG_USE, "--data DIR is missing");
}

static status announce(const request *r, const several_table *t)
{
    if (r->json) return json_report_print(several_table_json(t));
    several_table_print(t, stdout);
    return OK;
}

int eval_several(int argc, char **argv)
{
    request r = {.options = {.views = NETWORK_VIEWS, .size = NETWORK_SIZE, .stopped = cli_interrupted}};
    if (parse(argc, argv, &r) != OK) return cli_usage("eval several", "%s", status_message());
    if (r.help) return fputs(help, stdout) < 0;
    cli_catch_interrupts();
    char *weights = NULL, *flash = NULL, *several = NULL;
    several_table table;
    status s = photo_find_models(r.options.weights ? r.options.weights : "merlin-any", &weights, &flash);
    if (s == OK && r.options.several) s = photo_find_several(r.options.several, &several);
    r.options.weights = weights;
    r.options.several = several;
    if (s == OK) s = several_table_run(&r.options, &table);
    free(weights);
    free(flash);
    free(several);
    if (s == OK) s = announce(&r, &table);
    return s == OK ? 0 : cli_fail("eval several", s);
}
