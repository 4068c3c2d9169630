/* SPDX-License-Identifier: MIT */
/* merlin-lab eval lights: the accuracy of estimates by kind of light. */
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>

#include "command/cli.h"
#include "command/json_line.h"
#include "command/options.h"
#include "command/photos.h"
#include "estimate/photo/network.h"
#include "lab/cli/eval/eval_commands.h"
#include "lab/eval/tables/light_table.h"

static const char help[] =
    "usage: merlin-lab eval lights --data DIR [options]\n\n"
    "The errors of merlin estimate by the kind of light in the photograph: flash, flash in a room, room, lamps by "
    "their\n"
    "angle from the line to the camera, a lamp in a room, on samples that merlin-lab render made with --lamps (and\n"
    "--lamp-angles for lamps at these).\n\n"
    "  --data DIR       held-out samples\n"
    "  --model W        weights (default: those merlin estimate takes)\n"
    "  --count N        only the first N samples\n"
    "  --views N        maps as merlin estimate --views N makes them (default 4, as there)\n"
    "  --lens-unknown   as if nothing were known of the lens\n"
    "      --json       report on standard output as JSON\n"
    "  -t, --threads N  how many threads work (default: one a processor)\n"
    "  -q, --quiet      no progress\n"
    "  -h, --help       this text\n";

typedef struct request {
    light_options options;
    bool json, help;
} request;

static status parse(int argc, char **argv, request *r)
{
    const cli_option options[] = {
        {"data", .text = &r->options.data},
        {"model", .text = &r->options.weights},
        {"count", .count = &r->options.count, .low = 1, .high = 1000000},
        {"views", .integer = &r->options.views, .low = 1, .high = 8},
        {"lens-unknown", .flag = &r->options.lens_unknown},
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

static status announce(const request *r, const light_table *t)
{
    if (r->json) return json_report_print(light_table_json(t));
    light_table_print(t, stdout);
    return OK;
}

int eval_lights(int argc, char **argv)
{
    request r = {.options = {.views = NETWORK_VIEWS, .stopped = cli_interrupted}};
    if (parse(argc, argv, &r) != OK) return cli_usage("eval lights", "%s", status_message());
    if (r.help) return fputs(help, stdout) < 0;
    cli_catch_interrupts();
    char *weights, *flash;
    light_table table;
    status s = photo_find_models(r.options.weights, &weights, &flash);
    r.options.weights = weights;
    r.options.flash = flash;
    if (s == OK) s = light_table_run(&r.options, &table);
    free(weights);
    free(flash);
    if (s == OK) s = announce(&r, &table);
    return s == OK ? 0 : cli_fail("eval lights", s);
}
