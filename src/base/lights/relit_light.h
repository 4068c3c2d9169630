/* SPDX-License-Identifier: MIT */
/* Shares of an object that are burnt out or black in pictures of it under other light.
 *
 *     relit_light seen = {0};
 *     relit_light_note(&seen, &picture, &mask);                      each picture
 *     relit_light_warn(&seen, "--exposure auto", &doubts); */
#ifndef MERLIN_BASE_LIGHTS_RELIT_LIGHT_H
#define MERLIN_BASE_LIGHTS_RELIT_LIGHT_H

#include "base/warnings.h"
#include "merlin/image.h"

typedef struct relit_light {
    double burnt_out; /* largest share of the object's pixels with a channel at white, over all pictures */
    size_t pictures;  /* number of pictures */
    size_t burnt;     /* number in which much is burnt out */
    size_t dark;      /* number in which the object is black */
} relit_light;

/* Counts the object's white pixels, and those that are not black. mask: coverage, of the picture's size. */
void relit_light_note(relit_light *seen, const merlin_image *picture, const merlin_image *mask);
/* Adds nothing_lit and relit_burnt_out where they apply; remedy: what darkens the pictures. */
void relit_light_warn(const relit_light *seen, const char *remedy, warnings *list);
/* Adds environment_values if a share of an environment's values, in [0, 1], is negative. */
void relit_light_warn_negative(double share, warnings *list);

#endif
