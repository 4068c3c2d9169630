/* SPDX-License-Identifier: MIT */
#include "image/metadata/picture_size.h"

/* Largest pictures that are read, at a reduced size, and most bytes of one that is decoded as a whole. */
#ifdef FUZZING_BUILD_MODE_UNSAFE_FOR_PRODUCTION /* sanitizers slow large pictures down too much */
enum { MOST_SIDE = 1000000, MOST_PIXELS = 4000000, MOST_BYTES = 8000000 };
#else
enum { MOST_SIDE = 1000000, MOST_PIXELS = 512000000, MOST_BYTES = 512000000 };
#endif

status picture_check_size(const char *path, long long width, long long height)
{
    if (width < 1 || height < 1) return fail(MERLIN_BAD_INPUT, "cannot read %s: it has no pixels", path);
    if (width > MOST_SIDE || height > MOST_SIDE) /* a row would be too large to hold */
        return fail(MERLIN_BAD_INPUT,
                    "cannot read %s: it is %lld x %lld pixels, more than %d a side; make it smaller first", path, width,
                    height, MOST_SIDE);
    if (width <= MOST_PIXELS / height) return OK;
    return fail(MERLIN_BAD_INPUT,
                "cannot read %s: it is %lld x %lld pixels, more than %d million; make it smaller first", path, width,
                height, MOST_PIXELS / 1000000);
}

status picture_check_sides(const char *path, long long width, long long height)
{
    if (width <= IMAGE_MAX_SIDE && height <= IMAGE_MAX_SIDE) return picture_check_size(path, width, height);
    return fail(MERLIN_BAD_INPUT,
                "cannot read %s: it is %lld x %lld pixels, more than %d a side; make it smaller first", path, width,
                height, IMAGE_MAX_SIDE);
}

status picture_check_whole(const char *path, long long width, long long height, int bytes, const char *advice)
{
    status s = picture_check_size(path, width, height);
    if (s != OK || width * height <= MOST_BYTES / bytes) return s;
    return fail(
        MERLIN_BAD_INPUT,
        "cannot read %s: its %lld x %lld pixels would have to be held as a whole; save it %s or make it smaller", path,
        width, height, advice);
}
