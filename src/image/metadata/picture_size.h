/* SPDX-License-Identifier: MIT */
/* Limits of a picture's size, and the size at which it is read. */
#ifndef MERLIN_IMAGE_METADATA_PICTURE_SIZE_H
#define MERLIN_IMAGE_METADATA_PICTURE_SIZE_H

#include "base/status.h"

/* Largest size of an image in memory: larger pictures are averaged down to it as they are read. It is smaller for the
 * fuzzers, so that they reach that code in reasonable time. */
#ifdef FUZZING_BUILD_MODE_UNSAFE_FOR_PRODUCTION
enum { IMAGE_MAX_SIDE = 4096, IMAGE_MOST_PIXELS = 500 * 1000 };
#else
enum { IMAGE_MAX_SIDE = 16384, IMAGE_MOST_PIXELS = 64 * 1000 * 1000 };
#endif

/* Refuses pictures that would take too long to read, whatever part of them is kept. */
status picture_check_size(const char *path, long long width, long long height);
/* Refuses also sides above IMAGE_MAX_SIDE, for kinds that are decoded as a whole and then reduced. */
status picture_check_sides(const char *path, long long width, long long height);
/* Refuses pictures that would take too much memory where the decoder must hold all of it, so many bytes a pixel;
 * advice: how to save the picture instead. */
status picture_check_whole(const char *path, long long width, long long height, int bytes, const char *advice);

#endif
