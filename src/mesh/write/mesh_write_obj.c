/* SPDX-License-Identifier: MIT */
/* Writes OBJ with texture coordinates, its material file, and the albedo texture as PNG. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/file.h"
#include "base/text/decimal.h"
#include "base/text/mesh_parts.h"
#include "image/write/write.h"
#include "mesh/write/mesh_formats.h"

typedef struct obj {
    const merlin_mesh *mesh;
    const char *material;
} obj;

static char *put_numbers(char *to, const char *kind, const double *number, int count, int digits)
{
    to = stpcpy(to, kind);
    for (int i = 0; i < count; i++) {
        *to++ = ' ';
        to = decimal_put(to, number[i], digits);
    }
    *to++ = '\n';
    return to;
}

static void print_vertex(FILE *f, const obj *o, size_t v)
{
    const float *p = o->mesh->positions + 3 * v, *t = o->mesh->uvs + 2 * v, *n = o->mesh->normals + 3 * v;
    const double place[] = {(double)p[0], (double)p[1], (double)p[2]}, texture[] = {(double)t[0], 1 - (double)t[1]};
    const double normal[] = {(double)n[0], (double)n[1], (double)n[2]};
    char lines[9 * DECIMAL_ROOM], *end = put_numbers(lines, "v", place, 3, 7);
    end = put_numbers(end, "vt", texture, 2, 7);
    end = put_numbers(end, "vn", normal, 3, 5);
    fwrite(lines, 1, (size_t)(end - lines), f);
}

/* Prints a triangle; positions, texture coordinates and normals have the same numbers. */
static void print_triangle(FILE *f, const uint32_t *corner)
{
    char line[10 * DECIMAL_ROOM], *end = stpcpy(line, "f");
    for (int k = 0; k < 3; k++)
        for (int same = 0; same < 3; same++) {
            *end++ = same ? '/' : ' ';
            end = decimal_put_count(end, corner[k] + 1);
        }
    *end++ = '\n';
    fwrite(line, 1, (size_t)(end - line), f);
}

static void print_mesh(FILE *f, const void *context)
{
    const obj *o = context;
    const merlin_mesh *m = o->mesh;
    fprintf(f, "# written by merlin\nmtllib %s\nusemtl surface\n", file_name_of(o->material));
    for (size_t v = 0; v < m->vertex_count; v++)
        print_vertex(f, o, v);
    for (size_t t = 0; t < m->triangle_count; t++)
        print_triangle(f, m->triangles + 3 * t);
}

static status write_material(const char *path, const char *texture)
{
    char *text = NULL;
    int length = asprintf(&text, "# written by merlin\nnewmtl surface\nKa 0 0 0\n%s\nKs 0 0 0\nillum 1\n%s%s%s",
                          texture ? "Kd 1 1 1" : "Kd 0.6 0.6 0.6", texture ? "map_Kd " : "",
                          texture ? file_name_of(texture) : "", texture ? "\n" : "");
    if (length < 0) return fail(MERLIN_NO_MEMORY, "no memory to write %s", path);
    status s = file_write(path, text, (size_t)length);
    free(text);
    return s;
}

/* The OBJ and the files that it refers to. */
enum { TEXTURE, MATERIAL, MESH, FILES };

/* Writes all files under temporary names, those that the OBJ refers to first. */
static status write_aside(const char *const path[FILES], char *aside[FILES], const merlin_mesh *m)
{
    const bool textured = m->albedo.data != NULL;
    status s = OK;
    for (int i = textured ? TEXTURE : MATERIAL; s == OK && i < FILES; i++)
        s = file_temporary(path[i], &aside[i]);
    if (s == OK && textured) s = img_write_png(aside[TEXTURE], &m->albedo, IMG_SRGB8);
    if (s == OK) s = write_material(aside[MATERIAL], textured ? path[TEXTURE] : NULL);
    return s == OK ? file_print(aside[MESH], print_mesh, &(obj){m, path[MATERIAL]}) : s;
}

status mesh_write_obj(const char *path, const merlin_mesh *m)
{
    char *material = mesh_part_path(path, MESH_MATERIAL), *texture = mesh_part_path(path, MESH_ALBEDO);
    char *aside[FILES] = {NULL};
    const char *const paths[FILES] = {texture, material, path};
    status s = material && texture ? write_aside(paths, aside, m) : fail(MERLIN_NO_MEMORY, "no memory for file names");
    s = file_commit_all(s, aside, paths, FILES);
    free(material);
    free(texture);
    return s;
}
