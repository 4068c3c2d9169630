#include "estimate/fill.h"

#include <stdbool.h>
#include <string.h>

/* Half the size; each pixel is the mean of its valid children, valid if any child is. */
static void pull(const img *fine, const img *valid, img *coarse, img *coarse_valid)
{
    for (int y = 0; y < coarse->height; y++) {
        for (int x = 0; x < coarse->width; x++) {
            float *sum = img_at(coarse, x, y), weight = 0;
            for (int i = 0; i < 4; i++) {
                int u = 2 * x + (i & 1), v = 2 * y + (i >> 1);
                if (u >= fine->width || v >= fine->height || *img_at(valid, u, v) < 0.5f) continue;
                for (int c = 0; c < fine->channels; c++)
                    sum[c] += img_at(fine, u, v)[c];
                weight += 1;
            }
            for (int c = 0; c < fine->channels && weight > 0; c++)
                sum[c] /= weight;
            *img_at(coarse_valid, x, y) = weight > 0;
        }
    }
}

static int clamp_index(int i, int count)
{
    return i < 0 ? 0 : i >= count ? count - 1 : i;
}

/* Bilinear value of coarse at the centre of the fine pixel. */
static void sample(const img *coarse, int x, int y, float *out)
{
    int x0 = (x - 1) >> 1, y0 = (y - 1) >> 1;
    float u = x & 1 ? 0.25f : 0.75f, v = y & 1 ? 0.25f : 0.75f;
    int left = clamp_index(x0, coarse->width), right = clamp_index(x0 + 1, coarse->width);
    int top = clamp_index(y0, coarse->height), bottom = clamp_index(y0 + 1, coarse->height);
    for (int c = 0; c < coarse->channels; c++) {
        float above = (1 - u) * img_at(coarse, left, top)[c] + u * img_at(coarse, right, top)[c];
        float below = (1 - u) * img_at(coarse, left, bottom)[c] + u * img_at(coarse, right, bottom)[c];
        out[c] = (1 - v) * above + v * below;
    }
}

static void push(const img *coarse, const img *valid, img *fine)
{
    for (int y = 0; y < fine->height; y++)
        for (int x = 0; x < fine->width; x++)
            if (*img_at(valid, x, y) < 0.5f) sample(coarse, x, y, img_at(fine, x, y));
}

status fill_outside(img *image, const img *mask)
{
    if (image->width == 1 && image->height == 1) {
        if (mask->data[0] < 0.5f) memset(image->data, 0, (size_t)image->channels * sizeof(float));
        return OK;
    }
    img coarse = {0}, valid = {0};
    int width = (image->width + 1) / 2, height = (image->height + 1) / 2;
    status s = img_new(&coarse, width, height, image->channels);
    if (s == OK) s = img_new(&valid, width, height, 1);
    if (s == OK) {
        pull(image, mask, &coarse, &valid);
        s = fill_outside(&coarse, &valid);
    }
    if (s == OK) push(&coarse, mask, image);
    img_free(&coarse);
    img_free(&valid);
    return s;
}
