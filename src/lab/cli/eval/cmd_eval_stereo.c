/* SPDX-License-Identifier: MIT */
/* merlin-lab eval stereo: the paper's Table 3. */
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>

#include "command/cli.h"
#include "command/json_line.h"
#include "command/options.h"
#include "command/photos.h"
#include "lab/cli/eval/eval_commands.h"
#include "lab/cli/eval/judge.h"
#include "lab/eval/stereo/stereo_table.h"
#include "photo_stereo/subsets.h"

static const char help[] =
    "usage: merlin-lab eval stereo --data DIR [options]\n\n"
    "How far normals are off, as in the paper's Table 3: the network's own from a single photograph, those of\n"
    "photometric stereo from that photograph relit, and from real pictures; with the lights known and not. 32 of 50\n"
    "relit pictures and 32 of the real ones are drawn five times.\n\n"
    "  --data DIR         samples with many targets (merlin-lab render --targets 52 or --leds 52), an object's folder\n"
    "                     in the LUCES or DiLiGenT layout, or a folder of such folders\n"
    "  --model W          weights to measure (default: $MERLIN_MODEL, else merlin-point)\n"
    "  --method universal two rows more: by a network that sees the pictures of a draw together, lights unknown, as\n"
    "                     merlin stereo does (merlin-any and merlin-several)\n"
    "  --nfps W           two rows more: by weights of the network of near lights (configs/runs/merlin-nfps);\n"
    "                     with --method universal also with lights that a network tells; near begins with it, too\n"
    "  --count N          only the first N objects\n"
    "  --draws N          only the first N of the five draws\n"
    "  --pictures N       draw so many instead of 32, from 3 on\n"
    "  --figure F.png     a picture of the normals and where they are off\n"
    "      --json         report on standard output as JSON\n"
    "  -t, --threads N    how many threads work (default: one a processor)\n"
    "  -q, --quiet        no progress\n"
    "  -h, --help         this text\n\n"
    "The rendered near-field set of docs/evaluation.md is made by\n"
    "  merlin-lab render --count 14 --seed 52 --size 256 --targets 52 --paths 16 --no-env -o near-field\n";

typedef struct request {
    stereo_options options;
    const char *model, *method;
    bool json, help;
} request;

static status parse(int *argc, char ***argv, request *r)
{
    const cli_option options[] = {
        {"data", .text = &r->options.data},
        {"model", .text = &r->model},
        {"method", .text = &r->method},
        {"nfps", .text = &r->options.nfps},
        {"count", .count = &r->options.count, .low = 1, .high = 100000000},
        {"draws", .integer = &r->options.draws, .low = 1, .high = SUBSETS},
        {"pictures", .integer = &r->options.pictures, .low = 3, .high = 1000},
        {"figure", .picture = &r->options.figure},
        {"json", .flag = &r->json},
        {"quiet", 'q', .flag = &r->options.quiet},
        {"help", 'h', .flag = &r->help},
        {0},
    };
    status s = cli_read_options(argc, argv, options);
    if (s != OK || r->help) return s;
    if (*argc > 0) return fail(MERLIN_WRONG_USE, "unexpected argument \"%s\"", (*argv)[0]);
    s = judge_check(r->method);
    return s != OK || r->options.data ? s : fail(MERLIN_WRONG_USE, "--data DIR is missing");
}

static status announce(const request *r, const stereo_table *t)
{
    if (r->json) return json_report_print(stereo_table_json(t));
    stereo_table_print(t, stdout);
    return OK;
}

int eval_stereo(int argc, char **argv)
{
    request r = {.options = {.stopped = cli_interrupted}};
    if (parse(&argc, &argv, &r) != OK) return cli_usage("eval stereo", "%s", status_message());
    if (r.help) return fputs(help, stdout) < 0;
    char *weights = NULL, *flash = NULL;
    judge by = {NULL, NULL};
    status s = photo_find_models(r.model, &weights, &flash);
    if (s == OK) s = judge_find(r.method, &by, &r.options);
    r.options.weights = weights;
    r.options.flash = flash;
    cli_catch_interrupts();
    stereo_table table;
    if (s == OK) s = stereo_table_run(&r.options, &table);
    free(weights);
    free(flash);
    judge_free(&by);
    if (s == OK) {
        s = announce(&r, &table);
        stereo_table_free(&table);
    }
    return s == OK ? 0 : cli_fail("eval stereo", s);
}
