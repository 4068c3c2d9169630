/* SPDX-License-Identifier: MIT */
/* merlin_maps_export and merlin_maps_occlusion. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/api_needs.h"
#include "base/file.h"
#include "base/json/json_put.h"
#include "base/number.h"
#include "base/staging.h"
#include "base/text/report.h"
#include "base/watch.h"
#include "estimate/relight/maps_surface.h"
#include "estimate/surface/fill.h"
#include "export/materialx.h"
#include "export/occlusion.h"
#include "image/exr/exr.h"
#include "image/resize.h"
#include "image/write/write.h"
#include "merlin/export.h"
#include "optics/brdf.h"

/* Size of the surface whose horizon is computed, as an estimate's shape has no finer detail, and the largest size at
 * which occlusion, which is smooth, is computed. */
enum { HORIZON_SIDE = 512, OCCLUSION_SIDE = 1024 };
enum {
    USUAL_MAPS = MERLIN_EXPORT_ALBEDO | MERLIN_EXPORT_NORMAL | MERLIN_EXPORT_ROUGHNESS | MERLIN_EXPORT_OCCLUSION |
                 MERLIN_EXPORT_HEIGHT | MERLIN_EXPORT_ALPHA,
    WITH_OCCLUSION = MERLIN_EXPORT_OCCLUSION | MERLIN_EXPORT_ORM,
    WITH_HEIGHT = MERLIN_EXPORT_HEIGHT | MERLIN_EXPORT_HEIGHT_FLOAT,
    OF_MATERIALX = MERLIN_EXPORT_ALBEDO | MERLIN_EXPORT_NORMAL | MERLIN_EXPORT_ROUGHNESS,
};

/* Names of the files, in the order of merlin_export_map's bits. */
static const char *const map_names[] = {"albedo.png", "normal.png", "roughness.png", "smoothness.png", "ao.png",
                                        "orm.png",    "height.png", "height.exr",    "alpha.png",      "material.mtlx"};
enum { MAPS = sizeof map_names / sizeof *map_names };
#define FACTS "export.json"

typedef struct export_job {
    const merlin_maps *maps;
    unsigned wanted;
    bool normal_down;
    merlin_export_facts facts;
    surface of;     /* the square; `filled`: its maps are continued outside the object */
    img occlusion;  /* 1 channel; no data: not requested */
    img height;     /* 1 channel, in widths of the square; no data: not wanted */
    float farthest; /* depth of the object's lowest point */
    staging *files;
    cJSON *list; /* names of the files */
    watch shown;
} export_job;

static void job_free(export_job *j)
{
    surface_free(&j->of);
    img_free(&j->occlusion);
    img_free(&j->height);
}

/* Tells how far the work is, and asks whether to go on. */
static status told(const export_job *j, double share)
{
    watch_tell(&j->shown, "exporting", share);
    return watch_stops(&j->shown) ? fail(MERLIN_STOPPED, "stopped") : OK;
}

/* ---- computed maps ---- */

/* Sets occlusion to 1 beside the object. */
static status clear_outside(const img *mask, img *occlusion)
{
    img larger = {0};
    status s = img_resize(mask, occlusion->width, occlusion->height, &larger);
    for (size_t i = 0; s == OK && i < img_value_count(occlusion); i++)
        if (!(larger.data[i] > 0)) occlusion->data[i] = 1;
    img_free(&larger);
    return s;
}

static status compute_occlusion(const merlin_maps *maps, int side, img *out)
{
    surface fine = {0}, coarse = {0};
    img small = {0};
    const int fine_side = min_int(side, OCCLUSION_SIDE);
    const bool is_coarse = fine_side <= HORIZON_SIDE;
    status s = maps_surface(maps, fine_side, &fine);
    if (s == OK && !is_coarse) s = maps_surface(maps, HORIZON_SIDE, &coarse);
    if (s == OK) s = occlusion_of(is_coarse ? &fine : &coarse, &fine, &small);
    if (s == OK && fine_side == side) {
        *out = small;
        small = (img){0};
    } else if (s == OK) {
        s = fill_outside(&small, &fine.mask);
        if (s == OK) s = img_resize(&small, side, side, out);
        if (s == OK) s = clear_outside(&fine.mask, out);
    }
    surface_free(&coarse);
    surface_free(&fine);
    img_free(&small);
    return s;
}

static void measure(export_job *j)
{
    float nearest = INFINITY;
    double sum = 0, count = 0;
    j->farthest = -INFINITY;
    for (size_t i = 0; i < img_value_count(&j->of.depth); i++) {
        if (j->of.mask.data[i] < 0.5f) continue;
        nearest = fminf(nearest, j->of.depth.data[i]);
        j->farthest = fmaxf(j->farthest, j->of.depth.data[i]);
        sum += (double)j->of.depth.data[i];
        count++;
    }
    if (count == 0) return;
    j->facts.width = (float)(2 * (double)camera_tangent(surface_lens(&j->of).fov) * sum / count);
    j->facts.relief = (j->farthest - nearest) / j->facts.width;
}

static status compute_height(export_job *j)
{
    status s = img_copy(&j->height, &j->of.depth);
    for (size_t i = 0; s == OK && i < img_value_count(&j->height); i++)
        j->height.data[i] = j->of.mask.data[i] >= 0.5f ? (j->farthest - j->height.data[i]) / j->facts.width : 0;
    return s;
}

static status fill_textures(export_job *j)
{
    status s = fill_outside(&j->of.albedo, &j->of.mask);
    if (s == OK) s = fill_outside(&j->of.roughness, &j->of.mask);
    if (s == OK) s = fill_outside(&j->of.normal, &j->of.mask);
    for (size_t i = 0; s == OK && i < img_value_count(&j->of.normal); i += 3) {
        float *n = j->of.normal.data + i;
        vec3 unit = vec3_normalize(vec3_make(n[0], n[1], n[2] + 1e-6f));
        n[0] = (float)unit.x, n[1] = (float)unit.y, n[2] = (float)unit.z;
    }
    if (s == OK && j->occlusion.data && j->occlusion.width == j->of.mask.width)
        s = fill_outside(&j->occlusion, &j->of.mask);
    return s;
}

/* ---- files ---- */

/* Lists a map's file, and composes its path. */
static const char *file_of(export_job *j, int map, char path[PATH_MAX])
{
    json_append_text(j->list, map_names[map]);
    return staging_path(j->files, map_names[map], path);
}

static void encode_normals(const void *context, size_t first, size_t count, float *values)
{
    const export_job *j = context;
    const float up = j->normal_down ? -0.5f : 0.5f;
    (void)first;
    for (size_t i = 0; i < count; i++, values += 3) {
        values[0] = 0.5f * values[0] + 0.5f;
        values[1] = up * values[1] + 0.5f;
        values[2] = 0.5f * values[2] + 0.5f;
    }
}

static void encode_smoothness(const void *context, size_t first, size_t count, float *values)
{
    (void)context, (void)first;
    for (size_t i = 0; i < count; i++)
        values[i] = 1 - values[i];
}

static void encode_height(const void *context, size_t first, size_t count, float *values)
{
    const float relief = *(const float *)context;
    (void)first;
    for (size_t i = 0; i < count; i++)
        values[i] = relief > 0 ? values[i] / relief : 0;
}

static status write_orm(export_job *j, const char *path)
{
    img packed = {0};
    status s = img_new(&packed, j->of.mask.width, j->of.mask.height, 3);
    for (size_t i = 0; s == OK && i < img_value_count(&j->of.mask); i++) {
        packed.data[3 * i] = j->occlusion.data[i];
        packed.data[3 * i + 1] = j->of.roughness.data[i];
    }
    if (s == OK) s = img_write_png(path, &packed, IMG_LINEAR8);
    img_free(&packed);
    return s;
}

static status write_height_exr(const export_job *j, const char *path)
{
    const exr_channel channel = {"Y", j->height.data, 1, true};
    return exr_write(path, j->height.width, j->height.height, &channel, 1, NULL, 0);
}

static status write_map(export_job *j, int map)
{
    char path[PATH_MAX];
    file_of(j, map, path);
    switch ((merlin_export_map)(1 << map)) {
    case MERLIN_EXPORT_ALBEDO:
        return img_write_png(path, &j->of.albedo, IMG_SRGB8);
    case MERLIN_EXPORT_NORMAL:
        return img_write_png_changed(path, &j->of.normal, IMG_LINEAR16, encode_normals, j);
    case MERLIN_EXPORT_ROUGHNESS:
        return img_write_png(path, &j->of.roughness, IMG_LINEAR8);
    case MERLIN_EXPORT_SMOOTHNESS:
        return img_write_png_changed(path, &j->of.roughness, IMG_LINEAR8, encode_smoothness, NULL);
    case MERLIN_EXPORT_OCCLUSION:
        return img_write_png(path, &j->occlusion, IMG_LINEAR8);
    case MERLIN_EXPORT_ORM:
        return write_orm(j, path);
    case MERLIN_EXPORT_HEIGHT:
        return img_write_png_changed(path, &j->height, IMG_LINEAR16, encode_height, &j->facts.relief);
    case MERLIN_EXPORT_HEIGHT_FLOAT:
        return write_height_exr(j, path);
    case MERLIN_EXPORT_ALPHA:
        return img_write_png(path, &j->of.mask, IMG_LINEAR8);
    case MERLIN_EXPORT_MATERIALX:
        return materialx_write(path, j->maps->captured);
    case MERLIN_EXPORT_ALL:
        break;
    }
    return OK;
}

static status write_facts(export_job *j)
{
    char path[PATH_MAX];
    cJSON *o = report_begin(&(warnings){0});
    json_put_text(o, "model", j->maps->model);
    json_put_number(o, "side", j->facts.side);
    json_put_number(o, "relief", (double)j->facts.relief);
    json_put_number(o, "width", (double)j->facts.width);
    json_put_number(o, "f0", j->maps->captured ? 0 : round(1e4 * (double)BRDF_F0) / 1e4);
    json_put_text(o, "normal_y", j->normal_down ? "down" : "up");
    json_put_item(o, "maps", j->list);
    char *text = json_print(o);
    cJSON_Delete(o);
    if (!text) return fail(MERLIN_NO_MEMORY, "no memory for export.json");
    status s = file_write(staging_path(j->files, FACTS, path), text, strlen(text));
    free(text);
    return s;
}

/* ---- the whole ---- */

static status check(const merlin_export_params *p)
{
    if (p->maps & ~(unsigned)MERLIN_EXPORT_ALL)
        return fail(MERLIN_WRONG_USE, "there is no map to export by the number %u", p->maps);
    if (p->side && (p->side < MERLIN_EXPORT_LEAST_SIDE || p->side > MERLIN_EXPORT_MOST_SIDE))
        return fail(MERLIN_WRONG_USE, "a side of %d pixels is not between %d and %d", p->side, MERLIN_EXPORT_LEAST_SIDE,
                    MERLIN_EXPORT_MOST_SIDE);
    if (p->maps & MERLIN_EXPORT_MATERIALX && p->normal_down && p->maps != MERLIN_EXPORT_ALL)
        return fail(MERLIN_WRONG_USE, "MaterialX has normals whose green is up alone: material.mtlx cannot go with "
                                      "normals whose green is down (leave one of the two out)");
    return OK;
}

static status compute(export_job *j, int side)
{
    img mask = {0};
    const bool as_photographed = side == j->maps->crop.side;
    status s = as_photographed ? maps_as_photographed(j->maps, &j->of) : maps_take_mask(j->maps, &mask);
    if (s == OK && !as_photographed) s = maps_take_surface(j->maps, &mask, side, false, &j->of);
    img_free(&mask);
    if (s != OK) return s;
    j->facts.side = side;
    measure(j);
    s = told(j, 0.1);
    if (s == OK && j->wanted & WITH_OCCLUSION) s = compute_occlusion(j->maps, side, &j->occlusion);
    if (s == OK) s = told(j, 0.3);
    if (s == OK && j->wanted & WITH_HEIGHT) s = compute_height(j);
    return s == OK ? fill_textures(j) : s;
}

/* Checks that nothing in the folder would be replaced that is no earlier export's, or contradict these files. */
static status check_folder(const export_job *j, const char *folder)
{
    if (file_is_in(folder, "maps.exr"))
        return fail(MERLIN_CANNOT_WRITE,
                    "%s holds maps, whose pictures have names of an export's: choose another folder", folder);
    if (j->normal_down && (j->wanted & MERLIN_EXPORT_NORMAL) && file_is_in(folder, "material.mtlx"))
        return fail(MERLIN_CANNOT_WRITE, "%s has a material.mtlx, for normals whose green is up: choose another folder",
                    folder);
    for (int map = 0; map < MAPS && !file_is_in(folder, FACTS); map++)
        if (j->wanted & 1U << map && file_is_in(folder, map_names[map]))
            return fail(MERLIN_CANNOT_WRITE,
                        "cannot write into %s: its %s is no earlier export's, for there is no " FACTS
                        " beside it, and would be replaced; choose another folder",
                        folder, map_names[map]);
    return OK;
}

static status write_all(export_job *j, const char *folder, merlin_files *written)
{
    status s = staging_begin(folder, NULL, &j->files);
    if (s != OK) return s;
    j->list = cJSON_CreateArray();
    for (int map = 0; s == OK && map < MAPS; map++) {
        s = told(j, 0.5 + 0.5 * map / MAPS);
        if (s == OK && j->wanted & 1U << map) s = write_map(j, map);
    }
    if (s == OK) s = told(j, 1);
    if (s == OK)
        s = write_facts(j);
    else
        cJSON_Delete(j->list);
    return s == OK ? staging_commit(j->files, written) : staging_abort(j->files, s);
}

merlin_status merlin_maps_export(const merlin_maps *maps, const merlin_export_params *params, const char *folder,
                                 merlin_export_facts *facts, merlin_files *written)
{
    static const merlin_export_params usual = {0};
    const merlin_export_params *how = params ? params : &usual;
    export_job j = {.maps = maps,
                    .wanted = how->maps ? how->maps : USUAL_MAPS,
                    .normal_down = how->normal_down != 0,
                    .shown = {how->progress, how->progress_context, how->stop}};
    if (written) *written = (merlin_files){0};
    status s = api_needs(__func__, maps && folder);
    if (s == OK) s = check(how);
    if (s == OK) s = maps_check(maps);
    if (s != OK) return s;
    if (j.normal_down) j.wanted &= ~(unsigned)MERLIN_EXPORT_MATERIALX;
    if (j.wanted & MERLIN_EXPORT_MATERIALX) j.wanted |= OF_MATERIALX;
    s = check_folder(&j, folder);
    if (s == OK) s = compute(&j, how->side ? how->side : min_int(maps->crop.side, MERLIN_EXPORT_SIDE));
    if (s == OK) s = write_all(&j, folder, written);
    if (s == OK && facts) *facts = j.facts;
    job_free(&j);
    return s;
}

merlin_status merlin_maps_occlusion(const merlin_maps *maps, int side, merlin_image *out)
{
    status s = api_needs(__func__, maps && out);
    if (s != OK) return s;
    *out = (merlin_image){0};
    if (side < MERLIN_EXPORT_LEAST_SIDE || side > MERLIN_EXPORT_MOST_SIDE)
        return fail(MERLIN_WRONG_USE, "a side of %d pixels is not between %d and %d", side, MERLIN_EXPORT_LEAST_SIDE,
                    MERLIN_EXPORT_MOST_SIDE);
    s = maps_check(maps);
    return s == OK ? compute_occlusion(maps, side, out) : s;
}
