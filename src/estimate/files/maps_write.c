/* SPDX-License-Identifier: MIT */
/* merlin_maps_write: writes a folder with all files, or nothing. */
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/api_needs.h"
#include "base/file.h"
#include "base/folder_batch.h"
#include "base/text/map_names.h"
#include "estimate/files/map_png.h"
#include "estimate/files/maps_files.h"
#include "estimate/files/overview.h"
#include "estimate/photo/model_pair.h"
#include "estimate/relight/maps_surface.h"
#include "estimate/relight/reconstruct.h"
#include "image/write/write.h"

/* ---- one file each ---- */

enum { TILE_SIZE = 256, COLUMNS = 4 };

typedef struct job {
    const merlin_maps *maps;
    overview overview;
} job;

static status write_image(const merlin_image *image, img_encoding encoding, const char *path)
{
    img m = *image;
    return img_write_png(path, &m, encoding);
}

static status write_exr(const void *context, const char *path)
{
    const job *j = context;
    return maps_write_exr(j->maps, path);
}

static status write_albedo(const void *context, const char *path)
{
    const job *j = context;
    return write_image(&j->maps->albedo, IMG_SRGB8, path);
}

static status write_roughness(const void *context, const char *path)
{
    const job *j = context;
    return write_image(&j->maps->roughness, IMG_LINEAR8, path);
}

static status write_mask(const void *context, const char *path)
{
    const job *j = context;
    return write_image(&j->maps->mask, IMG_LINEAR8, path);
}

static status write_reconstruction(const void *context, const char *path)
{
    const job *j = context;
    return write_image(&j->maps->reconstruction, IMG_SRGB8, path);
}

static status write_normal(const void *context, const char *path)
{
    const job *j = context;
    img normal = j->maps->normal, mask = j->maps->mask;
    return map_write_normals(path, &normal, &mask);
}

/* Writes depths; report.json (statistics.depth) has their range. */
static status write_depth(const void *context, const char *path)
{
    const job *j = context;
    img depth = j->maps->depth, mask = j->maps->mask;
    return map_write_depths(path, &depth, &mask);
}

static status write_confidence(const void *context, const char *path)
{
    const job *j = context;
    img spread = j->maps->spread, mask = j->maps->mask;
    return map_write_confidence(path, &spread, &mask);
}

static status write_report(const void *context, const char *path)
{
    const job *j = context;
    char *text = NULL;
    status s = merlin_maps_report(j->maps, &text);
    if (s == OK) s = file_write(path, text, strlen(text));
    free(text);
    return s;
}

/* ---- the overview ---- */

static status write_overview(const void *context, const char *path)
{
    const job *j = context;
    figure_tile tiles[OVERVIEW_TILES];
    overview_tiles(&j->overview, tiles);
    return figure_sheet(path, tiles, OVERVIEW_TILES, COLUMNS, TILE_SIZE);
}

/* ---- all of them ---- */

/* Output files, the slowest first, so that two processors finish together. */
static const folder_file outputs[] = {
    {"overview.png", write_overview},   {"maps.exr", write_exr},
    {"normal.png", write_normal},       {"reconstruction.png", write_reconstruction},
    {"albedo.png", write_albedo},       {"depth.png", write_depth},
    {"roughness.png", write_roughness}, {"mask.png", write_mask},
    {"report.json", write_report},      {"confidence.png", write_confidence}, /* the last one: not of one photograph */
};
enum { OUTPUTS = sizeof outputs / sizeof outputs[0] };

static size_t outputs_of(const merlin_maps *maps)
{
    return maps->spread.data ? OUTPUTS : OUTPUTS - 1;
}

static status write_maps(merlin_model *model, const merlin_maps *maps, const merlin_write_params *by,
                         const char *folder)
{
    job *j = calloc(1, sizeof *j);
    if (!j) return fail(MERLIN_NO_MEMORY, "no memory to write %s", folder);
    j->maps = maps;
    const folder_batch files = {.files = outputs,
                                .count = outputs_of(maps),
                                .job = j,
                                .folder = folder,
                                .in_place = by->in_place,
                                .watch = {by->progress, by->progress_context, by->stop},
                                .steps = outputs_of(maps) + 1};
    watch_tell(&files.watch, "writing", 0);
    /* before the files are written in parallel, as the network uses all processors itself */
    network *n = model_network(model, maps, MERLIN_BY_BRDF);
    status s = by->in_place ? OK : map_names_check(folder);
    if (s == OK) s = overview_new(n, maps, &j->overview);
    if (by->last) network_release(n);
    if (s == OK) s = folder_batch_write(&files);
    overview_free(&j->overview);
    free(j);
    return s;
}

/* Writes maps that were read from a folder, with a reconstruction. */
static status write_read_maps(merlin_model *model, const merlin_maps *maps, const merlin_write_params *by,
                              const char *folder)
{
    merlin_maps whole = *maps;
    status s = maps_reconstruct(model, maps, &whole.reconstruction);
    if (s == OK) s = write_maps(model, &whole, by, folder);
    merlin_image_free(&whole.reconstruction);
    return s;
}

merlin_status merlin_maps_write(merlin_model *model, const merlin_maps *maps, const merlin_write_params *params,
                                const char *folder)
{
    const merlin_write_params usual = {.in_place = 0};
    status s = api_needs(__func__, model && maps && folder);
    if (s == OK) s = maps_check(maps);
    if (s == OK && maps->captured)
        s = fail(MERLIN_WRONG_USE, "these maps are of a captured surface, which is what is written");
    if (s == OK) s = maps_check_values("these maps", maps);
    if (s != OK) return s;
    if (!params) params = &usual;
    return maps->reconstruction.data ? write_maps(model, maps, params, folder)
                                     : write_read_maps(model, maps, params, folder);
}
