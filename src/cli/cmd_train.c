/* merlin train: from a folder of samples to weights. */
#include <stdio.h>
#include <stdlib.h>

#include "base/parallel.h"
#include "cli/cli.h"
#include "cli/options.h"
#include "cli/photos.h"
#include "train/train.h"

static const char help[] =
    "usage: merlin train CONFIG.json --data DIR -o DIR [OPTION]...\n"
    "Train the model of a configuration (configs/) on samples made by merlin render.\n"
    "\n"
    "  -d, --data DIR      folder of samples, all of the configuration's size\n"
    "  -o, --output DIR    receives weights.safetensors (from the first validation on),\n"
    "                      checkpoint.safetensors, curves.csv, validation.csv, curves.png and seconds.txt\n"
    "  -r, --resume        go on from DIR's checkpoint\n"
    "  -i, --init W        start from these weights (to fine-tune them): a file, or merlin-point or merlin-env\n"
    "      --init-shared W start from those of another model's weights that fit by name and shape\n"
    "  -n, --note TEXT     kept in the weights, such as the commit they were trained with\n"
    "  -t, --threads N     processor threads (default: all)\n"
    "  -q, --quiet         no progress bar\n"
    "  -h, --help          this text\n"
    "\n"
    "Interrupted (Ctrl-C), it writes a checkpoint first.\n";

typedef struct request {
    trn_options options;
    const char *init, *init_shared;
    int threads;
    bool help;
} request;

static status parse(int argc, char **argv, request *r)
{
    trn_options *o = &r->options;
    const cli_option options[] = {
        {"data", 'd', .text = &o->data},
        {"output", 'o', .folder = &o->output},
        {"resume", 'r', .flag = &o->resume},
        {"init", 'i', .text = &r->init},
        {"init-shared", .text = &r->init_shared},
        {"note", 'n', .text = &o->note},
        {"threads", 't', .integer = &r->threads, .low = 1, .high = 1024},
        {"quiet", 'q', .flag = &o->quiet},
        {"help", 'h', .flag = &r->help},
        {0},
    };
    status s = cli_read_options(&argc, &argv, options);
    if (s != OK || r->help) return s;
    if (argc != 1) return fail(ERROR_USAGE, "give one configuration file");
    if (!o->data) return fail(ERROR_USAGE, "--data is missing");
    if (!o->output) return fail(ERROR_USAGE, "--output is missing");
    if (r->init && r->init_shared) return fail(ERROR_USAGE, "--init and --init-shared exclude each other");
    o->init = r->init_shared ? r->init_shared : r->init;
    o->init_shared = r->init_shared != NULL;
    if (o->init && o->resume) return fail(ERROR_USAGE, "--init and --resume exclude each other");
    o->config = argv[0];
    return OK;
}

/* Weights are named as everywhere else: a file, or those that ship. */
static status train(trn_options *o)
{
    char *weights = NULL;
    status s = o->init ? photo_find_model(o->init, &weights) : OK;
    o->init = weights;
    if (s == OK) s = trn_train(o);
    free(weights);
    return s;
}

int cmd_train(int argc, char **argv)
{
    request r = {.options = {.interrupted = cli_interrupted}};
    if (parse(argc, argv, &r) != OK) return cli_usage("train", "%s", status_message());
    if (r.help) return fputs(help, stdout) < 0;
    if (r.threads > 0) parallel_set_threads(r.threads);
    cli_catch_interrupts();
    status s = train(&r.options);
    return s == OK ? 0 : cli_fail("train", s);
}
