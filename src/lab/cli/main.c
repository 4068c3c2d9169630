/* SPDX-License-Identifier: MIT */
/* merlin-lab: makes and measures the models of merlin. */
#include "command/program.h"
#include "lab/cli/lab_commands.h"

static const cli_command commands[] = {
    {"render", "make training data", cmd_render},
    {"train", "train a model", cmd_train},
    {"eval", "measure a model on held-out data, beside trivial answers", cmd_eval},
    {"average", "the mean of two weights files", cmd_average},
    {"export", "write a model's networks for other runtimes", cmd_export},
    {"bench", "measure what the model and the renderer cost on this machine", cmd_bench},
};

int main(int argc, char **argv)
{
    static const char *const of_merlin[] = {"estimate", "relight", "view", "stereo", "info", NULL};
    static const program lab = {
        .name = "merlin-lab",
        .about = "Training data, training and evaluation of the models that merlin takes photographs apart with.",
        .commands = commands,
        .count = sizeof commands / sizeof *commands,
        .other = "merlin",
        .elsewhere = of_merlin,
    };
    return program_run(&lab, argc, argv);
}
