/* SPDX-License-Identifier: MIT */
/* Photographs and maps from disk into linear float (libpng, OpenEXR Core, LibRaw, own readers of BMP, TGA and netpbm's
 * formats, libvips for all others).
 *
 * 8- and 16-bit files are decoded from sRGB (or by their ICC profile, honoured) to linear; EXR, Radiance HDR and
 * cameras' raw pictures are linear already. EXIF orientation is applied. Grey becomes three equal channels. */
#ifndef MERLIN_IMAGE_READ_READ_H
#define MERLIN_IMAGE_READ_READ_H

#include <stdbool.h>

#include "image/image.h"
#include "image/metadata/picture_size.h"

/* How raw pictures' names end; for lists of endings (file_ends_in_any). */
#define IMAGE_RAW_ENDINGS ".dng", ".cr2", ".cr3", ".nef", ".arw", ".raf", ".rw2", ".orf", ".pef", ".srw", ".3fr", ".iiq"
/* What cameras leave beside them, developed by themselves: no measurements. */
#define IMAGE_CAMERA_ENDINGS ".jpg", ".jpeg", ".heic", ".heif"
/* All that are read. */
#define IMAGE_ENDINGS ".png", ".tif", ".tiff", ".webp", ".avif", ".exr", ".hdr", IMAGE_CAMERA_ENDINGS, IMAGE_RAW_ENDINGS

/* Every format that img_is_picture (image/formats/img_format.h) knows. color gets 3 channels. If alpha is not NULL it
 * gets 1 channel in [0, 1] where the file has an alpha channel (EXR: "A", else "mask.A"), and stays empty otherwise;
 * colour then is not times alpha, whatever the file's kind. Refuses non-images, truncated files, more than 512 million
 * pixels and values that are NaN or infinite, in one clear line. */
status img_read(const char *path, img *color, img *alpha);
/* The size that it is read at, from the file's head alone, the longer side perhaps as height: before an orientation is
 * applied. */
status img_read_size(const char *path, int *width, int *height);
typedef struct img_facts {
    int reduced; /* so many of its pixels a side become one: 1 for most */
    int frames;  /* pictures in it, one after the other, of which the first is read: 1 for most */
} img_facts;
/* What a file's head says of how it is read; 1 and 1 of what is refused. */
img_facts img_look(const char *path);
/* img_read of an environment, a latitude-longitude picture: twice as wide as high and 8×4 pixels at least. Mirror
 * balls' and cubes' pictures, which would be bent around the object, are refused. */
status img_read_latlong(const char *path, img *color);
/* A measurement rather than a photograph: 1 or 3 channels as the file has them. Decoded to linear only if asked are
 * samples that were encoded: 8-bit ones, from sRGB, and what has a colour profile or states its curve; others are as
 * they are. Raw ones are white balanced for daylight, not as the camera was set, which may have changed from one to the
 * next. *bits: 8, 16 or 32 (floats). */
status img_read_samples(const char *path, bool decode, img *color, int *bits);
/* One channel in [0, 1], the mean of colours without decoding: a map of numbers. */
status img_read_grey(const char *path, img *grey);
/* Coverage in [0, 1], one channel: the alpha, else of two values the greater one, whatever they are, else what is white
 * on black (mask_values.h). */
status img_read_mask(const char *path, img *mask);

#endif
