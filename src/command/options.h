/* SPDX-License-Identifier: MIT */
/* A command's options as a table: what each is called and where its value goes.
 *
 *     const cli_option options[] = {
 *         {"mask", .text = &r->mask},
 *         {"output", 'o', .text = &r->output},
 *         {"count", .count = &r->count, .low = 1, .high = 1000},
 *         {"by", .take = take_way, .into = r},
 *         {"json", .flag = &r->json},
 *         {"help", 'h', .flag = &r->help},
 *         {0},
 *     };
 *     status s = cli_read_options(&argc, &argv, options);
 *
 * Each row fills one of the places. --threads belongs to every command and needs no row. */
#ifndef MERLIN_COMMAND_OPTIONS_H
#define MERLIN_COMMAND_OPTIONS_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "base/status.h"

typedef struct cli_option {
    const char *name; /* of --name */
    char letter;      /* of -l, or 0 */
    bool *flag;       /* takes no value; is set to true */
    const char **text;
    const char **folder;  /* a folder to write; a picture's name is refused, and so is - unless it is `printed` */
    const char **picture; /* a picture to write, which ends in .png */
    int *integer;         /* from low to high */
    size_t *count;        /* from low to high */
    uint64_t *whole;      /* from low to high */
    float *real;          /* from low to high */
    long low, high;
    status (*take)(const char *value, void *into); /* MERLIN_WRONG_USE for a value it refuses */
    void *into;
    bool printed;                       /* a folder may be -, standard output */
    bool many;                          /* may be given again; flags may, too */
    bool (*is_value)(const char *word); /* beside flag and take: the value may be missing, or be the next word */
} cli_option;

enum { CLI_MOST_OPTIONS = 40 }; /* with those of every command */

/* Reads options wherever they stand, as getopt_long does; *argc and *argv are then the operands alone. What is
 * not `many` is refused the second time: a value that replaced another would be a guess. MERLIN_WRONG_USE names the
 * option. At most CLI_MOST_OPTIONS rows. */
status cli_read_options(int *argc, char ***argv, const cli_option *own);

#endif
