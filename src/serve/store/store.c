/* SPDX-License-Identifier: MIT */
#include "serve/store/store.h"

#include <dirent.h>
#include <errno.h>
#include <fcntl.h>
#include <ftw.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/file.h>
#include <sys/random.h>
#include <sys/stat.h>
#include <time.h>
#include <unistd.h>

#include "base/file.h"

#define FRONT "merlin-serve-"
#define LOCK "lock"

struct store {
    char folder[PATH_MAX];
    int lock;
};

/* ---- removal ---- */

static int remove_one(const char *path, const struct stat *s, int kind, struct FTW *where)
{
    (void)s;
    (void)where;
    (void)(kind == FTW_DP ? rmdir(path) : unlink(path));
    return 0; /* continues with the rest */
}

/* Removes a folder with all that is in it. Links are removed, not followed. */
static void remove_tree(const char *path)
{
    enum { OPEN_FOLDERS = 8 };
    (void)nftw(path, remove_one, OPEN_FOLDERS, FTW_DEPTH | FTW_PHYS);
}

/* Tells whether a folder is this user's, and its server has ended: nobody holds its lock. One without a lock is just
 * being created, or its server was killed meanwhile. */
static bool is_left(int parent, const char *name)
{
    enum { MAKING = 60 }; /* seconds */
    struct stat s;
    if (fstatat(parent, name, &s, AT_SYMLINK_NOFOLLOW) != 0 || !S_ISDIR(s.st_mode) || s.st_uid != geteuid())
        return false;
    int folder = openat(parent, name, O_RDONLY | O_DIRECTORY | O_NOFOLLOW | O_CLOEXEC);
    int lock = folder < 0 ? -1 : openat(folder, LOCK, O_RDWR | O_NOFOLLOW | O_CLOEXEC);
    bool left = lock < 0 ? errno == ENOENT && time(NULL) - s.st_mtime > MAKING : flock(lock, LOCK_EX | LOCK_NB) == 0;
    if (lock >= 0) close(lock);
    if (folder >= 0) close(folder);
    return left;
}

static void remove_left(const char *scratch)
{
    DIR *d = opendir(scratch);
    char path[PATH_MAX];
    for (struct dirent *e; d && (e = readdir(d));)
        if (strncmp(e->d_name, FRONT, strlen(FRONT)) == 0 && is_left(dirfd(d), e->d_name) &&
            snprintf(path, sizeof path, "%s/%s", scratch, e->d_name) < (int)sizeof path)
            remove_tree(path);
    if (d) closedir(d);
}

/* ---- the folder ---- */

static status make_folder(const char *scratch, store *s)
{
    enum { MOST = PATH_MAX - 256 }; /* leaves room for the names in it */
    if (snprintf(s->folder, MOST, "%s/" FRONT "XXXXXX", scratch) >= MOST)
        return fail(MERLIN_CANNOT_WRITE, "the name of the folder for temporary files is too long: set another $TMPDIR");
    if (!mkdtemp(s->folder))
        return fail_by_errno(MERLIN_CANNOT_WRITE, "cannot make a folder in %s (set another $TMPDIR)", scratch);
    char path[PATH_MAX];
    snprintf(path, sizeof path, "%.*s/" LOCK, PATH_MAX - 16, s->folder);
    s->lock = open(path, O_RDWR | O_CREAT | O_EXCL | O_CLOEXEC, 0600);
    if (s->lock >= 0 && flock(s->lock, LOCK_EX | LOCK_NB) == 0) return OK;
    return fail_by_errno(MERLIN_CANNOT_WRITE, "cannot lock %s", path);
}

status store_open(store **out)
{
    *out = NULL;
    char *name = file_in_scratch(""), *scratch = name ? realpath(name, NULL) : NULL;
    store *s = calloc(1, sizeof *s);
    status done = fail(MERLIN_NO_MEMORY, "no memory for the folder of uploads");
    if (s) s->lock = -1;
    if (s && name && !scratch) done = fail_by_errno(MERLIN_CANNOT_WRITE, "cannot use the folder %s", name);
    if (s && scratch) {
        remove_left(scratch);
        done = make_folder(scratch, s);
    }
    free(name);
    free(scratch);
    if (done == OK)
        *out = s;
    else
        store_close(s);
    return done;
}

void store_close(store *s)
{
    if (!s) return;
    if (s->lock >= 0) remove_tree(s->folder);
    if (s->lock >= 0) close(s->lock);
    free(s);
}

/* ---- jobs' folders ---- */

const char *store_path(const store *s, const char *id, store_part part, const char *name, char path[PATH_MAX])
{
    snprintf(path, PATH_MAX, "%.*s/%s/%s%s%s", PATH_MAX - 256, s->folder, id, part == STORE_IN ? "in" : "out",
             name ? "/" : "", name ? name : "");
    return path;
}

static void job_folder(const store *s, const char *id, char path[PATH_MAX])
{
    snprintf(path, PATH_MAX, "%.*s/%s", PATH_MAX - 256, s->folder, id);
}

status store_add(const store *s, char id[STORE_ID])
{
    unsigned char bits[(STORE_ID - 1) / 2];
    if (getrandom(bits, sizeof bits, 0) != (ssize_t)sizeof bits)
        return fail_by_errno(MERLIN_DEVICE_FAILED, "the system gives no random numbers");
    for (size_t i = 0; i < sizeof bits; i++)
        snprintf(id + 2 * i, 3, "%02x", bits[i]);
    char path[PATH_MAX], in[PATH_MAX], result[PATH_MAX];
    job_folder(s, id, path);
    if (mkdir(path, 0700) == 0 && mkdir(store_path(s, id, STORE_IN, NULL, in), 0700) == 0 &&
        mkdir(store_path(s, id, STORE_OUT, NULL, result), 0700) == 0)
        return OK;
    status done = fail_by_errno(MERLIN_CANNOT_WRITE, "the server cannot keep uploads");
    remove_tree(path);
    return done;
}

void store_remove(const store *s, const char *id)
{
    char path[PATH_MAX];
    job_folder(s, id, path);
    remove_tree(path);
}

void store_empty(const store *s, const char *id, store_part part)
{
    char path[PATH_MAX];
    remove_tree(store_path(s, id, part, NULL, path));
    (void)mkdir(path, 0700);
}

status store_open_unnamed(const store *s, int *descriptor)
{
    char path[PATH_MAX];
    *descriptor = open(s->folder, O_TMPFILE | O_RDWR | O_CLOEXEC, 0600);
    if (*descriptor >= 0) return OK;
    snprintf(path, sizeof path, "%.*s/unnamed-XXXXXX", PATH_MAX - 256, s->folder);
    *descriptor = mkostemp(path, O_CLOEXEC); /* of a file system that knows no others */
    if (*descriptor < 0) return fail_by_errno(MERLIN_CANNOT_WRITE, "the server cannot make a file");
    (void)unlink(path);
    return OK;
}

bool store_is_id(const char *text)
{
    return strspn(text, "0123456789abcdef") == STORE_ID - 1 && !text[STORE_ID - 1];
}
