/* SPDX-License-Identifier: MIT */
/* Options of a data set: see generate.h. */
#ifndef MERLIN_LAB_RENDER_RENDER_OPTIONS_H
#define MERLIN_LAB_RENDER_RENDER_OPTIONS_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "lab/render/render.h"

typedef struct render_options {
    const char *folder; /* NULL: render and throw away, to measure */
    uint64_t seed, first;
    size_t count;
    image_settings image; /* its fov is the narrowest, its slant is not looked at */
    float widest_fov;     /* degrees; lenses are drawn from image.fov to this, evenly in the logarithm; or 0 */
    float off_axis; /* pictures are cut out up to so many degrees beside the lens's axis, as far as a lens of 80 sees */
    bool environment;               /* an environment image and its SH coefficients as well */
    const char *environment_folder; /* maps from files instead of procedural ones; or NULL */
    const char *material_folder;    /* photographed materials on most objects; or NULL */
    const char *mesh_folder;        /* meshes instead of procedural objects for a share of them; or NULL */
    float mesh_share;               /* of the objects; 0 counts as one half */
    const char *mesh;               /* a mesh file instead of procedural objects; or NULL */
    bool quiet;                     /* no progress bar */
    int (*interrupted)(void);       /* polled between samples; may be NULL */
} render_options;

#endif
