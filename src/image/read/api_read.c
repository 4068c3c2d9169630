/* SPDX-License-Identifier: MIT */
/* merlin_image_read and merlin_mask_read (merlin/image.h). */
#include "base/api_needs.h"
#include "image/coverage.h"
#include "image/read/read.h"

merlin_status merlin_image_read(const char *path, merlin_image *color, merlin_image *alpha)
{
    if (color) *color = (merlin_image){0};
    if (alpha) *alpha = (merlin_image){0};
    status s = api_needs(__func__, path && color);
    if (s != OK) return s;
    img c = {0}, a = {0};
    s = img_read(path, &c, alpha ? &a : NULL);
    if (s == OK && a.data && coverage_is_transparent(&a))
        s = fail(MERLIN_BAD_INPUT,
                 "%s is transparent everywhere, so its alpha shows no object; give a mask, or save it "
                 "without alpha",
                 path);
    if (s != OK) {
        img_free(&c);
        img_free(&a);
        return s;
    }
    if (a.data && coverage_is_opaque(&a)) img_free(&a);
    *color = c;
    if (alpha) *alpha = a;
    return MERLIN_OK;
}

merlin_status merlin_mask_read(const char *path, merlin_image *mask)
{
    if (mask) *mask = (merlin_image){0};
    status s = api_needs(__func__, path && mask);
    return s == OK ? img_read_mask(path, mask) : s;
}
