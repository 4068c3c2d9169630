/* SPDX-License-Identifier: MIT */
#include "scratch.h"

#include <ftw.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

char *scratch;

char *scratch_new(void)
{
    const char *root = getenv("TMPDIR");
    char name[4096];
    snprintf(name, sizeof name, "%s/merlin-test-XXXXXX", root ? root : "/tmp");
    if (!mkdtemp(name)) {
        perror(name);
        abort();
    }
    return strdup(name);
}

static int remove_one(const char *path, const struct stat *about, int kind, struct FTW *place)
{
    (void)about;
    (void)kind;
    (void)place;
    return remove(path);
}

void scratch_remove(char *folder)
{
    if (folder && nftw(folder, remove_one, 16, FTW_DEPTH | FTW_PHYS) != 0) perror(folder);
    free(folder);
}

int scratch_open(void **state)
{
    (void)state;
    scratch = scratch_new();
    return 0;
}

int scratch_close(void **state)
{
    (void)state;
    scratch_remove(scratch);
    scratch = NULL;
    return 0;
}

const char *scratch_path(const char *name)
{
    static char paths[4][4352];
    static int turn;
    char *path = paths[turn++ & 3];
    snprintf(path, sizeof paths[0], "%s/%s", scratch, name);
    return path;
}
