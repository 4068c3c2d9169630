/* Blocks of memory for numbers: zero, and aligned to a cache line.
 *
 *     float *x = memory_new(count * sizeof *x);
 *     memory_free(x);
 *
 * The zeros come from the system, so pages of a large block that nobody touches cost nothing. */
#ifndef MERLIN_BASE_MEMORY_H
#define MERLIN_BASE_MEMORY_H

#include <stddef.h>

enum { MEMORY_ALIGNMENT = 64 };

/* NULL if memory ran out. */
void *memory_new(size_t bytes);
void memory_free(void *block);

#endif
