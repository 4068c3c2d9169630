/* Shared libraries that a program loads when it needs them. One that is linked starts with every program, whether it is
 * called or not: libvips and the hundred libraries behind it take 20 ms, LAPACK 6 (it starts threads).
 *
 *     static struct { __typeof__(cbrt) *cbrt; } maths;
 *     static const library_function wanted[] = {{"cbrt", &maths.cbrt}};
 *     if (library_load("libm.so.6", wanted, 1)) printf("%g\n", maths.cbrt(8));
 */
#ifndef MERLIN_BASE_LIBRARY_H
#define MERLIN_BASE_LIBRARY_H

#include <stdbool.h>
#include <stddef.h>

typedef struct library_function {
    const char *name;
    void *into; /* the pointer to the function */
} library_function;

/* For good; false if the library or one of the functions is not there. */
bool library_load(const char *file, const library_function *functions, size_t count);

#endif
