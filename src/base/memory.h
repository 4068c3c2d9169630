/* SPDX-License-Identifier: MIT */
/* Blocks of memory for numbers: zeroed, and aligned to a cache line.
 *
 *     float *x = memory_new(count * sizeof *x);
 *     memory_free(x);
 *
 * The zeros of a large block come from the system, so that untouched pages cost nothing. */
#ifndef MERLIN_BASE_MEMORY_H
#define MERLIN_BASE_MEMORY_H

#include <stdbool.h>
#include <stddef.h>
#include <stdio.h>

enum { MEMORY_ALIGNMENT = 64 };

/* Returns NULL if memory ran out. */
void *memory_new(size_t bytes);
void memory_free(void *block);

/* Closes a stream of open_memstream. Returns false if memory ran out for any of it; *text is then NULL, and freed. */
bool memory_stream_close(FILE *stream, char **text);

/* Tells whether so many bytes can be had now, by allocating and freeing them: called before libraries that crash or
 * hang when they are refused memory. */
bool memory_is_left(size_t bytes);

/* Asks the system for large pages in a fresh block, malloc'ed or not, if it is big enough: filling it then takes one
 * page fault instead of hundreds. Has no other effect. */
void memory_prefer_large_pages(void *block, size_t bytes);

/* Sets a part of a block, malloc'ed or not, to zero, and gives its whole pages back to the system. */
void memory_forget(void *part, size_t bytes);

#endif
