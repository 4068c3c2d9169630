/* SPDX-License-Identifier: MIT */
/* libvips, which a hundred other libraries hang from: loaded when it is first needed, so that a program that reads and
 * writes PNG and EXR alone does without it; started once, silent, and without the caches and threads that a command
 * reading a few files does not need. A program that has started it for itself keeps its own of all these. */
#ifndef MERLIN_IMAGE_VIPS_START_H
#define MERLIN_IMAGE_VIPS_START_H

#include <stdbool.h>

#include "base/status.h"

/* From any thread. MERLIN_DEVICE_FAILED if it is not installed. */
status vips_begin(void);

/* "cannot VERB PATH: the library's first words" with status s; forgets the library's words. */
status vips_refusal(status s, const char *verb, const char *path);

/* For a program's main, before it has threads: libvips shall start without its modules, which take longer than all else
 * that it does for a small picture. None but HEIF's is needed here, and vips_load_heif brings that. */
void vips_without_modules(void);
/* After vips_begin; from any thread. False if the module is not installed. */
bool vips_load_heif(void);

#endif
