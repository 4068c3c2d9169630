/* SPDX-License-Identifier: MIT */
#include "estimate/surface/crop.h"

#include <math.h>
#include <string.h>

#include "image/coverage.h"

enum { FEWEST_PIXELS = 64 };
static const float WANTED_SHARE = 0.8f, LEAST_SHARE_OF_WHOLE = 0.6f;

bool crop_is_sound(crop_square c)
{
    return c.side > 0 && c.side < CROP_FARTHEST && c.x > -CROP_FARTHEST && c.x < CROP_FARTHEST &&
           c.y > -CROP_FARTHEST && c.y < CROP_FARTHEST;
}

status crop_around(const img *mask, crop_square *out)
{
    const coverage_box b = coverage_box_of(mask);
    if (b.pixels < FEWEST_PIXELS)
        return fail(MERLIN_BAD_INPUT, "the mask selects %s (%zu pixels are half white or more; at least %d are needed)",
                    b.pixels ? "too little" : "nothing", b.pixels, FEWEST_PIXELS);
    int width = b.right - b.left, height = b.bottom - b.top;
    int longest = width > height ? width : height;
    if (mask->width == mask->height && (float)longest >= LEAST_SHARE_OF_WHOLE * (float)mask->width) {
        *out = (crop_square){0, 0, mask->width};
        return OK;
    }
    int side = (int)ceilf((float)longest / WANTED_SHARE);
    *out = (crop_square){b.left - (side - width) / 2, b.top - (side - height) / 2, side};
    return OK;
}

bool crop_holds(const img *mask, crop_square c, int slack, float least_share)
{
    const coverage_box b = coverage_box_of(mask);
    int width = b.right - b.left, height = b.bottom - b.top;
    bool inside = b.left >= c.x - slack && b.top >= c.y - slack && b.right <= c.x + c.side + slack &&
                  b.bottom <= c.y + c.side + slack;
    return b.pixels > 0 && inside && (float)(width > height ? width : height) >= least_share * (float)c.side;
}

/* Copies the part of a row that is covered and lies in both images; shift: difference of columns between `from` and
 * `to`. */
static void copy_row(const img *from, int y, const img *cover, int shift, img *to, int to_y)
{
    img_span s = cover ? img_row_span(cover, y) : (img_span){0, from->width};
    int first = s.first + shift > 0 ? s.first + shift : 0, end = s.end + shift < to->width ? s.end + shift : to->width;
    if (first >= end) return;
    memcpy(img_at(to, first, to_y), img_at(from, first - shift, y),
           (size_t)(end - first) * (size_t)to->channels * sizeof(float));
}

status crop_take(const img *from, crop_square c, const img *cover, img *out)
{
    status s = img_new(out, c.side, c.side, from->channels);
    for (int y = c.y > 0 ? c.y : 0; s == OK && y < from->height && y < c.y + c.side; y++)
        copy_row(from, y, cover, -c.x, out, y - c.y);
    return s;
}

void crop_put(const img *from, crop_square c, const img *cover, img *to)
{
    for (int y = c.y > 0 ? c.y : 0; y < to->height && y < c.y + c.side; y++)
        copy_row(from, y - c.y, cover, c.x, to, y);
}
