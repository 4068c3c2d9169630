/* SPDX-License-Identifier: MIT */
/* A visible surface in a square frame: the maps of one crop, and what is done with them.
 *
 *     surface low;                         what the network said, at its size
 *     surface_encode_guide(&guide, gain);  the photograph
 *     surface_refine(&low, &guide, &mask, &full);  the same at its resolution
 *     surface_shade(&full, light, &direct);        under a point light
 *     surface_free(&low);
 *
 * The frame is a camera's of docs/conventions.md that looks at its centre: 60 degrees wide where nothing is known. Maps
 * are zero outside the mask, normals unit with z > 0, everything finite; albedo and roughness in [0, 1]. */
#ifndef MERLIN_ESTIMATE_SURFACE_SURFACE_H
#define MERLIN_ESTIMATE_SURFACE_SURFACE_H

#include <stdbool.h>

#include "base/vec.h"
#include "image/image.h"
#include "optics/camera.h"
#include "optics/light.h"

typedef struct surface {
    img albedo;       /* 3 */
    img normal;       /* 3 */
    img roughness;    /* 1 */
    img depth;        /* 1 */
    img mask;         /* 1, coverage */
    bool matte;       /* lamps light its diffuse part alone */
    camera_lens lens; /* fov 0: CAMERA_FOV, no slant */
} surface;

static inline camera_lens surface_lens(const surface *s)
{
    return s->lens.fov > 0 ? s->lens : (camera_lens){.fov = CAMERA_FOV};
}

/* The camera that sees the maps. */
static inline camera surface_camera(const surface *s)
{
    return camera_through(surface_lens(s), s->mask.width, s->mask.height);
}

/* Zero maps of width × height. */
status surface_new(int width, int height, surface *out);
void surface_free(surface *s);

/* Makes what the header promises true for any content: out-of-range values are clamped, normals made unit and turned
 * toward the camera, non-finite values replaced, everything outside the mask zeroed. */
void surface_tidy(surface *s);
/* A normal map likewise; mask: its size. */
void surface_tidy_normals(const img *mask, img *normal);

/* What the network is given: a mask that is 0 or 1, and an image (3 channels, may be NULL) that is zero outside it and
 * not negative inside. */
void harden_mask(img *image, img *mask);

/* To another square size, averaging or interpolating the object's own pixels only. mask: the new size's. */
status surface_resize(const surface *from, const img *mask, surface *out);

/* Makes a photograph (linear, any size) a guide: its noise should be even from shadow to light, and a square root does
 * that for photon noise. gain: the photograph's (exposure.h). Bright pictures of any unit become the usual ones; dark
 * ones stay dark, for brightening would bring their noise above what is followed. */
void surface_encode_guide(img *photo, float gain);

/* The same with albedo and roughness edges that follow a guide (3 channels, encoded, mask's size); shape does not, or
 * print on a flat side would become relief. For a guide smaller than the surface this is surface_resize. */
status surface_refine(const surface *from, const img *guide, const img *mask, surface *out);

/* Radiance under a point light of the training data's power at `light`, before clipping, times coverage; no shadows. */
status surface_shade(const surface *s, vec3 light, img *out);
/* Under a lamp, near or distant, as if its tint were white. */
status surface_shade_lamp(const surface *s, const lamp *l, img *out);
/* The same, added to what out holds already. */
void surface_add_light(const surface *s, vec3 light, img *out);

/* Light of bounces 2 and up from the network's size to cover's, and under it alone: smooth by nature, so that the
 * pattern of the network's last layer, two pixels wide, is averaged away. */
status surface_resize_indirect(const img *from, const img *mask, const img *cover, img *out);

/* Any image that belongs to a surface, resized without letting its outside in: shrunk, it is weighted by the mask;
 * enlarged, values where mask < 0.5 are replaced by their neighbours' first. cover: the new size's mask, beside which
 * an enlarged image may be zero (img_resize_covered). */
status surface_resize_image(const img *from, const img *mask, const img *cover, img *out);

#endif
