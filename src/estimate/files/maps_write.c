/* SPDX-License-Identifier: MIT */
/* merlin_maps_write: a folder with everything, or nothing. */
#include <pthread.h>
#include <stdatomic.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

#include "base/api_needs.h"
#include "base/file.h"
#include "base/parallel.h"
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

/* Which depths these are is in report.json: statistics.depth. */
static status write_depth(const job *j, const char *path)
{
    img depth = j->maps->depth, mask = j->maps->mask;
    return map_write_depths(path, &depth, &mask);
}

static status write_report(const job *j, const char *path)
{
    char *text = maps_report(j->maps);
    if (!text) return fail(MERLIN_NO_MEMORY, "no memory for a report");
    status s = file_write(path, text, strlen(text));
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

/* The slowest first, so that two processors end together. */
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
    pthread_t owner; /* the thread that tells */
    atomic_int done;
    staging *staging;
    const maps_output *output;
} batch;

static bool stopped(const batch *b)
{
    return b->output->stop && b->output->stop();
}

static status write_one(void *context, size_t i)
{
    batch *b = context;
    char path[PATH_MAX];
    if (stopped(b)) return fail(MERLIN_STOPPED, "stopped");
    status s = outputs[i].write(&b->job, staging_path(b->staging, outputs[i].name, path));
    int done = atomic_fetch_add(&b->done, 1) + 1;
    if (pthread_equal(b->owner, pthread_self())) watch_tell(b->output->watch, "writing", (double)done / (OUTPUTS + 1));
    return s;
}

/* A mesh is no part of merlin_maps_write, but of the same all or none. */
static status write_more(const batch *b, maps_staging *all)
{
    return b->output->more ? b->output->more(b->output->context, b->job.maps, all) : OK;
}

static status write_through(batch *b)
{
    const maps_output *o = b->output;
    maps_staging all = {.count = 1};
    status s = staging_begin(o->folder, o->inputs, &all.at[0]);
    if (s != OK) return s;
    b->staging = all.at[0];
    s = parallel_try(OUTPUTS, write_one, b);
    if (s == OK) s = write_more(b, &all);
    if (s == OK && stopped(b)) s = fail(MERLIN_STOPPED, "stopped");
    if (s == OK) return staging_commit_all(all.at, all.count, o->written);
    while (all.count > 0)
        s = staging_abort(all.at[--all.count], s);
    return s;
}

status maps_write(merlin_model *model, const merlin_maps *maps, const maps_output *to)
{
    batch *b = calloc(1, sizeof *b);
    if (!b) return fail(MERLIN_NO_MEMORY, "no memory to write %s", to->folder);
    b->job.maps = maps;
    b->output = to;
    b->owner = pthread_self();
    watch_tell(to->watch, "writing", 0);
    /* before the files are written side by side, because the network uses every processor itself */
    network *n = model_network(model, maps, MERLIN_BY_BRDF);
    status s = overview_new(n, maps, &b->job.overview);
    if (to->last) network_release(n);
    if (s == OK) s = write_through(b);
    overview_free(&b->job.overview);
    free(b);
    return s;
}

merlin_status merlin_maps_write(merlin_model *model, const merlin_maps *maps, const char *folder)
{
    status s = api_needs(__func__, model && maps && folder);
    return s == OK ? maps_write(model, maps, &(maps_output){.folder = folder}) : s;
}
