/* SPDX-License-Identifier: MIT */
/* A command's options as a table of their names and the places of their values.
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
 * Each row fills one of the places. --threads is an option of every command and needs no row. */
#ifndef MERLIN_COMMAND_OPTIONS_H
#define MERLIN_COMMAND_OPTIONS_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "base/status.h"

typedef struct cli_option {
    const char *name; /* name in --name */
    char letter;      /* letter in -l, or 0 */
    bool *flag;       /* set to true; the option has no value */
    const char **text;
    const char **folder;  /* a folder to write; a picture's name is refused, and "-" unless `printed` */
    const char **picture; /* a picture to write, whose name ends in .png */
    int *integer;         /* integer from low to high */
    size_t *count;        /* integer from low to high */
    uint64_t *whole;      /* integer from low to high */
    float *real;          /* number from low to high */
    long low, high;
    status (*take)(const char *value, void *into); /* callback; returns MERLIN_WRONG_USE for a value it refuses */
    void *into;
    bool printed; /* whether a folder may be "-", standard output */
    bool many;    /* whether it may be repeated, as flags may */
    bool (*is_value)(
        const char *word); /* with flag and take: whether the next word is the value, which may be missing */
} cli_option;

enum { CLI_MOST_OPTIONS = 40 }; /* including those of every command */

/* Reads options at any position, as getopt_long does; afterwards *argc and *argv contain only the operands. A repeated
 * option that is not `many` is refused, since replacing its value would be a guess. MERLIN_WRONG_USE names the option.
 * At most CLI_MOST_OPTIONS rows. */
status cli_read_options(int *argc, char ***argv, const cli_option *own);

#endif
