/* What tests of captures share: cmocka, and files to write in a test's folder. */
#ifndef MERLIN_TESTS_STEREO_CAPTURE_FILES_H
#define MERLIN_TESTS_STEREO_CAPTURE_FILES_H

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "base/file.h"
#include "image/write.h"
#include "scratch.h"

/* after the project's headers: its macro fail() would break the declaration of ours */
#include <cmocka.h>

static inline void write_text(const char *name, const char *text)
{
    assert_int_equal(file_write(scratch_path(name), text, strlen(text)), OK);
}

/* A picture of one value. */
static inline void write_flat(const char *name, int width, int height, int channels, float value, img_encoding encoding)
{
    img picture;
    assert_int_equal(img_new(&picture, width, height, channels), OK);
    for (int i = 0; i < width * height * channels; i++)
        picture.data[i] = value;
    assert_int_equal(img_write_png(scratch_path(name), &picture, encoding), OK);
    img_free(&picture);
}

/* The last failure is one line with these words in it. */
static inline void assert_says(const char *words)
{
    if (!strstr(status_message(), words)) fail_msg("\"%s\" does not say \"%s\"", status_message(), words);
    assert_null(strchr(status_message(), '\n'));
}

#endif
