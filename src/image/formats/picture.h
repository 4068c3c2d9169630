/* SPDX-License-Identifier: MIT */
/* Reading, before colour is decoded: a picture as its samples lie in the file, upright, colour and alpha apart. The
 * sources behind it, libpng, libvips, EXR and LibRaw, are read by picture_read_png, picture_decode, picture_read_exr
 * and picture_read_raw, what is read without any by picture_read_plain (image/plain/picture_plain.h). */
#ifndef MERLIN_IMAGE_FORMATS_PICTURE_H
#define MERLIN_IMAGE_FORMATS_PICTURE_H

#include <stdbool.h>

#include "image/image.h"
#include "image/metadata/picture_kind.h"
#include "image/metadata/picture_light.h"
#include "image/metadata/picture_size.h"

/* How colour samples become linear light; alpha is linear always. */
typedef enum picture_colour {
    PICTURE_LINEARIZE, /* integers are sRGB (or by their profile or gamma), floats are linear */
    PICTURE_AS_IT_IS,  /* integers are scaled to [0, 1] and nothing else */
} picture_colour;

/* What a file's head alone says; bits of a sample: 8, 16 or 32. */
typedef struct picture_head {
    int width, height, bits; /* as stored: an orientation may exchange width and height */
    bool plain;              /* of PNG: without colour profile */
    int frames;              /* of an animation; 0 is 1, too */
    bool profile;            /* a colour profile says what the samples mean */
    picture_light light;     /* whole numbers' meaning without one */
} picture_head;

/* A PNG as most are, head->plain; any other is left to picture_decode. color, alpha as below: either may be NULL. */
status picture_read_png(const char *path, picture_colour how, img *color, img *alpha, picture_head *head);

/* Any kind but EXR and raw. color: 1 or 3 channels; alpha: 1 channel or empty. Either may be NULL. */
status picture_decode(const char *path, picture_kind kind, picture_colour how, img *color, img *alpha);
/* Any kind but EXR and raw. */
status picture_look(const char *path, picture_kind kind, picture_head *head);
/* Refuses Radiance pictures that would come out in wrong colours or turned. */
status picture_check_hdr(const char *path);
/* The page of a TIFF that is the picture. */
typedef struct picture_tiff_page {
    int number, pages;   /* from 0, and how many there are */
    bool premultiplied;  /* its colours are multiplied by its alpha, the only band beside them */
    picture_light light; /* by its own words beside a profile */
} picture_tiff_page;
/* Finds it; refuses TIFFs of several that it might be, those whose YCbCr would be taken for RGB, and what would take
 * too much memory. */
status picture_check_tiff(const char *path, picture_tiff_page *out);
/* Tells whether a TIFF is the frame of a raw picture: a page is a mosaic, or all are small copies of something else. */
bool picture_tiff_is_raw(const char *path);
/* Tells whether the JPEGs that a raw picture of that frame is made of claim to be far larger than it. */
bool picture_tiff_is_overfull(const char *path);
/* By the EXIF standard, from 1 (upright) to 8; 1 for what is damaged. */
int picture_exif_orientation(void *exif, size_t size);
/* Refuses a picture of a kind that its decoder holds as a whole, where that would take too much memory. */
status picture_check_held(const char *path, picture_kind kind, int width, int height);
/* Refuses a WebP that has fewer bytes than it says, for which decoders have other words. */
status picture_check_cut(const char *path, picture_kind kind);
status picture_read_exr(const char *path, picture_colour how, img *color, img *alpha);
status picture_look_exr(const char *path, picture_head *head);
/* Upright and linear, in sRGB's primaries, white where the sensor saturates; 3 channels, 1 if it has no mosaic. White
 * balanced as the camera was set if linearized, for daylight otherwise: the same for all pictures of one camera. Then
 * a pixel of which any colour is saturated is white. */
status picture_read_raw(const char *path, picture_colour how, img *color);
status picture_look_raw(const char *path, picture_head *head);

#endif
