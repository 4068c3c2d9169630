/* SPDX-License-Identifier: MIT */
#include <stdlib.h>
#include <string.h>

#include "base/file.h"
#include "base/progress.h"
#include "image/exr/exr.h"
#include "image/resize.h"
#include "lab/eval/metrics.h"
#include "lab/eval/trivial.h"

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

static void write_mean(const double *sum, size_t i, eval_maps *maps)
{
    vec3 n = vec3_normalize(vec3_make((float)sum[NORMAL], (float)sum[NORMAL + 1], (float)sum[NORMAL + 2]));
    maps->normal.data[3 * i] = n.x;
    maps->normal.data[3 * i + 1] = n.y;
    maps->normal.data[3 * i + 2] = n.z;
    for (size_t c = 0; c < 3; c++)
        maps->albedo.data[3 * i + c] = (float)(2 * sum[ALBEDO + c] / sum[WEIGHT] - 1);
    maps->roughness.data[i] = (float)(2 * sum[ROUGHNESS] / sum[WEIGHT] - 1);
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
    status s = eval_maps_new(&out->maps, m->width, m->height);
    if (s != OK) return s;
    for (size_t i = 0; i < pixels; i++) {
        const double *sum = m->sum + i * SUMS;
        write_mean(sum[WEIGHT] > 0 ? sum : all, i, &out->maps);
    }
    out->roughness = (float)(2 * all[ROUGHNESS] / all[WEIGHT] - 1);
    out->depth = (float)(all[DEPTH] / all[WEIGHT]);
    for (int i = 0; i < 27; i++)
        out->sh[i / 3][i % 3] = (float)(m->sh[i / 3][i % 3] / (double)m->samples);
    out->samples = m->samples;
    return OK;
}

static status add_file(mean_sums *m, const char *path)
{
    sample one;
    status s = sample_read_training(path, &one);
    if (s != OK) return s;
    s = add_sample(m, &one, path);
    sample_free(&one);
    return s;
}

status eval_means_of_folder(const char *folder, size_t limit, bool quiet, int (*stopped)(void), eval_means *out)
{
    *out = (eval_means){0};
    char **names;
    size_t count;
    status s = sample_list(folder, &names, &count);
    if (s != OK) return s;
    size_t used = limit && limit < count ? limit : count;
    mean_sums sums = {0};
    progress p;
    progress_begin(&p, "means", "samples", 0, used, quiet);
    for (size_t i = 0; s == OK && i < used; i++) {
        s = stopped && stopped() ? fail(MERLIN_STOPPED, "stopped after the means of %zu of %zu samples", i, used)
                                 : add_file(&sums, names[i]);
        if (s == OK) progress_update(&p, i + 1, NULL);
    }
    progress_end(&p);
    if (s == OK) s = finish_means(&sums, out);
    free(sums.sum);
    file_list_free(names, count);
    return s;
}

void eval_means_free(eval_means *means)
{
    eval_maps_free(&means->maps);
}

enum { CHANNELS = 8 };

/* The maps' channels by their names in files, for reading and writing alike. */
static void name_channels(const eval_maps *maps, exr_target out[CHANNELS])
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
    eval_maps file = means->maps;
    status s = img_copy(&file.albedo, &means->maps.albedo);
    if (s != OK) return s;
    s = img_copy(&file.roughness, &means->maps.roughness);
    if (s == OK) {
        eval_to_file_range(&file.albedo);
        eval_to_file_range(&file.roughness);
        exr_target targets[CHANNELS];
        exr_channel channels[CHANNELS];
        name_channels(&file, targets);
        for (int i = 0; i < CHANNELS; i++)
            channels[i] = (exr_channel){targets[i].name, targets[i].data, targets[i].stride, false};
        exr_attribute attributes[] = {exr_number("roughness_mean", (means->roughness + 1) / 2),
                                      exr_number("depth_mean", means->depth),
                                      exr_number("sample_count", (float)means->samples),
                                      {.name = "sphericalHarmonics", .count = 27}};
        memcpy(attributes[3].values, means->sh, sizeof means->sh);
        s = exr_write(path, file.albedo.width, file.albedo.height, channels, CHANNELS, attributes, 4);
        img_free(&file.roughness);
    }
    img_free(&file.albedo);
    return s;
}

static status read_means_file(const char *path, exr_file *f, eval_means *out)
{
    float roughness, depth, samples;
    if (!exr_get_numbers(f, "roughness_mean", &roughness, 1) || !exr_get_numbers(f, "depth_mean", &depth, 1) ||
        !exr_get_numbers(f, "sample_count", &samples, 1) || !(depth > 0 && samples >= 1 && samples < 1e12f))
        return fail(MERLIN_BAD_INPUT, "%s holds no mean maps; make them with merlin-lab eval --means", path);
    status s = eval_maps_new(&out->maps, exr_width(f), exr_height(f));
    if (s != OK) return s;
    exr_target targets[CHANNELS];
    name_channels(&out->maps, targets);
    s = exr_read(f, targets, CHANNELS);
    if (s != OK) {
        eval_maps_free(&out->maps);
        return s;
    }
    eval_to_network_range(&out->maps.albedo);
    eval_to_network_range(&out->maps.roughness);
    out->roughness = 2 * roughness - 1;
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

static status resize_maps(eval_maps *maps, int width, int height)
{
    status s = resize_in_place(&maps->albedo, width, height);
    if (s == OK) s = resize_in_place(&maps->normal, width, height);
    if (s == OK) s = resize_in_place(&maps->roughness, width, height);
    if (s == OK) s = resize_in_place(&maps->depth, width, height);
    if (s != OK) return s;
    eval_make_unit(&maps->normal);
    return OK;
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
