/* SPDX-License-Identifier: MIT */
/* PNG files from pixel codes that are computed row by row. */
#ifndef MERLIN_IMAGE_WRITE_CODES_H
#define MERLIN_IMAGE_WRITE_CODES_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "base/status.h"

/* A picture whose rows are requested one by one, in any order and by several threads. wide: codes of 16 instead of 8
 * bits; srgb: they are sRGB's, which the file then states; row: computes the codes of row y. */
typedef struct code_rows {
    int width, height, channels;
    bool wide, srgb;
    void (*row)(const void *context, int y, void *codes);
    const void *context;
} code_rows;

status codes_write_png(const char *path, const code_rows *p);
/* Encodes the file in memory, malloc'ed; `name` is used in messages. */
status codes_encode_png(const char *name, const code_rows *p, uint8_t **data, size_t *size);

#endif
