/* SPDX-License-Identifier: MIT */
/* .ptm files, "Polynomial Texture Map (.ptm) File Format", version 1.2, of Malzbender and Gelb (Hewlett-Packard
 * Laboratories 2001): a header of text lines, and pixels' bytes in rows from below. */
#include <stdio.h>

#include "base/file.h"
#include "rti/rti_write.h"

enum { TERMS = 6 };

/* Which of the terms 1, x, y, x², xy, y² the file has in each place: x², y², xy, x, y, 1. */
static const int ORDER[TERMS] = {3, 5, 4, 1, 2, 0};

static bool is_lrgb(const rti_planes *planes)
{
    return planes->planes == 3 + TERMS;
}

/* The plane of a term; of PTM its channel's. */
static int plane_of(const rti_planes *planes, int place, int channel)
{
    return is_lrgb(planes) ? 3 + ORDER[place] : 3 * ORDER[place] + channel;
}

/* A value is (code - bias) × scale, where 255 is white. */
static void print_header(FILE *f, const rti_planes *planes)
{
    fprintf(f, "PTM_1.2\nPTM_FORMAT_%s\n%d\n%d\n", is_lrgb(planes) ? "LRGB" : "RGB", planes->width, planes->height);
    for (int i = 0; i < TERMS; i++)
        fprintf(f, "%.9g%s", (double)planes->scale[plane_of(planes, i, 0)], i + 1 < TERMS ? " " : "\n");
    for (int i = 0; i < TERMS; i++)
        fprintf(f, "%d%s", planes->zero[plane_of(planes, i, 0)], i + 1 < TERMS ? " " : "\n");
}

static void print_terms(FILE *f, const rti_planes *planes, int channel)
{
    const size_t width = (size_t)planes->width, count = (size_t)planes->planes;
    for (size_t y = (size_t)planes->height; y-- > 0;)
        for (size_t x = 0; x < width; x++) {
            const uint8_t *codes = planes->codes + (y * width + x) * count;
            for (int i = 0; i < TERMS; i++)
                putc(codes[plane_of(planes, i, channel)], f);
        }
}

static void print_colour(FILE *f, const rti_planes *planes)
{
    const size_t width = (size_t)planes->width, count = (size_t)planes->planes;
    for (size_t y = (size_t)planes->height; y-- > 0;)
        for (size_t x = 0; x < width; x++)
            fwrite(planes->codes + (y * width + x) * count, 1, 3, f);
}

static void print_all(FILE *f, const void *context)
{
    const rti_planes *planes = context;
    print_header(f, planes);
    for (int c = 0; c < (is_lrgb(planes) ? 1 : 3); c++)
        print_terms(f, planes, c);
    if (is_lrgb(planes)) print_colour(f, planes);
}

status rti_write_ptm(const char *path, const rti_planes *planes)
{
    return file_print(path, print_all, planes);
}
