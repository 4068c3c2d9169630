/* SPDX-License-Identifier: MIT */
/* Multi-layer OpenEXR files through OpenEXR Core: named channels and attributes, half float unless stated otherwise,
 * ZIP compression.
 *
 *     exr_channel channels[] = {{"albedo.R", albedo.data, 3, false}, {"albedo.G", albedo.data + 1, 3, false}, ...};
 *     exr_attribute attributes[] = {exr_number("fov", 60), exr_text("shape", "union")};
 *     status s = exr_write(path, width, height, channels, n, attributes, 2);
 *
 *     exr_file *f;
 *     status s = exr_open(path, &f);
 *     exr_read(f, targets, n);     fills the requested channels in one pass over the file
 *     exr_close(f);
 */
#ifndef MERLIN_IMAGE_EXR_EXR_H
#define MERLIN_IMAGE_EXR_EXR_H

#include <stdbool.h>
#include <stddef.h>

#include "base/status.h"

typedef struct exr_channel {
    const char *name;
    const float *data; /* first value; the next pixel's is stride floats further */
    int stride;
    bool full; /* 32-bit float in the file instead of half, for lengths in arbitrary units */
} exr_channel;

typedef struct exr_target {
    const char *name;
    float *data;
    int stride;
} exr_target;

/* An attribute: text, or if that is NULL a list of `count` floats. */
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

/* Writes a file atomically: under a temporary name, then renamed. Values beyond half's range are clamped to
 * ±HALF_LARGEST (base/half.h). */
status exr_write(const char *path, int width, int height, const exr_channel *channels, size_t channel_count,
                 const exr_attribute *attributes, size_t attribute_count);

typedef struct exr_file exr_file;
status exr_open(const char *path, exr_file **out);
/* Goes on to the next part of a file of several parts, if there is one; *found tells. A file is opened at its first
 * part. */
status exr_next_part(exr_file *f, bool *found);
void exr_close(exr_file *f);
int exr_width(const exr_file *f);
int exr_height(const exr_file *f);

/* The visible picture (OpenEXR's display window), and where in it the first stored value lies: the stored values may
 * cover less than it, or more. */
typedef struct exr_frame {
    long long width, height, left, top;
} exr_frame;
exr_frame exr_display(const exr_file *f);
/* Reads the CIE 1931 chromaticities of red, green, blue and white; returns false and leaves xy alone if the file does
 * not state them. */
bool exr_get_chromaticities(const exr_file *f, float xy[8]);
bool exr_has_channel(const exr_file *f, const char *name);
/* Returns a channel's name by index, sorted by name; NULL behind the last. */
const char *exr_channel_name(const exr_file *f, int index);
/* Reads channels of half, float or uint, in scan lines or tiles; a missing channel is an error that names it. */
status exr_read(exr_file *f, const exr_target *targets, size_t count);
bool exr_has_attribute(const exr_file *f, const char *name);
/* Read attributes as exr_write writes them; return false, and leave the values alone, if one is absent, of another type
 * or not finite. */
bool exr_get_numbers(const exr_file *f, const char *name, float *values, int count);
const char *exr_get_text(const exr_file *f, const char *name); /* returns NULL if absent */

#endif
