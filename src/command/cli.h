/* SPDX-License-Identifier: MIT */
/* What the subcommands share: their table, how they refuse, and how they read option values.
 *
 * A command returns the exit status: 0, 2 for wrong use, 1 for anything else. It prints one line to stderr when it
 * fails, "PROGRAM COMMAND: message". Each reads its options by a table of command/options.h and knows --help, --json
 * and
 * --quiet. */
#ifndef MERLIN_COMMAND_CLI_H
#define MERLIN_COMMAND_CLI_H

#include "base/status.h"

typedef struct cli_command {
    const char *name, *summary;
    int (*run)(int argc, char **argv);
} cli_command;

/* Prints "PROGRAM COMMAND: " and the status's message; returns 2 for MERLIN_WRONG_USE, else 1. */
int cli_fail(const char *command, status s);
/* Prints "PROGRAM COMMAND: message (try PROGRAM COMMAND --help)"; returns 2. */
int cli_usage(const char *command, const char *format, ...) __attribute__((format(printf, 2, 3)));
/* One of both, for a command's arguments that were refused: cli_usage for MERLIN_WRONG_USE, else cli_fail. */
int cli_refuse(const char *command, status s);
/* Whole-text numbers within [low, high]; the message names the option. */
status cli_int(const char *option, const char *text, long low, long high, long *out);
status cli_float(const char *option, const char *text, double low, double high, double *out);
status cli_vec3(const char *option, const char *text, float out[3]); /* "x,y,z" */
/* Set by SIGINT, SIGTERM and SIGHUP once cli_catch_interrupts was called; long work polls it and stops tidily. */
void cli_catch_interrupts(void);
int cli_interrupted(void);

#endif
