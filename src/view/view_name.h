/* SPDX-License-Identifier: MIT */
#ifndef MERLIN_VIEW_VIEW_NAME_H
#define MERLIN_VIEW_VIEW_NAME_H

#include "base/status.h"

/* Refuses names of a page that do not end in .html or .htm: a file of another kind would be lost, and no browser opens
 * the page. */
status view_check_name(const char *path);

#endif
