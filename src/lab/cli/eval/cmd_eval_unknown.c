/* SPDX-License-Identifier: MIT */
/* merlin-lab eval unknown: normals from pictures whose lights nobody knows. */
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>

#include "command/cli.h"
#include "command/json_line.h"
#include "command/options.h"
#include "command/photos.h"
#include "estimate/photo/network.h"
#include "lab/cli/eval/eval_commands.h"
#include "lab/eval/stereo/unknown_table.h"

static const char help[] =
    "usage: merlin-lab eval unknown [--data DIR] [options]\n\n"
    "How far normals are off from 1, 2, 4, 8, 16, 32 and all pictures of an object whose lights nobody knows: those "
    "of\n"
    "the network, these refined by photometric stereo (merlin stereo --method universal), and those of photometric\n"
    "stereo without a network (--method uncalibrated).\n\n"
    "  --data DIR       samples with many targets (merlin-lab render --targets 52), an object's folder in the LUCES "
    "or\n"
    "                   DiLiGenT layout, or a folder of such folders (default: objects rendered under 32 distant\n"
    "                   lights)\n"
    "  --seed S         other rendered objects (default 2000)\n"
    "  --model W        weights (default: merlin-any)\n"
    "  --several W      weights that see the pictures together (default: merlin-several, where it is there)\n"
    "  --nfps W         weights of the network of near lights (default: merlin-nfps, where it is there)\n"
    "  --count N        only the first N objects\n"
    "  --views N        maps as merlin estimate --views N makes them (default 4, as there)\n"
    "  --dim SHARE      expose each picture by chance to a share from this one to 1, as a camera left to itself does\n"
    "  --lens-unknown   as if nothing were known of the lens\n"
    "      --json       report on standard output as JSON\n"
    "  -t, --threads N  how many threads work (default: one a processor)\n"
    "  -q, --quiet      no progress\n"
    "  -h, --help       this text\n";

typedef struct request {
    unknown_options options;
    const char *nfps;
    bool json, help;
} request;

static status parse(int argc, char **argv, request *r)
{
    const cli_option options[] = {
        {"data", .text = &r->options.data},
        {"model", .text = &r->options.weights},
        {"several", .text = &r->options.several},
        {"nfps", .text = &r->nfps},
        {"seed", .whole = &r->options.seed, .low = 0, .high = 2147483647},
        {"count", .count = &r->options.count, .low = 1, .high = 1000000},
        {"views", .integer = &r->options.views, .low = 1, .high = 8},
        {"dim", .real = &r->options.dim, .low = 0, .high = 1},
        {"json", .flag = &r->json},
        {"lens-unknown", .flag = &r->options.lens_unknown},
        {"quiet", 'q', .flag = &r->options.quiet},
        {"help", 'h', .flag = &r->help},
        {0},
    };
    status s = cli_read_options(&argc, &argv, options);
    if (s != OK || r->help) return s;
    if (argc > 0) return fail(MERLIN_WRONG_USE, "unexpected argument \"%s\"", argv[0]);
    return OK;
}

static status announce(const request *r, const unknown_table *t)
{
    if (r->json) return json_report_print(unknown_table_json(t));
    unknown_table_print(t, stdout);
    return OK;
}

int eval_unknown(int argc, char **argv)
{
    request r = {.options = {.seed = 2000, .views = NETWORK_VIEWS, .stopped = cli_interrupted}};
    if (parse(argc, argv, &r) != OK) return cli_usage("eval unknown", "%s", status_message());
    if (r.help) return fputs(help, stdout) < 0;
    cli_catch_interrupts();
    char *weights = NULL, *flash = NULL, *several = NULL;
    merlin_near_network *near = NULL;
    unknown_table table;
    status s = photo_find_models(r.options.weights ? r.options.weights : "merlin-any", &weights, &flash);
    if (s == OK) s = photo_find_several(r.options.several, &several);
    if (s == OK) s = photo_open_near(r.nfps, false, &near);
    r.options.weights = weights;
    r.options.several = several;
    r.options.near = near;
    if (s == OK) s = unknown_table_run(&r.options, &table);
    free(weights);
    free(flash);
    free(several);
    merlin_near_network_close(near);
    if (s == OK) {
        s = announce(&r, &table);
        unknown_table_free(&table);
    }
    return s == OK ? 0 : cli_fail("eval unknown", s);
}
