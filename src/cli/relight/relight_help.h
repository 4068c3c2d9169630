/* SPDX-License-Identifier: MIT */
/* The help of merlin relight. */
#ifndef MERLIN_CLI_RELIGHT_RELIGHT_HELP_H
#define MERLIN_CLI_RELIGHT_RELIGHT_HELP_H

void relight_print_help(void);

#endif
