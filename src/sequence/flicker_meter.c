/* SPDX-License-Identifier: MIT */
#include "sequence/flicker_meter.h"

#include <math.h>
#include <stdlib.h>

#include "image/color.h"
#include "image/image.h"

enum { MOST_SAMPLES = 128 * 1024, PHOTO = 0, ALBEDO, NORMAL, ROUGHNESS, DEPTH, MASK };

status flicker_meter_begin(flicker_meter *m, int width, int height)
{
    if (m->width == width && m->height == height) return OK;
    flicker_meter_free(m);
    int step = 1;
    while ((size_t)(width / step) * (size_t)(height / step) > MOST_SAMPLES)
        step++;
    const size_t count = (size_t)((width - 1) / step + 1) * (size_t)((height - 1) / step + 1);
    *m = (flicker_meter){.width = width, .height = height, .step = step, .count = count};
    m->last = calloc(count, sizeof *m->last);
    m->now = calloc(count, sizeof *m->now);
    return m->last && m->now ? OK : fail(MERLIN_NO_MEMORY, "no memory to compare frames");
}

void flicker_meter_free(flicker_meter *m)
{
    free(m->last);
    free(m->now);
    *m = (flicker_meter){0};
}

/* Returns the number of the frame's pixel at sample i. */
static size_t pixel_of(const flicker_meter *m, size_t i)
{
    const size_t step = (size_t)m->step, columns = ((size_t)m->width - 1) / step + 1;
    return i / columns * step * (size_t)m->width + i % columns * step;
}

void flicker_meter_take_photo(flicker_meter *m, const merlin_image *photo, bool after)
{
    for (size_t i = 0; i < m->count; i++) {
        const float light = color_luminance(photo->data + 3 * pixel_of(m, i));
        m->now[i].photo[after] = srgb_encode(fminf(fmaxf(light, 0), 1));
    }
}

void flicker_meter_take_maps(flicker_meter *m, const merlin_maps *maps, bool after)
{
    for (size_t i = 0; i < m->count; i++) {
        const size_t pixel = pixel_of(m, i);
        flicker_sample *s = &m->now[i];
        s->mask[after] = maps->mask.data[pixel];
        for (size_t c = 0; c < 3; c++) {
            s->maps[after][c] = maps->albedo.data[3 * pixel + c];
            s->maps[after][3 + c] = maps->normal.data[3 * pixel + c];
        }
        s->maps[after][6] = maps->roughness.data[pixel];
        s->maps[after][7] = maps->depth.data[pixel];
    }
}

static double angle(const float *a, const float *b)
{
    const double chord = sqrt(pow((double)a[0] - (double)b[0], 2) + pow((double)a[1] - (double)b[1], 2) +
                              pow((double)a[2] - (double)b[2], 2));
    return 2 * asin(fmin(chord / 2, 1)) * 180 / 3.14159265358979;
}

static double apart(float a, float b)
{
    return fabs((double)a - (double)b);
}

/* Adds a pixel that the object covers in both frames. */
static void add_pixel(const flicker_sample *was, const flicker_sample *is, int k, double sums[6])
{
    const float *a = was->maps[k], *b = is->maps[k];
    sums[PHOTO] += apart(was->photo[k], is->photo[k]);
    sums[ALBEDO] += (apart(a[0], b[0]) + apart(a[1], b[1]) + apart(a[2], b[2])) / 3;
    sums[NORMAL] += angle(a + 3, b + 3);
    sums[ROUGHNESS] += apart(a[6], b[6]);
    sums[DEPTH] += apart(a[7], b[7]);
}

/* Returns the sample of the frame before at what is now sample i, or NULL if it was beyond the edge. */
static const flicker_sample *sample_before(const flicker_meter *m, size_t i, const int shift[2])
{
    const long columns = (m->width - 1) / m->step + 1, rows = (m->height - 1) / m->step + 1;
    const long x = (long)i % columns - shift[0] / m->step, y = (long)i / columns - shift[1] / m->step;
    return x >= 0 && y >= 0 && x < columns && y < rows ? &m->last[y * columns + x] : NULL;
}

void flicker_meter_end(flicker_meter *m, const merlin_image *same, const int shift[2])
{
    double pixels = 0;
    const bool on_grid = shift[0] % m->step == 0 && shift[1] % m->step == 0;
    for (size_t i = 0; i < m->count && same && on_grid && m->has_last; i++) {
        const flicker_sample *was = sample_before(m, i, shift), *is = &m->now[i];
        if (!was || same->data[pixel_of(m, i)] < 0.5f) continue;
        bool covered = true;
        for (int k = 0; k < 2; k++) {
            m->sums[k][MASK] += apart(was->mask[k], is->mask[k]);
            covered &= was->mask[k] >= 0.5f && is->mask[k] >= 0.5f;
        }
        for (int k = 0; k < 2 && covered; k++)
            add_pixel(was, is, k, m->sums[k]);
        pixels += covered;
    }
    m->pixels += pixels;
    m->pairs += pixels > 0;
    flicker_sample *last = m->last;
    m->last = m->now;
    m->now = last;
    m->has_last = true;
}

static merlin_differences means(const double sums[6], double pixels)
{
    return (merlin_differences){.photo = sums[PHOTO] / pixels,
                                .albedo = sums[ALBEDO] / pixels,
                                .normal = sums[NORMAL] / pixels,
                                .roughness = sums[ROUGHNESS] / pixels,
                                .depth = sums[DEPTH] / pixels,
                                .mask = sums[MASK] / pixels};
}

void flicker_meter_read(const flicker_meter *m, merlin_flicker *out)
{
    *out = (merlin_flicker){.pairs = m->pairs};
    if (!(m->pixels > 0)) return;
    out->before = means(m->sums[0], m->pixels);
    out->after = means(m->sums[1], m->pixels);
}
