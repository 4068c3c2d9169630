/* SPDX-License-Identifier: MIT */
/* Locks for a program of one thread, which never waits. */
#ifndef MERLIN_BROWSER_PTHREAD_H
#define MERLIN_BROWSER_PTHREAD_H

#include <stddef.h>

typedef int pthread_mutex_t, pthread_once_t;
enum { PTHREAD_ONCE_INIT = 0 };

static inline int pthread_mutex_init(pthread_mutex_t *lock, const void *attributes)
{
    (void)attributes;
    *lock = 0;
    return 0;
}

static inline int pthread_mutex_lock(pthread_mutex_t *lock)
{
    *lock = 1;
    return 0;
}

static inline int pthread_mutex_unlock(pthread_mutex_t *lock)
{
    *lock = 0;
    return 0;
}

static inline int pthread_mutex_destroy(pthread_mutex_t *lock)
{
    return pthread_mutex_unlock(lock);
}

static inline int pthread_once(pthread_once_t *once, void (*first)(void))
{
    if (!*once) first();
    *once = 1;
    return 0;
}

#endif
