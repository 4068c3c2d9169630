/* SPDX-License-Identifier: MIT */
/* Raw pictures for tests: Adobe DNGs of a camera with sRGB's primaries, with a mosaic of red, green, green, blue.
 *
 *     dng d = {.width = 64, .height = 64, .see = grey, .neutral = {1, 1, 1}, .orientation = 1};
 *     dng_write(scratch_path("a.dng"), &d);
 */
#ifndef MERLIN_TESTS_DNG_H
#define MERLIN_TESTS_DNG_H

#include <stdbool.h>

typedef struct dng {
    int width, height;
    float (*see)(int x, int y, int channel); /* from 0, black, to 1, where the sensor saturates */
    float neutral[3];                        /* the camera's white balance: what counts as white */
    int orientation;                         /* by the EXIF standard */
    bool preview;                            /* a reduced picture comes first */
    bool big_endian;
    int floats;    /* bits of a float sample, deflated: 16, 24 or 32; 0 for integers */
    bool linear;   /* floats of three colours instead of a mosaic's */
    bool planes;   /* floats as differences of their bytes, the most significant first: the floating-point predictor */
    float exceeds; /* white in floats; 0 for 1 */
} dng;

enum { DNG_PREVIEW_SIDE = 16 };

void dng_write(const char *path, const dng *d);

#endif
