/* SPDX-License-Identifier: MIT */
/* merlin-lab eval table1, table2 and table3: the paper's tables by weights of this project's. */
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>

#include "command/cli.h"
#include "command/json_line.h"
#include "command/options.h"
#include "lab/cli/eval/eval_commands.h"
#include "lab/cli/eval/judge.h"
#include "lab/eval/paper/paper_table.h"
#include "lab/eval/paper/paper_table3.h"
#include "photo_stereo/subsets.h"

static const char help[] =
    "usage: merlin-lab eval table1 --data DIR WEIGHTS... [options]\n"
    "       merlin-lab eval table2 --data DIR WEIGHTS... [options]\n\n"
    "The paper's table of design choices, or of its rivals: weights of configs/runs/table1 or of\n"
    "configs/runs/table2, each measured alone on held-out samples (as merlin-lab eval --raw --views 1) in the row of\n"
    "its model, with the paper's figures below. Several weights of a model are runs with other seeds: their mean and\n"
    "standard deviation are shown.\n\n"
    "  --data DIR       held-out samples\n"
    "  --count N        only the first N samples\n"
    "      --json       report on standard output as JSON\n"
    "  -t, --threads N  how many threads work (default: one a processor)\n"
    "  -q, --quiet      no progress\n"
    "  -h, --help       this text\n";

typedef struct request {
    paper_options options;
    bool json, help;
} request;

static status parse(int argc, char **argv, request *r)
{
    const cli_option options[] = {
        {"data", .text = &r->options.data}, {"count", .count = &r->options.samples, .low = 1, .high = 1000000},
        {"json", .flag = &r->json},         {"quiet", 'q', .flag = &r->options.quiet},
        {"help", 'h', .flag = &r->help},    {0},
    };
    status s = cli_read_options(&argc, &argv, options);
    if (s != OK || r->help) return s;
    r->options.weights = (const char *const *)argv;
    r->options.count = argc;
    if (!r->options.data) return fail(MERLIN_WRONG_USE, "--data DIR is missing");
    return argc > 0 ? OK : fail(MERLIN_WRONG_USE, "name weights to measure");
}

static status announce(const request *r, const paper_table *t)
{
    if (r->json) return json_report_print(paper_table_json(t));
    paper_table_print(t, stdout);
    return OK;
}

static int run(int argc, char **argv, paper_which which, const char *name)
{
    request r = {.options = {.which = which, .stopped = cli_interrupted}};
    if (parse(argc, argv, &r) != OK) return cli_usage(name, "%s", status_message());
    if (r.help) return fputs(help, stdout) < 0;
    cli_catch_interrupts();
    paper_table table;
    status s = paper_table_run(&r.options, &table);
    if (s != OK) return cli_fail(name, s);
    s = announce(&r, &table);
    paper_table_free(&table);
    return s == OK ? 0 : cli_fail(name, s);
}

int eval_table1(int argc, char **argv)
{
    return run(argc, argv, PAPER_TABLE1, "eval table1");
}

int eval_table2(int argc, char **argv)
{
    return run(argc, argv, PAPER_TABLE2, "eval table2");
}

static const char help3[] =
    "usage: merlin-lab eval table3 --data DIR WEIGHTS... [options]\n\n"
    "The paper's table of photometric stereo from relit pictures, as merlin-lab eval stereo has it, with rows for\n"
    "pictures that each of several weights relit: by the maps' BRDF, and by its network where it is Sang's.\n\n"
    "  --data DIR         samples with many targets, or captures (merlin-lab eval stereo --help)\n"
    "  --method universal a judge more: a network that sees the pictures of a draw together, lights unknown\n"
    "  --nfps W           a judge more: weights of the network of near lights (configs/runs/merlin-nfps);\n"
    "                     with --method universal also with lights that a network tells\n"
    "  --count N          only the first N objects\n"
    "  --draws N          only the first N of the five draws\n"
    "      --json         report on standard output as JSON\n"
    "  -t, --threads N    how many threads work (default: one a processor)\n"
    "  -q, --quiet        no progress\n"
    "  -h, --help         this text\n";

typedef struct request3 {
    paper3_options options;
    const char *method;
    bool json, help;
} request3;

static status parse3(int argc, char **argv, request3 *r)
{
    const cli_option options[] = {
        {"data", .text = &r->options.stereo.data},
        {"method", .text = &r->method},
        {"nfps", .text = &r->options.stereo.nfps},
        {"count", .count = &r->options.stereo.count, .low = 1, .high = 1000000},
        {"draws", .integer = &r->options.stereo.draws, .low = 1, .high = SUBSETS},
        {"json", .flag = &r->json},
        {"quiet", 'q', .flag = &r->options.stereo.quiet},
        {"help", 'h', .flag = &r->help},
        {0},
    };
    status s = cli_read_options(&argc, &argv, options);
    if (s != OK || r->help) return s;
    r->options.weights = (const char *const *)argv;
    r->options.count = argc;
    if (!r->options.stereo.data) return fail(MERLIN_WRONG_USE, "--data DIR is missing");
    s = judge_check(r->method);
    return s != OK || argc > 0 ? s : fail(MERLIN_WRONG_USE, "name weights to relight with");
}

static status announce3(const request3 *r, const paper3_table *t)
{
    if (r->json) return json_report_print(paper3_table_json(t));
    paper3_table_print(t, stdout);
    return OK;
}

int eval_table3(int argc, char **argv)
{
    request3 r = {.options.stereo.stopped = cli_interrupted};
    if (parse3(argc, argv, &r) != OK) return cli_usage("eval table3", "%s", status_message());
    if (r.help) return fputs(help3, stdout) < 0;
    cli_catch_interrupts();
    judge by;
    paper3_table table;
    status s = judge_find(r.method, &by, &r.options.stereo);
    if (s == OK) s = paper3_table_run(&r.options, &table);
    judge_free(&by);
    if (s != OK) return cli_fail("eval table3", s);
    s = announce3(&r, &table);
    paper3_table_free(&table);
    return s == OK ? 0 : cli_fail("eval table3", s);
}
