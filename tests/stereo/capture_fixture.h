/* SPDX-License-Identifier: MIT */
/* Captures in folders, for the tests of their readers. */
#ifndef MERLIN_TESTS_STEREO_CAPTURE_FIXTURE_H
#define MERLIN_TESTS_STEREO_CAPTURE_FIXTURE_H

#include <sys/stat.h>

#include "capture_files.h"
#include "image/color.h"
#include "image/exr/exr.h"
#include "stereo/capture/capture.h"

static const merlin_capture_files PLAIN = {0};

static inline void three_pictures(img_encoding encoding)
{
    write_flat("a.png", 6, 4, 3, 0.25f, encoding);
    write_flat("b.png", 6, 4, 3, 0.5f, encoding);
    write_flat("c.png", 6, 4, 3, 0.75f, encoding);
    write_text("lights.txt", "0 0 2\n3 0 4\n0 -1 0\n");
}

static inline void assert_refused(const merlin_capture_files *options, const char *words)
{
    merlin_capture c;
    assert_int_equal(pst_capture_read(scratch, options, &c), MERLIN_BAD_INPUT);
    assert_says(words);
    assert_null(c.picture);
    assert_null(c.light);
}

#endif
