#include "scene/mesh_file.h"

#include <assimp/cimport.h>
#include <assimp/postprocess.h>
#include <assimp/scene.h>
#include <stdlib.h>
#include <sys/stat.h>

#include "base/file.h"
#include "base/library.h"
#include "scene/mesh_gltf.h"
#include "scene/mesh_obj.h"
#include "scene/mesh_ply.h"

enum { TRIANGLE_LIMIT = 5000000 };

/* Loaded when it is first needed. */
static struct {
    __typeof__(aiCreatePropertyStore) *create_settings;
    __typeof__(aiSetImportPropertyInteger) *set_integer;
    __typeof__(aiReleasePropertyStore) *release_settings;
    __typeof__(aiImportFileExWithProperties) *import;
    __typeof__(aiImportFileFromMemoryWithProperties) *import_text;
    __typeof__(aiReleaseImport) *release;
    __typeof__(aiGetErrorString) *error;
} assimp;

static const library_function wanted[] = {
    {"aiCreatePropertyStore", &assimp.create_settings},
    {"aiSetImportPropertyInteger", &assimp.set_integer},
    {"aiReleasePropertyStore", &assimp.release_settings},
    {"aiImportFileExWithProperties", &assimp.import},
    {"aiImportFileFromMemoryWithProperties", &assimp.import_text},
    {"aiReleaseImport", &assimp.release},
    {"aiGetErrorString", &assimp.error},
};
static library libassimp = {.file = MERLIN_ASSIMP, .functions = wanted, .count = sizeof wanted / sizeof *wanted};

static vec3 from_ai(struct aiVector3D v)
{
    return vec3_make((real)v.x, (real)v.y, (real)v.z);
}

static bool finite_vector(vec3 v)
{
    return isfinite(v.x) && isfinite(v.y) && isfinite(v.z) && fabsf(v.x) < 1e15f && fabsf(v.y) < 1e15f &&
           fabsf(v.z) < 1e15f;
}

static status add_mesh(scn_mesh *mesh, const struct aiMesh *from, vec3 *normal, uint8_t part)
{
    uint32_t first = mesh->vertex_count;
    for (unsigned i = 0; i < from->mNumVertices; i++) {
        vec3 p = from_ai(from->mVertices[i]);
        if (!finite_vector(p)) return fail(ERROR_INPUT, "a vertex that is not finite");
        if (normal) normal[mesh->vertex_count] = vec3_normalize(from_ai(from->mNormals[i]));
        mesh_add_vertex(mesh, p);
    }
    for (unsigned i = 0; i < from->mNumFaces; i++) {
        const struct aiFace *f = &from->mFaces[i];
        if (f->mNumIndices != 3) continue;
        const unsigned *v = f->mIndices;
        if (v[0] >= from->mNumVertices || v[1] >= from->mNumVertices || v[2] >= from->mNumVertices)
            return fail(ERROR_INPUT, "a face of vertices that are not there");
        mesh_add_triangle(mesh, first + v[0], first + v[1], first + v[2], part);
    }
    return mesh->failed ? fail(ERROR_MEMORY, "no memory for the mesh") : OK;
}

/* Above 0 where a triangle faces the way of its vertices' normals, below where it faces the other way. */
static float agreement(const scn_mesh *mesh, const uint32_t t[3])
{
    if (!mesh->normal) return 0;
    vec3 a = mesh->position[t[0]];
    vec3 n = vec3_cross(vec3_sub(mesh->position[t[1]], a), vec3_sub(mesh->position[t[2]], a));
    return vec3_dot(n, vec3_add(vec3_add(mesh->normal[t[0]], mesh->normal[t[1]]), mesh->normal[t[2]]));
}

/* Turns the triangles that wind against the file's normals, each on its own, for a mirrored part's do beside others
 * that do not; where there are none to tell, all when the surface winds around a negative volume. */
static void wind_outward(scn_mesh *mesh)
{
    mesh_normalize(mesh); /* centred, so that an open surface's volume has a sensible sign */
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

static status take_scene(const struct aiScene *scene, scn_mesh *mesh, int *parts)
{
    size_t vertices = 0, faces = 0;
    bool normals = true;
    for (unsigned i = 0; i < scene->mNumMeshes; i++) {
        vertices += scene->mMeshes[i]->mNumVertices;
        faces += scene->mMeshes[i]->mNumFaces;
        normals &= scene->mMeshes[i]->mNormals != NULL;
    }
    if (faces == 0) return fail(ERROR_INPUT, "no triangles in it");
    if (faces > TRIANGLE_LIMIT) return fail(ERROR_INPUT, "%zu triangles; at most %d", faces, TRIANGLE_LIMIT);
    vec3 *normal = normals ? malloc(vertices * sizeof *normal) : NULL;
    if (normals && !normal) return fail(ERROR_MEMORY, "no memory for the mesh");
    status s = OK;
    for (unsigned i = 0; i < scene->mNumMeshes && s == OK; i++)
        s = add_mesh(mesh, scene->mMeshes[i], normal, (uint8_t)(i % 32));
    mesh->normal = normal;
    *parts = scene->mNumMeshes < 32 ? (int)scene->mNumMeshes : 32;
    return s;
}

/* text: an OBJ's, which is not read from the file then; or NULL. */
static status import(const char *path, const char *text, size_t size, scn_mesh *mesh, int *parts)
{
    const unsigned steps = aiProcess_Triangulate | aiProcess_JoinIdenticalVertices | aiProcess_PreTransformVertices |
                           aiProcess_SortByPType;
    struct aiPropertyStore *settings = assimp.create_settings();
    if (!settings) return fail(ERROR_MEMORY, "no memory for the mesh");
    assimp.set_integer(settings, "PP_SBP_REMOVE", aiPrimitiveType_POINT | aiPrimitiveType_LINE);
    const struct aiScene *scene = text ? assimp.import_text(text, (unsigned)size, steps, "obj", settings)
                                       : assimp.import(path, steps, NULL, settings);
    assimp.release_settings(settings);
    if (!scene) return fail(ERROR_INPUT, "cannot read the mesh: %s", assimp.error());
    status s = take_scene(scene, mesh, parts);
    assimp.release(scene);
    return s;
}

static status read_by_assimp(const char *path, scn_mesh *mesh, int *parts)
{
    char *text = NULL;
    size_t size = 0;
    status s = file_ends_in(path, ".obj") ? mesh_tidy_obj(path, &text, &size) : mesh_check_gltf(path);
    if (s == OK) s = library_need(&libassimp);
    if (s == OK) s = import(path, text, size, mesh, parts);
    free(text);
    return s;
}

status mesh_read(const char *path, scn_mesh *mesh, int *parts)
{
    static const char *const by_assimp[] = {".obj", ".gltf", ".glb", NULL};
    bool is_ply = file_ends_in(path, ".ply");
    struct stat file;
    if (stat(path, &file) != 0) return fail(ERROR_INPUT, "no such file");
    if (!S_ISREG(file.st_mode)) return fail(ERROR_INPUT, "not a plain file"); /* assimp would wait for a pipe */
    if (!is_ply && !file_ends_in_any(path, by_assimp))
        return fail(ERROR_INPUT, "not a mesh that can be read; give .obj, .ply, .gltf or .glb");
    *parts = 1;
    status s = is_ply ? mesh_read_ply(path, mesh) : read_by_assimp(path, mesh, parts);
    if (s != OK) return s;
    if (mesh->triangle_count == 0) return fail(ERROR_INPUT, "no triangles in it");
    if (mesh->triangle_count > TRIANGLE_LIMIT)
        return fail(ERROR_INPUT, "%u triangles; at most %d", mesh->triangle_count, TRIANGLE_LIMIT);
    mesh_weld(mesh);
    if (mesh->failed) return fail(ERROR_MEMORY, "no memory for the mesh");
    wind_outward(mesh);
    return OK;
}
