/* SPDX-License-Identifier: MIT */
/* OpenEXR's ZIP compression of a chunk: even bytes before odd ones, differences of successive bytes, then a zlib stream
 * (the format's documentation, "ZIP"). The library's own functions do the same with zlib in two to three times the
 * time.
 *
 *     exr_zip zip = {0};
 *     exr_result_t r = exr_zip_pack(&zip, bytes, size, packed, &packed_size);
 *     ...
 *     exr_zip_free(&zip); */
#ifndef MERLIN_IMAGE_EXR_EXR_ZIP_H
#define MERLIN_IMAGE_EXR_EXR_ZIP_H

#include <stddef.h>
#include <stdint.h>

#include <openexr.h>

/* Memory and codecs that serve one chunk after the other; zeros at first. */
typedef struct exr_zip {
    struct libdeflate_compressor *packer;
    struct libdeflate_decompressor *unpacker;
    uint8_t *scratch;
    size_t room;
} exr_zip;

void exr_zip_free(exr_zip *z);

/* Packs a chunk into `to`, which has room for as many bytes; one that gets no shorter is copied, as the format stores
 * it. size: above 0 and even, as all channels have 2 or 4 bytes a pixel. packed: its size. */
exr_result_t exr_zip_pack(exr_zip *z, const uint8_t *from, size_t size, uint8_t *to, size_t *packed);

/* Unpacks what must have exactly `size` bytes, as above; EXR_ERR_CORRUPT_CHUNK: it has not, or is damaged. */
exr_result_t exr_zip_unpack(exr_zip *z, const uint8_t *from, size_t packed, uint8_t *to, size_t size);

#endif
