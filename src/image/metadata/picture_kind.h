/* SPDX-License-Identifier: MIT */
/* Kinds of pictures, one for each way of reading. */
#ifndef MERLIN_IMAGE_METADATA_PICTURE_KIND_H
#define MERLIN_IMAGE_METADATA_PICTURE_KIND_H

typedef enum picture_kind {
    PICTURE_UNKNOWN,
    PICTURE_EXR,
    PICTURE_PNG,
    PICTURE_JPEG,
    PICTURE_TIFF,
    PICTURE_WEBP,
    PICTURE_HEIC,
    PICTURE_HDR,
    PICTURE_RAW,
    PICTURE_GIF,
    PICTURE_BMP,
    PICTURE_PNM,
    PICTURE_TGA,
    PICTURE_OTHER, /* a picture in a format that is not read */
} picture_kind;

#endif
