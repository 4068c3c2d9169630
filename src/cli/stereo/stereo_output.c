/* SPDX-License-Identifier: MIT */
#include "cli/stereo/stereo_output.h"

#include <stdlib.h>
#include <string.h>

#include "base/file.h"
#include "base/json/json_put.h"
#include "base/parallel.h"
#include "cli/page.h"
#include "cli/stereo/stereo_view.h"
#include "estimate/files/map_png.h"
#include "estimate/files/maps_files.h"
#include "estimate/surface/crop.h"
#include "image/write/figure.h"
#include "image/write/write.h"
#include "mesh/surface/surface_mesh.h"

enum { TILES = 6, COLUMNS = 3, TILE_SIZE = 384 };

static size_t pixel_count(const stereo_result *r)
{
    return (size_t)r->mask.width * (size_t)r->mask.height;
}

/* ---- one file each ---- */

static status write_exr(const stereo_result *r, const char *path)
{
    const char *method = r->error_name;
    const exr_channel channels[] = {
        {"albedo.R", r->albedo.data, 3, false},     {"albedo.G", r->albedo.data + 1, 3, false},
        {"albedo.B", r->albedo.data + 2, 3, false}, {"normal.X", r->normal.data, 3, false},
        {"normal.Y", r->normal.data + 1, 3, false}, {"normal.Z", r->normal.data + 2, 3, false},
        {"depth.Z", r->depth.data, 1, true},        {"mask.A", r->mask.data, 1, false},
        {"error.Y", r->error.data, 1, false},
    };
    const exr_attribute attributes[] = {exr_text("merlinError", method), exr_number("merlinFocal", r->camera.focal),
                                        maps_picture_size(r->mask.width, r->mask.height)};
    return exr_write(path, r->mask.width, r->mask.height, channels, sizeof channels / sizeof channels[0], attributes,
                     sizeof attributes / sizeof attributes[0]);
}

static status write_normal(const stereo_result *r, const char *path)
{
    return map_write_normals(path, &r->normal, &r->mask);
}

static status write_albedo(const stereo_result *r, const char *path)
{
    return img_write_png(path, &r->albedo, IMG_SRGB8);
}

static status write_mask(const stereo_result *r, const char *path)
{
    return img_write_png(path, &r->mask, IMG_LINEAR8);
}

static status write_depth(const stereo_result *r, const char *path)
{
    return map_write_depths(path, &r->depth, &r->mask);
}

static status error_picture(const stereo_result *r, img *out)
{
    status s = img_copy(out, &r->error);
    for (size_t i = 0; i < pixel_count(r) && s == OK; i++)
        out->data[i] /= r->error_white;
    return s;
}

static status write_error(const stereo_result *r, const char *path)
{
    img shown = {0};
    status s = error_picture(r, &shown);
    if (s == OK) s = img_write_png(path, &shown, IMG_LINEAR8);
    img_free(&shown);
    return s;
}

/* Crops a tile to the object, which may be small in large photographs. */
static status crop_tile(crop_square c, img *tile)
{
    img part = {0};
    status s = crop_take(tile, c, NULL, &part);
    if (s != OK) return s;
    img_free(tile);
    *tile = part;
    return OK;
}

static status write_overview(const stereo_result *r, const char *path)
{
    img tile[TILES] = {0};
    crop_square c;
    status s = crop_around(&r->mask, &c);
    if (s != OK) c = (crop_square){0, 0, r->mask.width > r->mask.height ? r->mask.width : r->mask.height};
    s = figure_normals(&r->normal, &r->mask, &tile[0]);
    if (s == OK) s = crop_tile(c, &tile[0]);
    if (s == OK) s = crop_take(&r->albedo, c, NULL, &tile[1]);
    if (s == OK) s = figure_depth(&r->depth, &r->mask, &tile[2]);
    if (s == OK) s = crop_tile(c, &tile[2]);
    if (s == OK) s = crop_take(&r->mask, c, NULL, &tile[3]);
    if (s == OK) s = error_picture(r, &tile[4]);
    if (s == OK) s = crop_tile(c, &tile[4]);
    if (s == OK) s = stereo_side_view(r, TILE_SIZE, &tile[5]);
    const figure_tile tiles[TILES] = {{"normal", &tile[0]}, {"albedo", &tile[1]},      {"depth", &tile[2]},
                                      {"mask", &tile[3]},   {r->error_name, &tile[4]}, {"from 45 degrees", &tile[5]}};
    if (s == OK) s = figure_sheet(path, tiles, TILES, COLUMNS, TILE_SIZE);
    for (int k = 0; k < TILES; k++)
        img_free(&tile[k]);
    return s;
}

static status make_mesh(const stereo_result *r, merlin_mesh *out)
{
    const mesh_source source = {
        .depth = &r->depth, .mask = &r->mask, .normal = &r->normal, .albedo = &r->albedo, .camera = r->camera};
    return surface_mesh_new(&source, out);
}

static status write_report(const cJSON *report, const char *path)
{
    char *text = json_print(report);
    if (!text) return fail(MERLIN_NO_MEMORY, "no memory for a report");
    status s = file_write(path, text, strlen(text));
    free(text);
    return s;
}

/* ---- the whole ---- */

typedef struct output {
    const char *name;
    status (*write)(const stereo_result *r, const char *path); /* NULL: a mesh */
} output;

/* Output files, the slowest first, so that two processors finish together; among these the meshes, which are replaced
 * by those requested by name. */
static const output outputs[] = {
    {"mesh.obj", NULL},
    {"mesh.glb", NULL},
    {"mesh.ply", NULL},
    {"maps.exr", write_exr},
    {"overview.png", write_overview},
    {"normal.png", write_normal},
    {"albedo.png", write_albedo},
    {"depth.png", write_depth},
    {"error.png", write_error},
    {"mask.png", write_mask},
};
enum { MESHES = 3, OUTPUTS = sizeof outputs / sizeof outputs[0] };

typedef struct writing {
    const stereo_files *files;
    const staging *staging;
    const stereo_result *result;
    const merlin_mesh *mesh;
    size_t first; /* index of the first output */
} writing;

static status write_one(void *context, size_t i)
{
    const writing *w = context;
    char path[PATH_MAX];
    if (w->files->stop && w->files->stop()) return fail(MERLIN_STOPPED, "stopped");
    const output *o = &outputs[w->first + i];
    staging_path(w->staging, o->name, path);
    return o->write ? o->write(w->result, path) : merlin_mesh_write(w->mesh, path, NULL);
}

static status write_all(const stereo_files *files, const staging *t, const stereo_result *r, const merlin_mesh *mesh,
                        const cJSON *report)
{
    writing w = {files, t, r, mesh, files->mesh.count ? MESHES : 0};
    status s = parallel_try(OUTPUTS - w.first, write_one, &w);
    char path[PATH_MAX];
    return s == OK ? write_report(report, staging_path(t, "report.json", path)) : s;
}

/* Writes the page of the maps as relight reads them. */
static status write_page(const stereo_files *files, const staging *t)
{
    char path[PATH_MAX], *folder = file_folder_of(staging_path(t, "maps.exr", path));
    merlin_maps maps = {0};
    status s = folder ? merlin_maps_read(folder, &maps) : fail(MERLIN_NO_MEMORY, "no memory for a file name");
    const page_source of = {files->input, files->folder, 0};
    if (s == OK) s = page_write(&maps, &of, staging_path(t, PAGE_FILE, path));
    merlin_maps_free(&maps);
    free(folder);
    return s;
}

status stereo_write(const stereo_files *files, const stereo_result *r, const cJSON *report, staged_files *written)
{
    staging *t[1 + MESH_MOST_FILES] = {NULL};
    int count = 1;
    status s = staging_begin(files->folder, files->inputs, &t[0]);
    if (s != OK) return s;
    merlin_mesh mesh;
    s = make_mesh(r, &mesh);
    if (s == OK) s = write_all(files, t[0], r, &mesh, report);
    if (s == OK && files->page) s = write_page(files, t[0]);
    for (int i = 0; i < files->mesh.count && s == OK; i++) {
        mesh_file named = {files->mesh.at[i], files->folder, files->inputs, t[0], &mesh};
        s = mesh_file_stage(&named, &t[count]);
        count += t[count] != NULL;
    }
    merlin_mesh_free(&mesh);
    if (s == OK) return staging_commit_all(t, count, written);
    while (count > 0)
        s = staging_abort(t[--count], s);
    return s;
}
