/* SPDX-License-Identifier: MIT */
/* A visible surface in a square frame: the maps of one crop, and operations on them.
 *
 *     surface low;                                 the network's output, at its size
 *     surface_encode_guide(&guide, gain);          the photograph
 *     surface_refine(&low, &guide, &mask, &full);  the maps at the photograph's resolution
 *     surface_shade(&full, light, &direct);        lit by a point light
 *     surface_free(&low);
 *
 * The frame is that of a camera of docs/conventions.md that looks at its centre, 60 degrees wide if nothing is known.
 * Maps are zero outside the mask, normals unit with z > 0, all values finite; albedo and roughness are in [0, 1]. */
#ifndef MERLIN_ESTIMATE_SURFACE_SURFACE_H
#define MERLIN_ESTIMATE_SURFACE_SURFACE_H

#include <stdbool.h>

#include "base/vec.h"
#include "image/image.h"
#include "optics/camera.h"
#include "optics/light.h"

typedef struct surface {
    img albedo;       /* 3 channels */
    img normal;       /* 3 channels */
    img roughness;    /* 1 channel */
    img depth;        /* 1 channel */
    img mask;         /* 1 channel, coverage */
    bool matte;       /* whether lamps light its diffuse part only */
    camera_lens lens; /* lens; fov 0 means CAMERA_FOV and no slant */
} surface;

static inline camera_lens surface_lens(const surface *s)
{
    return s->lens.fov > 0 ? s->lens : (camera_lens){.fov = CAMERA_FOV};
}

/* Returns the camera that sees the maps. */
static inline camera surface_camera(const surface *s)
{
    return camera_through(surface_lens(s), s->mask.width, s->mask.height);
}

/* Makes maps of zeros, width × height. */
status surface_new(int width, int height, surface *out);
void surface_free(surface *s);

/* Makes any content keep the promises above: out-of-range values are clamped, normals made unit and turned toward the
 * camera, non-finite values replaced, and everything outside the mask zeroed. */
void surface_tidy(surface *s);
/* Does the same for a normal map; mask: of its size. */
void surface_tidy_normals(const img *mask, img *normal);
/* Does the same for a map of the normals' spread in degrees, which is in [0, 90]. */
void surface_tidy_spread(const img *mask, img *spread);

/* Makes a mask and an image (3 channels, may be NULL) the network's input: the mask 0 or 1, the image zero outside it
 * and not negative inside. */
void harden_mask(img *image, img *mask);

/* Resizes maps to another square size, averaging or interpolating only the object's own pixels. mask: of the new size.
 */
status surface_resize(const surface *from, const img *mask, surface *out);

/* Makes a photograph (linear, any size) a guide by a square root, which gives photon noise the same strength in shadow
 * and light. gain: the photograph's (exposure.h), which scales bright pictures of any unit to the usual range; dark
 * ones stay dark, as brightening them would raise their noise above the guide's threshold. */
void surface_encode_guide(img *photo, float gain);

/* Resizes as surface_resize does, with edges of albedo and roughness that follow a guide (3 channels, encoded, mask's
 * size); shape does not follow it, or print on a flat side would become relief. If the guide is smaller than the
 * surface, this is surface_resize. */
status surface_refine(const surface *from, const img *guide, const img *mask, surface *out);

/* Computes the radiance under a point light of the training data's power at `light`, before clipping, times coverage,
 * without shadows. */
status surface_shade(const surface *s, vec3 light, img *out);
/* Does the same for a near or distant lamp, as if its tint were white. */
status surface_shade_lamp(const surface *s, const lamp *l, img *out);
/* Adds the radiance under a point light to the content of out. */
void surface_add_light(const surface *s, vec3 light, img *out);

/* Resizes light of bounces 2 and up from the network's size to cover's, limited to it. The light is smooth, so that it
 * is averaged to half its size, which removes the two-pixel pattern of the network's last layer. */
status surface_resize_indirect(const img *from, const img *mask, const img *cover, img *out);

/* Resizes any image of a surface without influence of values outside it: to shrink, it is weighted by the mask; to
 * enlarge, values where mask < 0.5 are first replaced by their neighbours'. cover: the new size's mask, outside of
 * which an enlarged image may be zero (img_resize_covered). */
status surface_resize_image(const img *from, const img *mask, const img *cover, img *out);

#endif
