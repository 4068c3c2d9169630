/* SPDX-License-Identifier: MIT */
/* Work that is done again and again, a different allocation of it failing each time.
 *
 *     static int run(void *context);            the work; returns its status, everything given back that it was given
 *     each_allocation_fails(&(memory_trial){"merlin_estimate", run, check, context});
 */
#ifndef MERLIN_TESTS_EACH_ALLOCATION_H
#define MERLIN_TESTS_EACH_ALLOCATION_H

#include <stddef.h>

typedef struct memory_trial {
    const char *name;
    int (*run)(void *context);
    /* Says what is wrong with what run has left in the context, if anything (NULL: nothing after a refusal, the same as
     * ever after success), and frees it. */
    const char *(*check)(void *context, int result);
    void *context;
} memory_trial;

/* Asserts that each failure is told as lack of memory, in words, or is none: the work may do without what failed. Every
 * way through the program to an allocation is taken that no earlier trial has taken, where it is first come by and
 * where last; at each third all that follow fail, too. In the end the work succeeds as ever. */
void each_allocation_fails(const memory_trial *trial);
/* Asserts the same at one of `every` such places, for work that takes long. */
void some_allocations_fail(const memory_trial *trial, size_t every);

#endif
