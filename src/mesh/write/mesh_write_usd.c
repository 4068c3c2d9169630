/* SPDX-License-Identifier: MIT */
/* Writes USD as text, with a preview surface whose pictures lie beside it: albedo, tangent-space normals and roughness.
 * Source: "USD Preview Surface Proposal" 2.5 and the documentation of UsdGeomMesh, openusd.org. Its roughness is that
 * of docs/conventions.md, and its index of refraction that of F0. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/file.h"
#include "base/text/decimal.h"
#include "base/text/mesh_parts.h"
#include "image/write/write.h"
#include "mesh/write/mesh_formats.h"
#include "mesh/write/mesh_normal_map.h"
#include "optics/brdf.h"

/* The pictures, and the file itself. */
enum { ALBEDO, NORMAL, ROUGHNESS, PICTURES, SCENE = PICTURES, FILES };
static const mesh_part picture_parts[PICTURES] = {MESH_ALBEDO, MESH_NORMAL, MESH_ROUGHNESS};

typedef struct usd {
    const merlin_mesh *mesh;
    const char *picture[PICTURES]; /* names beside the file; NULL: none */
} usd;

/* ---- geometry ---- */

/* Prints an attribute of every vertex as tuples of so many numbers. */
static void print_tuples(FILE *f, const char *attribute, const float *values, size_t count, int each, int digits)
{
    fprintf(f, "        %s = [", attribute);
    for (size_t i = 0; i < count; i++) {
        char line[4 * DECIMAL_ROOM], *end = stpcpy(line, i ? ", (" : "(");
        for (int c = 0; c < each; c++) {
            if (c) end = stpcpy(end, ", ");
            end = decimal_put(end, (double)values[(size_t)each * i + (size_t)c], digits);
        }
        *end++ = ')';
        fwrite(line, 1, (size_t)(end - line), f);
    }
    fputs("]", f);
}

/* USD counts texture coordinates from below. */
static void print_texture_places(FILE *f, const merlin_mesh *m)
{
    fputs("        texCoord2f[] primvars:st = [", f);
    for (size_t v = 0; v < m->vertex_count; v++) {
        char line[4 * DECIMAL_ROOM], *end = stpcpy(line, v ? ", (" : "(");
        end = decimal_put(end, (double)m->uvs[2 * v], 7);
        end = stpcpy(end, ", ");
        end = decimal_put(end, 1 - (double)m->uvs[2 * v + 1], 7);
        *end++ = ')';
        fwrite(line, 1, (size_t)(end - line), f);
    }
    fputs("] (\n            interpolation = \"vertex\"\n        )\n", f);
}

static void print_triangles(FILE *f, const merlin_mesh *m)
{
    fputs("        int[] faceVertexCounts = [", f);
    for (size_t t = 0; t < m->triangle_count; t++)
        fputs(t ? ", 3" : "3", f);
    fputs("]\n        int[] faceVertexIndices = [", f);
    for (size_t i = 0; i < 3 * m->triangle_count; i++) {
        char line[DECIMAL_ROOM + 2], *end = stpcpy(line, i ? ", " : "");
        end = decimal_put_count(end, m->triangles[i]);
        fwrite(line, 1, (size_t)(end - line), f);
    }
    fputs("]\n", f);
}

static void print_extent(FILE *f, const merlin_mesh *m)
{
    float low[3] = {INFINITY, INFINITY, INFINITY}, high[3] = {-INFINITY, -INFINITY, -INFINITY};
    for (size_t i = 0; i < 3 * m->vertex_count; i++) {
        low[i % 3] = fminf(low[i % 3], m->positions[i]);
        high[i % 3] = fmaxf(high[i % 3], m->positions[i]);
    }
    const float both[6] = {low[0], low[1], low[2], high[0], high[1], high[2]};
    print_tuples(f, "float3[] extent", both, 2, 3, 7);
    fputs("\n", f);
}

static void print_geometry(FILE *f, const merlin_mesh *m)
{
    fputs("    def Mesh \"surface\" (\n        prepend apiSchemas = [\"MaterialBindingAPI\"]\n    )\n    {\n"
          "        uniform token subdivisionScheme = \"none\"\n"
          "        uniform token orientation = \"rightHanded\"\n"
          "        rel material:binding = </object/material>\n",
          f);
    print_extent(f, m);
    print_triangles(f, m);
    print_tuples(f, "point3f[] points", m->positions, m->vertex_count, 3, 7);
    fputs("\n", f);
    print_tuples(f, "normal3f[] normals", mesh_base_normals(m), m->vertex_count, 3, 5);
    fputs(" (\n            interpolation = \"vertex\"\n        )\n", f);
    print_texture_places(f, m);
    fputs("    }\n", f);
}

/* ---- the material ---- */

/* Prints a texture's node. A file's name that has USD's own quotation mark gets three of them. */
static void print_texture(FILE *f, const char *name, const char *file, const char *space, const char *more)
{
    const char *quote = strchr(file, '@') ? "@@@" : "@";
    fprintf(f,
            "        def Shader \"%s\"\n        {\n"
            "            uniform token info:id = \"UsdUVTexture\"\n"
            "            asset inputs:file = %s%s%s\n"
            "            token inputs:sourceColorSpace = \"%s\"\n"
            "            token inputs:wrapS = \"clamp\"\n"
            "            token inputs:wrapT = \"clamp\"\n"
            "            float2 inputs:st.connect = </object/material/place.outputs:result>\n%s        }\n",
            name, quote, file, quote, space, more);
}

static void print_surface(FILE *f, const usd *u)
{
    const double root = u->mesh->matte ? 0 : sqrt((double)BRDF_F0);
    fputs("        def Shader \"PreviewSurface\"\n        {\n"
          "            uniform token info:id = \"UsdPreviewSurface\"\n"
          "            float inputs:metallic = 0\n",
          f);
    fprintf(f, "            float inputs:ior = %.4f\n", (1 + root) / (1 - root));
    if (u->picture[ALBEDO])
        fputs("            color3f inputs:diffuseColor.connect = </object/material/albedo.outputs:rgb>\n", f);
    else
        fputs("            color3f inputs:diffuseColor = (0.6, 0.6, 0.6)\n", f);
    if (u->picture[ROUGHNESS])
        fputs("            float inputs:roughness.connect = </object/material/roughness.outputs:r>\n", f);
    else
        fputs("            float inputs:roughness = 1\n", f);
    if (u->picture[NORMAL])
        fputs("            normal3f inputs:normal.connect = </object/material/normal.outputs:rgb>\n", f);
    fputs("            token outputs:surface\n        }\n", f);
}

static void print_material(FILE *f, const usd *u)
{
    fputs("    def Material \"material\"\n    {\n"
          "        token outputs:surface.connect = </object/material/PreviewSurface.outputs:surface>\n",
          f);
    print_surface(f, u);
    fputs("        def Shader \"place\"\n        {\n"
          "            uniform token info:id = \"UsdPrimvarReader_float2\"\n"
          "            string inputs:varname = \"st\"\n"
          "            float2 outputs:result\n        }\n",
          f);
    if (u->picture[ALBEDO]) print_texture(f, "albedo", u->picture[ALBEDO], "sRGB", "            float3 outputs:rgb\n");
    if (u->picture[ROUGHNESS])
        print_texture(f, "roughness", u->picture[ROUGHNESS], "raw", "            float outputs:r\n");
    if (u->picture[NORMAL])
        print_texture(f, "normal", u->picture[NORMAL], "raw",
                      "            float4 inputs:scale = (2, 2, 2, 1)\n"
                      "            float4 inputs:bias = (-1, -1, -1, 0)\n"
                      "            float3 outputs:rgb\n");
    fputs("    }\n", f);
}

static void print_scene(FILE *f, const void *context)
{
    const usd *u = context;
    const double scale = u->mesh->scale > 0 ? u->mesh->scale : 1;
    fputs("#usda 1.0\n(\n    defaultPrim = \"object\"\n    doc = \"written by merlin\"\n    metersPerUnit = 1\n"
          "    upAxis = \"Y\"\n)\n\ndef Xform \"object\"\n{\n",
          f);
    fprintf(f,
            "    double3 xformOp:scale = (%.9g, %.9g, %.9g)\n"
            "    uniform token[] xformOpOrder = [\"xformOp:scale\"]\n\n",
            scale, scale, scale);
    print_material(f, u);
    print_geometry(f, u->mesh);
    fputs("}\n", f);
}

/* ---- files ---- */

static status write_picture(const merlin_mesh *m, int which, const char *path)
{
    img normals = {0};
    if (which == ALBEDO) return img_write_png(path, &m->albedo, IMG_SRGB8);
    if (which == ROUGHNESS) return img_write_png(path, &m->roughness, IMG_LINEAR8);
    status s = mesh_normal_map(m, &normals);
    if (s == OK) s = img_write_png(path, &normals, IMG_LINEAR8);
    img_free(&normals);
    return s;
}

/* Writes all files under temporary names, those that the scene refers to first. */
static status write_aside(const char *const path[FILES], char *aside[FILES], const merlin_mesh *m)
{
    usd u = {.mesh = m};
    status s = OK;
    for (int i = 0; s == OK && i < PICTURES; i++) {
        if (!path[i]) continue;
        u.picture[i] = file_name_of(path[i]);
        s = file_temporary(path[i], &aside[i]);
        if (s == OK) s = write_picture(m, i, aside[i]);
    }
    if (s == OK) s = file_temporary(path[SCENE], &aside[SCENE]);
    return s == OK ? file_print(aside[SCENE], print_scene, &u) : s;
}

status mesh_write_usda(const char *path, const merlin_mesh *m)
{
    const bool there[PICTURES] = {m->albedo.data != NULL, m->face_normals != NULL, m->roughness.data != NULL};
    char *picture[PICTURES] = {NULL}, *aside[FILES] = {NULL};
    const char *paths[FILES] = {[SCENE] = path};
    status s = OK;
    for (int i = 0; s == OK && i < PICTURES; i++) {
        if (!there[i]) continue;
        paths[i] = picture[i] = mesh_part_path(path, picture_parts[i]);
        if (!picture[i]) s = fail(MERLIN_NO_MEMORY, "no memory for file names");
    }
    if (s == OK) s = write_aside(paths, aside, m);
    s = file_commit_all(s, aside, paths, FILES);
    for (int i = 0; i < PICTURES; i++)
        free(picture[i]);
    return s;
}
