#include "eval/stereo_frame.h"

#include <math.h>
#include <stdlib.h>

#include "estimate/crop.h"
#include "image/resize.h"

enum { SATURATED = 64224 }; /* 0.98 of full scale, where the solvers stop to believe a value */

/* A square of the pictures whose blocks of shrink × shrink pixels become one pixel each. */
typedef struct frame {
    int x, y, side, shrink;
} frame;

/* One channel of one block; what lies outside the picture counts as black. */
static uint16_t block_code(const pst_capture *c, const uint16_t *from, const frame *f, int x, int y, int channel)
{
    uint32_t sum = 0;
    for (int j = 0; j < f->shrink; j++)
        for (int i = 0; i < f->shrink; i++) {
            int u = f->x + x * f->shrink + i, v = f->y + y * f->shrink + j;
            if (u < 0 || v < 0 || u >= c->width || v >= c->height) continue;
            uint16_t code = from[((size_t)v * (size_t)c->width + (size_t)u) * (size_t)c->channels + (size_t)channel];
            if (code >= SATURATED) return UINT16_MAX;
            sum += code;
        }
    uint32_t area = (uint32_t)(f->shrink * f->shrink);
    return (uint16_t)((sum + area / 2) / area);
}

static status shrink_plane(const pst_capture *c, const frame *f, uint16_t **plane)
{
    int side = f->side / f->shrink;
    uint16_t *to = malloc((size_t)side * (size_t)side * (size_t)c->channels * sizeof *to), *at = to;
    if (!to) return fail(ERROR_MEMORY, "no memory for a picture of %d pixels a side", side);
    for (int y = 0; y < side; y++)
        for (int x = 0; x < side; x++)
            for (int k = 0; k < c->channels; k++)
                *at++ = block_code(c, *plane, f, x, y, k);
    free(*plane);
    *plane = to;
    return OK;
}

/* The mean of each block, in place. */
static status shrink_image(const frame *f, img *image)
{
    if (!image->data) return OK;
    img part = {0}, out = {0};
    int side = f->side / f->shrink;
    status s = img_crop(image, f->x, f->y, f->side, f->side, &part);
    if (s == OK) s = img_new(&out, side, side, image->channels);
    size_t channels = (size_t)image->channels;
    float share = 1 / (float)(f->shrink * f->shrink);
    for (int y = 0; s == OK && y < f->side; y++)
        for (int x = 0; x < f->side; x++)
            for (size_t k = 0; k < channels; k++)
                img_at(&out, x / f->shrink, y / f->shrink)[k] += share * img_at(&part, x, y)[k];
    img_free(&part);
    if (s != OK) return s;
    img_free(image);
    *image = out;
    return OK;
}

static void keep_whole_pixels(img *mask)
{
    for (size_t i = 0, n = (size_t)mask->width * (size_t)mask->height; i < n; i++)
        mask->data[i] = mask->data[i] > 0.999f;
}

static void make_unit(img *normal)
{
    for (size_t i = 0, n = (size_t)normal->width * (size_t)normal->height; i < n; i++) {
        float *v = normal->data + 3 * i, length = sqrtf(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
        for (int k = 0; k < 3; k++)
            v[k] = length > 0.5f ? v[k] / length : 0; /* shorter: mostly unknown */
    }
}

static void move_camera(const frame *f, pst_camera *camera)
{
    camera->center_x = (camera->center_x - (float)f->x) / (float)f->shrink;
    camera->center_y = (camera->center_y - (float)f->y) / (float)f->shrink;
    camera->focal /= (float)f->shrink;
}

status stereo_frame(pst_capture *c, img *photo, int most_side)
{
    crop_square square;
    status s = crop_around(&c->mask, &square);
    if (s != OK) return s;
    frame f = {.x = square.x, .y = square.y, .shrink = (square.side + most_side - 1) / most_side};
    f.side = (square.side + f.shrink - 1) / f.shrink * f.shrink;
    for (int i = 0; i < c->count && s == OK; i++)
        s = shrink_plane(c, &f, &c->picture[i]);
    if (s == OK) s = shrink_image(&f, &c->mask);
    if (s == OK) s = shrink_image(&f, &c->normal_true);
    if (s == OK) s = shrink_image(&f, &c->depth_true);
    if (s == OK) s = shrink_image(&f, photo);
    if (s != OK) return s;
    keep_whole_pixels(&c->mask);
    if (c->normal_true.data) make_unit(&c->normal_true);
    move_camera(&f, &c->camera);
    c->width = c->height = f.side / f.shrink;
    return OK;
}
