/* SPDX-License-Identifier: MIT */
/* merlin-lab eval solvers: photometric stereo on data with known ground truth. */
#include <stdbool.h>
#include <stdio.h>

#include "command/cli.h"
#include "command/json_line.h"
#include "command/options.h"
#include "lab/cli/eval/eval_commands.h"
#include "lab/eval/stereo/solver_table.h"

static const char help[] =
    "usage: merlin-lab eval solvers [options]\n\n"
    "How far the normals and depth of photometric stereo are off, and how long it takes, on objects rendered under 50\n"
    "known lights: least squares and robust under distant lights, near under LEDs beside the object.\n\n"
    "      --count N    objects (default 8)\n"
    "      --seed S     other objects (default 2000)\n"
    "      --size P     pixels on a side (default 224: some 20,000 of an object)\n"
    "      --json       report on standard output as JSON\n"
    "  -t, --threads N  how many threads work (default: one a processor)\n"
    "  -q, --quiet      no progress\n"
    "  -h, --help       this text\n";

typedef struct request {
    solver_options options;
    bool json, help;
} request;

static status parse(int argc, char **argv, request *r)
{
    const cli_option options[] = {
        {"count", .count = &r->options.count, .low = 1, .high = 100000},
        {"seed", .whole = &r->options.seed, .low = 0, .high = 2147483647},
        {"size", .integer = &r->options.size, .low = 32, .high = 2048},
        {"json", .flag = &r->json},
        {"quiet", 'q', .flag = &r->options.quiet},
        {"help", 'h', .flag = &r->help},
        {0},
    };
    status s = cli_read_options(&argc, &argv, options);
    if (s != OK || r->help) return s;
    return argc == 0 ? OK : fail(MERLIN_WRONG_USE, "unexpected argument \"%s\"", argv[0]);
}

static status announce(const request *r, const solver_table *t)
{
    if (r->json) return json_report_print(solver_table_json(t));
    solver_table_print(t, stdout);
    return OK;
}

int eval_solvers(int argc, char **argv)
{
    request r = {.options = {.seed = 2000, .count = 8, .size = 224, .stopped = cli_interrupted}};
    if (parse(argc, argv, &r) != OK) return cli_usage("eval solvers", "%s", status_message());
    if (r.help) return fputs(help, stdout) < 0;
    cli_catch_interrupts();
    solver_table table;
    status s = solver_table_run(&r.options, &table);
    if (s == OK) {
        s = announce(&r, &table);
        solver_table_free(&table);
    }
    return s == OK ? 0 : cli_fail("eval solvers", s);
}
