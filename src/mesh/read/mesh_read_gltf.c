/* SPDX-License-Identifier: MIT */
#include "mesh/read/mesh_read_gltf.h"

#include <stdlib.h>
#include <string.h>

#include "mesh/read/gltf.h"
#include "mesh/read/mesh_limits.h"

enum { TRIANGLES = 4, STRIP = 5, FAN = 6 };

/* Triangles of one material. */
typedef struct primitive {
    gltf_accessor position, normal, index;
    bool has_normal, has_index;
    size_t mode, triangles;
    uint32_t material; /* UINT32_MAX: none */
    uint8_t part;
} primitive;

typedef struct reader {
    gltf *g;
    gltf_instance *instance;
    size_t instances;
    primitive *primitive;
    size_t primitives;
    size_t *first; /* index of a mesh's first primitive; one entry more than there are meshes */
    bool *shown;   /* per mesh: an instance shows it */
    bool smooth;   /* everything shown has normals */
    /* new index of a position: to[i], valid if stamp[i] is the current primitive's */
    uint32_t *stamp, *to, round;
    double origin[3];
    triangle_mesh *mesh;
} reader;

static status no_memory(void)
{
    return fail(MERLIN_NO_MEMORY, "no memory for the mesh");
}

/* ---- primitives ---- */

static size_t triangles_of(size_t mode, size_t corners)
{
    return mode == TRIANGLES ? corners / 3 : corners < 3 ? 0 : corners - 2;
}

static status read_attributes(gltf *g, const cJSON *about, primitive *p)
{
    const cJSON *attributes = cJSON_GetObjectItemCaseSensitive(about, "attributes");
    size_t position, normal, index;
    if (!gltf_whole(attributes, "POSITION", SIZE_MAX, &position) ||
        !gltf_whole(attributes, "NORMAL", SIZE_MAX, &normal) || !gltf_whole(about, "indices", SIZE_MAX, &index))
        return gltf_damaged("an accessor that is not there");
    if (position == SIZE_MAX) return OK;
    p->has_normal = normal != SIZE_MAX;
    p->has_index = index != SIZE_MAX;
    status s = gltf_find_accessor(g, position, &p->position);
    if (s == OK && p->has_normal) s = gltf_find_accessor(g, normal, &p->normal);
    if (s == OK && p->has_index) s = gltf_find_accessor(g, index, &p->index);
    if (s != OK) return s;
    if (p->position.components != GLTF_VEC3 || (p->has_normal && p->normal.components != GLTF_VEC3))
        return gltf_damaged("vertices or normals without x, y, z");
    if (p->has_normal && p->normal.count != p->position.count) return gltf_damaged("normals of other vertices");
    if (p->has_index && !gltf_holds_places(&p->index)) return gltf_damaged("corners that are no whole numbers");
    p->triangles = triangles_of(p->mode, p->has_index ? p->index.count : p->position.count);
    return OK;
}

/* Reads a primitive; points and lines are skipped. */
static status read_primitive(reader *r, const cJSON *about)
{
    size_t material;
    primitive p = {.material = UINT32_MAX};
    if (!gltf_whole(about, "mode", TRIANGLES, &p.mode) || p.mode > FAN) return gltf_damaged("a primitive of no kind");
    if (!gltf_whole(about, "material", UINT32_MAX, &material) || material > UINT32_MAX)
        return gltf_damaged("a material that is not there");
    if (p.mode < TRIANGLES) return OK;
    p.material = (uint32_t)material;
    status s = read_attributes(r->g, about, &p);
    if (s == OK && p.triangles > 0) r->primitive[r->primitives++] = p;
    return s;
}

static size_t count_primitives(const reader *r)
{
    size_t count = 0;
    const cJSON *item;
    for (size_t i = 0; i < r->g->meshes.count; i++)
        if (r->shown[i]) cJSON_ArrayForEach(item, cJSON_GetObjectItemCaseSensitive(r->g->meshes.at[i], "primitives"))
            {
                count++;
            }
    return count;
}

/* Reads the primitives of meshes that are shown; r->smooth tells whether all have normals. */
static status read_primitives(reader *r)
{
    status s = OK;
    size_t meshes = r->g->meshes.count;
    r->first = calloc(meshes + 1, sizeof *r->first);
    r->shown = calloc(meshes + 1, sizeof *r->shown);
    if (!r->first || !r->shown) return no_memory();
    for (size_t i = 0; i < r->instances; i++)
        r->shown[r->instance[i].mesh] = true;
    r->primitive = calloc(count_primitives(r) + 1, sizeof *r->primitive);
    if (!r->primitive) return no_memory();
    for (size_t i = 0; s == OK && i < meshes; i++) {
        const cJSON *item;
        cJSON_ArrayForEach(item, cJSON_GetObjectItemCaseSensitive(r->g->meshes.at[i], "primitives"))
        {
            if (s == OK && r->shown[i]) s = read_primitive(r, item);
        }
        r->first[i + 1] = r->primitives;
    }
    r->smooth = true;
    for (size_t i = 0; i < r->primitives; i++)
        r->smooth &= r->primitive[i].has_normal;
    return s;
}

/* ---- parts ---- */

static int compare_materials(const void *a, const void *b)
{
    uint32_t one = *(const uint32_t *)a, other = *(const uint32_t *)b;
    return (one > other) - (one < other);
}

/* Numbers the parts: the materials that are shown, in order; primitives without a material are the last part. */
static status name_parts(reader *r, int *parts)
{
    uint32_t *material = malloc((r->primitives + 1) * sizeof *material);
    size_t count = 0;
    if (!material) return no_memory();
    for (size_t i = 0; i < r->primitives; i++)
        material[i] = r->primitive[i].material;
    qsort(material, r->primitives, sizeof *material, compare_materials);
    for (size_t i = 0; i < r->primitives; i++)
        if (count == 0 || material[count - 1] != material[i]) material[count++] = material[i];
    for (size_t i = 0; i < r->primitives; i++) {
        const uint32_t *at = bsearch(&r->primitive[i].material, material, count, sizeof *material, compare_materials);
        r->primitive[i].part = (uint8_t)((at - material) % MESH_PARTS);
    }
    *parts = count < MESH_PARTS ? (int)count : MESH_PARTS;
    free(material);
    return OK;
}

/* ---- triangles ---- */

/* Returns the determinant of the transform's linear part, below 0 if it mirrors. */
static double determinant(const double *m)
{
    return m[0] * (m[5] * m[10] - m[6] * m[9]) - m[1] * (m[4] * m[10] - m[6] * m[8]) +
           m[2] * (m[4] * m[9] - m[5] * m[8]);
}

/* Transforms a normal by the cofactors, the inverse's transpose up to length. */
static vec3 turn_normal(const double *m, const double *n)
{
    double sign = determinant(m) < 0 ? -1 : 1, out[3], length = 0;
    for (int row = 0; row < 3; row++) {
        const double *a = m + 4 * ((row + 1) % 3), *b = m + 4 * ((row + 2) % 3);
        out[row] = sign * (n[0] * (a[1] * b[2] - a[2] * b[1]) + n[1] * (a[2] * b[0] - a[0] * b[2]) +
                           n[2] * (a[0] * b[1] - a[1] * b[0]));
        length += out[row] * out[row];
    }
    length = length > 0 && isfinite(length) ? sqrt(length) : 1;
    return vec3_make((real)(out[0] / length), (real)(out[1] / length), (real)(out[2] / length));
}

static status add_vertex(reader *r, const primitive *p, const double *m, size_t place, uint32_t *out)
{
    double from[4], n[4], to[3];
    gltf_numbers(&p->position, place, from);
    for (int row = 0; row < 3; row++) {
        const double *line = m + 4 * row;
        to[row] = line[0] * from[0] + line[1] * from[1] + line[2] * from[2] + (line[3] - r->origin[row]);
        if (!(fabs(to[row]) < 1e15)) return fail(MERLIN_BAD_INPUT, "a vertex that is not finite");
    }
    *out = mesh_add_vertex(r->mesh, vec3_make((real)to[0], (real)to[1], (real)to[2]));
    if (r->mesh->failed) return no_memory();
    if (!r->smooth) return OK;
    gltf_numbers(&p->normal, place, n);
    for (int k = 0; k < 3; k++)
        if (!(fabs(n[k]) < 1e15)) return fail(MERLIN_BAD_INPUT, "a normal that is not finite");
    r->mesh->normal[*out] = turn_normal(m, n);
    return OK;
}

/* Returns the corners of triangle t, in the primitive's numbering. */
static void corners_of(size_t mode, size_t t, size_t corner[3])
{
    size_t odd = mode == STRIP ? t % 2 : 0, first = mode == TRIANGLES ? 3 * t : t;
    corner[0] = mode == FAN ? 0 : first;
    corner[1] = first + 1 + odd;
    corner[2] = first + 2 - odd;
}

/* Adds a triangle and those of its vertices that the mesh does not have yet: many primitives may share one large list.
 */
static status add_triangle(reader *r, const primitive *p, const double *m, size_t t, bool mirrored)
{
    size_t corner[3];
    uint32_t v[3];
    corners_of(p->mode, t, corner);
    for (int k = 0; k < 3; k++) {
        size_t place = p->has_index ? gltf_place(&p->index, corner[k]) : corner[k];
        if (place >= p->position.count) return gltf_damaged("a face of vertices that are not there");
        status s = r->stamp[place] == r->round ? OK : add_vertex(r, p, m, place, &r->to[place]);
        if (s != OK) return s;
        r->stamp[place] = r->round;
        v[k] = r->to[place];
    }
    mesh_add_triangle(r->mesh, v[0], v[mirrored ? 2 : 1], v[mirrored ? 1 : 2], p->part);
    return r->mesh->failed ? no_memory() : OK;
}

/* Returns the most vertices that a primitive can add: those of its triangles, or its positions. */
static size_t most_vertices(const primitive *p)
{
    return 3 * p->triangles < p->position.count ? 3 * p->triangles : p->position.count;
}

/* Counts vertices and triangles before anything is added, and allocates room. */
static status prepare(reader *r)
{
    size_t triangles = 0, vertices = 0, longest = 0, most = mesh_most_triangles(r->g->bytes);
    for (size_t i = 0; i < r->instances; i++)
        for (size_t k = r->first[r->instance[i].mesh]; k < r->first[r->instance[i].mesh + 1]; k++) {
            const primitive *p = &r->primitive[k];
            triangles += p->triangles;
            vertices += most_vertices(p);
            if (p->position.count > longest) longest = p->position.count;
            if (triangles > most) return fail(MERLIN_BAD_INPUT, "more than %zu triangles", most);
        }
    if (triangles == 0) return fail(MERLIN_BAD_INPUT, "no triangles in it");
    for (int row = 0; row < 3; row++) /* coordinates may be too large for floats */
        r->origin[row] = r->instance[0].m[4 * row + 3];
    r->stamp = calloc(longest + 1, sizeof *r->stamp);
    r->to = calloc(longest + 1, sizeof *r->to);
    if (r->smooth) r->mesh->normal = malloc((vertices + 1) * sizeof *r->mesh->normal);
    return r->stamp && r->to && (!r->smooth || r->mesh->normal) ? OK : no_memory();
}

static status add_instance(reader *r, const gltf_instance *instance)
{
    bool mirrored = determinant(instance->m) < 0;
    status s = OK;
    for (size_t k = r->first[instance->mesh]; s == OK && k < r->first[instance->mesh + 1]; k++) {
        const primitive *p = &r->primitive[k];
        r->round++;
        for (size_t t = 0; s == OK && t < p->triangles; t++)
            s = add_triangle(r, p, instance->m, t, mirrored);
    }
    return s;
}

static status read_scene(reader *r, int *parts)
{
    status s = gltf_place_meshes(r->g, &r->instance, &r->instances);
    if (s == OK) s = read_primitives(r);
    if (s == OK) s = name_parts(r, parts);
    if (s == OK) s = prepare(r);
    for (size_t i = 0; s == OK && i < r->instances; i++)
        s = add_instance(r, &r->instance[i]);
    free(r->instance);
    free(r->primitive);
    free(r->first);
    free(r->shown);
    free(r->stamp);
    free(r->to);
    return s;
}

status mesh_parse_gltf(const void *bytes, size_t size, const char *folder, triangle_mesh *mesh, int *parts)
{
    reader r = {.mesh = mesh};
    *parts = 0;
    status s = gltf_parse(bytes, size, folder, &r.g);
    if (s == OK) s = read_scene(&r, parts);
    gltf_close(r.g);
    return s;
}

status mesh_read_gltf(const char *path, triangle_mesh *mesh, int *parts)
{
    file_view file;
    status s = file_map(path, MESH_BYTES, &file);
    if (s != OK) return s;
    char *folder = file_folder_of(path);
    s = folder ? mesh_parse_gltf(file.data, file.size, folder, mesh, parts) : no_memory();
    free(folder);
    file_unmap(&file);
    return s;
}
