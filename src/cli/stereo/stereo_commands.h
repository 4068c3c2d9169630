/* SPDX-License-Identifier: MIT */
/* Subcommands of merlin stereo with a file of their own. */
#ifndef MERLIN_CLI_STEREO_STEREO_COMMANDS_H
#define MERLIN_CLI_STEREO_STEREO_COMMANDS_H

/* Runs merlin stereo calibrate; argv[0] is "calibrate". Returns the exit status. */
int stereo_calibrate(int argc, char **argv);

#endif
