/* SPDX-License-Identifier: MIT */
/* For readers that want a path: arbitrary bytes as a file that lies in memory alone.
 *
 *     img_read(fuzz_file(data, size), &color, &alpha);
 *     merlin_maps_read(fuzz_folder("maps.exr", data, size), &maps); */
#ifndef MERLIN_FUZZ_FILE_H
#define MERLIN_FUZZ_FILE_H

#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <sys/mman.h>
#include <unistd.h>

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

static inline const char *fuzz_file(const uint8_t *data, size_t size)
{
    static char path[64];
    static int file = -1;
    if (file < 0) {
        file = memfd_create("fuzz", MFD_CLOEXEC);
        snprintf(path, sizeof path, "/proc/self/fd/%d", file);
    }
    if (file < 0 || ftruncate(file, 0) != 0 || pwrite(file, data, size, 0) != (ssize_t)size) abort();
    return path;
}

static char fuzz_folder_path[] = "/dev/shm/merlin-fuzz-XXXXXX", fuzz_folder_link[64];

static inline void fuzz_folder_remove(void)
{
    unlink(fuzz_folder_link);
    rmdir(fuzz_folder_path);
}

/* A folder that holds the bytes under a name, the same one in every call. */
static inline const char *fuzz_folder(const char *name, const uint8_t *data, size_t size)
{
    const char *path = fuzz_file(data, size);
    if (fuzz_folder_link[0]) return fuzz_folder_path;
    if (!mkdtemp(fuzz_folder_path)) abort();
    snprintf(fuzz_folder_link, sizeof fuzz_folder_link, "%s/%s", fuzz_folder_path, name);
    if (symlink(path, fuzz_folder_link) != 0) abort();
    atexit(fuzz_folder_remove);
    return fuzz_folder_path;
}

#endif
