/* SPDX-License-Identifier: MIT */
/* Writes GLB: binary glTF 2.0 (Khronos, ISO/IEC 12113), one buffer; albedo, a tangent-space normal map and roughness as
 * embedded PNGs. glTF's roughness is that of docs/conventions.md: both square it to the width of the lobe.
 *
 * Vertex normals are the triangles'; the normal map holds the photometric normals' difference to them, so that a
 * decimated mesh keeps its shading. Tangents run along the picture's rows, x to the right and y up. */
#include <cjson/cJSON.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/file.h"
#include "base/json/json_put.h"
#include "base/vec.h"
#include "image/write/write.h"
#include "mesh/write/mesh_formats.h"
#include "mesh/write/mesh_normal_map.h"

enum { FLOAT = 5126, UNSIGNED_INT = 5125, ARRAY_BUFFER = 34962, ELEMENT_ARRAY_BUFFER = 34963, TRIANGLES = 4 };
enum { HEADER = 12, CHUNK_HEADER = 8, MOST_PARTS = 8 };
static const size_t LARGEST_PICTURE = (size_t)1 << 30;

/* A range of the buffer and its description. */
typedef struct part {
    const void *data;
    size_t size, count;
    const char *type; /* accessor type; NULL: a picture */
    int component, target;
    float low[3], high[3];
    bool bounded;
} part;

typedef struct glb {
    part parts[MOST_PARTS];
    int count;
    float *tangent;
    bool matte;
    char *albedo, *normal, *roughness; /* PNG files in memory, or NULL */
    int albedo_part, normal_part, roughness_part, tangent_part;
    double scale; /* of the scene: viewers take a unit for a metre */
} glb;

/* ---- parts ---- */

static int add_part(glb *g, part p)
{
    g->parts[g->count] = p;
    return g->count++;
}

static status add_tangents(glb *g, const merlin_mesh *m)
{
    g->tangent = malloc(4 * m->vertex_count * sizeof *g->tangent);
    if (!g->tangent) return fail(MERLIN_NO_MEMORY, "no memory for a mesh of %zu vertices", m->vertex_count);
    for (size_t v = 0; v < m->vertex_count; v++) {
        vec3 t = mesh_tangent_of(vec3_of(mesh_base_normals(m) + 3 * v));
        float *to = g->tangent + 4 * v;
        vec3_put(t, to);
        to[3] = 1;
    }
    g->tangent_part = add_part(g, (part){.data = g->tangent,
                                         .size = 4 * m->vertex_count * sizeof(float),
                                         .count = m->vertex_count,
                                         .type = "VEC4",
                                         .component = FLOAT,
                                         .target = ARRAY_BUFFER});
    return OK;
}

/* Adds parts 0 to 3: positions with their bounds, normals, texture coordinates, triangles. */
static void add_geometry(glb *g, const merlin_mesh *m)
{
    const size_t n = m->vertex_count, corners = 3 * m->triangle_count;
    part position = {m->positions, 3 * n * sizeof(float), n, "VEC3", FLOAT, ARRAY_BUFFER, {0}, {0}, true};
    for (int c = 0; c < 3; c++) {
        position.low[c] = position.high[c] = m->positions[c];
        for (size_t v = 1; v < n; v++) {
            float x = m->positions[3 * v + (size_t)c];
            if (x < position.low[c]) position.low[c] = x;
            if (x > position.high[c]) position.high[c] = x;
        }
    }
    add_part(g, position);
    add_part(g, (part){mesh_base_normals(m), 3 * n * sizeof(float), n, "VEC3", FLOAT, ARRAY_BUFFER, {0}, {0}, false});
    add_part(g, (part){m->uvs, 2 * n * sizeof(float), n, "VEC2", FLOAT, ARRAY_BUFFER, {0}, {0}, false});
    add_part(g, (part){m->triangles,
                       corners * sizeof *m->triangles,
                       corners,
                       "SCALAR",
                       UNSIGNED_INT,
                       ELEMENT_ARRAY_BUFFER,
                       {0},
                       {0},
                       false});
}

/* ---- pictures ---- */

/* Encodes a PNG by way of a temporary file beside the mesh. */
static status png_bytes(const char *beside, const img *picture, img_encoding encoding, char **bytes, size_t *size)
{
    char *name = NULL, *temporary = NULL;
    if (asprintf(&name, "%s.png", beside) < 0) return fail(MERLIN_NO_MEMORY, "no memory for a file name");
    status s = file_temporary(name, &temporary);
    if (s == OK) {
        s = img_write_png(temporary, picture, encoding);
        if (s == OK) s = file_read(temporary, LARGEST_PICTURE, bytes, size);
        file_discard(temporary);
    }
    free(name);
    return s;
}

static status add_albedo(glb *g, const char *path, const img *albedo)
{
    size_t size = 0;
    status s = png_bytes(path, albedo, IMG_SRGB8, &g->albedo, &size);
    if (s == OK) g->albedo_part = add_part(g, (part){.data = g->albedo, .size = size});
    return s;
}

static status add_normal_map(glb *g, const char *path, const merlin_mesh *m)
{
    img map = {0};
    size_t size = 0;
    status s = mesh_normal_map(m, &map);
    if (s == OK) s = png_bytes(path, &map, IMG_LINEAR8, &g->normal, &size);
    img_free(&map);
    if (s == OK) g->normal_part = add_part(g, (part){.data = g->normal, .size = size});
    return s;
}

/* Adds roughness, which glTF stores in green, with metalness in blue. */
static status add_roughness(glb *g, const char *path, const img *roughness)
{
    img map = {0};
    size_t size = 0;
    status s = img_new(&map, roughness->width, roughness->height, 3);
    if (s != OK) return s;
    size_t count = (size_t)map.width * (size_t)map.height;
    for (size_t i = 0; i < count; i++)
        map.data[3 * i + 1] = roughness->data[i];
    s = png_bytes(path, &map, IMG_LINEAR8, &g->roughness, &size);
    img_free(&map);
    if (s == OK) g->roughness_part = add_part(g, (part){.data = g->roughness, .size = size});
    return s;
}

/* ---- the JSON ---- */

static size_t padded(size_t size)
{
    return (size + 3) & ~(size_t)3;
}

static void put_bounds(cJSON *accessor, const char *name, const float bound[3])
{
    cJSON *a = json_put_array(accessor, name);
    for (int c = 0; c < 3; c++)
        json_append(a, cJSON_CreateNumber((double)bound[c]));
}

/* Writes the parts. Accessors have the first numbers, so that an accessor has the number of its view; pictures follow.
 */
static void put_parts(cJSON *root, const glb *g)
{
    cJSON *views = json_put_array(root, "bufferViews"), *accessors = json_put_array(root, "accessors");
    size_t offset = 0;
    for (int i = 0; i < g->count; i++) {
        const part *p = &g->parts[i];
        cJSON *view = json_append_object(views);
        json_put_number(view, "buffer", 0);
        json_put_number(view, "byteOffset", (double)offset);
        json_put_number(view, "byteLength", (double)p->size);
        offset += padded(p->size);
        if (!p->type) continue;
        json_put_number(view, "target", p->target);
        cJSON *accessor = json_append_object(accessors);
        json_put_number(accessor, "bufferView", i);
        json_put_number(accessor, "componentType", p->component);
        json_put_number(accessor, "count", (double)p->count);
        json_put_text(accessor, "type", p->type);
        if (p->bounded) {
            put_bounds(accessor, "min", p->low);
            put_bounds(accessor, "max", p->high);
        }
    }
    cJSON *buffers = json_put_array(root, "buffers");
    json_put_number(json_append_object(buffers), "byteLength", (double)offset);
}

/* Writes a texture of the picture in that part; does nothing if there is none. */
static void put_texture(cJSON *root, cJSON *user, const char *name, int picture)
{
    if (picture < 0) return;
    cJSON *images = cJSON_GetObjectItem(root, "images"), *textures = cJSON_GetObjectItem(root, "textures");
    if (!images) images = json_put_array(root, "images");
    if (!textures) textures = json_put_array(root, "textures");
    int number = cJSON_GetArraySize(images);
    cJSON *image = json_append_object(images);
    json_put_number(image, "bufferView", picture);
    json_put_text(image, "mimeType", "image/png");
    json_put_number(json_append_object(textures), "source", number);
    json_put_number(json_put_object(user, name), "index", number);
}

/* Takes the gloss away, which is that of a dielectric otherwise. */
static void put_matte(cJSON *root, cJSON *material)
{
    static const char name[] = "KHR_materials_specular";
    json_put_number(json_put_object(json_put_object(material, "extensions"), name), "specularFactor", 0);
    json_append_text(json_put_array(root, "extensionsUsed"), name);
}

static void put_material(cJSON *root, const glb *g)
{
    cJSON *material = json_append_object(json_put_array(root, "materials"));
    json_put_text(material, "name", "surface");
    cJSON *pbr = json_put_object(material, "pbrMetallicRoughness");
    json_put_number(pbr, "metallicFactor", 0);
    json_put_number(pbr, "roughnessFactor", 1);
    put_texture(root, pbr, "baseColorTexture", g->albedo_part);
    put_texture(root, pbr, "metallicRoughnessTexture", g->roughness_part);
    put_texture(root, material, "normalTexture", g->normal_part);
    json_put_bool(material, "doubleSided", true);
    if (g->matte) put_matte(root, material);
}

static void put_scene(cJSON *root, const glb *g)
{
    cJSON *asset = json_put_object(root, "asset");
    json_put_text(asset, "version", "2.0");
    json_put_text(asset, "generator", "merlin");
    json_put_number(root, "scene", 0);
    cJSON *nodes = json_put_array(json_append_object(json_put_array(root, "scenes")), "nodes");
    json_append(nodes, cJSON_CreateNumber(0));
    cJSON *node = json_append_object(json_put_array(root, "nodes"));
    json_put_number(node, "mesh", 0);
    json_put_item(node, "scale", cJSON_CreateDoubleArray((const double[]){g->scale, g->scale, g->scale}, 3));
    cJSON *primitives = json_put_array(json_append_object(json_put_array(root, "meshes")), "primitives");
    cJSON *primitive = json_append_object(primitives), *attributes = json_put_object(primitive, "attributes");
    json_put_number(attributes, "POSITION", 0);
    json_put_number(attributes, "NORMAL", 1);
    json_put_number(attributes, "TEXCOORD_0", 2);
    if (g->tangent_part >= 0) json_put_number(attributes, "TANGENT", g->tangent_part);
    json_put_number(primitive, "indices", 3);
    json_put_number(primitive, "material", 0);
    json_put_number(primitive, "mode", TRIANGLES);
}

/* ---- the file ---- */

static void put_u32(FILE *f, size_t x)
{
    uint8_t bytes[4] = {(uint8_t)x, (uint8_t)(x >> 8), (uint8_t)(x >> 16), (uint8_t)(x >> 24)};
    fwrite(bytes, 1, 4, f);
}

static void put_padded(FILE *f, const void *data, size_t size, int filler)
{
    fwrite(data, 1, size, f);
    for (size_t i = size; i < padded(size); i++)
        fputc(filler, f);
}

/* Padded sizes for the file's header. */
typedef struct chunks {
    const glb *g;
    const char *json;
    size_t text, binary, total;
} chunks;

static void write_chunks(FILE *f, const void *context)
{
    const chunks *c = context;
    fputs("glTF", f);
    put_u32(f, 2);
    put_u32(f, c->total);
    put_u32(f, c->text);
    fputs("JSON", f);
    put_padded(f, c->json, strlen(c->json), ' ');
    put_u32(f, c->binary);
    fwrite("BIN", 1, 4, f);
    for (int i = 0; i < c->g->count; i++)
        put_padded(f, c->g->parts[i].data, c->g->parts[i].size, 0);
}

static status write_file(const char *path, const glb *g, const char *json)
{
    chunks c = {.g = g, .json = json, .text = padded(strlen(json))};
    for (int i = 0; i < g->count; i++)
        c.binary += padded(g->parts[i].size);
    c.total = HEADER + 2 * (size_t)CHUNK_HEADER + c.text + c.binary;
    if (c.total > UINT32_MAX)
        return fail(MERLIN_CANNOT_WRITE, "cannot write %s: a GLB holds at most 4 GiB; use .ply", path);
    return file_print(path, write_chunks, &c);
}

static status assemble(const char *path, const glb *g)
{
    cJSON *root = cJSON_CreateObject();
    put_scene(root, g);
    put_material(root, g);
    put_parts(root, g);
    char *json = json_print_line(root);
    cJSON_Delete(root);
    if (!json) return fail(MERLIN_NO_MEMORY, "no memory to write %s", path);
    status s = write_file(path, g, json);
    free(json);
    return s;
}

status mesh_write_glb(const char *path, const merlin_mesh *m)
{
    if (m->triangle_count == 0)
        return fail(MERLIN_BAD_INPUT,
                    "cannot write %s: the surface has no triangle; its mask is too thin, or depth jumps everywhere",
                    path);
    glb g = {.matte = m->matte != 0,
             .albedo_part = -1,
             .normal_part = -1,
             .roughness_part = -1,
             .tangent_part = -1,
             .scale = 1};
    if (m->scale > 0) g.scale = m->scale;
    add_geometry(&g, m);
    status s = m->face_normals ? add_tangents(&g, m) : OK;
    if (s == OK && m->albedo.data) s = add_albedo(&g, path, &m->albedo);
    if (s == OK && m->face_normals) s = add_normal_map(&g, path, m);
    if (s == OK && m->roughness.data) s = add_roughness(&g, path, &m->roughness);
    if (s == OK) s = assemble(path, &g);
    free(g.tangent);
    free(g.albedo);
    free(g.normal);
    free(g.roughness);
    return s;
}
