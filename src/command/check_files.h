/* SPDX-License-Identifier: MIT */
/* Files that a command is given or is to write, looked at before anything that takes time. */
#ifndef MERLIN_COMMAND_CHECK_FILES_H
#define MERLIN_COMMAND_CHECK_FILES_H

#include "base/status.h"

/* MERLIN_BAD_INPUT where there is no file or folder of that name: "there is no mesh x.obj". path may be NULL: none was
 * given. */
status check_named(const char *what, const char *path);
/* MERLIN_BAD_INPUT where there is no photograph or no mask of that name; mask may be NULL. */
status check_photo_and_mask(const char *photo, const char *mask);
/* MERLIN_CANNOT_WRITE where a folder cannot be written into; it is made for the trial, and removed again. */
status check_output(const char *folder);

#endif
