/* SPDX-License-Identifier: MIT */
/* The program of a package: starts the build for the processor that it runs on. The levels of x86-64 (System V ABI):
 * v4 has AVX-512, v3 AVX2, and what lies beside them runs on all.
 *
 * The builds are PREFIX/lib/merlin/LEVEL/merlin, for this PREFIX/bin/merlin. */
#include <errno.h>
#include <limits.h>
#include <stdio.h>
#include <string.h>
#include <unistd.h>

#define PROGRAM "merlin"

/* Returns the folder of the build for this processor. Who has the first instructions of a level has them all. */
static const char *level(void)
{
#ifdef __x86_64__
    __builtin_cpu_init();
    const int v3 = __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma") && __builtin_cpu_supports("bmi") &&
                   __builtin_cpu_supports("bmi2");
    const int v4 = v3 && __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512bw") &&
                   __builtin_cpu_supports("avx512cd") && __builtin_cpu_supports("avx512dq") &&
                   __builtin_cpu_supports("avx512vl");
    if (v3) return v4 ? "x86-64-v4" : "x86-64-v3";
#endif
    return "all";
}

/* Finds this program's own path, up to the slash before bin; returns 0 if the system does not tell it. */
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
        fprintf(stderr, "%s: /proc does not tell where this program lies\n", PROGRAM);
        return 1;
    }
    snprintf(path, sizeof path, "%s/lib/merlin/%s/%s", from, level(), PROGRAM);
    execv(path, argv);
    if (errno == ENOENT) {
        snprintf(path, sizeof path, "%s/lib/merlin/all/%s", from, PROGRAM);
        execv(path, argv);
    }
    fprintf(stderr, "%s: cannot start %s: %s\n", PROGRAM, path, strerror(errno));
    return 1;
}
