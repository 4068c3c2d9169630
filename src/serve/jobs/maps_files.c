/* SPDX-License-Identifier: MIT */
#include "serve/jobs/maps_files.h"

#include "serve/jobs/mesh_files.h"

static status write_mesh(const work_context *w, const merlin_maps *maps)
{
    merlin_mesh mesh = {.vertex_count = 0};
    status s = merlin_mesh_from_maps(maps, NULL, &mesh);
    if (s == OK) s = mesh_files_write(w, &mesh);
    merlin_mesh_free(&mesh);
    return s;
}

status maps_files_write(const work_context *w, const merlin_maps *maps, maps_files which)
{
    char folder[PATH_MAX], page[PATH_MAX];
    const merlin_write_params write = {
        .in_place = 1, .stop = w->stop, .progress = w->progress, .progress_context = w->progress_context};
    const merlin_view_params view = {.name = which.page};
    w->progress(w->progress_context, "writing", 0);
    status s = merlin_maps_write(w->model, maps, &write, store_path(w->store, w->form->id, STORE_OUT, NULL, folder));
    if (s == OK && w->stop()) s = fail(MERLIN_STOPPED, "stopped");
    if (s == OK && which.page)
        s = merlin_view_write(maps, &view, store_path(w->store, w->form->id, STORE_OUT, "viewer.html", page));
    return s == OK && which.mesh ? write_mesh(w, maps) : s;
}
