/* SPDX-License-Identifier: MIT */
/* --rti: a dome's pictures as one that viewers relight. */
#ifndef MERLIN_CLI_RELIGHT_RELIGHT_RTI_H
#define MERLIN_CLI_RELIGHT_RELIGHT_RTI_H

#include "cli/relight/relight_work.h"

/* Takes the option's value, for a row of command/options.h; into is a relight_rti. */
status relight_take_rti(const char *text, void *into);
/* Returns that word again. */
const char *relight_rti_name(const relight_rti *rti);
/* Checks it against the number of the dome's pictures; other: whether other lights, lists or formats were asked for. */
status relight_rti_check(const relight_rti *rti, int count, bool near, bool other);
/* Renders the dome's pictures, and writes what they make. */
status relight_write_rti(relight_work *w);

#endif
