/* SPDX-License-Identifier: MIT */
/* Small copies of relit pictures and their labels, on one sheet. */
#ifndef MERLIN_CLI_RELIGHT_RELIGHT_SHEET_H
#define MERLIN_CLI_RELIGHT_RELIGHT_SHEET_H

#include "base/status.h"
#include "merlin/merlin.h"

enum { RELIGHT_MOST_TILES = 24, RELIGHT_LABEL = 48 };
typedef struct relight_sheet {
    merlin_image pictures[RELIGHT_MOST_TILES];
    char labels[RELIGHT_MOST_TILES][RELIGHT_LABEL];
    int count;
} relight_sheet;
void relight_label(const merlin_lamp *lights, int count, char label[RELIGHT_LABEL]);
/* Adds a small copy of the square, if there is room. */
status relight_sheet_add(relight_sheet *s, const merlin_image *picture, const char *label);
status relight_sheet_write(const relight_sheet *s, const char *path);
void relight_sheet_free(relight_sheet *s);

#endif
