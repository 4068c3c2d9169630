/* SPDX-License-Identifier: MIT */
#include "lab/eval/stereo/stereo_object.h"

#include <dirent.h>
#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/file.h"
#include "lab/eval/stereo/stereo_frame.h"
#include "lab/render/sample.h"
#include "photo_stereo/near_capture.h"

enum { MOST_OBJECTS = 1000 };
/* Radiance that a camera records as white: the middle of the training data's sensors (estimate/surface/exposure.h). */
static const float PHOTO_WHITE = 1.568f;

/* ---- which ---- */

static int by_name(const void *a, const void *b)
{
    return strcmp(*(char *const *)a, *(char *const *)b);
}

static status add_folders(const char *folder, DIR *open, char **path, size_t *count)
{
    for (struct dirent *entry; (entry = readdir(open));) {
        if (entry->d_name[0] == '.') continue;
        char *inner = file_join(folder, entry->d_name);
        if (!inner) return fail(MERLIN_NO_MEMORY, "no memory for a file name");
        if (*count < MOST_OBJECTS && file_is_folder(inner) && pst_is_of_data_set(inner))
            path[(*count)++] = inner;
        else
            free(inner);
    }
    qsort(path, *count, sizeof *path, by_name);
    return OK;
}

static status list_folders(const char *folder, char ***path, size_t *count)
{
    *count = 0;
    *path = calloc(MOST_OBJECTS, sizeof **path);
    if (!*path) return fail(MERLIN_NO_MEMORY, "no memory for a list of objects");
    DIR *open = opendir(folder);
    status s =
        open ? add_folders(folder, open, *path, count) : fail(MERLIN_BAD_INPUT, "cannot open the folder %s", folder);
    if (open) closedir(open);
    if (s == OK && *count == 0)
        s = fail(MERLIN_BAD_INPUT,
                 "%s holds no samples of merlin-lab render, and no folders in the LUCES or DiLiGenT layout", folder);
    if (s != OK) file_list_free(*path, *count);
    return s;
}

static status list_itself(const char *folder, char ***path, size_t *count)
{
    *path = malloc(sizeof **path);
    if (*path) **path = strdup(folder);
    *count = 1;
    if (*path && **path) return OK;
    free(*path);
    return fail(MERLIN_NO_MEMORY, "no memory for a file name");
}

status stereo_object_list(const char *folder, char ***path, size_t *count)
{
    static const char *const samples[] = {".exr", NULL};
    if (pst_is_of_data_set(folder)) return list_itself(folder, path, count);
    status s = file_list(folder, samples, path, count);
    if (s != OK || *count > 0) return s;
    file_list_free(*path, *count);
    return list_folders(folder, path, count);
}

/* ---- a rendered sample ---- */

static void sum_into(const img *a, const img *b, float white, img *out)
{
    for (size_t i = 0, n = 3 * (size_t)out->width * (size_t)out->height; i < n; i++)
        out->data[i] = fminf((a->data[i] + b->data[i]) / white, 1);
}

static status take_targets(const sample *from, merlin_capture *c)
{
    img picture = {0};
    status s = near_capture_new(&from->mask, &from->depth, from->fov, c);
    if (s == OK) s = img_new(&picture, from->mask.width, from->mask.height, 3);
    for (int i = 0; i < from->target_count && s == OK; i++) {
        sum_into(&from->targets[i].direct, &from->targets[i].indirect, NEAR_CAPTURE_WHITE, &picture);
        merlin_light light = {.lobe = from->targets[i].lobe};
        vec3_put(from->targets[i].light, light.position);
        vec3_put(from->targets[i].axis, light.direction);
        s = near_capture_add(c, &picture, &light);
    }
    img_free(&picture);
    if (s == OK) s = img_copy(&c->normal_true, &from->normal);
    return s;
}

static status read_sample(const char *path, stereo_object *out)
{
    sample from;
    status s = sample_read(path, &from);
    if (s != OK) return s;
    if (from.target_count < 3)
        s = fail(MERLIN_BAD_INPUT, "%s has %d pictures under other lights; render it with --targets 52 or --leds 52",
                 path, from.target_count);
    if (s == OK) s = take_targets(&from, &out->capture);
    if (s == OK) s = img_new(&out->photo, from.mask.width, from.mask.height, 3);
    if (s == OK) sum_into(&from.direct, &from.indirect, PHOTO_WHITE, &out->photo);
    snprintf(out->name, sizeof out->name, "%" PRIu64 " %.10s", from.index, from.shape);
    sample_free(&from);
    return s;
}

/* ---- a capture on disk ---- */

/* Returns the distance of a light from a flash beside the lens. */
static float distance_from_flash(const merlin_capture *c, int i)
{
    return c->lighting == MERLIN_NEAR_LIGHTS ? vec3_length(vec3_of(c->light[i].position)) : -c->light[i].direction[2];
}

int stereo_object_frontal(const merlin_capture *c)
{
    int best = 0;
    for (int i = 1; i < c->count; i++)
        if (distance_from_flash(c, i) < distance_from_flash(c, best)) best = i;
    return best;
}

status stereo_object_photo(const merlin_capture *c, int picture, img *photo)
{
    status s = img_new(photo, c->width, c->height, 3);
    if (s != OK) return s;
    float gain[3], most = 0;
    for (int k = 0; k < 3; k++) {
        float intensity = c->light[picture].intensity[c->channels == 3 ? k : 0];
        gain[k] = c->intensities_known && intensity > 0 ? intensity : 1;
        most = fmaxf(most, gain[k]);
    }
    size_t channels = (size_t)c->channels;
    for (size_t i = 0, n = 3 * (size_t)c->width * (size_t)c->height; i < n; i++) {
        size_t from = channels == 3 ? i : i / 3;
        photo->data[i] = fminf((float)pst_code(&c->picture[picture], from) / 65535 * most / gain[i % 3], 1);
    }
    return OK;
}

static status read_capture(const char *path, stereo_object *out)
{
    const char *slash = strrchr(path, '/');
    snprintf(out->name, sizeof out->name, "%.31s", slash && slash[1] ? slash + 1 : path);
    status s = pst_capture_read(path, NULL, &out->capture);
    if (s != OK) return s;
    if (!out->capture.normal_true.data) return fail(MERLIN_BAD_INPUT, "%s has no true normals to compare with", path);
    return stereo_object_photo(&out->capture, stereo_object_frontal(&out->capture), &out->photo);
}

status stereo_object_read(const char *path, stereo_object *out)
{
    *out = (stereo_object){0};
    status s = file_is_folder(path) ? read_capture(path, out) : read_sample(path, out);
    if (s == OK) {
        s = stereo_frame(&out->capture, &out->photo, STEREO_OBJECT_SIDE);
        if (s != OK) s = fail_in(s, "%s", path);
    }
    if (s != OK) stereo_object_free(out);
    return s;
}

void stereo_object_free(stereo_object *o)
{
    img_free(&o->photo);
    img_free(&o->albedo);
    pst_capture_free(&o->capture);
}
