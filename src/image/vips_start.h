/* SPDX-License-Identifier: MIT */
/* Starts libvips, on which a hundred other libraries depend: loaded when it is first needed, so that a program that
 * reads and writes only PNG and EXR does without it; started once, silent, and without the caches and threads that a
 * command reading a few files does not need. A program that has started libvips itself keeps its own settings. */
#ifndef MERLIN_IMAGE_VIPS_START_H
#define MERLIN_IMAGE_VIPS_START_H

#include <stdbool.h>

#include "base/status.h"

/* Starts libvips; may be called from any thread. MERLIN_DEVICE_FAILED if it is not installed. */
status vips_begin(void);

/* Fails with "cannot VERB PATH: the library's first message" and status s, of which MERLIN_BAD_INPUT adds what may be
 * wrong with the file; clears the library's messages. */
status vips_refusal(status s, const char *verb, const char *path);

/* Loads libvips' HEIF module, which it has not where a program leaves modules out (command/program.c), after
 * vips_begin; may be called from any thread. Returns false if the module is not
 * installed. */
bool vips_load_heif(void);

#endif
