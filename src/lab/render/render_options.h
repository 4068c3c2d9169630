/* SPDX-License-Identifier: MIT */
/* Options of a data set (generate.h). */
#ifndef MERLIN_LAB_RENDER_RENDER_OPTIONS_H
#define MERLIN_LAB_RENDER_RENDER_OPTIONS_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "lab/render/render.h"

typedef struct render_options {
    const char *folder; /* NULL: render without writing, for measurements */
    uint64_t seed, first;
    size_t count;
    image_settings image; /* its fov is the narrowest, its slant is not used */
    float widest_fov;     /* degrees; lenses are log-uniform between image.fov and this; 0: all have image.fov */
    float off_axis;   /* crops are up to so many degrees off the lens's axis, inside the view of a lens of 80 degrees */
    bool environment; /* an environment image and its SH coefficients as well */
    const char *environment_folder; /* maps from files instead of procedural ones; or NULL */
    const char *material_folder;    /* photographed materials for most objects; or NULL */
    const char *mesh_folder;        /* meshes instead of procedural objects for a share of them; or NULL */
    float mesh_share;               /* share of meshes; 0 counts as one half */
    const char *mesh;               /* one mesh file instead of procedural objects; or NULL */
    bool quiet;                     /* no progress bar */
    int (*interrupted)(void);       /* polled between samples; may be NULL */
} render_options;

#endif
