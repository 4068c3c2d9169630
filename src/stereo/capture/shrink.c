/* SPDX-License-Identifier: MIT */
#include "stereo/capture/shrink.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/number.h"
#include "base/parallel.h"

typedef struct shrink_job {
    const merlin_capture *from;
    merlin_capture *to;
    pst_blocks blocks;
    uint16_t high;
} shrink_job;

typedef struct map_job {
    const img *map, *mask;
    pst_blocks blocks;
    img *to;
} map_job;

/* The part of a block that lies inside the picture. */
typedef struct block {
    int left, right, top, bottom;
} block;

static block block_of(const pst_blocks *b, const img *mask, int x, int y)
{
    int left = b->x + x * b->factor, top = b->y + y * b->factor, width = mask->width, height = mask->height;
    return (block){clamp_int(left, 0, width), clamp_int(left + b->factor, 0, width), clamp_int(top, 0, height),
                   clamp_int(top + b->factor, 0, height)};
}

static void mean_of(const shrink_job *job, const pst_plane *picture, block b, uint16_t *out)
{
    const merlin_capture *c = job->from;
    uint64_t sum[3] = {0}, count = 0;
    bool saturated[3] = {false};
    for (int y = b.top; y < b.bottom; y++)
        for (int x = b.left; x < b.right; x++) {
            size_t at = (size_t)y * (size_t)c->width + (size_t)x;
            if (c->mask.data[at] <= 0.5f) continue;
            count++;
            for (int ch = 0; ch < c->channels; ch++) {
                uint16_t code = pst_code(picture, at * (size_t)c->channels + (size_t)ch);
                sum[ch] += code;
                saturated[ch] |= code >= job->high;
            }
        }
    for (int ch = 0; ch < c->channels; ch++)
        out[ch] = saturated[ch] ? UINT16_MAX : (uint16_t)(count ? (sum[ch] + count / 2) / count : 0);
}

static void shrink_picture(void *context, size_t k)
{
    const shrink_job *job = context;
    merlin_capture *to = job->to;
    for (int y = 0; y < to->height; y++)
        for (int x = 0; x < to->width; x++) {
            size_t at = (size_t)y * (size_t)to->width + (size_t)x;
            if (to->mask.data[at] <= 0.5f) continue;
            mean_of(job, &job->from->picture[k], block_of(&job->blocks, &job->from->mask, x, y),
                    to->picture[k].wide + at * (size_t)to->channels);
        }
}

static int pixels_on_object(const shrink_job *job, block b)
{
    int count = 0;
    for (int y = b.top; y < b.bottom; y++)
        for (int x = b.left; x < b.right; x++)
            count += *img_at(&job->from->mask, x, y) > 0.5f;
    return count;
}

static void shrink_mask(const shrink_job *job)
{
    int needed = job->blocks.whole ? job->blocks.factor * job->blocks.factor : 1;
    img *to = &job->to->mask;
    for (int y = 0; y < to->height; y++)
        for (int x = 0; x < to->width; x++)
            *img_at(to, x, y) = pixels_on_object(job, block_of(&job->blocks, &job->from->mask, x, y)) >= needed;
}

static status allocate(const merlin_capture *c, const pst_blocks *b, merlin_capture *out)
{
    size_t count = (size_t)c->count, samples = (size_t)b->columns * (size_t)b->rows * (size_t)c->channels;
    *out = (merlin_capture){.width = b->columns,
                            .height = b->rows,
                            .channels = c->channels,
                            .lighting = c->lighting,
                            .intensities_known = c->intensities_known,
                            .camera = c->camera};
    out->camera.focal /= (float)b->factor;
    out->camera.x = (c->camera.x - (float)b->x) / (float)b->factor;
    out->camera.y = (c->camera.y - (float)b->y) / (float)b->factor;
    out->light = malloc(count * sizeof *out->light);
    out->picture = calloc(count, sizeof *out->picture);
    if (!out->light || !out->picture) return fail(MERLIN_NO_MEMORY, "no memory for %zu small pictures", count);
    memcpy(out->light, c->light, count * sizeof *out->light);
    for (; (size_t)out->count < count; out->count++) {
        out->picture[out->count].wide = calloc(samples, sizeof(uint16_t));
        if (!out->picture[out->count].wide) return fail(MERLIN_NO_MEMORY, "no memory for %zu small pictures", count);
    }
    return img_new(&out->mask, out->width, out->height, 1);
}

pst_blocks pst_blocks_of(const merlin_capture *c, int factor)
{
    return (pst_blocks){
        .columns = (c->width + factor - 1) / factor, .rows = (c->height + factor - 1) / factor, .factor = factor};
}

status pst_shrink(const merlin_capture *c, pst_blocks blocks, float saturation, merlin_capture *out)
{
    status s = allocate(c, &blocks, out);
    if (s != OK) {
        pst_capture_free(out);
        return s;
    }
    float high = saturation * 65535;
    shrink_job job = {c, out, blocks, (uint16_t)(high < 65535 ? high : 65535)};
    shrink_mask(&job);
    parallel_for((size_t)c->count, shrink_picture, &job);
    return OK;
}

static void shrink_map_row(void *context, size_t y)
{
    const map_job *job = context;
    const int channels = job->map->channels;
    for (int x = 0; x < job->to->width; x++) {
        const block b = block_of(&job->blocks, job->mask, x, (int)y);
        float *to = img_at(job->to, x, (int)y), count = 0;
        for (int j = b.top; j < b.bottom; j++)
            for (int i = b.left; i < b.right; i++) {
                if (!(*img_at(job->mask, i, j) > 0.5f)) continue;
                for (int ch = 0; ch < channels; ch++)
                    to[ch] += img_at(job->map, i, j)[ch];
                count++;
            }
        for (int ch = 0; ch < channels && count > 0; ch++)
            to[ch] /= count;
    }
}

status pst_shrink_map(const img *map, const img *mask, pst_blocks blocks, img *out)
{
    map_job job = {map, mask, blocks, out};
    status s = img_new(out, blocks.columns, blocks.rows, map->channels);
    if (s == OK) parallel_for((size_t)blocks.rows, shrink_map_row, &job);
    return s;
}

/* Selects these pictures and their lights in the caller's arrays of `some`, and shrinks them. */
static status shrink_some(const merlin_capture *c, int pixels, const int picture[], merlin_capture *some,
                          merlin_capture *out)
{
    size_t inside = 0;
    for (size_t i = 0, n = (size_t)c->width * (size_t)c->height; i < n; i++)
        inside += c->mask.data[i] > 0.5f;
    for (int k = 0; k < some->count; k++) {
        some->picture[k] = c->picture[picture[k]];
        some->light[k] = c->light[picture[k]];
    }
    int factor = (int)sqrt((double)inside / pixels);
    return pst_shrink(some, pst_blocks_of(c, factor > 1 ? factor : 1), PST_SATURATED, out);
}

status pst_shrink_to(const merlin_capture *c, int pixels, int most_pictures, int picture[], merlin_capture *out)
{
    merlin_capture some = *c;
    some.count = c->count < most_pictures ? c->count : most_pictures;
    some.picture = malloc((size_t)some.count * sizeof *some.picture);
    some.light = malloc((size_t)some.count * sizeof *some.light);
    for (int k = 0; k < some.count; k++)
        picture[k] = (int)((long)k * c->count / some.count);
    status s = some.picture && some.light ? shrink_some(c, pixels, picture, &some, out)
                                          : fail(MERLIN_NO_MEMORY, "no memory for %d pictures", some.count);
    free(some.picture);
    free(some.light);
    return s;
}

/* Interpolates bilinearly between the small pixels' centres, as far as these are on the object. */
static float between(const img *small, const img *small_mask, float x, float y)
{
    int left = (int)(x + 1) - 1, top = (int)(y + 1) - 1; /* rounded down: at least -1 */
    float sum = 0, weights = 0;
    for (int k = 0; k < 4; k++) {
        int i = left + k % 2, j = top + k / 2;
        if (i < 0 || j < 0 || i >= small->width || j >= small->height) continue;
        size_t at = (size_t)j * (size_t)small->width + (size_t)i;
        float along = k % 2 ? x - (float)left : 1 - x + (float)left, down = k / 2 ? y - (float)top : 1 - y + (float)top;
        float w = small_mask->data[at] > 0.5f ? along * down : 0;
        sum += w * small->data[at];
        weights += w;
    }
    return weights > 0 ? sum / weights : 0;
}

void pst_enlarge(const img *small, const img *small_mask, const img *mask, int factor, img *out)
{
    float scale = 1 / (float)factor;
    for (int y = 0; y < mask->height; y++)
        for (int x = 0; x < mask->width; x++) {
            size_t at = (size_t)y * (size_t)mask->width + (size_t)x;
            if (mask->data[at] <= 0.5f) continue;
            out->data[at] =
                between(small, small_mask, ((float)x + 0.5f) * scale - 0.5f, ((float)y + 0.5f) * scale - 0.5f);
        }
}
