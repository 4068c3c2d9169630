/* SPDX-License-Identifier: MIT */
/* EXIF in PNG files, as a camera's program writes it.
 *
 *     png_add_exif(scratch_path("a.png"), 2, 33);        a fiftieth of a second by a lens like one of 33 mm */
#ifndef MERLIN_TESTS_PNG_EXIF_H
#define MERLIN_TESTS_PNG_EXIF_H

#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include "base/file.h"

/* Writes a number, its highest byte first; returns its size. */
static inline size_t png_put(unsigned char *at, uint32_t number, size_t size)
{
    for (size_t i = 0; i < size; i++)
        at[i] = (unsigned char)(number >> 8 * (size - 1 - i));
    return size;
}

/* The CRC-32 of a PNG's chunks, bit by bit. */
static inline uint32_t png_checksum(const unsigned char *data, size_t size)
{
    uint32_t crc = 0xffffffff;
    for (size_t i = 0; i < size; i++) {
        crc ^= data[i];
        for (int bit = 0; bit < 8; bit++)
            crc = crc >> 1 ^ (crc & 1 ? 0xedb88320 : 0);
    }
    return ~crc;
}

/* Writes a TIFF head and pages, big-endian, with an exposure and a focal length; returns their size. */
static inline size_t png_put_facts(unsigned char *at, uint32_t hundredths, uint32_t focal_35mm)
{
    enum { SHORT = 3, LONG = 4, RATIONAL = 5, EXIF = 34665, BELOW = 26, BEHIND = 80 };
    enum { TIME = 33434, F_NUMBER = 33437, SENSITIVITY = 34855, FOCAL = 41989 };
    const uint32_t entry[][4] = {{EXIF, LONG, 1, BELOW},
                                 {TIME, RATIONAL, 1, BEHIND},
                                 {F_NUMBER, RATIONAL, 1, BEHIND + 8},
                                 {SENSITIVITY, SHORT, 1, 200u << 16},
                                 {FOCAL, SHORT, 1, focal_35mm << 16}};
    const uint32_t fractions[] = {hundredths, 100, 2, 1};
    unsigned char *const begin = at;
    memcpy(at, "MM\0*\0\0\0\x08\0\x01", 10);
    at += 10;
    for (int i = 0; i < 5; i++) {
        for (int k = 0; k < 4; k++)
            at += png_put(at, entry[i][k], k < 2 ? 2 : 4);
        if (i == 0) {
            at += png_put(at, 0, 4); /* no page follows */
            at += png_put(at, 4, 2);
        }
    }
    at += png_put(at, 0, 4);
    for (int i = 0; i < 4; i++)
        at += png_put(at, fractions[i], 4);
    return (size_t)(at - begin);
}

/* Adds EXIF to a PNG file: an exposure of so many hundredths of a second at ISO 200 and f/2, and the focal length in mm
 * on 36 × 24 mm; 0: not stated. Aborts if it cannot. */
static inline void png_add_exif(const char *path, uint32_t hundredths, uint32_t focal_35mm)
{
    enum { HEAD = 33 }; /* a PNG's signature and first chunk */
    unsigned char chunk[160] = {0};
    char *data;
    size_t size, more = 8;
    if (file_read(path, 1 << 24, &data, &size) != OK) abort();
    memcpy(chunk + 4, "eXIf", 4);
    more += png_put_facts(chunk + more, hundredths, focal_35mm);
    png_put(chunk, (uint32_t)more - 8, 4);
    more += png_put(chunk + more, png_checksum(chunk + 4, more - 4), 4);
    char *whole = malloc(size + more);
    if (!whole) abort();
    memcpy(whole, data, HEAD);
    memcpy(whole + HEAD, chunk, more);
    memcpy(whole + HEAD + more, data + HEAD, size - HEAD);
    if (file_write(path, whole, size + more) != OK) abort();
    free(whole);
    free(data);
}

#endif
