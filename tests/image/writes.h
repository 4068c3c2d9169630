/* SPDX-License-Identifier: MIT */
/* Shared by tests of writing: cmocka, and checks for what failed writes leave. */
#ifndef MERLIN_TESTS_IMAGE_WRITES_H
#define MERLIN_TESTS_IMAGE_WRITES_H

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
#include "scratch.h"

/* last, as cmocka defines a macro named fail */
#include <cmocka.h>

/* Tells whether a temporary file was left behind. */
static inline bool folder_has_leftovers(void)
{
    char **names = NULL;
    size_t count = 0;
    bool found = false;
    assert_int_equal(file_list(scratch, NULL, &names, &count), OK);
    for (size_t i = 0; i < count; i++)
        found |= strchr(names[i], '~') != NULL;
    file_list_free(names, count);
    return found;
}

/* Limits the size of files, which has the effect of a full disk; 0 lifts the limit. */
static inline void limit_file_size(size_t bytes)
{
    struct rlimit limit;
    signal(SIGXFSZ, SIG_IGN);
    assert_int_equal(getrlimit(RLIMIT_FSIZE, &limit), 0);
    limit.rlim_cur = bytes ? bytes : limit.rlim_max;
    assert_int_equal(setrlimit(RLIMIT_FSIZE, &limit), 0);
}

#endif
