/* SPDX-License-Identifier: MIT */
/* merlin-lab eval detail: what a larger picture adds to an estimate's shape. */
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>

#include "command/cli.h"
#include "command/json_line.h"
#include "command/options.h"
#include "command/photos.h"
#include "estimate/photo/network.h"
#include "lab/cli/eval/eval_commands.h"
#include "lab/eval/tables/detail_table.h"

static const char help[] =
    "usage: merlin-lab eval detail --data DIR [options]\n\n"
    "The errors of merlin estimate on samples of more than 256 pixels a side (merlin-lab render --size 512) when the\n"
    "network sees them in 256 pixels, in up to 512, and in both, as it does unless --size says otherwise.\n\n"
    "  --data DIR       held-out samples\n"
    "  --model W        weights (default: those merlin estimate takes)\n"
    "  --count N        only the first N samples\n"
    "  --views N        maps as merlin estimate --views N makes them (default 4, as there)\n"
    "      --json       report on standard output as JSON\n"
    "  -t, --threads N  how many threads work (default: one a processor)\n"
    "  -q, --quiet      no progress\n"
    "  -h, --help       this text\n";

typedef struct request {
    detail_options options;
    bool json, help;
} request;

static status parse(int argc, char **argv, request *r)
{
    const cli_option options[] = {
        {"data", .text = &r->options.data},
        {"model", .text = &r->options.weights},
        {"count", .count = &r->options.count, .low = 1, .high = 1000000},
        {"views", .integer = &r->options.views, .low = 1, .high = 8},
        {"json", .flag = &r->json},
        {"quiet", 'q', .flag = &r->options.quiet},
        {"help", 'h', .flag = &r->help},
        {0},
    };
    status s = cli_read_options(&argc, &argv, options);
    if (s != OK || r->help) return s;
    if (argc > 0) return fail(MERLIN_WRONG_USE, "unexpected argument \"%s\"", argv[0]);
    return r->options.data ? OK : fail(MERLIN_WRONG_USE, "--data DIR is missing");
}

static status announce(const request *r, const detail_table *t)
{
    if (r->json) return json_report_print(detail_table_json(t));
    detail_table_print(t, stdout);
    return OK;
}

int eval_detail(int argc, char **argv)
{
    request r = {.options = {.views = NETWORK_VIEWS, .stopped = cli_interrupted}};
    if (parse(argc, argv, &r) != OK) return cli_usage("eval detail", "%s", status_message());
    if (r.help) return fputs(help, stdout) < 0;
    cli_catch_interrupts();
    char *weights;
    detail_table table;
    status s = photo_find_model(r.options.weights, &weights);
    r.options.weights = weights;
    if (s == OK) s = detail_table_run(&r.options, &table);
    free(weights);
    if (s == OK) s = announce(&r, &table);
    return s == OK ? 0 : cli_fail("eval detail", s);
}
