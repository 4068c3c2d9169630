/* SPDX-License-Identifier: MIT */
#include "base/leftovers.h"

#include <dirent.h>
#include <errno.h>
#include <fcntl.h>
#include <limits.h>
#include <pthread.h>
#include <signal.h>
#include <stdatomic.h>
#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>
#include <sys/stat.h>
#include <time.h>
#include <unistd.h>

/* ---- names ---- */

/* Continues an FNV-1a hash. */
static uint32_t mix(uint32_t hash, const void *data, size_t size)
{
    for (size_t i = 0; i < size; i++)
        hash = (hash ^ ((const unsigned char *)data)[i]) * 16777619u;
    return hash;
}

/* Returns a hash of the kernel's boot identifier, which no other machine and no other start has, and of the namespace
 * of process numbers, as each container has its own. */
static uint32_t mark_of_here(void)
{
    char boot[64] = {0};
    struct stat space = {0};
    int f = open("/proc/sys/kernel/random/boot_id", O_RDONLY | O_CLOEXEC);
    ssize_t got = f < 0 ? 0 : read(f, boot, sizeof boot);
    if (f >= 0) close(f);
    (void)stat("/proc/self/ns/pid", &space);
    uint32_t hash = mix(2166136261u, boot, got > 0 ? (size_t)got : 0);
    return mix(hash, &space.st_ino, sizeof space.st_ino);
}

void leftovers_file_front(char front[LEFTOVERS_FRONT])
{
    /* the thread's number: several threads of a process may write the same file at once */
    snprintf(front, LEFTOVERS_FRONT, ".%08x-%d~", mark_of_here(), (int)gettid());
}

void leftovers_folder_name(char name[LEFTOVERS_NAME])
{
    snprintf(name, LEFTOVERS_NAME, ".merlin-%08x-%d-XXXXXX", mark_of_here(), (int)getpid());
}

/* ---- files of dead processes ---- */

static bool is_old(int folder, const char *name)
{
    enum { DAY = 24 * 3600 };
    struct stat s;
    return fstatat(folder, name, &s, AT_SYMLINK_NOFOLLOW) == 0 && time(NULL) - s.st_mtime > DAY;
}

static bool is_dead(int number)
{
    return number > 0 && kill(number, 0) != 0 && errno == ESRCH;
}

/* Removes a folder's plain files and the folder. It allocates no memory, as a signal handler calls it. */
static void remove_folder(int parent, const char *name)
{
    _Alignas(struct dirent64) char room[2048];
    int folder = openat(parent, name, O_RDONLY | O_DIRECTORY | O_NOFOLLOW | O_CLOEXEC);
    for (ssize_t got; folder >= 0 && (got = getdents64(folder, room, sizeof room)) > 0;)
        for (ssize_t at = 0; at < got;) {
            const struct dirent64 *e = (const void *)(room + at);
            at += e->d_reclen;
            (void)unlinkat(folder, e->d_name, 0); /* fails for "." and "..", which are folders */
        }
    if (folder >= 0) close(folder);
    (void)unlinkat(parent, name, AT_REMOVEDIR);
}

void leftovers_remove_folder(const char *path)
{
    remove_folder(AT_FDCWD, path);
}

/* Parses a temporary name of either kind into its mark and process number. */
static bool parse(const char *name, unsigned *mark, int *number, bool *is_folder)
{
    int length = 0;
    *is_folder = sscanf(name, ".merlin-%8x-%d-%n", mark, number, &length) == 2 && length > 0;
    if (*is_folder) return strlen(name + length) == strlen("XXXXXX");
    return sscanf(name, ".%8x-%d~%n", mark, number, &length) == 2 && length > 0 && name[length];
}

void leftovers_clear(const char *folder)
{
    DIR *d = opendir(folder);
    uint32_t here = mark_of_here();
    for (struct dirent *e; d && (e = readdir(d));) {
        unsigned mark;
        int number;
        bool is_folder;
        if (e->d_name[0] != '.' || !parse(e->d_name, &mark, &number, &is_folder)) continue;
        if (mark == here ? !is_dead(number) : !is_old(dirfd(d), e->d_name)) continue;
        if (is_folder)
            remove_folder(dirfd(d), e->d_name);
        else
            (void)unlinkat(dirfd(d), e->d_name, 0);
    }
    if (d) closedir(d);
}

void leftovers_clear_once(const char *folder)
{
    static pthread_mutex_t lock = PTHREAD_MUTEX_INITIALIZER;
    static uint32_t last;
    uint32_t hash = mix(2166136261u, folder, strlen(folder));
    pthread_mutex_lock(&lock);
    bool is_new = hash != last;
    last = hash;
    pthread_mutex_unlock(&lock);
    if (is_new) leftovers_clear(folder);
}

/* ---- files of this process ---- */

enum { MOST_NOTED = 256 }; /* files beyond this number are left to a later run */

static struct {
    _Atomic(const char *) path;
    atomic_size_t kept;
} noted[MOST_NOTED];

void leftovers_note(const char *path, size_t kept)
{
    for (int i = 0; i < MOST_NOTED; i++) {
        const char *nothing = NULL;
        if (!atomic_compare_exchange_strong(&noted[i].path, &nothing, path)) continue;
        atomic_store(&noted[i].kept, kept);
        return;
    }
}

void leftovers_forget(const char *path)
{
    for (int i = 0; i < MOST_NOTED; i++)
        if (atomic_load(&noted[i].path) == path) {
            atomic_store(&noted[i].kept, 0);
            atomic_store(&noted[i].path, NULL);
            return;
        }
}

/* Removes a folder, and its parents as far as they were made for it. */
static void remove_with_parents(const char *path, size_t kept)
{
    char part[PATH_MAX];
    size_t length = strlen(path);
    if (length >= sizeof part) return;
    memcpy(part, path, length + 1);
    remove_folder(AT_FDCWD, part);
    for (; length > kept; length--)
        if (part[length] == '/') {
            part[length] = 0;
            (void)rmdir(part); /* fails for folders that are not empty */
        }
}

void leftovers_remove_own(void)
{
    for (int i = 0; i < MOST_NOTED; i++) {
        const char *path = atomic_load(&noted[i].path);
        size_t kept = atomic_load(&noted[i].kept);
        if (path && kept) remove_with_parents(path, kept);
        if (path && !kept) (void)unlink(path);
    }
}
