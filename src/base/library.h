/* SPDX-License-Identifier: MIT */
/* Shared libraries loaded when they are first needed. A linked library is loaded at every start, used or not: libvips
 * and the hundred libraries behind it take 20 ms.
 *
 *     static struct { __typeof__(cbrt) *cbrt; } maths;
 *     static const library_function wanted[] = {{"cbrt", &maths.cbrt}};
 *     static library libm = {.file = "libm.so.6", .functions = wanted, .count = 1};
 *
 *     status s = library_need(&libm);
 *     if (s == OK) printf("%g\n", maths.cbrt(8));
 */
#ifndef MERLIN_BASE_LIBRARY_H
#define MERLIN_BASE_LIBRARY_H

#include <stdatomic.h>
#include <stddef.h>

#include "base/status.h"

typedef struct library_function {
    const char *name;
    void *into; /* address of the function pointer to fill in */
} library_function;

typedef struct library {
    const char *file;
    const library_function *functions;
    size_t count;
    atomic_bool loaded; /* set by library_need */
} library;

/* Loads the library on the first call, for good; later calls are cheap. May be called from any thread.
 * MERLIN_DEVICE_FAILED if the library or one of the functions is missing. */
status library_need(library *l);

#endif
