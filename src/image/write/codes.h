/* SPDX-License-Identifier: MIT */
/* PNG from codes that are made row by row. */
#ifndef MERLIN_IMAGE_WRITE_CODES_H
#define MERLIN_IMAGE_WRITE_CODES_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "base/status.h"

/* A picture whose rows are asked for one by one, in any order and by several threads: what 8 or 16 bits (wide) a code
 * of row y are, and whether they are sRGB's, which the file then says. */
typedef struct code_rows {
    int width, height, channels;
    bool wide, srgb;
    void (*row)(const void *context, int y, void *codes);
    const void *context;
} code_rows;

status codes_write_png(const char *path, const code_rows *p);
/* The same into memory, malloc'ed; messages call it by name. */
status codes_encode_png(const char *name, const code_rows *p, uint8_t **data, size_t *size);

#endif
