/* SPDX-License-Identifier: MIT */
#include "image/formats/img_format.h"

#include <string.h>

#include "base/file.h"
#include "image/formats/picture.h"
#include "image/metadata/byte_source.h"

/* Bytes at a fixed position by which all files of a format are recognized. */
typedef struct mark {
    size_t at, count;
    char bytes[20];
    picture_kind kind;
    const char *name;
} mark;

static const mark marks[] = {
    {0, 4, "\x76\x2f\x31\x01", PICTURE_EXR, "OpenEXR"},
    {0, 8, "\x89PNG\r\n\x1a\n", PICTURE_PNG, "PNG"},
    {0, 3, "\xff\xd8\xff", PICTURE_JPEG, "JPEG"},
    {0, 4, "II*\0", PICTURE_TIFF, "TIFF"},
    {0, 4, "MM\0*", PICTURE_TIFF, "TIFF"},
    {0, 4, "II+\0", PICTURE_TIFF, "TIFF"},
    {0, 4, "MM\0+", PICTURE_TIFF, "TIFF"},
    {0, 10, "#?RADIANCE", PICTURE_HDR, "Radiance HDR"},
    {0, 6, "#?RGBE", PICTURE_HDR, "Radiance HDR"},
    {0, 6, "GIF87a", PICTURE_GIF, "GIF"},
    {0, 6, "GIF89a", PICTURE_GIF, "GIF"},
    /* raw pictures that are not TIFF: Olympus, Panasonic, Fujifilm, Canon (two kinds), Minolta and Sigma */
    {0, 4, "IIRO", PICTURE_RAW, "raw"},
    {0, 4, "IIRS", PICTURE_RAW, "raw"},
    {0, 4, "MMOR", PICTURE_RAW, "raw"},
    {0, 4, "IIU\0", PICTURE_RAW, "raw"},
    {0, 8, "FUJIFILM", PICTURE_RAW, "raw"},
    {4, 8, "ftypcrx ", PICTURE_RAW, "raw"},
    {6, 4, "HEAP", PICTURE_RAW, "raw"},
    {0, 4, "\0MRM", PICTURE_RAW, "raw"},
    {0, 4, "FOVb", PICTURE_RAW, "raw"},
    /* recognized, but not read */
    {0, 12, "\0\0\0\x0cjP  \r\n\x87\n", PICTURE_OTHER, "JPEG 2000"},
    {0, 4, "\xff\x4f\xff\x51", PICTURE_OTHER, "JPEG 2000"},
    {0, 12, "\0\0\0\x0cJXL \r\n\x87\n", PICTURE_OTHER, "JPEG XL"},
    {0, 2, "\xff\x0a", PICTURE_OTHER, "JPEG XL"},
    {0, 3, "II\xbc", PICTURE_OTHER, "JPEG XR"},
    {0, 4, "8BPS", PICTURE_OTHER, "Photoshop"},
    {0, 9, "gimp xcf ", PICTURE_OTHER, "GIMP"},
    {38, 16, "image/openraster", PICTURE_OTHER, "OpenRaster"},
    {38, 19, "application/x-krita", PICTURE_OTHER, "Krita"},
    {0, 5, "%PDF-", PICTURE_OTHER, "PDF"},
    {0, 5, "%!PS-", PICTURE_OTHER, "PostScript"},
    {0, 4, "\xc5\xd0\xd3\xc6", PICTURE_OTHER, "PostScript"},
    {0, 4, "\0\0\1\0", PICTURE_OTHER, "Windows icon"},
    {0, 4, "DDS ", PICTURE_OTHER, "DDS"},
    {0, 6, "\xabKTX 1", PICTURE_OTHER, "KTX"},
    {0, 6, "\xabKTX 2", PICTURE_OTHER, "KTX"},
    {0, 4, "SDPX", PICTURE_OTHER, "DPX"},
    {0, 4, "XPDS", PICTURE_OTHER, "DPX"},
    {0, 4, "\x80\x2a\x5f\xd7", PICTURE_OTHER, "Cineon"},
    {0, 11, "SIMPLE  =  ", PICTURE_OTHER, "FITS"},
    {0, 4, "qoif", PICTURE_OTHER, "QOI"},
    {0, 8, "farbfeld", PICTURE_OTHER, "farbfeld"},
    {0, 4, "FLIF", PICTURE_OTHER, "FLIF"},
    {0, 4, "BPG\xfb", PICTURE_OTHER, "BPG"},
    {0, 8, "\x8aMNG\r\n\x1a\n", PICTURE_OTHER, "MNG"},
    {0, 8, "\x8bJNG\r\n\x1a\n", PICTURE_OTHER, "JNG"},
    {0, 8, "AT&TFORM", PICTURE_OTHER, "DjVu"},
    {0, 4, "\x59\xa6\x6a\x95", PICTURE_OTHER, "Sun raster"},
    {0, 4, "\x01\xda\0\1", PICTURE_OTHER, "SGI"},
    {0, 4, "\x01\xda\1\1", PICTURE_OTHER, "SGI"},
    {0, 4, "\x01\xda\0\2", PICTURE_OTHER, "SGI"},
    {0, 4, "\x01\xda\1\2", PICTURE_OTHER, "SGI"},
    {0, 9, "/* XPM */", PICTURE_OTHER, "XPM"},
};

static bool is_read(picture_kind kind)
{
    return kind != PICTURE_UNKNOWN && kind != PICTURE_OTHER;
}

static bool has_mark(const unsigned char *head, size_t size, const mark *m)
{
    return m->at + m->count <= size && memcmp(head + m->at, m->bytes, m->count) == 0;
}

static unsigned little16(const unsigned char *p)
{
    return p[0] | (unsigned)p[1] << 8;
}

/* Recognizes an ISO base media file with a still picture's brand; HEIC and AVIF share a decoder. */
static bool is_heic(const unsigned char *head, size_t size)
{
    static const char *const brands[] = {"heic", "heix", "hevc", "heim", "heis", "hevm",
                                         "hevs", "mif1", "msf1", "avif", "avis"};
    enum { FIRST = 8, MOST = 64 };
    if (size < 12 || memcmp(head + 4, "ftyp", 4) != 0) return false;
    size_t end = head[0] || head[1] || head[2] ? MOST : head[3];
    for (size_t at = FIRST; at + 4 <= size && at + 4 <= end && at < MOST; at += 4)
        for (size_t i = 0; i < sizeof brands / sizeof *brands; i++)
            if (memcmp(head + at, brands[i], 4) == 0) return true;
    return false;
}

/* Recognizes BMP: after "BM" and the file's sizes, a header of a known length, for one plane. */
static bool is_bmp(const unsigned char *head, size_t size)
{
    if (size < 26 || memcmp(head, "BM", 2) != 0 || head[15] || head[16] || head[17]) return false;
    unsigned length = head[14];
    if (length == 12) return little16(head + 22) == 1;
    return length >= 16 && length <= 124 && little16(head + 26) == 1;
}

static bool is_space(unsigned char c)
{
    return c == ' ' || c == '\t' || c == '\r' || c == '\n';
}

/* Recognizes netpbm. Text may begin with a letter and a digit, too; here a number or a comment follows. */
static bool is_pnm(const unsigned char *head, size_t size)
{
    if (size < 8 || head[0] != 'P') return false;
    if (memcmp(head, "P7\n", 3) == 0) return true;
    bool is_kind = (head[1] >= '1' && head[1] <= '6') || head[1] == 'F' || head[1] == 'f';
    if (!is_kind) return false;
    size_t at = 2;
    while (at < size && is_space(head[at]))
        at++;
    return at > 2 && at < size && (head[at] == '#' || (head[at] >= '0' && head[at] <= '9'));
}

static bool is_svg(const unsigned char *head, size_t size)
{
    size_t at = file_text_mark((const char *)head, size);
    while (at < size && is_space(head[at]))
        at++;
    return at < size && head[at] == '<' && memmem(head + at, size - at, "<svg", 4);
}

img_format img_format_of_head(const void *bytes, size_t size)
{
    const unsigned char *head = bytes;
    img_format f = {.kind = PICTURE_UNKNOWN};
    for (size_t i = 0; !f.name && i < sizeof marks / sizeof *marks; i++)
        if (has_mark(head, size, &marks[i])) f = (img_format){.kind = marks[i].kind, .name = marks[i].name};
    if (!f.name && size >= 12 && memcmp(head, "RIFF", 4) == 0 && memcmp(head + 8, "WEBP", 4) == 0)
        f = (img_format){.kind = PICTURE_WEBP, .name = "WebP"};
    if (!f.name && is_heic(head, size)) f = (img_format){.kind = PICTURE_HEIC, .name = "HEIC"};
    if (!f.name && is_bmp(head, size)) f = (img_format){.kind = PICTURE_BMP, .name = "BMP"};
    if (!f.name && is_pnm(head, size)) f = (img_format){.kind = PICTURE_PNM, .name = "PNM"};
    if (!f.name && is_svg(head, size)) f = (img_format){.kind = PICTURE_OTHER, .name = "SVG"};
    f.is_read = is_read(f.kind);
    return f;
}

static bool has_color(unsigned bits)
{
    return bits == 15 || bits == 16 || bits == 24 || bits == 32;
}

/* Recognizes Truevision's TGA. It has no signature at its beginning, and not always one at its end, so that a
 * consistent header is required, and at least as many bytes after it as its pixels need. */
static bool is_tga(uint64_t file_size, const unsigned char *head, size_t size)
{
    enum { HEAD = 18, MAPPED = 1, RUNS = 8, LONGEST_RUN = 128 };
    if (size < HEAD || head[1] > 1) return false;
    unsigned type = head[2], kind = type & ~(unsigned)RUNS, bits = head[16], map_bits = head[7];
    unsigned long long width = little16(head + 12), height = little16(head + 14), map = little16(head + 5);
    if (kind < 1 || kind > 3 || type > 11 || width == 0 || height == 0 || head[17] & 0xc0) return false;
    if (kind == MAPPED ? head[1] != 1 || bits != 8 : bits != 8 && !has_color(bits)) return false;
    if (head[1] ? !has_color(map_bits) || map == 0 : map != 0 || map_bits != 0) return false;
    unsigned long long pixels = width * height, bytes = (bits + 7) / 8;
    unsigned long long least = type & RUNS ? (pixels + LONGEST_RUN - 1) / LONGEST_RUN * (bytes + 1) : pixels * bytes;
    return file_size >= HEAD + head[0] + map * ((map_bits + 7) / 8) + least;
}

img_format img_format_of(const char *path)
{
    byte_source file;
    if (!byte_source_open(&file, path)) return (img_format){.kind = PICTURE_UNKNOWN};
    unsigned char head[IMG_FORMAT_HEAD];
    size_t size = byte_source_read(&file, 0, head, sizeof head);
    img_format f = img_format_of_head(head, size);
    if (!f.name && is_tga(file.size, head, size)) f = (img_format){PICTURE_TGA, "TGA", is_read(PICTURE_TGA)};
    byte_source_close(&file);
    if (f.kind == PICTURE_TIFF && picture_tiff_is_raw(path)) f = (img_format){PICTURE_RAW, "raw", true};
    return f;
}

bool img_is_picture(const char *path)
{
    return img_format_of(path).is_read;
}
