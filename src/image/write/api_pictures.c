/* SPDX-License-Identifier: MIT */
/* Pictures for people to look at (merlin/pictures.h). */
#include "merlin/pictures.h"

#include <stdlib.h>

#include "base/api_needs.h"
#include "base/file.h"
#include "image/resize.h"
#include "image/write/animation.h"
#include "image/write/figure.h"
#include "image/write/write.h"

enum { LARGEST_SIDE = 65535, MOST_TILES = 256 };

static status check_image(const merlin_image *image)
{
    const bool sound =
        image->data && image->width > 0 && image->height > 0 && (image->channels == 1 || image->channels == 3);
    return sound ? OK : fail(MERLIN_WRONG_USE, "the image is empty, or has neither 1 nor 3 channels");
}

/* Checks that an image can be written. */
static status check_shown(const merlin_image *image)
{
    status s = check_image(image);
    return s == OK ? img_check_numbers(image) : s;
}

merlin_status merlin_image_resize(const merlin_image *image, int width, int height, merlin_image *out)
{
    const merlin_image none = {0};
    if (out) *out = none;
    status s = api_needs(__func__, image && out);
    if (s == OK) s = check_image(image);
    if (s == OK && (width < 1 || height < 1 || width > LARGEST_SIDE || height > LARGEST_SIDE))
        s = fail(MERLIN_WRONG_USE, "an image cannot have %d x %d pixels", width, height);
    return s == OK ? img_resize(image, width, height, out) : s;
}

/* ---- files ---- */

static status check_format(merlin_image_format format)
{
    if (format == MERLIN_PNG || format == MERLIN_JPEG) return OK;
    return fail(MERLIN_WRONG_USE, "no format of pictures has the number %d", (int)format);
}

merlin_status merlin_image_encode(const merlin_image *image, merlin_image_format format, unsigned char **bytes,
                                  size_t *size)
{
    if (bytes) *bytes = NULL;
    if (size) *size = 0;
    status s = api_needs(__func__, image && bytes && size);
    if (s == OK) s = check_shown(image);
    if (s == OK) s = check_format(format);
    const img_file_kind kind = format == MERLIN_JPEG ? IMG_JPEG : IMG_PNG;
    return s == OK ? img_encode_picture("the picture", image, kind, bytes, size) : s;
}

merlin_status merlin_mask_write(const merlin_image *mask, const char *path)
{
    status s = api_needs(__func__, mask && path);
    if (s == OK) s = check_shown(mask);
    if (s != OK) return s;
    if (file_ends_in(path, ".webp")) return img_write_webp(path, mask);
    if (file_ends_in(path, ".png")) return img_write_png(path, mask, IMG_LINEAR8);
    return fail(MERLIN_WRONG_USE, "cannot write %s: a mask's name ends in .png or .webp", path);
}

/* ---- sheets ---- */

merlin_status merlin_sheet_write(const merlin_tile *tiles, int count, int columns, int side, const char *path)
{
    figure_tile drawn[MOST_TILES];
    status s = api_needs(__func__, tiles && path);
    if (s == OK && (count < 1 || count > MOST_TILES || columns < 1 || columns > count || side < 1 || side > 2048))
        s = fail(MERLIN_WRONG_USE, "cannot write %s: a sheet has 1 to %d tiles of 1 to 2048 pixels", path, MOST_TILES);
    for (int i = 0; i < count && s == OK; i++) {
        s = api_needs(__func__, tiles[i].label && tiles[i].picture);
        if (s == OK) s = check_shown(tiles[i].picture);
        drawn[i] = (figure_tile){tiles[i].label, tiles[i].picture};
    }
    return s == OK ? figure_sheet(path, drawn, count, columns, side) : s;
}

/* ---- animations ---- */

struct merlin_animation {
    img_animation frames;
};

merlin_status merlin_animation_new(int width, int height, int most, merlin_animation **out)
{
    if (out) *out = NULL;
    status s = api_needs(__func__, out);
    if (s != OK) return s;
    merlin_animation *made = calloc(1, sizeof *made);
    if (!made) return fail(MERLIN_NO_MEMORY, "no memory for an animation");
    s = img_animation_new(width, height, most, &made->frames);
    if (s != OK)
        free(made);
    else
        *out = made;
    return s;
}

merlin_status merlin_animation_add(merlin_animation *animation, const merlin_image *frame)
{
    status s = api_needs(__func__, animation && frame);
    return s == OK ? img_animation_add(&animation->frames, frame) : s;
}

merlin_status merlin_animation_write(const merlin_animation *animation, const char *path, int milliseconds)
{
    status s = api_needs(__func__, animation && path);
    if (s == OK && (milliseconds < 1 || milliseconds > 60000))
        s = fail(MERLIN_WRONG_USE, "cannot write %s: a frame is shown for 1 to 60000 milliseconds", path);
    return s == OK ? img_animation_write(&animation->frames, path, milliseconds) : s;
}

void merlin_animation_free(merlin_animation *animation)
{
    if (!animation) return;
    img_animation_free(&animation->frames);
    free(animation);
}
