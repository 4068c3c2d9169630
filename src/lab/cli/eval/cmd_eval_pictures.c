/* SPDX-License-Identifier: MIT */
/* merlin-lab eval pictures: one picture's estimate, for every picture of real captures. */
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>

#include "command/cli.h"
#include "command/json_line.h"
#include "command/options.h"
#include "command/photos.h"
#include "lab/cli/eval/eval_commands.h"
#include "lab/eval/stereo/picture_table.h"

static const char help[] =
    "usage: merlin-lab eval pictures FOLDER... [options]\n\n"
    "How far the normals are off that merlin estimate finds from one picture alone, for every picture of captures for\n"
    "photometric stereo, which are each lit from elsewhere; and how far the lamp that it sees is off. Held against "
    "the\n"
    "true normals where the capture has any (the LUCES and DiLiGenT layouts), else against those of all its pictures\n"
    "together. Nothing is told of lens and light.\n\n"
    "      --lights FILE  the lights of all captures (default: found in each folder, as merlin stereo finds them)\n"
    "      --linear       8-bit pictures are linear already, as in merlin stereo\n"
    "      --model W      weights (default: those merlin estimate takes)\n"
    "      --json         a report of every picture as JSON on standard output\n"
    "  -t, --threads N    how many threads work (default: one a processor)\n"
    "  -q, --quiet        no progress\n"
    "  -h, --help         this text\n";

typedef struct request {
    picture_options options;
    const char *model;
    bool json, help;
} request;

static status parse(int *argc, char ***argv, request *r)
{
    const cli_option options[] = {
        {"lights", .text = &r->options.lights},
        {"linear", .flag = &r->options.linear},
        {"model", .text = &r->model},
        {"json", .flag = &r->json},
        {"quiet", 'q', .flag = &r->options.quiet},
        {"help", 'h', .flag = &r->help},
        {0},
    };
    status s = cli_read_options(argc, argv, options);
    if (s != OK || r->help) return s;
    r->options.folder = (const char *const *)*argv;
    r->options.count = (size_t)*argc;
    return *argc > 0 ? OK : fail(MERLIN_WRONG_USE, "no capture given");
}

static status announce(const request *r, const picture_table *t)
{
    if (r->json) return json_report_print(picture_table_json(t));
    picture_table_print(t, stdout);
    return OK;
}

int eval_pictures(int argc, char **argv)
{
    request r = {.options = {.stopped = cli_interrupted}};
    if (parse(&argc, &argv, &r) != OK) return cli_usage("eval pictures", "%s", status_message());
    if (r.help) return fputs(help, stdout) < 0;
    cli_catch_interrupts();
    char *weights, *flash;
    picture_table table = {.count = 0};
    status s = photo_find_models(r.model, &weights, &flash);
    r.options.weights = weights;
    r.options.flash = flash;
    if (s == OK) s = picture_table_run(&r.options, &table);
    free(weights);
    free(flash);
    if (s == OK) s = announce(&r, &table);
    picture_table_free(&table);
    return s == OK ? 0 : cli_fail("eval pictures", s);
}
