/* SPDX-License-Identifier: MIT */
/* Readers of simple formats, and what they share: each parses a file's header and then its rows. Internal to
 * picture_plain.h. */
#ifndef MERLIN_IMAGE_PLAIN_PLAIN_FILE_H
#define MERLIN_IMAGE_PLAIN_PLAIN_FILE_H

#include <stdint.h>
#include <stdio.h>

#include "image/formats/picture_rows.h"

/* A file being read. */
typedef struct plain_file {
    FILE *file;
    const char *path; /* for messages */
    uint64_t size;
    picture_layout layout; /* known after the header */
    int bits;              /* bits of a sample, as in picture_head */
} plain_file;

/* A format. open reads the header up to the pixels and allocates its state, which close frees; row reads the next row's
 * samples by the layout, and returns false if the file is damaged or truncated. state is NULL before open, and is
 * passed to close also after open failed. */
typedef struct plain_format {
    status (*open)(plain_file *f, void **state);
    bool (*row)(plain_file *f, void *state, void *samples);
    void (*close)(void *state);
} plain_format;

extern const plain_format plain_pnm, plain_bmp, plain_tga;

/* Fails with "cannot read PATH: it is damaged or cut short". */
status plain_damaged(const plain_file *f);
/* Refuses sizes that cannot be read, and files shorter than the pixels need at least, so that only large files take
 * much memory or time. */
status plain_check(const plain_file *f, double least_bytes);

static inline unsigned plain_little16(const uint8_t *p)
{
    return p[0] | (unsigned)p[1] << 8;
}

static inline uint32_t plain_little32(const uint8_t *p)
{
    return plain_little16(p) | (uint32_t)plain_little16(p + 2) << 16;
}

static inline bool plain_get(plain_file *f, void *bytes, size_t count)
{
    return fread(bytes, 1, count, f->file) == count;
}

#endif
