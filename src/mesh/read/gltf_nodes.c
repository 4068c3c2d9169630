/* SPDX-License-Identifier: MIT */
/* Nodes: which meshes a scene shows, and where. */
#include <math.h>
#include <stdlib.h>

#include "mesh/read/gltf.h"

/* Nodes in the order in which they are visited, each before its children. */
typedef struct walk {
    const gltf *g;
    struct placed {
        size_t node;
        double m[12];
    } * placed;
    bool *met;
    size_t count;
} walk;

static const double identity[12] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0};

/* Reads the numbers of an array; returns false if it has another length. */
static bool take_numbers(const cJSON *array, int count, double *out)
{
    const cJSON *item;
    int i = 0;
    cJSON_ArrayForEach(item, array)
    {
        if (i == count || !cJSON_IsNumber(item)) return false;
        out[i++] = item->valuedouble;
    }
    return i == count;
}

/* Computes the rotation by the quaternion q of x, y, z, w, each column scaled. */
static void rotation(const double *q, const double *scale, double *m)
{
    double norm = q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3], s = norm > 0 ? 2 / norm : 0;
    double x = q[0], y = q[1], z = q[2], w = q[3];
    const double r[9] = {1 - s * (y * y + z * z), s * (x * y - z * w),     s * (x * z + y * w),
                         s * (x * y + z * w),     1 - s * (x * x + z * z), s * (y * z - x * w),
                         s * (x * z - y * w),     s * (y * z + x * w),     1 - s * (x * x + y * y)};
    for (int row = 0; row < 3; row++)
        for (int column = 0; column < 3; column++)
            m[4 * row + column] = r[3 * row + column] * scale[column];
}

static status read_transform(const cJSON *node, double m[12])
{
    const cJSON *matrix = cJSON_GetObjectItemCaseSensitive(node, "matrix");
    double columns[16];
    if (matrix) {
        if (!take_numbers(matrix, 16, columns)) return gltf_damaged("a matrix of other than 16 numbers");
        for (int row = 0; row < 3; row++)
            for (int column = 0; column < 4; column++)
                m[4 * row + column] = columns[4 * column + row];
        return OK;
    }
    double q[4] = {0, 0, 0, 1}, scale[3] = {1, 1, 1}, move[3] = {0, 0, 0};
    const cJSON *t = cJSON_GetObjectItemCaseSensitive(node, "translation");
    const cJSON *r = cJSON_GetObjectItemCaseSensitive(node, "rotation");
    const cJSON *s = cJSON_GetObjectItemCaseSensitive(node, "scale");
    if ((t && !take_numbers(t, 3, move)) || (r && !take_numbers(r, 4, q)) || (s && !take_numbers(s, 3, scale)))
        return gltf_damaged("a node's place that is not whole");
    rotation(q, scale, m);
    for (int row = 0; row < 3; row++)
        m[4 * row + 3] = move[row];
    return OK;
}

static void multiply(const double *a, const double *b, double *out)
{
    for (int row = 0; row < 3; row++)
        for (int column = 0; column < 4; column++) {
            double sum = column == 3 ? a[4 * row + 3] : 0;
            for (int k = 0; k < 3; k++)
                sum += a[4 * row + k] * b[4 * k + column];
            out[4 * row + column] = sum;
        }
}

static status meet(walk *w, size_t node, const double *parent)
{
    if (node >= w->g->nodes.count) return gltf_damaged("a node that is not there");
    if (w->met[node]) return fail(MERLIN_BAD_INPUT, "damaged glTF: node %zu has two parents", node);
    w->met[node] = true;
    double own[12] = {0};
    status s = read_transform(w->g->nodes.at[node], own);
    if (s != OK) return s;
    struct placed *p = &w->placed[w->count++];
    p->node = node;
    multiply(parent, own, p->m);
    return OK;
}

static status meet_all(walk *w, const cJSON *numbers, const double *parent)
{
    const cJSON *item;
    status s = OK;
    cJSON_ArrayForEach(item, numbers)
    {
        if (s != OK) break;
        if (!cJSON_IsNumber(item) || !(item->valuedouble >= 0)) return gltf_damaged("a node that is not there");
        s = meet(w, item->valuedouble < 0x1p48 ? (size_t)item->valuedouble : SIZE_MAX, parent);
    }
    return s;
}

/* Visits the nodes that are no node's children, for a document without scenes. */
static status meet_roots(walk *w)
{
    size_t count = w->g->nodes.count;
    bool *child = calloc(count + 1, sizeof *child);
    if (!child) return fail(MERLIN_NO_MEMORY, "no memory for the mesh");
    for (size_t i = 0; i < count; i++) {
        const cJSON *item;
        cJSON_ArrayForEach(item, cJSON_GetObjectItemCaseSensitive(w->g->nodes.at[i], "children"))
        {
            if (item->valuedouble >= 0 && item->valuedouble < (double)count) child[(size_t)item->valuedouble] = true;
        }
    }
    status s = OK;
    for (size_t i = 0; s == OK && i < count; i++)
        if (!child[i]) s = meet(w, i, identity);
    free(child);
    return s;
}

static status meet_scene(walk *w)
{
    const cJSON *array = cJSON_GetObjectItemCaseSensitive(w->g->root, "scenes");
    size_t scene;
    if (cJSON_GetArraySize(array) == 0) return meet_roots(w);
    if (!gltf_whole(w->g->root, "scene", 0, &scene) || scene >= (size_t)cJSON_GetArraySize(array))
        return gltf_damaged("a scene that is not there");
    return meet_all(w, cJSON_GetObjectItemCaseSensitive(cJSON_GetArrayItem(array, (int)scene), "nodes"), identity);
}

static status walk_nodes(walk *w)
{
    status s = meet_scene(w);
    for (size_t i = 0; s == OK && i < w->count; i++) {
        const cJSON *node = w->g->nodes.at[w->placed[i].node];
        s = meet_all(w, cJSON_GetObjectItemCaseSensitive(node, "children"), w->placed[i].m);
    }
    return s;
}

static status collect(const walk *w, gltf_instance *out, size_t *count)
{
    for (size_t i = 0; i < w->count; i++) {
        size_t mesh;
        const cJSON *node = w->g->nodes.at[w->placed[i].node];
        if (!gltf_whole(node, "mesh", SIZE_MAX, &mesh)) return gltf_damaged("a mesh that is not there");
        if (mesh == SIZE_MAX) continue;
        if (mesh >= w->g->meshes.count) return gltf_damaged("a mesh that is not there");
        out[*count].mesh = mesh;
        for (int k = 0; k < 12; k++)
            out[*count].m[k] = w->placed[i].m[k];
        ++*count;
    }
    return OK;
}

status gltf_place_meshes(const gltf *g, gltf_instance **out, size_t *count)
{
    size_t room = g->nodes.count + 1;
    walk w = {.g = g, .placed = calloc(room, sizeof *w.placed), .met = calloc(room, sizeof *w.met)};
    *out = NULL;
    *count = 0;
    status s = w.placed && w.met ? walk_nodes(&w) : fail(MERLIN_NO_MEMORY, "no memory for the mesh");
    if (s == OK && !(*out = calloc(w.count + 1, sizeof **out))) s = fail(MERLIN_NO_MEMORY, "no memory for the mesh");
    if (s == OK) s = collect(&w, *out, count);
    free(w.placed);
    free(w.met);
    return s;
}
