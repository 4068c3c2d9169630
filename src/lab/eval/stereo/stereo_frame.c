/* SPDX-License-Identifier: MIT */
#include "lab/eval/stereo/stereo_frame.h"

#include <math.h>

#include "estimate/surface/crop.h"
#include "image/resize.h"
#include "stereo/capture/shrink.h"

/* The mean of each block, in place. */
static status shrink_image(const pst_blocks *b, img *image)
{
    if (!image->data) return OK;
    img part = {0}, out = {0};
    int side = b->columns * b->factor;
    status s = img_crop(image, b->x, b->y, side, side, &part);
    if (s == OK) s = img_new(&out, b->columns, b->rows, image->channels);
    size_t channels = (size_t)image->channels;
    float share = 1 / (float)(b->factor * b->factor);
    for (int y = 0; s == OK && y < side; y++)
        for (int x = 0; x < side; x++)
            for (size_t k = 0; k < channels; k++)
                img_at(&out, x / b->factor, y / b->factor)[k] += share * img_at(&part, x, y)[k];
    img_free(&part);
    if (s != OK) return s;
    img_free(image);
    *image = out;
    return OK;
}

static void make_unit(img *normal)
{
    for (size_t i = 0, n = (size_t)normal->width * (size_t)normal->height; i < n; i++) {
        float *v = normal->data + 3 * i, length = sqrtf(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
        for (int k = 0; k < 3; k++)
            v[k] = length > 0.5f ? v[k] / length : 0; /* shorter: mostly unknown */
    }
}

/* The small one's pictures, lights, mask and camera in the place of the large one's. */
static void take_place(merlin_capture *small, merlin_capture *c)
{
    merlin_capture large = *c;
    c->width = small->width;
    c->height = small->height;
    c->camera = small->camera;
    c->picture = small->picture;
    c->light = small->light;
    c->mask = small->mask;
    large.name = NULL;
    large.normal_true = large.depth_true = (img){0};
    pst_capture_free(&large);
}

status stereo_frame(merlin_capture *c, img *photo, int most_side)
{
    crop_square square;
    status s = crop_around(&c->mask, &square);
    if (s != OK) return s;
    int factor = (square.side + most_side - 1) / most_side, side = (square.side + factor - 1) / factor;
    pst_blocks frame = {.x = square.x, .y = square.y, .columns = side, .rows = side, .factor = factor, .whole = true};
    merlin_capture small;
    s = pst_shrink(c, frame, PST_SATURATED, &small);
    if (s != OK) return s;
    take_place(&small, c);
    s = shrink_image(&frame, &c->normal_true);
    if (s == OK) s = shrink_image(&frame, &c->depth_true);
    if (s == OK && photo) s = shrink_image(&frame, photo);
    if (s == OK && c->normal_true.data) make_unit(&c->normal_true);
    return s;
}

status stereo_frame_check(const merlin_capture *c, const merlin_maps *maps)
{
    if (maps->crop.x == 0 && maps->crop.y == 0 && maps->crop.side == c->width) return OK;
    return fail(MERLIN_BAD_INPUT,
                "shrunk to %d pixels a side the object does not fill its frame: its parts are too thin", c->width);
}
