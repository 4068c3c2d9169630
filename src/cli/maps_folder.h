/* SPDX-License-Identifier: MIT */
/* A folder of maps as the only operand of a command. */
#ifndef MERLIN_CLI_MAPS_FOLDER_H
#define MERLIN_CLI_MAPS_FOLDER_H

#include "base/status.h"

/* Takes the folder, or that of its maps.exr, from what options have left of the arguments. MERLIN_WRONG_USE unless
 * there is one operand. */
status maps_folder_take(int argc, char *const *argv, const char **input);
/* Returns MERLIN_BAD_INPUT unless it is a folder. remedy: the end of what makes one of a photograph, after "merlin
 * estimate PHOTO ", such as "makes one". */
status maps_folder_check(const char *input, const char *remedy);

#endif
