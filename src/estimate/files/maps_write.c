/* SPDX-License-Identifier: MIT */
/* merlin_maps_write: writes a folder with all files, or nothing. */
#include <pthread.h>
#include <stdatomic.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/api_needs.h"
#include "base/file.h"
#include "base/parallel.h"
#include "base/staging.h"
#include "base/watch.h"
#include "estimate/files/map_png.h"
#include "estimate/files/maps_files.h"
#include "estimate/files/overview.h"
#include "estimate/photo/model_pair.h"
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

static status write_exr(const job *j, const char *path)
{
    return maps_write_exr(j->maps, path);
}

static status write_albedo(const job *j, const char *path)
{
    return write_image(&j->maps->albedo, IMG_SRGB8, path);
}

static status write_roughness(const job *j, const char *path)
{
    return write_image(&j->maps->roughness, IMG_LINEAR8, path);
}

static status write_mask(const job *j, const char *path)
{
    return write_image(&j->maps->mask, IMG_LINEAR8, path);
}

static status write_reconstruction(const job *j, const char *path)
{
    return write_image(&j->maps->reconstruction, IMG_SRGB8, path);
}

static status write_normal(const job *j, const char *path)
{
    img normal = j->maps->normal, mask = j->maps->mask;
    return map_write_normals(path, &normal, &mask);
}

/* Writes depths; report.json (statistics.depth) has their range. */
static status write_depth(const job *j, const char *path)
{
    img depth = j->maps->depth, mask = j->maps->mask;
    return map_write_depths(path, &depth, &mask);
}

static status write_report(const job *j, const char *path)
{
    char *text = NULL;
    status s = merlin_maps_report(j->maps, &text);
    if (s == OK) s = file_write(path, text, strlen(text));
    free(text);
    return s;
}

/* ---- the overview ---- */

static status write_overview(const job *j, const char *path)
{
    figure_tile tiles[OVERVIEW_TILES];
    overview_tiles(&j->overview, tiles);
    return figure_sheet(path, tiles, OVERVIEW_TILES, COLUMNS, TILE_SIZE);
}

/* ---- all of them ---- */

typedef struct output {
    const char *name;
    status (*write)(const job *j, const char *path);
} output;

/* Output files, the slowest first, so that two processors finish together. */
static const output outputs[] = {
    {"overview.png", write_overview},   {"maps.exr", write_exr},
    {"normal.png", write_normal},       {"reconstruction.png", write_reconstruction},
    {"albedo.png", write_albedo},       {"depth.png", write_depth},
    {"roughness.png", write_roughness}, {"mask.png", write_mask},
    {"report.json", write_report},
};
enum { OUTPUTS = sizeof outputs / sizeof outputs[0] };

typedef struct batch {
    job job;
    pthread_t owner; /* thread that reports progress */
    atomic_int done;
    staging *staging; /* NULL: into `folder` itself */
    const char *folder;
    watch watch;
} batch;

static const char *path_of(const batch *b, const char *name, char path[PATH_MAX])
{
    if (b->staging) return staging_path(b->staging, name, path);
    snprintf(path, PATH_MAX, "%s/%s", b->folder, name);
    return path;
}

static status write_one(void *context, size_t i)
{
    batch *b = context;
    char path[PATH_MAX];
    if (watch_stops(&b->watch)) return fail(MERLIN_STOPPED, "stopped");
    status s = outputs[i].write(&b->job, path_of(b, outputs[i].name, path));
    int done = atomic_fetch_add(&b->done, 1) + 1;
    if (pthread_equal(b->owner, pthread_self())) watch_tell(&b->watch, "writing", (double)done / (OUTPUTS + 1));
    return s;
}

static status write_all(batch *b, bool in_place)
{
    const size_t length = strlen(b->folder);
    status s = !in_place ? staging_begin(b->folder, NULL, &b->staging)
               : length + 1 + NAME_MAX < PATH_MAX
                   ? OK
                   : fail(MERLIN_CANNOT_WRITE, "a path of %zu bytes is too long", length);
    if (s != OK) return s;
    s = parallel_try(OUTPUTS, write_one, b);
    if (s == OK && watch_stops(&b->watch)) s = fail(MERLIN_STOPPED, "stopped");
    if (in_place) return s;
    return s == OK ? staging_commit(b->staging, NULL) : staging_abort(b->staging, s);
}

static status write_maps(merlin_model *model, const merlin_maps *maps, const merlin_write_params *by,
                         const char *folder)
{
    batch *b = calloc(1, sizeof *b);
    if (!b) return fail(MERLIN_NO_MEMORY, "no memory to write %s", folder);
    b->job.maps = maps;
    b->folder = folder;
    b->owner = pthread_self();
    b->watch = (watch){by->progress, by->progress_context, by->stop};
    watch_tell(&b->watch, "writing", 0);
    /* before the files are written in parallel, as the network uses all processors itself */
    network *n = model_network(model, maps, MERLIN_BY_BRDF);
    status s = overview_new(n, maps, &b->job.overview);
    if (by->last) network_release(n);
    if (s == OK) s = write_all(b, by->in_place);
    overview_free(&b->job.overview);
    free(b);
    return s;
}

merlin_status merlin_maps_write(merlin_model *model, const merlin_maps *maps, const merlin_write_params *params,
                                const char *folder)
{
    const merlin_write_params usual = {.in_place = 0};
    status s = api_needs(__func__, model && maps && folder);
    return s == OK ? write_maps(model, maps, params ? params : &usual, folder) : s;
}
