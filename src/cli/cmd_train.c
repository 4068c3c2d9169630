/* merlin train: from a folder of samples to weights. */
#include <getopt.h>
#include <stdio.h>

#include "base/parallel.h"
#include "cli/cli.h"
#include "train/train.h"

static void help(void)
{
    puts("Usage: merlin train CONFIG.json --data DIR -o DIR [OPTION]...\n"
         "Train the model of a configuration (configs/) on samples made by merlin render.\n"
         "\n"
         "  -d, --data DIR      folder of samples, all of the configuration's size\n"
         "  -o, --output DIR    receives weights.safetensors, checkpoint.safetensors, curves.csv,\n"
         "                      validation.csv, curves.png and seconds.txt\n"
         "  -r, --resume        go on from DIR's checkpoint\n"
         "  -i, --init W        start from these weights (to fine-tune them)\n"
         "      --init-shared W start from those of another model's weights that fit by name and shape\n"
         "  -n, --note TEXT     kept in the weights, such as the commit they were trained with\n"
         "  -t, --threads N     processor threads (default: all)\n"
         "  -q, --quiet         no progress bar\n"
         "  -h, --help          this text\n"
         "\n"
         "Interrupted (Ctrl-C), it writes a checkpoint first.");
}

enum { OPTION_INIT_SHARED = 256 };

static const struct option options[] = {
    {"data", required_argument, NULL, 'd'},
    {"output", required_argument, NULL, 'o'},
    {"resume", no_argument, NULL, 'r'},
    {"init", required_argument, NULL, 'i'},
    {"init-shared", required_argument, NULL, OPTION_INIT_SHARED},
    {"note", required_argument, NULL, 'n'},
    {"threads", required_argument, NULL, 't'},
    {"quiet", no_argument, NULL, 'q'},
    {"help", no_argument, NULL, 'h'},
    {NULL, 0, NULL, 0},
};

static status set_threads(const char *text)
{
    long threads = 0;
    status s = cli_int("--threads", text, 1, 1024, &threads);
    if (s == OK) parallel_set_threads((int)threads);
    return s;
}

int cmd_train(int argc, char **argv)
{
    trn_options o = {.interrupted = cli_interrupted};
    status s = OK;
    int c;
    opterr = 0; /* one line, and it is ours */
    while ((c = getopt_long(argc, argv, "d:o:ri:n:t:qh", options, NULL)) != -1) {
        switch (c) {
        case 'd':
            o.data = optarg;
            break;
        case 'o':
            o.output = optarg;
            break;
        case 'r':
            o.resume = true;
            break;
        case 'i':
        case OPTION_INIT_SHARED:
            o.init = optarg;
            o.init_shared = c == OPTION_INIT_SHARED;
            break;
        case 'n':
            o.note = optarg;
            break;
        case 't':
            s = set_threads(optarg);
            break;
        case 'q':
            o.quiet = true;
            break;
        case 'h':
            help();
            return 0;
        default:
            return cli_usage("train", "unknown option, or its value is missing: %s", argv[optind - 1]);
        }
        if (s != OK) return cli_fail("train", s);
    }
    if (optind + 1 != argc) return cli_usage("train", "give one configuration file");
    if (!o.data) return cli_usage("train", "--data is missing");
    if (!o.output) return cli_usage("train", "--output is missing");
    if (o.init && o.resume) return cli_usage("train", "--init and --resume exclude each other");
    o.config = argv[optind];
    cli_catch_interrupts();
    s = trn_train(&o);
    return s == OK ? 0 : cli_fail("train", s);
}
