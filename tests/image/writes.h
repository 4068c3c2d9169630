/* SPDX-License-Identifier: MIT */
/* What image tests share: cmocka, and what failing writes leave. */
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

/* after the project's headers: its macro fail() would break the declaration of ours */
#include <cmocka.h>

/* Whether a temporary file was left behind. */
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
