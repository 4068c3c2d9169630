/* SPDX-License-Identifier: MIT */
/* Parts of relight_output.h beside single pictures: domes, orbits, and what an earlier run has left. */
#ifndef MERLIN_CLI_RELIGHT_RELIGHT_PARTS_H
#define MERLIN_CLI_RELIGHT_RELIGHT_PARTS_H

#include "cli/relight/relight_work.h"

/* Tells whether a name is kind_000.png or .jpg, or one with another number; kind: with its "_". */
bool relight_is_numbered(const char *name, const char *kind);
/* Lamp i of a dome. */
merlin_lamp relight_dome_lamp(const relight_job *job, int i);
/* MERLIN_CANNOT_WRITE where the folder has files of another dome that would be taken with these. */
status relight_dome_check(const relight_job *job);
/* Counts the numbered pictures of an earlier run that stay beside those that were written. */
void relight_find_left(const relight_job *job, relight_result *result);
status relight_write_dome(relight_work *w);
/* Lamp i of an orbit. */
merlin_lamp relight_orbit_lamp(const relight_job *job, int i);
/* frame_000.png and on, orbit.png and animations; the relighter has the frames' size. */
status relight_write_orbit(relight_work *w, int side);

#endif
