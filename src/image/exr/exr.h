/* SPDX-License-Identifier: MIT */
/* Multi-layer OpenEXR files by OpenEXR Core: named channels and attributes, half float where not told otherwise, ZIP.
 *
 *     exr_channel channels[] = {{"albedo.R", albedo.data, 3, false}, {"albedo.G", albedo.data + 1, 3, false}, ...};
 *     exr_attribute attributes[] = {exr_number("fov", 60), exr_text("shape", "union")};
 *     status s = exr_write(path, width, height, channels, n, attributes, 2);
 *
 *     exr_file *f;
 *     status s = exr_open(path, &f);
 *     exr_read(f, targets, n);     fills the asked channels, all in one pass over the file
 *     exr_close(f);
 */
#ifndef MERLIN_IMAGE_EXR_EXR_H
#define MERLIN_IMAGE_EXR_EXR_H

#include <stdbool.h>
#include <stddef.h>

#include "base/status.h"

typedef struct exr_channel {
    const char *name;
    const float *data; /* first value; the next pixel's is stride floats on */
    int stride;
    bool full; /* 32 bits in the file instead of half's 16, for lengths in whatever unit */
} exr_channel;

typedef struct exr_target {
    const char *name;
    float *data;
    int stride;
} exr_target;

/* text NULL: a list of count floats. */
typedef struct exr_attribute {
    const char *name;
    const char *text;
    float values[40];
    int count;
} exr_attribute;

static inline exr_attribute exr_number(const char *name, float value)
{
    return (exr_attribute){.name = name, .values = {value}, .count = 1};
}

static inline exr_attribute exr_text(const char *name, const char *text)
{
    return (exr_attribute){.name = name, .text = text};
}

/* Atomic: a temporary name, then renamed. Values beyond half's range are clamped to ±HALF_LARGEST (base/half.h). */
status exr_write(const char *path, int width, int height, const exr_channel *channels, size_t channel_count,
                 const exr_attribute *attributes, size_t attribute_count);

typedef struct exr_file exr_file;
status exr_open(const char *path, exr_file **out);
/* Of a file of several parts the first is open at first; this goes on to the next one, if there is one. */
status exr_next_part(exr_file *f, bool *found);
void exr_close(exr_file *f);
int exr_width(const exr_file *f);
int exr_height(const exr_file *f);

/* The picture that is meant to be seen (OpenEXR's display window), and where in it the first value lies: all values may
 * lie within it or beyond. */
typedef struct exr_frame {
    long long width, height, left, top;
} exr_frame;
exr_frame exr_display(const exr_file *f);
/* CIE 1931 chromaticities of red, green, blue and white: false, and values as they were, if the file does not say. */
bool exr_get_chromaticities(const exr_file *f, float xy[8]);
bool exr_has_channel(const exr_file *f, const char *name);
/* Channels by number, sorted by name; NULL from the last one on. */
const char *exr_channel_name(const exr_file *f, int index);
/* Half, float and uint channels; scan lines or tiles; a missing channel is an error that names it. */
status exr_read(exr_file *f, const exr_target *targets, size_t count);
bool exr_has_attribute(const exr_file *f, const char *name);
/* Attributes as written by exr_write: false, and values as they were, if absent, of another kind or not finite. */
bool exr_get_numbers(const exr_file *f, const char *name, float *values, int count);
const char *exr_get_text(const exr_file *f, const char *name); /* NULL if absent */

#endif
