/* What tests of captures share: cmocka, and for each test a folder of its own. */
#ifndef MERLIN_TESTS_STEREO_SCRATCH_H
#define MERLIN_TESTS_STEREO_SCRATCH_H

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

/* after the project's headers: its macro fail() would break the declaration of ours */
#include <cmocka.h>

static char scratch[64];

static int scratch_make(void **state)
{
    (void)state;
    strcpy(scratch, "/tmp/merlin-stereo-XXXXXX");
    return mkdtemp(scratch) ? 0 : -1;
}

static int scratch_remove(void **state)
{
    (void)state;
    char **names = NULL;
    size_t count = 0;
    if (file_list(scratch, NULL, &names, &count) != OK) return -1;
    for (size_t i = 0; i < count; i++)
        unlink(names[i]);
    file_list_free(names, count);
    return rmdir(scratch);
}

#define in_scratch(test) cmocka_unit_test_setup_teardown(test, scratch_make, scratch_remove)

/* A path in the folder; one of four in turn. */
static inline const char *scratch_path(const char *name)
{
    static char paths[4][160];
    static int turn;
    char *path = paths[turn++ & 3];
    snprintf(path, sizeof paths[0], "%s/%s", scratch, name);
    return path;
}

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
