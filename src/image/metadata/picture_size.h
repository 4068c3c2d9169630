/* SPDX-License-Identifier: MIT */
/* Limits of a picture's size, and the size at which it is read. */
#ifndef MERLIN_IMAGE_METADATA_PICTURE_SIZE_H
#define MERLIN_IMAGE_METADATA_PICTURE_SIZE_H

#include "base/status.h"

/* Larger pictures are read at a reduced size: the mean of so many of their pixels that they have no more. */
#ifdef FUZZING_BUILD_MODE_UNSAFE_FOR_PRODUCTION /* so that reading at a reduced size is tried, too, where all is slow  \
                                                 */
enum { IMAGE_MAX_SIDE = 4096, IMAGE_MOST_PIXELS = 500 * 1000 };
#else
enum { IMAGE_MAX_SIDE = 16384, IMAGE_MOST_PIXELS = 64 * 1000 * 1000 };
#endif

/* Refuses what takes too long to read, however little of it is kept. */
status picture_check_size(const char *path, long long width, long long height);
/* Refuses, too, sides above IMAGE_MAX_SIDE, of kinds that are decoded as a whole and reduced then. */
status picture_check_sides(const char *path, long long width, long long height);
/* Refuses what would take too much memory where a decoder has to hold all of it, so many bytes a pixel; advice:
 * how it is to be saved instead. */
status picture_check_whole(const char *path, long long width, long long height, int bytes, const char *advice);

#endif
