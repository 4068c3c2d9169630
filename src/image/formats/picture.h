/* SPDX-License-Identifier: MIT */
/* First stage of reading: a picture's samples as the file has them, upright, colour and alpha separated. The readers on
 * libpng, libvips, OpenEXR and LibRaw are picture_read_png, picture_decode, picture_read_exr and picture_read_raw;
 * formats read without a library are in image/plain/picture_plain.h. */
#ifndef MERLIN_IMAGE_FORMATS_PICTURE_H
#define MERLIN_IMAGE_FORMATS_PICTURE_H

#include <stdbool.h>

#include "image/image.h"
#include "image/metadata/picture_kind.h"
#include "image/metadata/picture_light.h"
#include "image/metadata/picture_size.h"

/* How colour samples become linear light; alpha is always linear. */
typedef enum picture_colour {
    PICTURE_LINEARIZE, /* integers are decoded from sRGB (or by their profile or gamma), floats are linear */
    PICTURE_AS_IT_IS,  /* integers are scaled to [0, 1] and not decoded; only grey and RGB are light */
    PICTURE_AS_SHOWN,  /* the same, but other spaces, such as CMYK, are converted to sRGB's codes */
} picture_colour;

/* What is known from a file's header alone. */
typedef struct picture_head {
    int width, height, bits; /* size before an orientation is applied; bits of a sample: 8, 16 or 32 */
    bool plain;              /* for PNG: without a colour profile */
    int frames;              /* frames of an animation; 0 counts as 1 */
    bool profile;            /* has a colour profile, which defines the samples */
    picture_light light;     /* meaning of integer samples without a profile */
} picture_head;

/* Reads an ordinary PNG (head->plain); others are left to picture_decode. color and alpha as there: either may be NULL.
 */
status picture_read_png(const char *path, picture_colour how, img *color, img *alpha, picture_head *head);

/* Reads any kind but EXR and raw through libvips. color: 1 or 3 channels; alpha: 1 channel or empty. Either may be
 * NULL. */
status picture_decode(const char *path, picture_kind kind, picture_colour how, img *color, img *alpha);
/* Reads the header of any kind but EXR and raw. */
status picture_look(const char *path, picture_kind kind, picture_head *head);
/* Refuses Radiance pictures that libvips would return in wrong colours or turned. */
status picture_check_hdr(const char *path);
/* The page of a TIFF that holds the picture. */
typedef struct picture_tiff_page {
    int number, pages;   /* page, from 0, and number of pages */
    bool premultiplied;  /* colours are multiplied by alpha, the only extra band */
    picture_light light; /* meaning of its samples by the file's own tags, beside a profile */
} picture_tiff_page;
/* Finds the picture's page. Refuses TIFFs with several candidates, those whose YCbCr would be read as RGB, and those
 * that would take too much memory. */
status picture_check_tiff(const char *path, picture_tiff_page *out);
/* Tells whether a TIFF is the container of a raw picture: a page is a mosaic, or all pages are reduced copies of
 * another image. */
bool picture_tiff_is_raw(const char *path);
/* Tells whether the JPEGs inside such a raw picture claim to be far larger than it. */
bool picture_tiff_is_overfull(const char *path);
/* Refuses a picture whose decoder holds it as a whole if that would take too much memory. */
status picture_check_held(const char *path, picture_kind kind, int width, int height);
/* Refuses a WebP with fewer bytes than it states, for which decoders have less clear messages. */
status picture_check_cut(const char *path, picture_kind kind);
status picture_read_exr(const char *path, picture_colour how, img *color, img *alpha);
status picture_look_exr(const char *path, picture_head *head);
/* Reads a raw picture: upright and linear, in sRGB's primaries, white where the sensor saturates; 3 channels, or 1 if
 * it has no mosaic. If linearized, white balance is as the camera was set; otherwise it is for daylight, the same for
 * all pictures of one camera, and a pixel with any saturated colour is white. */
status picture_read_raw(const char *path, picture_colour how, img *color);
status picture_look_raw(const char *path, picture_head *head);

#endif
