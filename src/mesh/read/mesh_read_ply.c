/* SPDX-License-Identifier: MIT */
#include "mesh/read/mesh_read_ply.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/file.h"
#include "mesh/read/mesh_limits.h"

enum { PROPERTIES = 32, ELEMENTS = 8, NAME = 32, POLYGON = 256, COUNT_LIMIT = 20000000 };

typedef enum number_type { I8, U8, I16, U16, I32, U32, F32, F64, NO_TYPE } number_type;

typedef struct property {
    char name[NAME];
    number_type type, count_type; /* count_type: NO_TYPE unless it is a list */
} property;

typedef struct element {
    char name[NAME];
    size_t count;
    int properties;
    property property[PROPERTIES];
} element;

typedef struct ply {
    bool binary;
    int elements;
    element element[ELEMENTS];
    const char *at, *end; /* rest of the file; *end is zero */
    triangle_mesh *mesh;
    double origin[3]; /* the first vertex */
    vec3 *normal;
    size_t normals;
} ply;

static number_type type_of(const char *word)
{
    static const char *const WORDS[][2] = {{"char", "int8"},     {"uchar", "uint8"},   {"short", "int16"},
                                           {"ushort", "uint16"}, {"int", "int32"},     {"uint", "uint32"},
                                           {"float", "float32"}, {"double", "float64"}};
    for (int i = 0; i < NO_TYPE; i++)
        if (strcmp(word, WORDS[i][0]) == 0 || strcmp(word, WORDS[i][1]) == 0) return (number_type)i;
    return NO_TYPE;
}

static status damaged(const char *what)
{
    return fail(MERLIN_BAD_INPUT, "damaged PLY: %s", what);
}

static status header_property(ply *p, const char *line)
{
    if (p->elements == 0) return damaged("a property of no element");
    element *e = &p->element[p->elements - 1];
    if (e->properties == PROPERTIES) return damaged("too many properties");
    property *q = &e->property[e->properties++];
    char type[NAME], count[NAME];
    q->count_type = NO_TYPE;
    if (sscanf(line, "property list %31s %31s %31s", count, type, q->name) == 3) {
        q->count_type = type_of(count);
        if (q->count_type >= F32) return damaged("a list's count is not a whole number");
    } else if (sscanf(line, "property %31s %31s", type, q->name) != 2) {
        return damaged("a property without type or name");
    }
    q->type = type_of(type);
    return q->type == NO_TYPE ? damaged("a property of unknown type") : OK;
}

static status header_line(ply *p, const char *line, bool *done)
{
    char word[NAME] = "", name[NAME];
    sscanf(line, "%31s", word);
    if (strcmp(word, "property") == 0) return header_property(p, line);
    if (strcmp(word, "end_header") == 0) {
        *done = true;
    } else if (strcmp(word, "format") == 0) {
        if (sscanf(line, "format %31s", name) != 1) return damaged("no format");
        p->binary = strcmp(name, "binary_little_endian") == 0;
        if (!p->binary && strcmp(name, "ascii") != 0)
            return fail(MERLIN_BAD_INPUT, "PLY of format %s; save it as ascii or binary_little_endian", name);
    } else if (strcmp(word, "element") == 0) {
        element *e = &p->element[p->elements];
        if (p->elements == ELEMENTS || sscanf(line, "element %31s %zu", e->name, &e->count) != 2)
            return damaged("an element without name or count");
        if (e->count > COUNT_LIMIT) return damaged("too many of an element");
        p->elements++;
    }
    return OK;
}

static status read_header(ply *p)
{
    if (strncmp(p->at, "ply", 3) != 0) return fail(MERLIN_BAD_INPUT, "not a PLY file");
    bool done = false;
    while (!done) {
        const char *newline = memchr(p->at, '\n', (size_t)(p->end - p->at));
        char line[256];
        if (!newline) return damaged("the header has no end");
        snprintf(line, sizeof line, "%.*s", (int)(newline - p->at < 255 ? newline - p->at : 255), p->at);
        p->at = newline + 1;
        status s = header_line(p, line, &done);
        if (s != OK) return s;
    }
    return OK;
}

/* Reads the next number; returns false at the end of the file. */
static bool read_number(ply *p, number_type type, double *value)
{
    static const size_t SIZES[] = {1, 1, 2, 2, 4, 4, 4, 8};
    if (!p->binary) {
        char *after;
        *value = strtod(p->at, &after);
        if (after == p->at) return false;
        p->at = after;
        return true;
    }
    if ((size_t)(p->end - p->at) < SIZES[type]) return false;
    union {
        int8_t i8;
        uint8_t u8;
        int16_t i16;
        uint16_t u16;
        int32_t i32;
        uint32_t u32;
        float f32;
        double f64;
    } u;
    memcpy(&u, p->at, SIZES[type]);
    p->at += SIZES[type];
    const double as[] = {[I8] = type == I8 ? u.i8 : 0,
                         [U8] = type == U8 ? u.u8 : 0,
                         [I16] = type == I16 ? u.i16 : 0,
                         [U16] = type == U16 ? u.u16 : 0,
                         [I32] = type == I32 ? u.i32 : 0,
                         [U32] = type == U32 ? u.u32 : 0,
                         [F32] = type == F32 ? (double)u.f32 : 0,
                         [F64] = type == F64 ? u.f64 : 0};
    *value = as[type];
    return true;
}

static status read_vertex(ply *p, const element *e)
{
    static const char *const NAMES[] = {"x", "y", "z", "nx", "ny", "nz"};
    double value[6] = {0};
    int found = 0;
    for (int i = 0; i < e->properties; i++) {
        const property *q = &e->property[i];
        double number;
        if (q->count_type != NO_TYPE) return damaged("a vertex with a list");
        if (!read_number(p, q->type, &number)) return damaged("it ends among the vertices");
        for (int k = 0; k < 6; k++) {
            if (strcmp(q->name, NAMES[k]) != 0) continue;
            value[k] = number;
            found |= 1 << k;
        }
    }
    for (int k = 0; k < 6; k++)
        if (!(fabs(value[k]) < 1e15)) return damaged("a vertex that is not finite");
    if ((found & 7) != 7) return damaged("vertices without x, y, z");
    if (found == 63)
        p->normal[p->normals++] = vec3_normalize(vec3_make((real)value[3], (real)value[4], (real)value[5]));
    /* relative to the first vertex: scans use national coordinates, which floats hold only to half metres */
    if (p->mesh->vertex_count == 0) memcpy(p->origin, value, sizeof p->origin);
    const double *o = p->origin;
    mesh_add_vertex(p->mesh, vec3_make((real)(value[0] - o[0]), (real)(value[1] - o[1]), (real)(value[2] - o[2])));
    return OK;
}

/* Reads a face, or skips the numbers of an element that is not needed. */
static status read_face(ply *p, const element *e, bool is_face)
{
    for (int i = 0; i < e->properties; i++) {
        const property *q = &e->property[i];
        double count = 1, number;
        uint32_t corner[POLYGON] = {0};
        bool list = q->count_type != NO_TYPE;
        bool polygon = is_face && list && strncmp(q->name, "vertex_ind", 10) == 0;
        if (list && !read_number(p, q->count_type, &count)) return damaged("it ends among the faces");
        if (!(count >= 0 && count <= (polygon ? POLYGON : COUNT_LIMIT))) return damaged("a list that is too long");
        for (int k = 0; k < (int)count; k++) {
            if (!read_number(p, q->type, &number)) return damaged("it ends among the faces");
            if (!polygon) continue;
            if (!(number >= 0 && number < (double)p->mesh->vertex_count))
                return damaged("a face of vertices that are not there");
            corner[k] = (uint32_t)number;
        }
        if (polygon) mesh_add_polygon(p->mesh, corner, (int)count, 0);
    }
    return OK;
}

static status read_elements(ply *p)
{
    for (int i = 0; i < p->elements; i++) {
        const element *e = &p->element[i];
        bool vertices = strcmp(e->name, "vertex") == 0, faces = strcmp(e->name, "face") == 0;
        if (e->count > (size_t)(p->end - p->at)) return damaged("it is shorter than its header says");
        if (vertices) {
            if (p->normal) return damaged("two sets of vertices");
            p->normal = malloc((e->count + 1) * sizeof *p->normal);
            if (!p->normal) return fail(MERLIN_NO_MEMORY, "no memory for the mesh");
        }
        for (size_t k = 0; k < e->count; k++) {
            status s = vertices ? read_vertex(p, e) : read_face(p, e, faces);
            if (s != OK) return s;
            if (p->mesh->failed) return fail(MERLIN_NO_MEMORY, "no memory for the mesh");
        }
    }
    return OK;
}

status mesh_parse_ply(const char *data, size_t size, triangle_mesh *mesh)
{
    ply p = {.at = data, .end = data + size, .mesh = mesh};
    status s = read_header(&p);
    if (s == OK) s = read_elements(&p);
    if (s == OK && p.normals > 0 && p.normals == mesh->vertex_count) {
        mesh->normal = p.normal;
        p.normal = NULL;
    }
    free(p.normal);
    return s;
}

status mesh_read_ply(const char *path, triangle_mesh *mesh)
{
    char *data;
    size_t size;
    status s = file_read(path, MESH_BYTES, &data, &size);
    if (s != OK) return s;
    s = mesh_parse_ply(data, size, mesh);
    free(data);
    return s;
}
