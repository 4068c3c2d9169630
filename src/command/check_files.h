/* SPDX-License-Identifier: MIT */
/* Checks files that a command reads or will write, before long work. */
#ifndef MERLIN_COMMAND_CHECK_FILES_H
#define MERLIN_COMMAND_CHECK_FILES_H

#include "base/status.h"

/* Fails with MERLIN_BAD_INPUT if there is no file or folder of that name: "there is no mesh x.obj". path may be NULL:
 * none was given. */
status check_named(const char *what, const char *path);
/* Fails with MERLIN_BAD_INPUT if there is no photograph or no mask of that name; mask may be NULL. */
status check_photo_and_mask(const char *photo, const char *mask);
/* Fails with MERLIN_CANNOT_WRITE if a folder cannot be written to; a missing one is created for the test, and removed
 * again. */
status check_output(const char *folder);

#endif
