/* SPDX-License-Identifier: MIT */
#include "cli/estimate_write.h"

#include "cli/left_files.h"
#include "cli/page.h"
#include "command/cli.h"
#include "command/photo_source.h"
#include "command/standard_input.h"
#include "merlin/merlin.h"

static status write_meshes(const estimate_write *w, const merlin_maps *maps, maps_staging *to)
{
    const mesh_names *names = &w->request->meshes;
    char path[PATH_MAX];
    merlin_mesh mesh;
    if (!w->request->mesh && !names->count) return OK;
    status s = merlin_mesh_from_maps(maps, NULL, &mesh);
    if (s == OK && w->request->mesh) s = merlin_mesh_write(&mesh, staging_path(to->at[0], "mesh.glb", path), NULL);
    for (int i = 0; i < names->count && s == OK; i++) {
        mesh_file named = {names->at[i], w->output, w->inputs, to->at[0], &mesh};
        s = mesh_file_stage(&named, &to->at[to->count]);
        to->count += to->at[to->count] != NULL;
    }
    merlin_mesh_free(&mesh);
    return s;
}

static status write_more(const estimate_write *w, const merlin_maps *maps, maps_staging *to)
{
    char path[PATH_MAX];
    const photo_how how = {&w->request->params, w->request->weights, w->request->flash_weights};
    status s = w->job ? photo_source_note(w->job, &how, staging_folder(to->at[0])) : OK;
    if (s == OK) s = write_meshes(w, maps, to);
    const page_source of = {standard_input_name(w->photo), w->output, 0};
    if (s == OK && w->request->html) s = page_write(maps, &of, staging_path(to->at[0], PAGE_FILE, path));
    return s == OK && cli_interrupted() ? fail(MERLIN_STOPPED, "stopped") : s;
}

status estimate_write_files(const estimate_write *w, const merlin_maps *maps, bool last, staged_files *written)
{
    const estimate_request *r = w->request;
    const merlin_write_params params = {.in_place = 1,
                                        .last = last,
                                        .stop = cli_interrupted,
                                        .progress = r->watch->tell,
                                        .progress_context = r->watch->context};
    maps_staging all = {.count = 1};
    status s = staging_begin(w->output, w->inputs, &all.at[0]);
    if (s != OK) return s;
    s = merlin_maps_write(r->model, maps, &params, staging_folder(all.at[0]));
    if (s == OK) s = write_more(w, maps, &all);
    if (s == OK) return staging_commit_all(all.at, all.count, written);
    while (all.count > 0)
        s = staging_abort(all.at[--all.count], s);
    return s;
}

void estimate_find_doubts(bool page, const char *folder, const merlin_maps *maps, const staged_files *written,
                          warnings *doubts)
{
    merlin_maps_warnings(maps, doubts);
    if (page) page_doubt(maps->crop.side, 0, doubts);
    left_files_warn(folder, written, doubts);
}
