/* SPDX-License-Identifier: MIT */
/* The program of a package: starts the build for the processor that it runs on. GCC's levels of x86-64 (System V ABI):
 * v4 has AVX-512, v3 AVX2, and what lies beside them runs on all.
 *
 * The builds are PREFIX/lib/merlin/LEVEL/NAME, for a launcher PREFIX/bin/NAME. */
#include <errno.h>
#include <limits.h>
#include <stdio.h>
#include <string.h>
#include <unistd.h>

static const char *level(void)
{
#ifdef __x86_64__
    __builtin_cpu_init();
    if (__builtin_cpu_supports("x86-64-v4")) return "x86-64-v4";
    if (__builtin_cpu_supports("x86-64-v3")) return "x86-64-v3";
#endif
    return "all";
}

/* Returns the launcher's own path up to the slash before bin; false if the system does not tell it. */
static int prefix(char out[PATH_MAX])
{
    ssize_t length = readlink("/proc/self/exe", out, PATH_MAX - 1);
    if (length <= 0) return 0;
    out[length] = 0;
    for (int parts = 0; parts < 2; parts++) {
        char *slash = strrchr(out, '/');
        if (!slash) return 0;
        *slash = 0;
    }
    return 1;
}

int main(int argc, char **argv)
{
    char from[PATH_MAX], path[PATH_MAX + 64];
    (void)argc;
    if (!prefix(from)) {
        fprintf(stderr, "%s: /proc does not tell where this program lies\n", LAUNCH_NAME);
        return 1;
    }
    snprintf(path, sizeof path, "%s/lib/merlin/%s/%s", from, level(), LAUNCH_NAME);
    execv(path, argv);
    if (errno == ENOENT) {
        snprintf(path, sizeof path, "%s/lib/merlin/all/%s", from, LAUNCH_NAME);
        execv(path, argv);
    }
    fprintf(stderr, "%s: cannot start %s: %s\n", LAUNCH_NAME, path, strerror(errno));
    return 1;
}
