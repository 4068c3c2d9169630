/* SPDX-License-Identifier: MIT */
/* Parses led_params.txt of the LUCES layout (Mecca et al. 2021): camera and LEDs, converted to this project's axes. */
#ifndef MERLIN_STEREO_CAPTURE_LUCES_H
#define MERLIN_STEREO_CAPTURE_LUCES_H

#include "stereo/capture/capture.h"

typedef struct luces_params {
    int count, height, width;
    pinhole camera;
    merlin_light *light; /* count */
} luces_params;

/* Parses the text; `where` is put before messages. Free light with luces_free. */
status luces_parse(const char *text, size_t size, const char *where, luces_params *out);
void luces_free(luces_params *p);

#endif
