/* SPDX-License-Identifier: MIT */
/* Functions that all commands share: their table, their errors, and values of options.
 *
 * A command returns the exit status: 0, 2 for wrong use, 1 for other errors. If it fails, it prints one line to stderr,
 * "PROGRAM COMMAND: message". Each reads its options by a table of command/options.h and accepts --help, --json and
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
/* Reports refused arguments of a command: by cli_usage for MERLIN_WRONG_USE, else by cli_fail. */
int cli_refuse(const char *command, status s);
/* Read numbers within [low, high] that make up the whole text; messages name the option. */
status cli_int(const char *option, const char *text, long low, long high, long *out);
status cli_float(const char *option, const char *text, double low, double high, double *out);
status cli_vec3(const char *option, const char *text, float out[3]); /* "x,y,z" */
/* Makes SIGINT, SIGTERM and SIGHUP set cli_interrupted; long work polls it and stops in an orderly way. */
void cli_catch_interrupts(void);
int cli_interrupted(void);

#endif
