/* SPDX-License-Identifier: MIT */
/* The C library's own, and what it lacks: memory of WebAssembly never goes back to the system. */
#ifndef MERLIN_BROWSER_MALLOC_H
#define MERLIN_BROWSER_MALLOC_H

#include_next <malloc.h>

static inline int malloc_trim(size_t pad)
{
    (void)pad;
    return 0;
}

#endif
