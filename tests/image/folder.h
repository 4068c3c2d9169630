/* What image tests share: cmocka, and a folder of their own that is emptied and removed at the end. */
#ifndef MERLIN_TESTS_IMAGE_FOLDER_H
#define MERLIN_TESTS_IMAGE_FOLDER_H

#include <setjmp.h>
#include <signal.h>
#include <stdarg.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>
#include <unistd.h>

#include "base/file.h"
#include "base/status.h"

/* after the project's headers: its macro fail() would break the declaration of ours */
#include <cmocka.h>

static char folder[] = "/tmp/merlin-image-XXXXXX";

static inline int make_folder(void **state)
{
    (void)state;
    return mkdtemp(folder) ? 0 : -1;
}

static inline int remove_folder(void **state)
{
    (void)state;
    char **names = NULL;
    size_t count = 0;
    if (file_list(folder, NULL, &names, &count) != OK) return -1;
    for (size_t i = 0; i < count; i++)
        unlink(names[i]);
    file_list_free(names, count);
    return rmdir(folder);
}

/* A path in the folder; one of four in turn, so that a few can be held at once. */
static inline const char *in_folder(const char *name)
{
    static char paths[4][256];
    static int turn;
    char *path = paths[turn++ & 3];
    snprintf(path, sizeof paths[0], "%s/%s", folder, name);
    return path;
}

/* Whether a temporary file was left behind. */
static inline bool folder_has_leftovers(void)
{
    char **names = NULL;
    size_t count = 0;
    bool found = false;
    assert_int_equal(file_list(folder, NULL, &names, &count), OK);
    for (size_t i = 0; i < count; i++)
        found |= strchr(names[i], '~') != NULL;
    file_list_free(names, count);
    return found;
}

/* Lets no file grow beyond the bytes, as a full disk does; 0 lifts the limit. */
static inline void limit_file_size(size_t bytes)
{
    struct rlimit limit;
    signal(SIGXFSZ, SIG_IGN);
    assert_int_equal(getrlimit(RLIMIT_FSIZE, &limit), 0);
    limit.rlim_cur = bytes ? bytes : limit.rlim_max;
    assert_int_equal(setrlimit(RLIMIT_FSIZE, &limit), 0);
}

#endif
