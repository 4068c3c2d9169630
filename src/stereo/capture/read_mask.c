/* SPDX-License-Identifier: MIT */
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "base/number.h"
#include "image/coverage.h"
#include "image/read/folder.h"
#include "image/read/read.h"
#include "stereo/capture/capture_parts.h"

/* Ratio of a picture's longer side to the margin around the object that is kept. */
enum { MARGIN = 8 };

status pst_find_mask(const char *folder, const char *asked, char **path)
{
    img_folder f = {0};
    *path = NULL;
    if (!asked) {
        status s = img_folder_read(folder, &f);
        if (s != OK) return s;
        const img_folder_file *found = img_folder_whole_mask(&f);
        if (found) asked = found->path;
    }
    if (asked) *path = strdup(asked);
    img_folder_free(&f);
    return !asked || *path ? OK : fail(MERLIN_NO_MEMORY, "no memory for a file name");
}

/* Tells whether the mask has the smallest possible surface: a triangle of three of a square's four pixels. */
static bool holds_a_triangle(const img *mask)
{
    const float *m = mask->data;
    const size_t width = (size_t)mask->width;
    for (int y = 0; y + 1 < mask->height; y++)
        for (size_t at = (size_t)y * width, end = at + width - 1; at < end; at++)
            if (m[at] + m[at + 1] + m[at + width] + m[at + width + 1] > 2.5f) return true;
    return false;
}

/* Tells whether some pixel is lit in some picture. Dim pictures pass, as a given mask may select dark pixels on
 * purpose. */
static bool is_ever_lit(const merlin_capture *c)
{
    const size_t pixels = (size_t)c->width * (size_t)c->height, channels = (size_t)c->channels;
    for (int k = 0; k < c->count; k++)
        for (size_t i = 0; i < pixels * channels; i++)
            if (pst_code(&c->picture[k], i) > 0 && c->mask.data[i / channels] > 0) return true;
    return false;
}

static status check_mask(const char *path, merlin_capture *c)
{
    if (c->mask.width != c->width || c->mask.height != c->height)
        return fail(MERLIN_BAD_INPUT, "the mask %s is %d x %d pixels, but the pictures are %d x %d", path,
                    c->mask.width, c->mask.height, c->width, c->height);
    size_t pixels = (size_t)c->width * (size_t)c->height, inside = 0;
    for (size_t p = 0; p < pixels; p++)
        inside += (c->mask.data[p] = c->mask.data[p] >= 0.5f) > 0;
    if (!inside) return fail(MERLIN_BAD_INPUT, "the mask %s is black or transparent everywhere", path);
    if (!holds_a_triangle(&c->mask))
        return fail(MERLIN_BAD_INPUT,
                    "the mask %s shows %zu pixel%s, too few or too far apart for a surface: it must be white wherever "
                    "the object is",
                    path, inside, inside == 1 ? "" : "s");
    if (!is_ever_lit(c))
        return fail(MERLIN_BAD_INPUT,
                    "the pictures are black where the mask %s is white: is it theirs, and the object white in it?",
                    path);
    return OK;
}

static status find_mask(const char *from, merlin_capture *c)
{
    status s = pst_capture_find_mask(c);
    size_t pixels = (size_t)c->width * (size_t)c->height;
    size_t inside = 0;
    for (size_t p = 0; p < pixels && s == OK; p++)
        inside += c->mask.data[p] > 0;
    if (s != OK) return s;
    if (!inside)
        return fail(MERLIN_BAD_INPUT, "the pictures of %s are black: nothing is above %g %% of full scale; give a mask",
                    from, (double)(100 * PST_BLACK));
    if (holds_a_triangle(&c->mask)) return OK;
    return fail(MERLIN_BAD_INPUT,
                "no object is to be found in %s: %zu pixel%s stand%s out, too few for a surface; give a mask", from,
                inside, inside == 1 ? "" : "s", inside == 1 ? "s" : "");
}

/* Finds the mask's box with a margin for pictures that moved. */
static coverage_box find_kept(const merlin_capture *c)
{
    const int margin = (c->width > c->height ? c->width : c->height) / MARGIN;
    const coverage_box b = coverage_box_of(&c->mask);
    return (coverage_box){clamp_int(b.left - margin, 0, c->width), clamp_int(b.top - margin, 0, c->height),
                          clamp_int(b.right + margin, 0, c->width), clamp_int(b.bottom + margin, 0, c->height),
                          b.pixels};
}

/* Makes all pictures black far from the object, which nobody looks at, so that large ones take less memory. */
static void forget_surroundings(merlin_capture *c)
{
    const coverage_box k = find_kept(c);
    const size_t width = (size_t)c->width;
    for (int i = 0; i < c->count; i++) {
        char *picture = pst_plane_data(&c->picture[i]);
        size_t from = 0, pixel = (size_t)c->channels * pst_plane_bytes(&c->picture[i]);
        for (int y = k.top; y < k.bottom; y++) {
            const size_t row = (size_t)y * width;
            memory_forget(picture + from * pixel, (row + (size_t)k.left - from) * pixel);
            from = row + (size_t)k.right;
        }
        memory_forget(picture + from * pixel, (width * (size_t)c->height - from) * pixel);
    }
}

status pst_take_mask(const char *path, const char *from, merlin_capture *c)
{
    c->mask_found = !path;
    if (!path) return find_mask(from, c);
    status s = img_read_mask(path, &c->mask);
    if (s == OK) s = check_mask(path, c);
    if (s == OK) forget_surroundings(c);
    return s;
}

status pst_read_mask(const char *folder, const merlin_capture_files *options, merlin_capture *c)
{
    char *path;
    status s = pst_find_mask(folder, options->mask, &path);
    if (s == OK) s = pst_take_mask(path, folder, c);
    if (s == OK) s = pst_list_skipped(folder, path, options->ambient, c);
    free(path);
    return s;
}
