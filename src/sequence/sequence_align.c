/* SPDX-License-Identifier: MIT */
#include "sequence/sequence_align.h"

#include <math.h>
#include <stdbool.h>

#include "image/resize.h"

/* Longest side of the coarsest pictures, and of the finest, below which all are compared. */
enum { COARSEST = 48, FINEST = 1024, FIRST_REACH = 4, REACH = 2 };
/* A shift must beat none by this share. */
static const float CLEARLY = 0.9f;

/* The part of the frames that is compared: the mask's bounds, and as much around them as is searched. */
typedef struct window {
    int x, y, width, height;
} window;

static bool window_of(const img *mask, window *out)
{
    int left = mask->width, right = -1, top = mask->height, bottom = -1;
    for (int y = 0; y < mask->height; y++) {
        const img_span s = img_row_span(mask, y);
        if (s.first >= s.end) continue;
        left = s.first < left ? s.first : left;
        right = s.end - 1 > right ? s.end - 1 : right;
        top = y < top ? y : top;
        bottom = y;
    }
    if (right < left) return false;
    const int width = right - left + 1, height = bottom - top + 1, margin = (width > height ? width : height) / 8 + 2;
    *out = (window){left - margin, top - margin, width + 2 * margin, height + 2 * margin};
    return true;
}

typedef struct level {
    img before, now, mask;
} level;

static void level_free(level *l)
{
    img_free(&l->before);
    img_free(&l->now);
    img_free(&l->mask);
}

static status shrink(const img *whole, const window *w, int width, int height, img *out)
{
    img part = {0};
    status s = img_crop(whole, w->x, w->y, w->width, w->height, &part);
    if (s == OK && width == w->width && height == w->height) {
        *out = part;
        return OK;
    }
    if (s == OK) s = img_resize(&part, width, height, out);
    img_free(&part);
    return s;
}

static status level_new(const img *before, const img *now, const img *mask, const window *w, float scale, level *out)
{
    const int width = (int)fmaxf(1, roundf(scale * (float)w->width));
    const int height = (int)fmaxf(1, roundf(scale * (float)w->height));
    *out = (level){.before = {0}};
    status s = shrink(before, w, width, height, &out->before);
    if (s == OK) s = shrink(now, w, width, height, &out->now);
    if (s == OK) s = shrink(mask, w, width, height, &out->mask);
    if (s != OK) level_free(out);
    return s;
}

/* Returns the mean squared difference within the mask; pixels that leave the window count as quite different. */
static float difference(const level *l, int dx, int dy)
{
    const float beyond = 0.25f * 0.25f;
    double sum = 0, count = 0;
    for (int y = 0; y < l->mask.height; y++) {
        const float *mask = img_at(&l->mask, 0, y), *before = img_at(&l->before, 0, y);
        const bool row_inside = y + dy >= 0 && y + dy < l->now.height;
        const float *now = img_at(&l->now, 0, row_inside ? y + dy : y);
        double row = 0, in_row = 0;
        for (int x = 0; x < l->mask.width; x++) {
            if (!(mask[x] > 0.25f)) continue;
            const bool inside = row_inside && x + dx >= 0 && x + dx < l->now.width;
            const float d = inside ? now[x + dx] - before[x] : 0;
            row += (double)(inside ? d * d : beyond);
            in_row++;
        }
        sum += row;
        count += in_row;
    }
    return count > 0 ? (float)(sum / count) : 0;
}

static void search(const level *l, int reach, sequence_shift *at)
{
    const sequence_shift start = *at;
    float best = difference(l, start.x, start.y);
    for (int y = start.y - reach; y <= start.y + reach; y++)
        for (int x = start.x - reach; x <= start.x + reach; x++) {
            const float d = difference(l, x, y);
            if (d >= best) continue;
            best = d;
            *at = (sequence_shift){x, y};
        }
    if (difference(l, 0, 0) * CLEARLY <= best) *at = (sequence_shift){0, 0};
}

status sequence_align(const img *before, const img *now, const img *mask, sequence_shift expected, sequence_shift *out)
{
    window w;
    *out = (sequence_shift){0, 0};
    if (!window_of(mask, &w)) return OK;
    const float longest = (float)(w.width > w.height ? w.width : w.height);
    const float finest = fminf(1, FINEST / longest);
    float scale = finest;
    while (scale * longest > COARSEST)
        scale /= 2;
    float x = (float)expected.x, y = (float)expected.y;
    status s = OK;
    for (int reach = FIRST_REACH; s == OK; reach = REACH) {
        level l;
        s = level_new(before, now, mask, &w, scale, &l);
        if (s != OK) return s;
        sequence_shift at = {(int)roundf(x * scale), (int)roundf(y * scale)};
        search(&l, reach, &at);
        x = (float)at.x / scale;
        y = (float)at.y / scale;
        level_free(&l);
        if (scale >= finest) break;
        scale = fminf(finest, 2 * scale);
    }
    *out = (sequence_shift){(int)roundf(x), (int)roundf(y)};
    return s;
}

status sequence_move(img *image, sequence_shift by)
{
    if (!image->data || (by.x == 0 && by.y == 0)) return OK;
    img moved = {0};
    status s = img_crop(image, -by.x, -by.y, image->width, image->height, &moved);
    if (s != OK) return s;
    img_free(image);
    *image = moved;
    return OK;
}
