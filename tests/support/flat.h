/* SPDX-License-Identifier: MIT */
/* Pictures of one value for tests, and cmocka. */
#ifndef MERLIN_TESTS_FLAT_H
#define MERLIN_TESTS_FLAT_H

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include "image/write/write.h"
#include "scratch.h"

/* last, as cmocka defines a macro named fail */
#include <cmocka.h>

/* Writes a PNG in the test's folder; returns its path. */
static inline const char *write_flat(const char *name, int width, int height, int channels, float value,
                                     img_encoding encoding)
{
    const char *path = scratch_path(name);
    img picture;
    assert_int_equal(img_new(&picture, width, height, channels), OK);
    for (size_t i = 0; i < img_value_count(&picture); i++)
        picture.data[i] = value;
    assert_int_equal(img_write_png(path, &picture, encoding), OK);
    img_free(&picture);
    return path;
}

#endif
