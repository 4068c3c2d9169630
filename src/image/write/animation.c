/* SPDX-License-Identifier: MIT */
#include "image/write/animation.h"

#include <limits.h>
#include <stdlib.h>

#include "base/file.h"
#include "image/color.h"
#include "image/vips_library.h"
#include "image/vips_start.h"

static size_t frame_bytes(const img_animation *a)
{
    return 3 * (size_t)a->width * (size_t)a->height;
}

status img_animation_new(int width, int height, int most, img_animation *a)
{
    *a = (img_animation){.width = width, .height = height, .most = most};
    if (width < 1 || height < 1 || most < 1 || height > INT_MAX / most)
        return fail(MERLIN_WRONG_USE, "no animation of %d frames of %d x %d", most, width, height);
    a->codes = malloc(frame_bytes(a) * (size_t)most);
    return a->codes ? OK : fail(MERLIN_NO_MEMORY, "no memory for an animation of %d frames", most);
}

status img_animation_add(img_animation *a, const img *frame)
{
    if (a->count == a->most) return fail(MERLIN_WRONG_USE, "an animation of %d frames is full", a->most);
    if (!frame->data || frame->channels != 3 || frame->width != a->width || frame->height != a->height)
        return fail(MERLIN_WRONG_USE, "frame %d of an animation is not a colour image of %d x %d", a->count, a->width,
                    a->height);
    status s = img_check_numbers(frame);
    if (s != OK) return s;
    size_t each = frame_bytes(a);
    srgb_codes8(frame->data, each, a->codes + each * (size_t)a->count++);
    return OK;
}

/* Wraps the codes in a libvips image, frames one below the other; the codes must outlive it. Returns NULL if that
 * fails. */
static VipsImage *wrap(const img_animation *a)
{
    size_t size = frame_bytes(a) * (size_t)a->count;
    VipsImage *bare =
        vips()->image_new_from_memory(a->codes, size, a->width, a->height * a->count, 3, VIPS_FORMAT_UCHAR);
    if (!bare) return NULL;
    VipsImage *named = NULL;
    int failed = vips()->copy(bare, &named, "interpretation", VIPS_INTERPRETATION_sRGB, NULL);
    vips()->g_object_unref(bare);
    return failed ? NULL : named;
}

static status check(const img_animation *a, const char *path)
{
    if (!file_ends_in(path, ".webp") && !file_ends_in(path, ".gif"))
        return fail(MERLIN_WRONG_USE, "cannot write %s: an animation's name ends in .webp or .gif", path);
    if (a->count < 1) return fail(MERLIN_WRONG_USE, "cannot write %s: an animation needs at least one frame", path);
    if (file_ends_in(path, ".gif") && !vips()->type_find("VipsOperation", "gifsave_buffer"))
        return fail(MERLIN_CANNOT_WRITE, "cannot write %s: this libvips has no GIF writer, use .webp", path);
    return OK;
}

/* Saves the image with the page height and delays that libvips' writers expect. */
static int save(const img_animation *a, const char *path, const int *delays, void **data, size_t *size)
{
    VipsImage *image = wrap(a);
    if (!image) return -1;
    vips()->image_set_int(image, VIPS_META_PAGE_HEIGHT, a->height);
    vips()->image_set_int(image, "loop", 0);
    vips()->image_set_array_int(image, "delay", delays, a->count);
    int failed = file_ends_in(path, ".gif") ? vips()->gifsave_buffer(image, data, size, NULL)
                                            : vips()->webpsave_buffer(image, data, size, "Q", 90, "effort", 3, NULL);
    vips()->g_object_unref(image);
    return failed;
}

status img_animation_write(const img_animation *a, const char *path, int milliseconds)
{
    status s = vips_begin();
    if (s == OK) s = check(a, path);
    if (s != OK) return s;
    void *data = NULL;
    size_t size = 0;
    int *delays = calloc((size_t)a->count, sizeof *delays);
    if (!delays) return fail(MERLIN_NO_MEMORY, "no memory to write %s", path);
    for (int i = 0; i < a->count; i++)
        delays[i] = milliseconds;
    if (save(a, path, delays, &data, &size))
        s = vips_refusal(MERLIN_CANNOT_WRITE, "write", path);
    else
        s = file_write(path, data, size);
    vips()->g_free(data);
    free(delays);
    return s;
}

void img_animation_free(img_animation *a)
{
    free(a->codes);
    *a = (img_animation){.codes = NULL};
}
