/* SPDX-License-Identifier: MIT */
/* The commands of merlin: each gets the arguments after its name and returns the exit status (command/cli.h). */
#ifndef MERLIN_CLI_COMMANDS_H
#define MERLIN_CLI_COMMANDS_H

int cmd_estimate(int argc, char **argv);
int cmd_relight(int argc, char **argv);
int cmd_export(int argc, char **argv);
int cmd_view(int argc, char **argv);
int cmd_stereo(int argc, char **argv);
int cmd_serve(int argc, char **argv);
int cmd_info(int argc, char **argv);

#endif
