/* SPDX-License-Identifier: MIT */
/* Loads the plug-in for MPI: only `train --mpi` needs it, so that the program is not linked with MPI. */
#include <dlfcn.h>
#include <limits.h>
#include <stdio.h>
#include <string.h>
#include <unistd.h>

#include "base/file.h"
#include "base/ranks/ranks.h"

static void *find_plugin(void)
{
    static const char *const places[] = {"", "../" MERLIN_PLUGINS "/"};
    char folder[PATH_MAX], path[PATH_MAX + 64];
    if (!file_program_folder(folder)) return NULL;
    void *found = NULL;
    for (size_t i = 0; !found && i < sizeof places / sizeof *places; i++) {
        snprintf(path, sizeof path, "%s/%smerlin_mpi.so", folder, places[i]);
        if (access(path, F_OK) == 0) found = dlopen(path, RTLD_NOW | RTLD_GLOBAL);
    }
    return found;
}

status ranks_open_mpi(ranks **out)
{
    *out = NULL;
    void *plugin = find_plugin();
    if (!plugin) {
        const char *why = dlerror();
        return fail(MERLIN_DEVICE_FAILED, "there is no MPI: %s",
                    why ? why
                        : "merlin_mpi.so is not beside the program; copy it there, or install openmpi-bin and "
                          "libopenmpi-dev and build merlin again");
    }
    /* dlsym returns object pointers, and C has no conversion to function pointers */
    ranks *(*begin)(void);
    void *function = dlsym(plugin, "merlin_ranks_begin");
    memcpy(&begin, &function, sizeof begin);
    if (!function) return fail(MERLIN_DEVICE_FAILED, "merlin_mpi.so is of another version: %s", dlerror());
    *out = begin();
    return *out ? OK : fail(MERLIN_DEVICE_FAILED, "MPI does not start");
}
