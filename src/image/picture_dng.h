/* Raw pictures of floats: DNGs that programs make of several exposures, or of a picture that they have mosaicked no
 * more. LibRaw does not read those that are deflated, as nearly all are, where it was built without zlib, and scales
 * others by what they show. */
#ifndef MERLIN_IMAGE_PICTURE_DNG_H
#define MERLIN_IMAGE_PICTURE_DNG_H

#include "image/picture.h"

/* Tells whether a file is one. */
bool picture_is_float_dng(const char *path);
/* As picture_read_raw, but for values above 1, which such a picture may have. color NULL: the head alone. */
status picture_read_float_dng(const char *path, picture_colour how, img *color, picture_head *head);

/* A page's pixels in parts, strips or tiles, of floats: deflated or as they are. */
typedef struct float_parts {
    int width, height, samples, bits; /* of the page; a sample's */
    int part_width, part_height;
    int predictor, compression;
    bool big_endian;
} float_parts;

/* Makes the floats of a part from its bytes in the file; false if it is damaged. out: part_width × part_height ×
 * samples; room: as many bytes as they have in the file. */
bool float_part_unpack(const float_parts *p, const void *data, size_t size, void *room, float *out);

#endif
