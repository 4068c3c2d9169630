/* SPDX-License-Identifier: MIT */
/* Refusals to write over what is not a command's own, before anything that takes time. Its own results are replaced:
 * whoever runs it again wants that. */
#ifndef MERLIN_CLI_CHECK_REPLACED_H
#define MERLIN_CLI_CHECK_REPLACED_H

#include <stdbool.h>

#include "base/status.h"

/* MERLIN_CANNOT_WRITE where the folder of results to write has files of these names that no run has left, for neither
 * maps.exr nor report.json is beside them, or holds another capture, which would take them for its own. meshes:
 * mesh.ply and the like will be written, too. */
status check_replaced(const char *folder, bool meshes);

/* The first words of a list of a near dome's lamps, by which relight knows it again. */
#define LIST_OF_PLACES "# places of the lamps of dome_000"
/* Tells whether the folder has a lights.txt that begins with these words. */
bool list_begins_with(const char *folder, const char *words);

/* MERLIN_CANNOT_WRITE where the folder has a lights.txt that neither stereo calibrate nor relight --dome wrote. */
status check_list_replaced(const char *folder);

#endif
