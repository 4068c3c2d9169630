/* SPDX-License-Identifier: MIT */
#include <stdlib.h>
#include <string.h>

#include "image/exr/exr.h"
#include "image/resize.h"
#include "lab/eval/metrics/metrics.h"
#include "lab/eval/samples/each_sample.h"
#include "lab/eval/samples/trivial.h"

enum { ALBEDO, NORMAL = 3, ROUGHNESS = 6, DEPTH, WEIGHT, SUMS };

/* Per pixel, sums in double: 20,000 samples would cost a float its last digits. */
typedef struct mean_sums {
    int width, height;
    size_t samples;
    double *sum; /* height × width × SUMS */
    double sh[9][3];
} mean_sums;

static status add_sample(mean_sums *m, const sample *s, const char *path)
{
    if (!m->sum) {
        m->width = s->mask.width;
        m->height = s->mask.height;
        m->sum = calloc((size_t)m->width * (size_t)m->height * SUMS, sizeof *m->sum);
        if (!m->sum) return fail(MERLIN_NO_MEMORY, "no memory for mean maps of %dx%d", m->width, m->height);
    }
    if (s->mask.width != m->width || s->mask.height != m->height)
        return fail(MERLIN_BAD_INPUT, "%s is %dx%d but the samples before it are %dx%d", path, s->mask.width,
                    s->mask.height, m->width, m->height);
    for (size_t i = 0, n = (size_t)m->width * (size_t)m->height; i < n; i++) {
        if (!(s->mask.data[i] > EVAL_MASK_LEVEL)) continue;
        double *sum = m->sum + i * SUMS;
        for (size_t c = 0; c < 3; c++) {
            sum[ALBEDO + c] += s->albedo.data[3 * i + c];
            sum[NORMAL + c] += s->normal.data[3 * i + c];
        }
        sum[ROUGHNESS] += s->roughness.data[i];
        sum[DEPTH] += s->depth.data[i];
        sum[WEIGHT] += 1;
    }
    for (int i = 0; i < 27; i++)
        m->sh[i / 3][i % 3] += s->sh[i / 3][i % 3];
    m->samples++;
    return OK;
}

static void write_mean(const double *sum, size_t i, surface *maps)
{
    vec3 n = vec3_normalize(vec3_make((float)sum[NORMAL], (float)sum[NORMAL + 1], (float)sum[NORMAL + 2]));
    maps->normal.data[3 * i] = n.x;
    maps->normal.data[3 * i + 1] = n.y;
    maps->normal.data[3 * i + 2] = n.z;
    for (size_t c = 0; c < 3; c++)
        maps->albedo.data[3 * i + c] = (float)(sum[ALBEDO + c] / sum[WEIGHT]);
    maps->roughness.data[i] = (float)(sum[ROUGHNESS] / sum[WEIGHT]);
    maps->depth.data[i] = (float)(sum[DEPTH] / sum[WEIGHT]);
}

static status finish_means(const mean_sums *m, eval_means *out)
{
    size_t pixels = (size_t)m->width * (size_t)m->height;
    double all[SUMS] = {0};
    for (size_t i = 0; i < pixels; i++)
        for (int c = 0; c < SUMS; c++)
            all[c] += m->sum[i * SUMS + (size_t)c];
    if (!(all[WEIGHT] > 0)) return fail(MERLIN_BAD_INPUT, "the samples' masks are empty: no mean to take");
    status s = surface_new(m->width, m->height, &out->maps);
    if (s != OK) return s;
    for (size_t i = 0; i < pixels; i++) {
        const double *sum = m->sum + i * SUMS;
        write_mean(sum[WEIGHT] > 0 ? sum : all, i, &out->maps);
    }
    out->roughness = (float)(all[ROUGHNESS] / all[WEIGHT]);
    out->depth = (float)(all[DEPTH] / all[WEIGHT]);
    for (int i = 0; i < 27; i++)
        out->sh[i / 3][i % 3] = (float)(m->sh[i / 3][i % 3] / (double)m->samples);
    out->samples = m->samples;
    return OK;
}

static status add_file(void *sums, const char *path)
{
    sample one;
    status s = sample_read_training(path, &one);
    if (s != OK) return s;
    s = add_sample(sums, &one, path);
    sample_free(&one);
    return s;
}

status eval_means_of_folder(const char *folder, size_t limit, bool quiet, int (*stopped)(void), eval_means *out)
{
    const eval_samples all = {folder, "means", limit, quiet, stopped};
    mean_sums sums = {0};
    *out = (eval_means){0};
    status s = eval_each_sample(&all, add_file, &sums);
    if (s == OK) s = finish_means(&sums, out);
    free(sums.sum);
    return s;
}

void eval_means_free(eval_means *means)
{
    surface_free(&means->maps);
}

enum { CHANNELS = 8 };

/* The maps' channels by their names in files, for reading and writing alike. */
static void name_channels(const surface *maps, exr_target out[CHANNELS])
{
    const exr_target channels[CHANNELS] = {
        {"albedo.R", maps->albedo.data, 3},       {"albedo.G", maps->albedo.data + 1, 3},
        {"albedo.B", maps->albedo.data + 2, 3},   {"normal.X", maps->normal.data, 3},
        {"normal.Y", maps->normal.data + 1, 3},   {"normal.Z", maps->normal.data + 2, 3},
        {"roughness.Y", maps->roughness.data, 1}, {"depth.Z", maps->depth.data, 1},
    };
    memcpy(out, channels, sizeof channels);
}

status eval_means_write(const eval_means *means, const char *path)
{
    exr_target targets[CHANNELS];
    exr_channel channels[CHANNELS];
    name_channels(&means->maps, targets);
    for (int i = 0; i < CHANNELS; i++)
        channels[i] = (exr_channel){targets[i].name, targets[i].data, targets[i].stride, false};
    exr_attribute attributes[] = {exr_number("roughness_mean", means->roughness),
                                  exr_number("depth_mean", means->depth),
                                  exr_number("sample_count", (float)means->samples),
                                  {.name = "sphericalHarmonics", .count = 27}};
    memcpy(attributes[3].values, means->sh, sizeof means->sh);
    return exr_write(path, means->maps.albedo.width, means->maps.albedo.height, channels, CHANNELS, attributes, 4);
}

static status read_means_file(const char *path, exr_file *f, eval_means *out)
{
    float roughness, depth, samples;
    if (!exr_get_numbers(f, "roughness_mean", &roughness, 1) || !exr_get_numbers(f, "depth_mean", &depth, 1) ||
        !exr_get_numbers(f, "sample_count", &samples, 1) || !(depth > 0 && samples >= 1 && samples < 1e12f))
        return fail(MERLIN_BAD_INPUT, "%s holds no mean maps; make them with merlin-lab eval --means", path);
    status s = surface_new(exr_width(f), exr_height(f), &out->maps);
    if (s != OK) return s;
    exr_target targets[CHANNELS];
    name_channels(&out->maps, targets);
    s = exr_read(f, targets, CHANNELS);
    if (s != OK) {
        surface_free(&out->maps);
        return s;
    }
    out->roughness = roughness;
    out->depth = depth;
    out->samples = (size_t)samples;
    exr_get_numbers(f, "sphericalHarmonics", &out->sh[0][0], 27); /* means of samples without environment have none */
    return OK;
}

static status resize_in_place(img *image, int width, int height)
{
    img resized;
    status s = img_resize(image, width, height, &resized);
    if (s != OK) return s;
    img_free(image);
    *image = resized;
    return OK;
}

static status resize_maps(surface *maps, int width, int height)
{
    status s = resize_in_place(&maps->albedo, width, height);
    if (s == OK) s = resize_in_place(&maps->normal, width, height);
    if (s == OK) s = resize_in_place(&maps->roughness, width, height);
    if (s == OK) s = resize_in_place(&maps->depth, width, height);
    img *normal = &maps->normal;
    for (size_t i = 0; s == OK && i < img_value_count(normal); i += 3)
        vec3_put(vec3_normalize(vec3_of(normal->data + i)), normal->data + i);
    return s;
}

status eval_means_read(const char *path, int width, int height, eval_means *out)
{
    *out = (eval_means){0};
    exr_file *f;
    status s = exr_open(path, &f);
    if (s != OK) return s;
    s = read_means_file(path, f, out);
    exr_close(f);
    if (s != OK) return s;
    if (out->maps.albedo.width != width || out->maps.albedo.height != height)
        s = resize_maps(&out->maps, width, height);
    if (s != OK) eval_means_free(out);
    return s;
}
