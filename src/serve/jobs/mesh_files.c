/* SPDX-License-Identifier: MIT */
#include "serve/jobs/mesh_files.h"

status mesh_files_write(const work_context *w, const merlin_mesh *mesh)
{
    static const char *const names[] = {"mesh.glb", "mesh.ply"};
    char path[PATH_MAX];
    status s = OK;
    for (size_t i = 0; i < sizeof names / sizeof *names && s == OK; i++) {
        if (w->stop()) return fail(MERLIN_STOPPED, "stopped");
        s = merlin_mesh_write(mesh, store_path(w->store, w->form->id, STORE_OUT, names[i], path), NULL);
    }
    return s;
}
