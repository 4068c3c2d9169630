/* SPDX-License-Identifier: MIT */
/* Bytes at any place of a file, or of memory, for looking at what stands in a picture's head. It asks for no memory, so
 * that an orientation or a kind cannot be missed for lack of it.
 *
 *     byte_source s;
 *     if (!byte_source_open(&s, path)) ...
 *     if (byte_source_read(&s, 8, four, 4) == 4) ...
 *     byte_source_close(&s); */
#ifndef MERLIN_IMAGE_METADATA_BYTE_SOURCE_H
#define MERLIN_IMAGE_METADATA_BYTE_SOURCE_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

enum { BYTE_SOURCE_BLOCK = 4096 };

typedef struct byte_source {
    int file;
    const uint8_t *memory; /* NULL: the bytes are the file's */
    uint64_t begin, size;  /* which of its bytes, those of a part */
    uint64_t block_at;     /* of the file, as is what follows: the last bytes that were looked at */
    size_t block_size;
    uint8_t block[BYTE_SOURCE_BLOCK];
} byte_source;

/* Opens a plain file; what is another kind of file has no bytes. False, and errno as open's, if it cannot be opened. */
bool byte_source_open(byte_source *s, const char *path);
void byte_source_close(byte_source *s);

/* These have nothing to close: an open file's bytes, those of memory, and of another source those from `at` on. */
void byte_source_of_file(byte_source *s, int file);
void byte_source_of_memory(byte_source *s, const void *bytes, size_t size);
void byte_source_of_part(byte_source *s, const byte_source *whole, uint64_t at, uint64_t size);

/* Reads up to count bytes at a place; returns how many there are. */
size_t byte_source_read(byte_source *s, uint64_t at, void *to, size_t count);

#endif
