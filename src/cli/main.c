/* SPDX-License-Identifier: MIT */
/* merlin: the program for photographs. */
#include "cli/commands.h"
#include "command/program.h"

static const cli_command commands[] = {
    {"estimate", "take a photograph apart into albedo, normal, depth and roughness", cmd_estimate},
    {"relight", "show the object of a photograph under other light", cmd_relight},
    {"view", "the maps as a page that a browser opens and lights", cmd_view},
    {"export", "the maps as engines and 3-D programs read them", cmd_export},
    {"stereo", "surfaces from many lights, or from one photograph", cmd_stereo},
    {"serve", "a page and an HTTP interface for all of this", cmd_serve},
    {"info", "say what is in a weights file", cmd_info},
};

int main(int argc, char **argv)
{
    static const char *const of_the_lab[] = {"render", "train", "eval", "bench", NULL};
    static const program merlin = {
        .name = "merlin",
        .about = "One photograph of an object, taken apart into its material and lit again from elsewhere.",
        .commands = commands,
        .count = sizeof commands / sizeof *commands,
        .other = "merlin-lab",
        .elsewhere = of_the_lab,
    };
    return program_run(&merlin, argc, argv);
}
