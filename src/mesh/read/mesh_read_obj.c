/* SPDX-License-Identifier: MIT */
#include "mesh/read/mesh_read_obj.h"

#include <stdlib.h>
#include <string.h>

#include "base/file.h"
#include "mesh/read/mesh_limits.h"

enum { CORNERS = 1024, MATERIALS = 256, NAME = 128, COUNT_LIMIT = 20000000 };

/* A corner's indices into the lists of vertices and normals, from 0. */
typedef struct corner {
    uint32_t vertex, normal; /* normal: UINT32_MAX without one */
} corner;

/* A growing list of triples. */
typedef struct triples {
    double (*at)[3];
    size_t count, room;
} triples;

/* A vertex of the mesh at a position of the file, for one of the normals there. */
typedef struct twin {
    uint32_t normal, index, next;
} twin;

typedef struct obj {
    const char *at, *end; /* rest of the text; *end is zero */
    size_t line;
    triples vertex, normal;
    size_t vertices, normals; /* how many precede the current line: negative indices count from there */
    bool smooth;              /* every corner has a normal */
    double origin[3];
    twin *twins;
    uint32_t *first_twin; /* per vertex, + 1; 0: none yet */
    size_t twin_count, twin_room;
    char material[MATERIALS][NAME];
    int materials, current; /* current: material of the following faces; -1 until one is named */
    int part_of[MATERIALS + 1];
    int parts;
    size_t most;
    triangle_mesh *mesh;
} obj;

static status damaged(const obj *o, const char *what)
{
    return fail(MERLIN_BAD_INPUT, "line %zu: %s", o->line, what);
}

/* ---- words ---- */

/* Returns the length of a backslash and the line end that it continues; 0 if there is none. */
static size_t continuation(const char *at)
{
    if (*at != '\\') return 0;
    return at[1] == '\n' ? 2 : at[1] != '\r' ? 0 : at[2] == '\n' ? 3 : 2;
}

static void skip_blanks(obj *o)
{
    for (;;) {
        size_t passed = continuation(o->at);
        o->line += passed > 0;
        if (*o->at == ' ' || *o->at == '\t' || *o->at == '\v' || *o->at == '\f') passed = 1;
        if (passed == 0) return;
        o->at += passed;
    }
}

static bool ends_line(const obj *o)
{
    return o->at >= o->end || *o->at == '\n' || *o->at == '\r' || *o->at == '#' || *o->at == 0;
}

/* Skips the rest of a line, with its continuations. */
static void skip_rest(obj *o)
{
    for (skip_blanks(o); !ends_line(o); skip_blanks(o))
        o->at++;
}

static void next_line(obj *o)
{
    o->at += strcspn(o->at, "\n\r");
    o->at += o->at[0] == '\r' && o->at[1] == '\n' ? 2 : 1;
    o->line++;
}

/* Tells whether the line begins with this word, and then skips it. */
static bool takes_word(obj *o, const char *word)
{
    size_t length = strlen(word);
    if (strncmp(o->at, word, length) != 0) return false;
    char after = o->at[length];
    if (after != ' ' && after != '\t' && after != '\\') return false;
    o->at += length;
    return true;
}

/* ---- lists ---- */

static status add_triple(obj *o, triples *list)
{
    if (list->count == COUNT_LIMIT) return damaged(o, "too many vertices");
    if (list->count == list->room) {
        size_t room = list->room ? 2 * list->room : 4096;
        void *larger = realloc(list->at, room * sizeof *list->at);
        if (!larger) return fail(MERLIN_NO_MEMORY, "no memory for the mesh");
        list->at = larger;
        list->room = room;
    }
    double *to = list->at[list->count++];
    for (int k = 0; k < 3; k++) {
        skip_blanks(o);
        char *after;
        if (ends_line(o)) return damaged(o, "three numbers are wanted");
        to[k] = strtod(o->at, &after);
        if (after == o->at) return damaged(o, "a number is wanted");
        if (!(fabs(to[k]) < 1e15)) return damaged(o, "a vertex that is not finite");
        o->at = after;
    }
    skip_rest(o);
    return OK;
}

/* Tells whether a number begins here, rather than the end of the line, which strtoll would skip. */
static bool begins_number(const obj *o)
{
    return (*o->at >= '0' && *o->at <= '9') || *o->at == '-' || *o->at == '+';
}

/* Reads an index into a list, from 1 or, if negative, from its current end; COUNT_LIMIT, which is never used, if it is
 * outside. */
static status take_place(obj *o, size_t so_far, uint32_t *place)
{
    char *after = NULL;
    long long number = begins_number(o) ? strtoll(o->at, &after, 10) : 0;
    if (number == 0) return damaged(o, "a face's corner is v, v/vt, v//vn or v/vt/vn, from 1");
    o->at = after;
    long long from_0 = number > 0 ? number - 1 : number + (long long)so_far;
    *place = from_0 >= 0 && from_0 < COUNT_LIMIT ? (uint32_t)from_0 : COUNT_LIMIT;
    return OK;
}

static status take_corner(obj *o, corner *c)
{
    uint32_t ignored;
    *c = (corner){.normal = UINT32_MAX};
    status s = take_place(o, o->vertices, &c->vertex);
    if (s != OK || *o->at != '/') return s;
    o->at++;
    if (begins_number(o)) s = take_place(o, 0, &ignored);
    if (s != OK || *o->at != '/') return s;
    o->at++;
    return begins_number(o) ? take_place(o, o->normals, &c->normal) : OK;
}

/* ---- first pass: the lists, and whether all corners have normals ---- */

static status look_at_line(obj *o)
{
    if (takes_word(o, "v")) return add_triple(o, &o->vertex);
    if (takes_word(o, "vn")) return add_triple(o, &o->normal);
    if (!takes_word(o, "f")) return OK;
    for (skip_blanks(o); !ends_line(o); skip_blanks(o)) {
        corner c;
        status s = take_corner(o, &c);
        if (s != OK) return s;
        o->smooth &= c.normal != UINT32_MAX;
    }
    return OK;
}

/* ---- second pass: faces ---- */

static status check_corner(const obj *o, corner c)
{
    if (c.vertex >= o->vertex.count) return damaged(o, "a face of vertices that are not there");
    if (c.normal != UINT32_MAX && c.normal >= o->normal.count)
        return damaged(o, "a face of normals that are not there");
    return OK;
}

static vec3 place_of(const obj *o, uint32_t vertex)
{
    const double *p = o->vertex.at[vertex], *from = o->origin;
    return vec3_make((real)(p[0] - from[0]), (real)(p[1] - from[1]), (real)(p[2] - from[2]));
}

/* Returns the mesh's vertex for a corner with a normal; UINT32_MAX without memory. If a vertex has very many normals, a
 * duplicate is harmless, while searching all of them would take too long. */
static uint32_t twin_of(obj *o, corner c)
{
    uint32_t t = o->first_twin[c.vertex];
    for (int looked = 0; t && looked < 64; looked++, t = o->twins[t - 1].next)
        if (o->twins[t - 1].normal == c.normal) return o->twins[t - 1].index;
    if (o->twin_count == o->twin_room) {
        size_t room = o->twin_room ? 2 * o->twin_room : 4096;
        twin *larger = realloc(o->twins, room * sizeof *larger);
        vec3 *normals = larger ? realloc(o->mesh->normal, room * sizeof *normals) : NULL;
        if (larger) o->twins = larger;
        if (normals) o->mesh->normal = normals;
        if (!normals) return UINT32_MAX;
        o->twin_room = room;
    }
    const double *n = o->normal.at[c.normal];
    uint32_t index = mesh_add_vertex(o->mesh, place_of(o, c.vertex));
    o->mesh->normal[index] = vec3_normalize(vec3_make((real)n[0], (real)n[1], (real)n[2]));
    o->twins[o->twin_count] = (twin){c.normal, index, o->first_twin[c.vertex]};
    o->first_twin[c.vertex] = (uint32_t)++o->twin_count;
    return index;
}

/* Returns the part of the current material. Parts are numbered as faces occur, so that a material without faces has
 * none. */
static uint8_t current_part(obj *o)
{
    int *part = &o->part_of[o->current + 1];
    if (*part < 0) *part = o->parts++;
    return (uint8_t)(*part % MESH_PARTS);
}

static status add_face(obj *o)
{
    uint32_t polygon[CORNERS];
    int count = 0;
    for (skip_blanks(o); !ends_line(o); skip_blanks(o)) {
        corner c;
        status s = take_corner(o, &c);
        if (s == OK) s = check_corner(o, c);
        if (s != OK) return s;
        if (count == CORNERS) return damaged(o, "a face of more than 1024 corners; cut it into triangles first");
        polygon[count] = o->smooth ? twin_of(o, c) : c.vertex;
        if (polygon[count++] == UINT32_MAX) return fail(MERLIN_NO_MEMORY, "no memory for the mesh");
    }
    if (count < 3) return OK;
    if (o->mesh->triangle_count + (size_t)count - 2 > o->most)
        return fail(MERLIN_BAD_INPUT, "more than %zu triangles", o->most);
    mesh_add_polygon(o->mesh, polygon, count, current_part(o));
    return o->mesh->failed ? fail(MERLIN_NO_MEMORY, "no memory for the mesh") : OK;
}

/* Selects a material; those beyond the limit share the last one. */
static void use_material(obj *o)
{
    skip_blanks(o);
    const char *begin = o->at;
    size_t length = strcspn(begin, "\r\n");
    while (length > 0 && (begin[length - 1] == ' ' || begin[length - 1] == '\t'))
        length--;
    if (length >= NAME) length = NAME - 1;
    for (o->current = 0; o->current < o->materials; o->current++)
        if (strncmp(o->material[o->current], begin, length) == 0 && o->material[o->current][length] == 0) return;
    if (o->materials == MATERIALS) {
        o->current = MATERIALS - 1;
        return;
    }
    memcpy(o->material[o->materials], begin, length);
    o->material[o->materials++][length] = 0;
}

static status take_line(obj *o)
{
    if (takes_word(o, "v")) {
        o->vertices++;
        skip_rest(o);
    } else if (takes_word(o, "vn")) {
        o->normals++;
        skip_rest(o);
    } else if (takes_word(o, "usemtl")) {
        use_material(o);
    } else if (takes_word(o, "f")) {
        return add_face(o);
    }
    return OK;
}

static status each_line(obj *o, const char *text, status (*take)(obj *))
{
    status s = OK;
    o->line = 1;
    for (o->at = text; s == OK && o->at < o->end; next_line(o)) {
        skip_blanks(o);
        s = take(o);
    }
    return s;
}

/* Chooses an origin near the vertices: scans use national coordinates, which floats hold only to half metres. */
static void choose_origin(obj *o)
{
    double low[3], high[3], extent = 0, far = 0;
    for (size_t i = 0; i < o->vertex.count; i++)
        for (int k = 0; k < 3; k++) {
            double x = o->vertex.at[i][k];
            if (i == 0 || x < low[k]) low[k] = x;
            if (i == 0 || x > high[k]) high[k] = x;
        }
    for (int k = 0; o->vertex.count > 0 && k < 3; k++) {
        extent = fmax(extent, high[k] - low[k]);
        far = fmax(far, fabs(low[k]));
        o->origin[k] = low[k];
    }
    if (far < 1000 * extent) memset(o->origin, 0, sizeof o->origin);
}

/* Begins the faces; without normals the mesh's vertices are the file's. */
static status begin_faces(obj *o)
{
    choose_origin(o);
    o->vertices = o->normals = 0;
    o->current = -1;
    memset(o->part_of, -1, sizeof o->part_of);
    o->smooth &= o->normal.count > 0;
    if (o->smooth && !(o->first_twin = calloc(o->vertex.count + 1, sizeof *o->first_twin)))
        return fail(MERLIN_NO_MEMORY, "no memory for the mesh");
    for (size_t i = 0; !o->smooth && i < o->vertex.count; i++)
        mesh_add_vertex(o->mesh, place_of(o, (uint32_t)i));
    return o->mesh->failed ? fail(MERLIN_NO_MEMORY, "no memory for the mesh") : OK;
}

static status read_text(obj *o, const char *text)
{
    status s = each_line(o, text, look_at_line);
    if (s == OK) s = begin_faces(o);
    if (s == OK) s = each_line(o, text, take_line);
    if (s == OK && o->mesh->triangle_count == 0) s = fail(MERLIN_BAD_INPUT, "no triangles in it");
    return s;
}

status mesh_parse_obj(const char *text, size_t size, size_t most, triangle_mesh *mesh, int *parts)
{
    obj *o = calloc(1, sizeof *o);
    if (!o) return fail(MERLIN_NO_MEMORY, "no memory for the mesh");
    *o = (obj){.end = text + size, .smooth = true, .most = most, .mesh = mesh};
    status s = read_text(o, text + file_text_mark(text, size));
    *parts = o->parts < MESH_PARTS ? o->parts : MESH_PARTS;
    free(o->vertex.at);
    free(o->normal.at);
    free(o->twins);
    free(o->first_twin);
    free(o);
    return s;
}

status mesh_read_obj(const char *path, size_t most, triangle_mesh *mesh, int *parts)
{
    char *text;
    size_t size;
    status s = file_read(path, MESH_BYTES, &text, &size);
    if (s != OK) return s;
    s = mesh_parse_obj(text, size, most, mesh, parts);
    free(text);
    return s;
}
