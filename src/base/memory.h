/* SPDX-License-Identifier: MIT */
/* Blocks of memory for numbers: zero, and aligned to a cache line.
 *
 *     float *x = memory_new(count * sizeof *x);
 *     memory_free(x);
 *
 * The zeros come from the system, so pages of a large block that nobody touches cost nothing. */
#ifndef MERLIN_BASE_MEMORY_H
#define MERLIN_BASE_MEMORY_H

#include <stdbool.h>
#include <stddef.h>

enum { MEMORY_ALIGNMENT = 64 };

/* NULL if memory ran out. */
void *memory_new(size_t bytes);
void memory_free(void *block);

/* Tells if so many bytes could be had now, by taking and returning them: before libraries are called that crash or hang
 * where they are refused memory. */
bool memory_is_left(size_t bytes);

/* Asks the system for large pages in a fresh block, malloc'ed or not, if that is worth it: filling it then takes one
 * page fault where it took hundreds. Changes nothing else. */
void memory_prefer_large_pages(void *block, size_t bytes);

#endif
