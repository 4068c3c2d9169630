/* SPDX-License-Identifier: MIT */
#include "cli/stereo/stereo_output.h"

#include <stdlib.h>
#include <string.h>

#include "base/file.h"
#include "base/parallel.h"
#include "cli/page.h"
#include "command/standard_input.h"

static status stopped(const stereo_files *files)
{
    return files->stop && files->stop() ? fail(MERLIN_STOPPED, "stopped") : OK;
}

/* ---- the surface's folder ---- */

static const char *input_of(const stereo_files *files)
{
    return standard_input_is(files->input) ? "-" : files->input;
}

/* Replaces the report, of which a warning was not known before. */
static status rewrite_report(const stereo_files *files, const staging *t, const merlin_surface *surface)
{
    char path[PATH_MAX], *text;
    status s = merlin_surface_report(surface, input_of(files), &text);
    if (s == OK) s = file_write(staging_path(t, "report.json", path), text, strlen(text));
    free(text);
    return s;
}

/* Writes the page of the maps as other commands read them. */
static status write_page(const stereo_files *files, const staging *t, merlin_surface *surface)
{
    char path[PATH_MAX];
    merlin_maps maps;
    const size_t known = surface->warnings.count;
    const page_source of = {standard_input_name(files->input), files->folder, 0};
    status s = merlin_maps_read(staging_folder(t), &maps);
    if (s == OK) page_doubt(maps.crop.side, 0, &surface->warnings);
    if (s == OK && surface->warnings.count > known) s = rewrite_report(files, t, surface);
    if (s == OK) s = page_write(&maps, &of, staging_path(t, PAGE_FILE, path));
    merlin_maps_free(&maps);
    return s;
}

static status write_folder(const stereo_files *files, const staging *t, merlin_surface *surface)
{
    const merlin_write_params params = {.in_place = 1, .stop = files->stop};
    status s = merlin_surface_write(surface, input_of(files), &params, staging_folder(t));
    return s == OK && files->page ? write_page(files, t, surface) : s;
}

/* ---- meshes ---- */

/* The slowest first, so that two processors finish together. */
static const char *const usual_meshes[] = {"mesh.obj", "mesh.glb", "mesh.ply"};
enum { USUAL_MESHES = sizeof usual_meshes / sizeof *usual_meshes };

typedef struct meshes {
    const stereo_files *files;
    const staging *staging;
    const merlin_mesh *mesh;
} meshes;

static status write_usual(void *context, size_t i)
{
    const meshes *m = context;
    char path[PATH_MAX];
    status s = stopped(m->files);
    return s == OK ? merlin_mesh_write(m->mesh, staging_path(m->staging, usual_meshes[i], path), NULL) : s;
}

static status write_meshes(const stereo_files *files, const merlin_surface *surface, maps_staging *all)
{
    merlin_mesh mesh;
    const char *const *names = files->mesh.at;
    meshes usual = {files, all->at[0], &mesh};
    status s = merlin_mesh_from_surface(surface, &mesh);
    if (s == OK && files->mesh.count == 0) s = parallel_try(USUAL_MESHES, write_usual, &usual);
    for (int i = 0; i < files->mesh.count && s == OK; i++) {
        mesh_file named = {names[i], files->folder, files->inputs, all->at[0], &mesh};
        s = stopped(files);
        if (s == OK) s = mesh_file_stage(&named, &all->at[all->count]);
        all->count += all->at[all->count] != NULL;
    }
    merlin_mesh_free(&mesh);
    return s;
}

status stereo_write(const stereo_files *files, merlin_surface *surface, staged_files *written)
{
    maps_staging all = {.count = 1};
    status s = staging_begin(files->folder, files->inputs, &all.at[0]);
    if (s != OK) return s;
    s = write_folder(files, all.at[0], surface);
    if (s == OK) s = write_meshes(files, surface, &all);
    if (s == OK) return staging_commit_all(all.at, all.count, written);
    while (all.count > 0)
        s = staging_abort(all.at[--all.count], s);
    return s;
}
