/* SPDX-License-Identifier: MIT */
/* Work that a run under sanitizers leaves out or shortens. It finds bad accesses and undefined arithmetic, which cases
 * that take the same ways through the program with other numbers do not show again, and it takes ten times as long.
 *
 *     enum { OBJECTS = SANITIZED ? 40 : 200 };
 *     static void a_lens_is_named(void **state) { shows_figures_alone(); ... }     other cases go the same way */
#ifndef MERLIN_TESTS_SANITIZED_H
#define MERLIN_TESTS_SANITIZED_H

#ifdef __SANITIZE_ADDRESS__
#define SANITIZED 1
#else
#define SANITIZED 0
#endif

/* Skips the case under a sanitizer. */
#define shows_figures_alone()                                                                                          \
    if (SANITIZED) skip()

#endif
