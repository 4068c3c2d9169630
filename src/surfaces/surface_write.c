/* SPDX-License-Identifier: MIT */
/* merlin_surface_write: a folder with all files of a captured surface, or none. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/api_needs.h"
#include "base/file.h"
#include "base/folder_batch.h"
#include "base/text/map_names.h"
#include "estimate/files/map_png.h"
#include "estimate/files/maps_files.h"
#include "estimate/surface/crop.h"
#include "image/write/figure.h"
#include "image/write/write.h"
#include "stereo/integrate/stereo_surface.h"
#include "surfaces/error_map.h"
#include "surfaces/side_view.h"
#include "surfaces/surface_albedo.h"

enum { TILES = 6, COLUMNS = 3, TILE_SIZE = 384 };

typedef struct job {
    const merlin_surface *surface;
    img albedo; /* scaled, 3 channels */
    const char *input;
} job;

/* ---- one file each ---- */

static status write_exr(const void *context, const char *path)
{
    const job *j = context;
    const exr_channel channels[] = {
        {"albedo.R", j->albedo.data, 3, false},
        {"albedo.G", j->albedo.data + 1, 3, false},
        {"albedo.B", j->albedo.data + 2, 3, false},
        {"normal.X", j->surface->normal.data, 3, false},
        {"normal.Y", j->surface->normal.data + 1, 3, false},
        {"normal.Z", j->surface->normal.data + 2, 3, false},
        {"depth.Z", j->surface->depth.data, 1, true},
        {"mask.A", j->surface->mask.data, 1, false},
        {"error.Y", j->surface->residual.data, 1, false},
        {"spread.Y", j->surface->spread.data, 1, false},
    };
    const size_t count = sizeof channels / sizeof channels[0] - (j->surface->spread.data ? 0 : 1);
    const exr_attribute attributes[] = {exr_text("merlinError", error_map_name(j->surface)),
                                        exr_number("merlinFocal", j->surface->camera.focal),
                                        maps_picture_size(j->surface->mask.width, j->surface->mask.height)};
    return exr_write(path, j->surface->mask.width, j->surface->mask.height, channels, count, attributes,
                     sizeof attributes / sizeof attributes[0]);
}

static status write_normal(const void *context, const char *path)
{
    const job *j = context;
    return map_write_normals(path, &j->surface->normal, &j->surface->mask);
}

static status write_albedo(const void *context, const char *path)
{
    const job *j = context;
    return img_write_png(path, &j->albedo, IMG_SRGB8);
}

static status write_mask(const void *context, const char *path)
{
    const job *j = context;
    return img_write_png(path, &j->surface->mask, IMG_LINEAR8);
}

static status write_depth(const void *context, const char *path)
{
    const job *j = context;
    return map_write_depths(path, &j->surface->depth, &j->surface->mask);
}

static status error_picture(const job *j, img *out)
{
    status s = img_copy(out, &j->surface->residual);
    for (size_t i = 0; i < img_value_count(out) && s == OK; i++)
        out->data[i] /= error_map_white(j->surface);
    return s;
}

static status write_error(const void *context, const char *path)
{
    const job *j = context;
    img shown = {0};
    status s = error_picture(j, &shown);
    if (s == OK) s = img_write_png(path, &shown, IMG_LINEAR8);
    img_free(&shown);
    return s;
}

/* Crops a tile to the object; large photographs often show little of it. */
static status crop_tile(crop_square c, img *tile)
{
    img part = {0};
    status s = crop_take(tile, c, NULL, &part);
    if (s != OK) return s;
    img_free(tile);
    *tile = part;
    return OK;
}

static status write_overview(const void *context, const char *path)
{
    const job *j = context;
    img tile[TILES] = {0};
    crop_square c;
    status s = crop_around(&j->surface->mask, &c);
    if (s != OK)
        c = (crop_square){
            0, 0, j->surface->mask.width > j->surface->mask.height ? j->surface->mask.width : j->surface->mask.height};
    s = figure_normals(&j->surface->normal, &j->surface->mask, &tile[0]);
    if (s == OK) s = crop_tile(c, &tile[0]);
    if (s == OK) s = crop_take(&j->albedo, c, NULL, &tile[1]);
    if (s == OK) s = figure_depth(&j->surface->depth, &j->surface->mask, &tile[2]);
    if (s == OK) s = crop_tile(c, &tile[2]);
    if (s == OK) s = crop_take(&j->surface->mask, c, NULL, &tile[3]);
    if (s == OK) s = error_picture(j, &tile[4]);
    if (s == OK) s = crop_tile(c, &tile[4]);
    if (s == OK) s = surface_side_view(j->surface, TILE_SIZE, &tile[5]);
    const figure_tile tiles[TILES] = {{"normal", &tile[0]},
                                      {"albedo", &tile[1]},
                                      {"depth", &tile[2]},
                                      {"mask", &tile[3]},
                                      {error_map_name(j->surface), &tile[4]},
                                      {"from 45 degrees", &tile[5]}};
    if (s == OK) s = figure_sheet(path, tiles, TILES, COLUMNS, TILE_SIZE);
    for (int k = 0; k < TILES; k++)
        img_free(&tile[k]);
    return s;
}

static status write_confidence(const void *context, const char *path)
{
    const job *j = context;
    return map_write_confidence(path, &j->surface->spread, &j->surface->mask);
}

static status write_report(const void *context, const char *path)
{
    const job *j = context;
    char *text;
    status s = merlin_surface_report(j->surface, j->input, &text);
    if (s == OK) s = file_write(path, text, strlen(text));
    free(text);
    return s;
}

/* ---- all of them ---- */

/* Output files, the slowest first, so that two processors finish together. */
static const folder_file outputs[] = {
    {"maps.exr", write_exr},
    {"overview.png", write_overview},
    {"normal.png", write_normal},
    {"albedo.png", write_albedo},
    {"depth.png", write_depth},
    {"error.png", write_error},
    {"mask.png", write_mask},
    {"report.json", write_report},
    {"confidence.png", write_confidence}, /* the last one */
};
enum { OUTPUTS = sizeof outputs / sizeof outputs[0] };

merlin_status merlin_surface_write(const merlin_surface *surface, const char *input, const merlin_write_params *params,
                                   const char *folder)
{
    static const merlin_write_params usual = {0};
    const merlin_write_params *by = params ? params : &usual;
    status s = api_needs(__func__, surface && folder);
    if (s == OK) s = pst_surface_check(surface);
    if (s != OK) return s;
    job j = {.surface = surface, .input = input};
    const size_t count = surface->spread.data ? OUTPUTS : OUTPUTS - 1;
    const folder_batch files = {.files = outputs,
                                .count = count,
                                .job = &j,
                                .folder = folder,
                                .in_place = by->in_place,
                                .watch = {by->progress, by->progress_context, by->stop},
                                .steps = count};
    watch_tell(&files.watch, "writing", 0);
    s = by->in_place ? OK : map_names_check(folder);
    if (s == OK) s = surface_albedo(surface, &j.albedo);
    if (s == OK) s = folder_batch_write(&files);
    img_free(&j.albedo);
    return s;
}
