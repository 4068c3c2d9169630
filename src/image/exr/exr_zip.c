/* SPDX-License-Identifier: MIT */
#include "image/exr/exr_zip.h"

#include <libdeflate.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

enum { LEVEL = 3 };

void exr_zip_free(exr_zip *z)
{
    if (z->packer) libdeflate_free_compressor(z->packer);
    if (z->unpacker) libdeflate_free_decompressor(z->unpacker);
    free(z->scratch);
    *z = (exr_zip){0};
}

static bool reserve(exr_zip *z, size_t bytes)
{
    if (z->room >= bytes) return true;
    uint8_t *more = realloc(z->scratch, bytes);
    if (!more) return false;
    z->scratch = more;
    z->room = bytes;
    return true;
}

exr_result_t exr_zip_pack(exr_zip *z, const uint8_t *from, size_t size, uint8_t *to, size_t *packed)
{
    const size_t half = size / 2;
    if (!z->packer) z->packer = libdeflate_alloc_compressor(LEVEL);
    if (!z->packer || !reserve(z, 2 * size)) return EXR_ERR_OUT_OF_MEMORY;
    uint8_t *shuffled = z->scratch, *changes = z->scratch + size;
    for (size_t i = 0; i < half; i++) {
        shuffled[i] = from[2 * i];
        shuffled[half + i] = from[2 * i + 1];
    }
    changes[0] = shuffled[0];
    for (size_t i = 1; i < size; i++)
        changes[i] = (uint8_t)(shuffled[i] - shuffled[i - 1] + 128);
    *packed = libdeflate_zlib_compress(z->packer, changes, size, to, size - 1);
    if (*packed > 0) return EXR_ERR_SUCCESS;
    memcpy(to, from, size);
    *packed = size;
    return EXR_ERR_SUCCESS;
}

exr_result_t exr_zip_unpack(exr_zip *z, const uint8_t *from, size_t packed, uint8_t *to, size_t size)
{
    const size_t half = size / 2;
    if (!z->unpacker) z->unpacker = libdeflate_alloc_decompressor();
    if (!z->unpacker || !reserve(z, size)) return EXR_ERR_OUT_OF_MEMORY;
    if (libdeflate_zlib_decompress(z->unpacker, from, packed, z->scratch, size, NULL) != LIBDEFLATE_SUCCESS)
        return EXR_ERR_CORRUPT_CHUNK;
    /* sums of the differences; those of the odd bytes go on where the even ones end, and run beside them */
    const uint8_t *even_change = z->scratch, *odd_change = z->scratch + half;
    uint8_t even = 128, odd = 128;
    for (size_t i = 0; i < half; i++)
        odd = (uint8_t)(odd + even_change[i] - 128);
    for (size_t i = 0; i < half; i++) {
        even = (uint8_t)(even + even_change[i] - 128);
        odd = (uint8_t)(odd + odd_change[i] - 128);
        to[2 * i] = even;
        to[2 * i + 1] = odd;
    }
    return EXR_ERR_SUCCESS;
}
