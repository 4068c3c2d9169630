/* SPDX-License-Identifier: MIT */
/* Converts the maps of a captured surface to those of a photograph: the crop around it is a frame 60 degrees wide, its
 * mean depth is 1, and its relief keeps its proportion to its width. Its gloss was not measured: it is rough. There is
 * no photograph: `photo` is black. */

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "base/number.h"
#include "estimate/files/maps_files.h"
#include "estimate/surface/crop.h"
#include "image/exr/exr.h"
#include "image/image.h"
#include "model/model.h"
#include "optics/camera.h"
#include "optics/light.h"

enum { FRAME = 256 };
/* Radiance of a white matte surface that faces a lamp at distance 1. */
static const float WHITE = LIGHT_POWER / PI;
/* Range of depth, as for estimates; nearer than this a surface would reach the camera. */
static const float nearest = 0.25f, farthest = 20;

/* Reads the focal length; no lens is so wide that it is less than a hundredth of the picture. */
static status read_focal(const exr_file *f, const char *path, float *focal)
{
    const int side = exr_width(f) > exr_height(f) ? exr_width(f) : exr_height(f);
    if (!exr_get_numbers(f, "merlinFocal", focal, 1))
        return fail(MERLIN_BAD_INPUT, "%s says nothing of the camera (merlinFocal)", path);
    if (*focal == 0 || *focal > 0.01f * (float)side) return OK;
    return fail(MERLIN_BAD_INPUT, "%s: no camera has a focal length of %g pixels (merlinFocal; 0: seen from afar)",
                path, (double)*focal);
}

static bool is_object(const merlin_maps *maps, size_t i)
{
    return maps->mask.data[i] >= 0.5f;
}

/* Range of the albedo's bright parts (a quantile), from a dark grey to white: its unit is that of the lights'
 * strengths, which may be any, so that it is scaled to this range if it is outside. */
static const float BRIGHT_PART = 0.999f, LEAST_BRIGHT = 0.2f, MOST_BRIGHT = 1;

static status normalize_albedo(merlin_maps *maps)
{
    size_t pixels = (size_t)maps->mask.width * (size_t)maps->mask.height, count = 0;
    float *brightest = malloc(pixels * sizeof *brightest), *albedo = maps->albedo.data;
    if (!brightest) return fail(MERLIN_NO_MEMORY, "no memory to look at the albedo");
    for (size_t i = 0; i < pixels; i++) {
        float most = fmaxf(fmaxf(albedo[3 * i], albedo[3 * i + 1]), albedo[3 * i + 2]);
        if (is_object(maps, i) && most > 0) brightest[count++] = most;
    }
    qsort(brightest, count, sizeof *brightest, number_ascending);
    float bright = count ? brightest[(size_t)(BRIGHT_PART * (float)(count - 1))] : MOST_BRIGHT;
    free(brightest);
    float scale = clamp(bright, LEAST_BRIGHT, MOST_BRIGHT) / bright;
    for (size_t i = 0; i < 3 * pixels && scale != 1; i++)
        albedo[i] *= scale;
    return OK;
}

/* Share of pixels with clamped depth from which on there is a warning: a badly solved surface may be deeper than the
 * camera is distant; some spikes are usual. */
static const double DEPTH_WORTH_A_WORD = 0.01;

static void doubt_depth(size_t clamped, size_t count, merlin_maps *maps)
{
    maps->mended.depth = (float)((double)clamped / (double)count);
    if ((double)maps->mended.depth > DEPTH_WORTH_A_WORD) maps->doubts |= MERLIN_DOUBT_DEPTH_CLAMPED;
}

/* Converts depth; focal: pixels; 0: orthographic, with depths in pixels. */
static status place_depth(merlin_maps *maps, float focal, float pitch)
{
    size_t pixels = (size_t)maps->mask.width * (size_t)maps->mask.height, count = 0, clamped = 0;
    double sum = 0;
    for (size_t i = 0; i < pixels; i++)
        if (is_object(maps, i)) {
            sum += (double)maps->depth.data[i];
            count++;
        }
    float mean = (float)(sum / (double)count);
    if (focal > 0 && !(mean > 0))
        return fail(MERLIN_BAD_INPUT,
                    "depth.Z should be positive: the camera of merlinFocal sees nothing behind itself");
    float scale = focal > 0 ? pitch * focal / mean : pitch;
    for (size_t i = 0; i < pixels; i++) {
        float placed = is_object(maps, i) ? 1 + scale * (maps->depth.data[i] - mean) : 1;
        clamped += placed < nearest || placed > farthest;
        maps->depth.data[i] = fminf(fmaxf(placed, nearest), farthest);
    }
    doubt_depth(clamped, count, maps);
    return OK;
}

/* Moves the surface into the camera of estimates, with its 60 degrees. Its shape is unchanged, and so are its normals,
 * so that lights have the stated directions. */
status maps_place_captured(merlin_maps *maps, float focal)
{
    img mask = maps->mask;
    crop_square c;
    status s = crop_around(&mask, &c);
    if (s != OK) return s;
    maps->crop.x = c.x;
    maps->crop.y = c.y;
    maps->crop.side = c.side;
    float pitch = camera_pixel_size(&(camera){.width = c.side, .height = c.side, .fov = CAMERA_FOV});
    s = place_depth(maps, focal, pitch);
    if (s == OK) s = normalize_albedo(maps);
    if (s != OK) return s;
    for (size_t i = 0, pixels = img_value_count(&mask); i < pixels; i++)
        maps->roughness.data[i] = 1;
    maps_tidy(maps);
    return OK;
}

void maps_begin_captured(merlin_maps *out)
{
    *out = (merlin_maps){
        .size = FRAME, .gain = WHITE, .mask_source = MERLIN_MASK_GIVEN, .mask_confidence = 1, .captured = 1};
    snprintf(out->model, sizeof out->model, "merlin stereo");
}

status maps_read_captured(exr_file *f, const char *path, merlin_maps *out)
{
    float focal = 0;
    maps_begin_captured(out);
    status s = read_focal(f, path, &focal);
    if (s == OK) s = maps_read_layers(f, path, false, out);
    return s == OK && (s = maps_place_captured(out, focal)) != OK ? fail_in(s, "%s", path) : s;
}
