#include "cli/stereo_maps.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "base/file.h"
#include "estimate/api.h"
#include "estimate/crop.h"
#include "eval/normal_frame.h"
#include "image/exr.h"
#include "model/model.h"

enum { LAYERS = 8, FRAME = 256 };
/* Of depth, as estimates have it; nearer than this a surface would reach the camera. */
static const float nearest = 0.25f;

static char *path_in(const char *folder)
{
    return file_join(folder, "maps.exr");
}

bool stereo_maps_in(const char *folder)
{
    char *path = path_in(folder);
    exr_file *f = NULL;
    bool theirs = path && file_exists(path) && exr_open(path, &f) == OK && exr_get_text(f, "merlinError");
    if (f) exr_close(f);
    free(path);
    return theirs;
}

static status allocate(int width, int height, merlin_maps *maps)
{
    const struct {
        merlin_image *image;
        int channels;
    } all[] = {{&maps->albedo, 3}, {&maps->normal, 3}, {&maps->roughness, 1},
               {&maps->depth, 1},  {&maps->mask, 1},   {&maps->photo, 3}};
    for (size_t i = 0; i < sizeof all / sizeof *all; i++) {
        img m = {0};
        status s = img_new(&m, width, height, all[i].channels);
        if (s != OK) return s;
        *all[i].image = image_of(&m);
    }
    return OK;
}

static status read_layers(exr_file *f, const char *path, merlin_maps *maps, float *focal)
{
    if (!exr_get_numbers(f, "merlinFocal", focal, 1) || !(*focal >= 0))
        return fail(ERROR_INPUT, "%s says nothing of the camera (merlinFocal)", path);
    status s = allocate(exr_width(f), exr_height(f), maps);
    if (s != OK) return s;
    const exr_target layers[LAYERS] = {{"albedo.R", maps->albedo.data, 3},     {"albedo.G", maps->albedo.data + 1, 3},
                                       {"albedo.B", maps->albedo.data + 2, 3}, {"normal.X", maps->normal.data, 3},
                                       {"normal.Y", maps->normal.data + 1, 3}, {"normal.Z", maps->normal.data + 2, 3},
                                       {"depth.Z", maps->depth.data, 1},       {"mask.A", maps->mask.data, 1}};
    return exr_read(f, layers, LAYERS);
}

static bool is_object(const merlin_maps *maps, size_t i)
{
    return maps->mask.data[i] >= 0.5f;
}

/* focal: pixels; 0: seen from afar, with depths in pixels. */
static void place_depth(merlin_maps *maps, float focal, float pitch)
{
    size_t pixels = (size_t)maps->mask.width * (size_t)maps->mask.height, count = 0;
    double sum = 0;
    for (size_t i = 0; i < pixels; i++)
        if (is_object(maps, i)) {
            sum += (double)maps->depth.data[i];
            count++;
        }
    float mean = (float)(sum / (double)count);
    float scale = focal > 0 ? pitch * focal / mean : pitch;
    for (size_t i = 0; i < pixels; i++)
        maps->depth.data[i] = is_object(maps, i) ? fmaxf(1 + scale * (maps->depth.data[i] - mean), nearest) : 1;
}

static void turn_normals(merlin_maps *maps, float focal, float pitch)
{
    pst_camera from = {.perspective = focal > 0,
                       .focal = focal,
                       .center_x = 0.5f * (float)maps->mask.width,
                       .center_y = 0.5f * (float)maps->mask.height};
    pst_camera to = {.perspective = true,
                     .focal = 1 / pitch,
                     .center_x = (float)maps->crop.x + 0.5f * (float)maps->crop.side,
                     .center_y = (float)maps->crop.y + 0.5f * (float)maps->crop.side};
    img normal = img_of(&maps->normal);
    normal_frame_change(&normal, &from, &to);
}

static status place(merlin_maps *maps, float focal)
{
    img mask = img_of(&maps->mask);
    crop_square c;
    status s = crop_around(&mask, &c);
    if (s != OK) return s;
    maps->crop.x = c.x;
    maps->crop.y = c.y;
    maps->crop.side = c.side;
    float pitch = 2 * tanf(0.5f * (float)MODEL_FOV * 0.0174532925f) / (float)c.side; /* a pixel's width at depth 1 */
    place_depth(maps, focal, pitch);
    turn_normals(maps, focal, pitch);
    for (size_t i = 0, pixels = img_value_count(&mask); i < pixels; i++)
        maps->roughness.data[i] = 1;
    surface all = {img_of(&maps->albedo), img_of(&maps->normal), img_of(&maps->roughness), img_of(&maps->depth), mask};
    surface_tidy(&all);
    return OK;
}

status stereo_maps_read(const char *folder, merlin_maps *out)
{
    *out = (merlin_maps){.size = FRAME, .gain = 1, .mask_source = MERLIN_MASK_GIVEN, .mask_confidence = 1};
    snprintf(out->model, sizeof out->model, "merlin stereo");
    char *path = path_in(folder);
    if (!path) return fail(ERROR_MEMORY, "no memory for a file name");
    exr_file *f = NULL;
    float focal;
    status s = exr_open(path, &f);
    if (s == OK) s = read_layers(f, path, out, &focal);
    if (f) exr_close(f);
    if (s == OK && (s = place(out, focal)) != OK) s = fail_in(s, "%s", path);
    free(path);
    if (s != OK) merlin_maps_free(out);
    return s;
}
