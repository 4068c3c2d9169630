/* SPDX-License-Identifier: MIT */
/* Parts of relight_output.h besides single pictures: exposure, domes, orbits, sequences, and files of an earlier run.
 */
#ifndef MERLIN_CLI_RELIGHT_RELIGHT_PARTS_H
#define MERLIN_CLI_RELIGHT_RELIGHT_PARTS_H

#include "cli/relight/relight_work.h"

/* Makes the relighter of the job's maps, with pictures of this side (0: the photograph's size), and exposes them. */
status relight_prepare(relight_work *w, int side);
/* Tells whether a name is kind_000.png or .jpg with any number; kind: with its "_". */
bool relight_is_numbered(const char *name, const char *kind);
/* Returns lamp i of a dome. */
merlin_lamp relight_dome_lamp(const relight_job *job, int i);
/* Fails with MERLIN_CANNOT_WRITE if the folder has files of another dome that would be used together with these. */
status relight_dome_check(const relight_job *job);
/* Fails with MERLIN_CANNOT_WRITE if pictures would be replaced that no earlier run wrote. */
status relight_check_replaced(const relight_job *job);
/* Counts the numbered pictures of an earlier run that remain with those that were written. */
void relight_find_left(const relight_job *job, relight_result *result);
status relight_write_dome(relight_work *w);
/* Returns lamp i of an orbit. */
merlin_lamp relight_orbit_lamp(const relight_job *job, int i);
/* Writes frame_000.png and so on, orbit.png and animations; the relighter has the frames' size. */
status relight_write_orbit(relight_work *w, int side);
/* Writes a picture of each frame of a sequence, frame_0001.png and so on, and all of them as relit.mp4 if there is an
 * encoder. The job's maps are the first frame's. */
status relight_write_frames(relight_work *w);

#endif
