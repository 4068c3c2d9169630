/* PNG from codes in memory, for whoever has encoded them already. */
#ifndef MERLIN_IMAGE_CODES_H
#define MERLIN_IMAGE_CODES_H

#include <vips/vips.h>

#include "base/status.h"

/* 8 or 16 bits a code, beside what libvips must know of them. */
typedef struct pixel_codes {
    void *codes;
    int width, height, channels;
    VipsBandFormat format;
    VipsInterpretation interpretation;
} pixel_codes;

status codes_write_png(const char *path, const pixel_codes *p);

#endif
