/* SPDX-License-Identifier: MIT */
/* The commands of merlin-lab: each takes what follows its name and returns the exit status (command/cli.h). */
#ifndef MERLIN_LAB_CLI_LAB_COMMANDS_H
#define MERLIN_LAB_CLI_LAB_COMMANDS_H

int cmd_render(int argc, char **argv);
int cmd_train(int argc, char **argv);
int cmd_eval(int argc, char **argv);
int cmd_average(int argc, char **argv);
int cmd_export(int argc, char **argv);
int cmd_bench(int argc, char **argv);

#endif
