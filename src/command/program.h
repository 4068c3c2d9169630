/* SPDX-License-Identifier: MIT */
/* A program of several commands: finds the requested one and runs it.
 *
 *     static const cli_command commands[] = {{"estimate", "take a photograph apart", cmd_estimate}};
 *     int main(int argc, char **argv)
 *     {
 *         static const program merlin = {.name = "merlin", .about = "...", .commands = commands, .count = 1};
 *         return program_run(&merlin, argc, argv);
 *     } */
#ifndef MERLIN_COMMAND_PROGRAM_H
#define MERLIN_COMMAND_PROGRAM_H

#include <stddef.h>

#include "command/cli.h"

typedef struct program {
    const char *name, *about; /* about: one sentence for the help */
    const cli_command *commands;
    size_t count;
    /* names of commands of another program for which users may look here, ended by NULL */
    const char *other;
    const char *const *elsewhere;
} program;

/* Returns the exit status: that of the command, 0 after help and version, 2 if there is no such command. It prints "out
 * of memory" on one line where libraries would abort, and prepares the process for pictures; only main may call it. */
int program_run(const program *p, int argc, char **argv);

#endif
