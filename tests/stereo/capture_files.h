/* SPDX-License-Identifier: MIT */
/* What tests of captures share: cmocka, and files to write in a test's folder. */
#ifndef MERLIN_TESTS_STEREO_CAPTURE_FILES_H
#define MERLIN_TESTS_STEREO_CAPTURE_FILES_H

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "base/file.h"
/* last, as cmocka defines a macro named fail */
#include "flat.h"

static inline void write_text(const char *name, const char *text)
{
    assert_int_equal(file_write(scratch_path(name), text, strlen(text)), OK);
}

/* The last failure is one line with these words in it. */
static inline void assert_says(const char *words)
{
    if (!strstr(status_message(), words)) fail_msg("\"%s\" does not say \"%s\"", status_message(), words);
    assert_null(strchr(status_message(), '\n'));
}

#endif
