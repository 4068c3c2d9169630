#include "estimate/crop.h"

#include <math.h>
#include <string.h>

#include "image/resize.h"

enum { FEWEST_PIXELS = 64 };
static const float WANTED_SHARE = 0.8f, LEAST_SHARE_OF_WHOLE = 0.6f;

typedef struct bounds {
    int left, right, top, bottom;
    size_t pixels;
} bounds;

static bounds bounds_of(const img *mask)
{
    bounds b = {mask->width, -1, mask->height, -1, 0};
    for (int y = 0; y < mask->height; y++) {
        for (int x = 0; x < mask->width; x++) {
            if (!(*img_at(mask, x, y) >= 0.5f)) continue;
            b.pixels++;
            if (x < b.left) b.left = x;
            if (x > b.right) b.right = x;
            if (y < b.top) b.top = y;
            b.bottom = y;
        }
    }
    return b;
}

status crop_around(const img *mask, crop_square *out)
{
    bounds b = bounds_of(mask);
    if (b.pixels < FEWEST_PIXELS)
        return fail(ERROR_INPUT, "the mask selects %s (%zu pixels; at least %d are needed)",
                    b.pixels ? "too little" : "nothing", b.pixels, FEWEST_PIXELS);
    int width = b.right - b.left + 1, height = b.bottom - b.top + 1;
    int longest = width > height ? width : height;
    if (mask->width == mask->height && (float)longest >= LEAST_SHARE_OF_WHOLE * (float)mask->width) {
        *out = (crop_square){0, 0, mask->width};
        return OK;
    }
    int side = (int)ceilf((float)longest / WANTED_SHARE);
    *out = (crop_square){b.left - (side - width) / 2, b.top - (side - height) / 2, side};
    return OK;
}

status crop_take(const img *from, crop_square c, img *out)
{
    return img_crop(from, c.x, c.y, c.side, c.side, out);
}

void crop_put(const img *from, crop_square c, img *to)
{
    int left = c.x > 0 ? c.x : 0, right = c.x + c.side < to->width ? c.x + c.side : to->width;
    int top = c.y > 0 ? c.y : 0, bottom = c.y + c.side < to->height ? c.y + c.side : to->height;
    if (left >= right) return;
    size_t row = (size_t)(right - left) * (size_t)to->channels * sizeof(float);
    for (int y = top; y < bottom; y++)
        memcpy(img_at(to, left, y), img_at(from, left - c.x, y - c.y), row);
}
