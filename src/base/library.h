/* SPDX-License-Identifier: MIT */
/* Shared libraries that a program loads when it needs them. One that is linked starts with every program, whether it is
 * called or not: libvips and the hundred libraries behind it take 20 ms.
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
    void *into; /* the pointer to the function */
} library_function;

typedef struct library {
    const char *file;
    const library_function *functions;
    size_t count;
    atomic_bool loaded; /* library_need's */
} library;

/* Loads it the first time, for good; from any thread, and cheap when it is there. MERLIN_DEVICE_FAILED if the library
 * or one of the functions is not. */
status library_need(library *l);

#endif
