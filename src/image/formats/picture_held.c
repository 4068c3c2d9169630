/* SPDX-License-Identifier: MIT */
/* Limits for pictures that decoders hold as a whole, even when few of their pixels are kept: how much memory a small
 * file may claim. */
#include "image/formats/picture.h"
#include "image/metadata/box_file.h"

/* Bytes a pixel that libwebp, libnsgif, libheif and libjpeg hold at most, as measured, including libvips. */
enum { BYTES_WEBP = 12, BYTES_GIF = 12, BYTES_HEIC = 6, BYTES_SCANS = 5 };

/* Tells whether a JPEG's pixels come in several scans, so that it is held as coefficients: a progressive one, or one
 * whose components follow each other. */
static bool comes_in_scans(byte_source *file)
{
    enum { MARKERS = 4096, SCAN = 0xffda, FRAMES = 0xffc0, LAST_FRAME = 0xffcf, TABLES = 4, ARITHMETIC = 12 };
    uint64_t at = 2, components = 0;
    for (int i = 0; i < MARKERS; i++) {
        uint64_t marker = box_number(file, at, 2), length = box_number(file, at + 2, 2);
        if (marker == SCAN) return box_number(file, at + 4, 1) < components;
        if (marker < 0xff01 || length < 2) return false;
        uint64_t kind = marker - FRAMES;
        bool frame =
            marker >= FRAMES && marker <= LAST_FRAME && kind != TABLES && kind != 2 * TABLES && kind != ARITHMETIC;
        if (frame && kind % 4 == 2) return true;
        if (frame) components = box_number(file, at + 9, 1);
        at += 2 + length;
    }
    return false;
}

status picture_check_held(const char *path, picture_kind kind, int width, int height)
{
    if (kind == PICTURE_WEBP) return picture_check_whole(path, width, height, BYTES_WEBP, "as PNG");
    if (kind == PICTURE_GIF) return picture_check_whole(path, width, height, BYTES_GIF, "as PNG");
    if (kind == PICTURE_HEIC) return picture_check_whole(path, width, height, BYTES_HEIC, "as PNG or TIFF");
    byte_source file;
    if (kind != PICTURE_JPEG || !byte_source_open(&file, path)) return OK;
    bool held = comes_in_scans(&file);
    byte_source_close(&file);
    return held ? picture_check_whole(path, width, height, BYTES_SCANS, "without scans (not progressive)") : OK;
}

status picture_check_cut(const char *path, picture_kind kind)
{
    enum { HEAD = 8 }; /* RIFF, and the count of the bytes behind it, the lowest first */
    byte_source file;
    if (kind != PICTURE_WEBP || !byte_source_open(&file, path)) return OK;
    uint8_t head[HEAD] = {0};
    bool known = byte_source_read(&file, 0, head, HEAD) == HEAD;
    long long size = known ? (long long)file.size : -1;
    byte_source_close(&file);
    const long long said =
        HEAD + ((long long)head[4] | (long long)head[5] << 8 | (long long)head[6] << 16 | (long long)head[7] << 24);
    if (size < 0 || size >= said) return OK;
    return fail(MERLIN_BAD_INPUT,
                "cannot read %s: it is cut short, %lld of its %lld bytes are there; copy or save it again", path, size,
                said);
}
