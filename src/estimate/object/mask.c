/* SPDX-License-Identifier: MIT */
#include "estimate/object/mask.h"

#include "estimate/object/find_object.h"
#include "image/coverage.h"

static const float NOTHING = 0.05f;

void mask_clean(img *mask)
{
    size_t count = (size_t)mask->width * (size_t)mask->height;
    for (size_t i = 0; i < count; i++) {
        float m = mask->data[i];
        mask->data[i] = m > COVERAGE_WHOLE ? 1 : m >= NOTHING ? m : 0;
    }
}

static bool is_hint(const merlin_hint *hint)
{
    return hint && (hint->point_count != 0 || hint->box.width != 0);
}

/* The photograph's sides in the pixels that a hint counts. */
typedef struct counted {
    int width, height;
} counted;

static int reduction(const merlin_hint *hint)
{
    return hint->reduced > 1 ? hint->reduced : 1;
}

static bool is_inside(counted photo, int x, int y)
{
    return x >= 0 && y >= 0 && x < photo.width && y < photo.height;
}

/* Checks a hint that has points or a box. */
static status check_hint(counted photo, const img *given, const merlin_hint *hint)
{
    if (given)
        return fail(MERLIN_WRONG_USE,
                    "the photograph has a mask, or an alpha that is one: points and a box are for the "
                    "search for the object where there is none");
    if (hint->point_count < 0 || hint->point_count > MERLIN_MOST_POINTS)
        return fail(MERLIN_WRONG_USE, "at most %d points tell where the object is, not %d", MERLIN_MOST_POINTS,
                    hint->point_count);
    for (int i = 0; i < hint->point_count; i++)
        if (!is_inside(photo, hint->point[i].x, hint->point[i].y))
            return fail(MERLIN_WRONG_USE, "the point %d,%d lies outside the photograph of %d×%d pixels",
                        hint->point[i].x, hint->point[i].y, photo.width, photo.height);
    int x = hint->box.x, y = hint->box.y, width = hint->box.width, height = hint->box.height;
    if (width == 0) return OK;
    if (width < 0 || height <= 0 || !is_inside(photo, x, y) || width > photo.width - x || height > photo.height - y)
        return fail(MERLIN_WRONG_USE, "the box %d,%d,%d,%d does not lie in the photograph of %d×%d pixels", x, y, width,
                    height, photo.width, photo.height);
    for (int i = 0; i < hint->point_count; i++) {
        int u = hint->point[i].x, v = hint->point[i].y;
        if (u < x || v < y || u >= x + width || v >= y + height)
            return fail(MERLIN_WRONG_USE, "the point %d,%d lies outside the box %d,%d,%d,%d", u, v, x, y, width,
                        height);
    }
    return OK;
}

/* Converts a hint to the photograph's own pixels. */
static merlin_hint in_pixels(const merlin_hint *hint)
{
    const int by = reduction(hint);
    merlin_hint own = *hint;
    for (int i = 0; i < own.point_count; i++) {
        own.point[i].x /= by;
        own.point[i].y /= by;
    }
    own.box.x /= by;
    own.box.y /= by;
    own.box.width = (hint->box.x + hint->box.width + by - 1) / by - own.box.x;
    own.box.height = (hint->box.y + hint->box.height + by - 1) / by - own.box.y;
    if (hint->box.width == 0) own.box.width = 0;
    own.reduced = 1;
    return own;
}

status mask_choose(const img *photo, const img *given, const merlin_hint *hint, img *mask, mask_choice *choice)
{
    *mask = (img){0};
    *choice = (mask_choice){false, 1};
    if (given && !given->data) given = NULL;
    if (given && (given->width != photo->width || given->height != photo->height))
        return fail(MERLIN_BAD_INPUT, "the mask is %d×%d pixels, the photograph %d×%d; they must be equal",
                    given->width, given->height, photo->width, photo->height);
    if (given && given->channels != 1)
        return fail(MERLIN_WRONG_USE, "the mask has %d channels instead of 1", given->channels);
    const int by = is_hint(hint) ? reduction(hint) : 1;
    status s = is_hint(hint) ? check_hint((counted){by * photo->width, by * photo->height}, given, hint) : OK;
    if (s != OK) return s;
    const merlin_hint own = is_hint(hint) ? in_pixels(hint) : (merlin_hint){.point_count = 0};
    if (given) {
        s = img_copy(mask, given);
    } else {
        choice->found = true;
        s = find_object(photo, is_hint(hint) ? &own : NULL, mask, &choice->confidence);
    }
    if (s == OK) mask_clean(mask);
    if (s == OK && !given && coverage_is_transparent(mask)) {
        img_free(mask);
        s = fail(MERLIN_BAD_INPUT, "no object was found%s: a mask tells where it is",
                 is_hint(hint) ? " where the point or the box is" : "");
    }
    return s;
}
