/* SPDX-License-Identifier: MIT */
/* merlin-lab average: the mean of two weights files. */
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>

#include "base/file.h"
#include "command/cli.h"
#include "command/options.h"
#include "command/photos.h"
#include "lab/cli/lab_commands.h"
#include "lab/train/mean_weights.h"

static const char help[] =
    "usage: merlin-lab average FIRST SECOND -o WEIGHTS [--share S]\n\n"
    "Writes the mean of two weights files of one network, of which one was trained on from the other: it has most of\n"
    "what was learned and little of what was lost. Which share is best is told by merlin-lab eval.\n\n"
    "      --share S      share of SECOND, from 0 to 1 (default 0.5)\n"
    "  -o, --output FILE  weights to write\n"
    "  -t, --threads N    how many threads work (default: one a processor)\n"
    "  -h, --help         this text\n";

typedef struct request {
    const char *output, *weights[2];
    float share;
    bool help;
} request;

static status parse(int argc, char **argv, request *r)
{
    const cli_option options[] = {
        {"share", .real = &r->share, .low = 0, .high = 1},
        {"output", 'o', .text = &r->output},
        {"help", 'h', .flag = &r->help},
        {0},
    };
    status s = cli_read_options(&argc, &argv, options);
    if (s != OK || r->help) return s;
    if (argc != 2) return fail(MERLIN_WRONG_USE, "name two weights files, not %d", argc);
    r->weights[0] = argv[0];
    r->weights[1] = argv[1];
    return r->output ? OK : fail(MERLIN_WRONG_USE, "-o FILE is missing");
}

int cmd_average(int argc, char **argv)
{
    request r = {.share = 0.5f};
    if (parse(argc, argv, &r) != OK) return cli_usage("average", "%s", status_message());
    if (r.help) return fputs(help, stdout) < 0;
    char *weights[2] = {NULL, NULL};
    status s = file_check_writable(r.output);
    for (int i = 0; i < 2 && s == OK; i++)
        s = photo_find_model(r.weights[i], &weights[i]);
    if (s == OK && (file_is_same(weights[0], r.output) || file_is_same(weights[1], r.output)))
        s = fail(MERLIN_WRONG_USE, "-o %s would replace weights that it is made of: name another file", r.output);
    if (s == OK) s = train_mean_weights(weights[0], weights[1], (double)r.share, r.output);
    free(weights[0]);
    free(weights[1]);
    return s == OK ? 0 : cli_fail("average", s);
}
