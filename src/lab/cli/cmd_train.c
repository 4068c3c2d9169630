/* SPDX-License-Identifier: MIT */
/* merlin-lab train: from a folder of samples to weights. */
#include <stdio.h>
#include <stdlib.h>

#include "command/check_files.h"
#include "command/cli.h"
#include "command/options.h"
#include "command/photos.h"
#include "lab/cli/lab_commands.h"
#include "lab/train/train.h"

static const char help[] =
    "usage: merlin-lab train CONFIG.json --data DIR -o DIR [OPTION]...\n"
    "Train the model of a configuration (configs/runs) on samples made by merlin-lab render.\n"
    "\n"
    "  -d, --data DIR      folder of samples, all of the configuration's size\n"
    "  -o, --output DIR    receives weights.safetensors (from the first validation on),\n"
    "                      checkpoint.safetensors, curves.csv, validation.csv, curves.png and seconds.txt\n"
    "  -r, --resume        go on from DIR's checkpoint\n"
    "  -i, --init W        start from these weights (to fine-tune them): a file, or merlin-point or merlin-env\n"
    "      --init-shared W start from those of another model's weights that fit by name and shape; may be repeated:\n"
    "                      what several have is taken from the last\n"
    "  -n, --note TEXT     kept in the weights, such as the commit they were trained with\n"
    "      --mpi           share every batch with the other ranks that mpirun or srun has started "
    "(docs/performance.md)\n"
    "  -t, --threads N     how many threads work (default: one a processor)\n"
    "  -q, --quiet         no progress bar\n"
    "  -h, --help          this text\n"
    "\n"
    "Interrupted (Ctrl-C), it writes a checkpoint first.\n";

enum { MOST_SHARED = 8 };

typedef struct request {
    train_options options;
    const char *shared[MOST_SHARED + 1]; /* ended by NULL */
    bool help, mpi;
} request;

static status take_shared(const char *name, void *into)
{
    request *r = into;
    size_t n = 0;
    while (r->shared[n])
        n++;
    if (n == MOST_SHARED) return fail(MERLIN_WRONG_USE, "--init-shared takes at most %d weights to share", MOST_SHARED);
    r->shared[n] = name;
    return OK;
}

static status parse(int argc, char **argv, request *r)
{
    train_options *o = &r->options;
    const cli_option options[] = {
        {"data", 'd', .text = &o->data},
        {"output", 'o', .folder = &o->output},
        {"resume", 'r', .flag = &o->resume},
        {"init", 'i', .text = &o->init},
        {"init-shared", .take = take_shared, .into = r, .many = true},
        {"note", 'n', .text = &o->note},
        {"mpi", .flag = &r->mpi},
        {"quiet", 'q', .flag = &o->quiet},
        {"help", 'h', .flag = &r->help},
        {0},
    };
    status s = cli_read_options(&argc, &argv, options);
    if (s != OK || r->help) return s;
    if (argc != 1) return fail(MERLIN_WRONG_USE, "give one configuration file");
    if (!o->data) return fail(MERLIN_WRONG_USE, "--data is missing");
    if (!o->output) return fail(MERLIN_WRONG_USE, "--output is missing");
    bool starts_shared = r->shared[0] != NULL;
    if (o->init && starts_shared) return fail(MERLIN_WRONG_USE, "--init and --init-shared exclude each other");
    if ((o->init || starts_shared) && o->resume)
        return fail(MERLIN_WRONG_USE, "%s and --resume exclude each other", o->init ? "--init" : "--init-shared");
    o->init_shared = r->shared;
    o->config = argv[0];
    return OK;
}

/* Finds weights by name as other commands do: a file, or weights that ship with merlin. *path is malloc'ed and replaces
 * the name. */
static status find_weights(const char **name, char **path)
{
    status s = photo_find_model(*name, path);
    if (s == OK) *name = *path;
    return s == OK ? check_named("weights file", *path) : s;
}

static status train(request *r)
{
    train_options *o = &r->options;
    char *init = NULL, *shared[MOST_SHARED] = {0};
    status s = o->init ? find_weights(&o->init, &init) : OK;
    for (size_t i = 0; s == OK && r->shared[i]; i++)
        s = find_weights(&r->shared[i], &shared[i]);
    if (s == OK) s = check_named("configuration", o->config);
    if (s == OK) s = train_run(o);
    free(init);
    for (size_t i = 0; i < MOST_SHARED; i++)
        free(shared[i]);
    return s;
}

/* Ends all ranks; one of them reports an error that all have. */
static int end(ranks *together, status s)
{
    bool all_know = s == OK || s == MERLIN_STOPPED || s == STATUS_ELSEWHERE;
    bool silent = s == OK || s == STATUS_ELSEWHERE || (s == MERLIN_STOPPED && ranks_index(together) > 0);
    int code = s == OK ? 0 : 1;
    if (!silent) code = cli_fail("train", s);
    if (all_know)
        ranks_close(together);
    else
        ranks_abort(together);
    return code;
}

int cmd_train(int argc, char **argv)
{
    request r = {.options = {.interrupted = cli_interrupted}};
    if (parse(argc, argv, &r) != OK) return cli_usage("train", "%s", status_message());
    if (r.help) return fputs(help, stdout) < 0;
    cli_catch_interrupts();
    status s = r.mpi ? ranks_open_mpi(&r.options.together) : OK;
    if (s == OK) s = train(&r);
    return end(r.options.together, s);
}
