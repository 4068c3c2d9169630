/* SPDX-License-Identifier: MIT */
#include "base/library.h"

#include <dlfcn.h>
#include <pthread.h>
#include <stdbool.h>
#include <stdio.h>
#include <string.h>

enum { REASON = 256 };

/* Loads the library and its functions; on failure writes the reason. */
static bool load(const library *l, char reason[REASON])
{
    void *handle = dlopen(l->file, RTLD_LAZY | RTLD_LOCAL);
    bool found = handle != NULL;
    for (size_t i = 0; found && i < l->count; i++) {
        /* dlsym returns object pointers, and C has no conversion to function pointers */
        void *function = dlsym(handle, l->functions[i].name);
        memcpy(l->functions[i].into, &function, sizeof function);
        found = function != NULL;
    }
    const char *why = found ? NULL : dlerror(); /* names the library or the function */
    if (why) snprintf(reason, REASON, "%s", why);
    return found;
}

status library_need(library *l)
{
    static pthread_mutex_t one_at_a_time = PTHREAD_MUTEX_INITIALIZER;
    char reason[REASON] = "is it installed?";
    if (atomic_load(&l->loaded)) return OK;
    pthread_mutex_lock(&one_at_a_time);
    bool found = atomic_load(&l->loaded) || load(l, reason);
    atomic_store(&l->loaded, found);
    pthread_mutex_unlock(&one_at_a_time);
    return found ? OK : fail(MERLIN_DEVICE_FAILED, "the library %s cannot be loaded: %s", l->file, reason);
}
