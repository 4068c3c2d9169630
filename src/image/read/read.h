/* SPDX-License-Identifier: MIT */
/* Reads photographs and maps into linear float (libpng, OpenEXR Core, LibRaw, own readers of BMP, TGA and netpbm's
 * formats, libvips for all others).
 *
 * 8- and 16-bit files are decoded from sRGB (or by their ICC profile) to linear; EXR, Radiance HDR and cameras' raw
 * pictures are linear already. EXIF orientation is applied. Grey becomes three equal channels. */
#ifndef MERLIN_IMAGE_READ_READ_H
#define MERLIN_IMAGE_READ_READ_H

#include <stdbool.h>

#include "image/image.h"
#include "image/metadata/picture_size.h"

/* Extensions of raw pictures; for lists of extensions (file_ends_in_any). */
#define IMAGE_RAW_ENDINGS ".dng", ".cr2", ".cr3", ".nef", ".arw", ".raf", ".rw2", ".orf", ".pef", ".srw", ".3fr", ".iiq"
/* Extensions of pictures that cameras process themselves, which are no measurements. */
#define IMAGE_CAMERA_ENDINGS ".jpg", ".jpeg", ".heic", ".heif"
/* Extensions of all formats that are read. */
#define IMAGE_ENDINGS ".png", ".tif", ".tiff", ".webp", ".avif", ".exr", ".hdr", IMAGE_CAMERA_ENDINGS, IMAGE_RAW_ENDINGS

/* Reads every format that img_is_picture (image/formats/img_format.h) knows. color gets 3 channels. If alpha is not
 * NULL it gets 1 channel in [0, 1] if the file has an alpha channel (EXR: "A", else "mask.A"), and stays empty
 * otherwise; color is then not multiplied by alpha, whatever the file's kind. Refuses non-images, truncated files, more
 * than 512 million pixels and values that are NaN or infinite, in one clear line. */
status img_read(const char *path, img *color, img *alpha);
/* Reads the size at which the picture is read, from the file's header alone, before an orientation is applied: width
 * and height may be exchanged. */
status img_read_size(const char *path, int *width, int *height);
typedef struct img_facts {
    int reduced;       /* number of its pixels a side that are averaged into one: 1 for most */
    int frames;        /* number of pictures in the file, of which the first is read: 1 for most */
    int width, height; /* before an orientation is applied; 0: unknown */
} img_facts;
/* Finds what a file's header says about reading it; 1, 1 and unknown for files that are refused. Fails with
 * MERLIN_NO_MEMORY only. */
status img_look(const char *path, img_facts *out);
/* Reads an environment, a latitude-longitude picture: twice as wide as high and at least 8×4 pixels. Pictures of mirror
 * balls and cubes, which would be distorted, are refused. */
status img_read_latlong(const char *path, img *color);
/* Reads a measurement rather than a photograph: 1 or 3 channels as the file has them. With `decode`, encoded samples
 * become linear: 8-bit ones, from sRGB, and those with a colour profile or a stated curve; others are kept. Raw
 * pictures are white balanced for daylight, not as the camera was set, which may change from one picture to the next.
 * *bits: 8, 16 or 32 (floats). */
status img_read_samples(const char *path, bool decode, img *color, int *bits);
/* Reads one channel in [0, 1], the mean of the colours without decoding: a map of numbers. */
status img_read_grey(const char *path, img *grey);
/* Reads coverage in [0, 1], one channel: the alpha, else the brighter of two values, whatever they are, else what is
 * white on black (mask_values.h). */
status img_read_mask(const char *path, img *mask);

#endif
