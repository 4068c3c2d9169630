/* SPDX-License-Identifier: MIT */
#include "mesh/read/mesh_read.h"

#include <sys/stat.h>

#include "base/file.h"
#include "base/plain_locale.h"
#include "mesh/read/mesh_limits.h"
#include "mesh/read/mesh_read_gltf.h"
#include "mesh/read/mesh_read_obj.h"
#include "mesh/read/mesh_read_ply.h"

/* Returns a value above 0 if a triangle faces the way of its vertices' normals, below 0 if it faces the other way. */
static float agreement(const triangle_mesh *mesh, const uint32_t t[3])
{
    if (!mesh->normal) return 0;
    vec3 a = mesh->position[t[0]];
    vec3 n = vec3_cross(vec3_sub(mesh->position[t[1]], a), vec3_sub(mesh->position[t[2]], a));
    return vec3_dot(n, vec3_add(vec3_add(mesh->normal[t[0]], mesh->normal[t[1]]), mesh->normal[t[2]]));
}

/* Reverses triangles that wind against the file's normals, one by one, as a mirrored part's do beside others that do
 * not. Without normals all are reversed if they enclose a negative volume. */
static void wind_outward(triangle_mesh *mesh)
{
    mesh_normalize(mesh); /* centred, so that an open surface's volume has a meaningful sign */
    bool inward = mesh_signed_volume(mesh) < 0;
    for (uint32_t i = 0; i < mesh->triangle_count; i++) {
        uint32_t *t = mesh->triangle[i], swap = t[1];
        float outward = agreement(mesh, t);
        if (outward < 0 || (outward == 0 && inward)) {
            t[1] = t[2];
            t[2] = swap;
        }
    }
}

static status read_kind(const char *path, triangle_mesh *mesh, int *parts)
{
    static const char *const gltf[] = {".gltf", ".glb", NULL};
    *parts = 1;
    if (file_ends_in(path, ".ply")) return mesh_read_ply(path, mesh);
    if (file_ends_in(path, ".obj")) return mesh_read_obj(path, MESH_TRIANGLES, mesh, parts);
    if (file_ends_in_any(path, gltf)) return mesh_read_gltf(path, mesh, parts);
    return fail(MERLIN_BAD_INPUT, "not a mesh that can be read; give .obj, .ply, .gltf or .glb");
}

status mesh_read(const char *path, triangle_mesh *mesh, int *parts)
{
    struct stat file;
    if (stat(path, &file) != 0) return fail(MERLIN_BAD_INPUT, "no such file");
    if (!S_ISREG(file.st_mode)) return fail(MERLIN_BAD_INPUT, "not a plain file");
    locale_t before = uselocale(plain_locale());
    status s = read_kind(path, mesh, parts);
    uselocale(before);
    if (s != OK) return s;
    if (mesh->triangle_count == 0) return fail(MERLIN_BAD_INPUT, "no triangles in it");
    if (mesh->triangle_count > MESH_TRIANGLES)
        return fail(MERLIN_BAD_INPUT, "%u triangles; at most %d", mesh->triangle_count, MESH_TRIANGLES);
    mesh_drop_repeated(mesh);
    mesh_weld(mesh);
    if (mesh->failed) return fail(MERLIN_NO_MEMORY, "no memory for the mesh");
    wind_outward(mesh);
    return OK;
}
