/* SPDX-License-Identifier: MIT */
#include "estimate/surface/smooth.h"

#include "estimate/surface/fill.h"

/* Filters `count` values that are `step` floats apart, repeating the edges; line: room for count. */
static void smooth_line(float *data, int count, size_t step, float *line)
{
    for (int i = 0; i < count; i++)
        line[i] = data[(size_t)i * step];
    for (int i = 0; i < count; i++) {
        float before = line[i > 0 ? i - 1 : 0], after = line[i + 1 < count ? i + 1 : count - 1];
        data[(size_t)i * step] = 0.25f * before + 0.5f * line[i] + 0.25f * after;
    }
}

status smooth_inside(img *image, const img *mask)
{
    img line = {0};
    int longest = image->width > image->height ? image->width : image->height;
    status s = fill_outside(image, mask);
    if (s == OK) s = img_new(&line, longest, 1, 1);
    if (s != OK) return s;
    size_t channels = (size_t)image->channels, row = channels * (size_t)image->width;
    for (int y = 0; y < image->height; y++)
        for (size_t c = 0; c < channels; c++)
            smooth_line(img_at(image, 0, y) + c, image->width, channels, line.data);
    for (size_t i = 0; i < row; i++)
        smooth_line(image->data + i, image->height, row, line.data);
    img_free(&line);
    return OK;
}

status smooth_estimate(surface *s)
{
    status result = smooth_inside(&s->normal, &s->mask);
    if (result == OK) result = smooth_inside(&s->roughness, &s->mask);
    return result == OK ? smooth_inside(&s->depth, &s->mask) : result;
}
