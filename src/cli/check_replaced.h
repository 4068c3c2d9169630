/* SPDX-License-Identifier: MIT */
/* Refuses to overwrite files that are not a command's own, before long work. Its own results are replaced. */
#ifndef MERLIN_CLI_CHECK_REPLACED_H
#define MERLIN_CLI_CHECK_REPLACED_H

#include <stdbool.h>

#include "base/status.h"

/* Fails with MERLIN_CANNOT_WRITE if the output folder has files of these names but neither maps.exr nor report.json, so
 * that no run wrote them, or if it contains another capture, which would use them as its own. meshes: mesh.ply and the
 * like will be written, too. */
status check_replaced(const char *folder, bool meshes);

/* Fails with MERLIN_CANNOT_WRITE if the photograph or its mask (NULL: none) has the name of a map in the output folder,
 * which would replace it: a mask that was painted over, say. */
status check_inputs_kept(const char *folder, const char *photo, const char *mask);

/* First words of a list of a near dome's lamps, by which relight recognizes it. */
#define LIST_OF_PLACES "# places of the lamps of dome_000"
/* Tells whether the folder has a lights.txt that begins with these words. */
bool list_begins_with(const char *folder, const char *words);

/* Fails with MERLIN_CANNOT_WRITE if the folder has a lights.txt that neither stereo calibrate nor relight --dome wrote.
 */
status check_list_replaced(const char *folder);

#endif
