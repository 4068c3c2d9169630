/* SPDX-License-Identifier: MIT */
/* Groups a folder's files into materials and reads them. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

#include "base/file.h"
#include "base/number.h"
#include "image/formats/img_format.h"
#include "image/read/read.h"
#include "image/resize.h"
#include "lab/scene/material/texture.h"

enum { LARGEST_TILE = 512 };

typedef enum map_kind { MAP_ALBEDO, MAP_ROUGHNESS, MAP_NORMAL, MAP_NORMAL_DOWN, MAP_OTHER } map_kind;

static const struct {
    const char *word;
    map_kind kind;
} words[] = {
    {"albedo", MAP_ALBEDO},
    {"basecolor", MAP_ALBEDO},
    {"color", MAP_ALBEDO},
    {"colour", MAP_ALBEDO},
    {"col", MAP_ALBEDO},
    {"diffuse", MAP_ALBEDO},
    {"diff", MAP_ALBEDO},
    {"roughness", MAP_ROUGHNESS},
    {"rough", MAP_ROUGHNESS},
    {"normal", MAP_NORMAL},
    {"normalgl", MAP_NORMAL},
    {"nor", MAP_NORMAL},
    {"normaldx", MAP_NORMAL_DOWN},
    {"ao", MAP_OTHER},
    {"ambientocclusion", MAP_OTHER},
    {"arm", MAP_OTHER},
    {"displacement", MAP_OTHER},
    {"disp", MAP_OTHER},
    {"height", MAP_OTHER},
    {"metalness", MAP_OTHER},
    {"metallic", MAP_OTHER},
    {"metal", MAP_OTHER},
    {"opacity", MAP_OTHER},
    {"specular", MAP_OTHER},
    {"spec", MAP_OTHER},
    {"gloss", MAP_OTHER},
    {"preview", MAP_OTHER},
};

/* A file of the folder: its kind of map, and its material, named by the path's first `stem` characters. */
typedef struct source {
    const char *path;
    map_kind kind;
    size_t stem;
} source;

static bool separates(char c)
{
    return c == '_' || c == '-' || c == ' ' || c == '.';
}

static bool word_is(const char *at, size_t length, const char *word)
{
    return strlen(word) == length && strncasecmp(at, word, length) == 0;
}

/* Returns the stem's end without separators and without "base" of base_color. */
static size_t trimmed(const char *name, size_t start, size_t end)
{
    while (end > start && separates(name[end - 1]))
        end--;
    if (end >= start + 5 && separates(name[end - 5]) && strncasecmp(name + end - 4, "base", 4) == 0) return end - 5;
    return end == start + 4 && word_is(name + start, 4, "base") ? start : end;
}

/* Tells whether a name is only a keyword, so that the material is the folder: normal.png, nor_gl.png. metal.png is an
 * exception, as it usually is a picture of metal. */
static bool is_bare(const char *name, size_t length)
{
    size_t first = strcspn(name, "_- ."), rest = first < length ? first + 1 : length;
    bool form = word_is(name + rest, length - rest, "gl") || word_is(name + rest, length - rest, "dx");
    return (rest == length || form) && !word_is(name, first, "metal");
}

/* Classifies a file by the last keyword in its name, as a material may itself be called "metal". */
static source classify(const char *path)
{
    size_t start = (size_t)(file_name_of(path) - path), end = (size_t)(strrchr(path, '.') - path);
    source s = {.path = path, .kind = MAP_ALBEDO, .stem = end};
    for (size_t at = is_bare(path + start, end - start) ? start : start + strcspn(path + start, "_- ."); at < end;) {
        size_t length = strcspn(path + at, "_- .");
        for (size_t k = 0; k < sizeof words / sizeof *words; k++) {
            if (!word_is(path + at, length, words[k].word)) continue;
            s.kind = words[k].kind;
            s.stem = trimmed(path, start, at);
        }
        if (s.kind == MAP_NORMAL && word_is(path + at, length, "dx")) s.kind = MAP_NORMAL_DOWN;
        at += length + 1;
    }
    return s;
}

static status read_tile(const source *s, img *out)
{
    img full = {0};
    int bits;
    status st = s->kind == MAP_ALBEDO      ? img_read(s->path, &full, NULL)
                : s->kind == MAP_ROUGHNESS ? img_read_grey(s->path, &full)
                                           : img_read_samples(s->path, false, &full, &bits);
    if (st != OK) return st;
    int side = full.width > full.height ? full.width : full.height;
    float shrink = side > LARGEST_TILE ? (float)LARGEST_TILE / (float)side : 1;
    int width = (int)max_of(1, (float)full.width * shrink), height = (int)max_of(1, (float)full.height * shrink);
    st = img_resize(&full, width, height, out);
    img_free(&full);
    return st;
}

/* Converts encoded normals to slopes of the height. */
static status slopes(const source *s, const img *normal, img *out)
{
    static const float STEEPEST = 3;
    if (normal->channels != 3) return fail(MERLIN_BAD_INPUT, "%s is grey: a normal map has three channels", s->path);
    status st = img_new(out, normal->width, normal->height, 2);
    if (st != OK) return st;
    float down = s->kind == MAP_NORMAL_DOWN ? -1.0f : 1.0f;
    size_t pixels = (size_t)normal->width * (size_t)normal->height;
    for (size_t i = 0; i < pixels; i++) {
        const float *n = normal->data + 3 * i;
        float z = max_of(0.05f, 2 * n[2] - 1);
        out->data[2 * i] = clamp(-(2 * n[0] - 1) / z, -STEEPEST, STEEPEST);
        out->data[2 * i + 1] = clamp(-down * (2 * n[1] - 1) / z, -STEEPEST, STEEPEST);
    }
    return OK;
}

static status read_map(const source *s, scene_texture *out)
{
    if (s->kind == MAP_ALBEDO) return read_tile(s, &out->albedo);
    if (s->kind == MAP_ROUGHNESS) return read_tile(s, &out->roughness);
    img normal = {0};
    status st = read_tile(s, &normal);
    if (st == OK) st = slopes(s, &normal, &out->slope);
    img_free(&normal);
    return st;
}

static void free_texture(scene_texture *t)
{
    img_free(&t->albedo);
    img_free(&t->roughness);
    img_free(&t->slope);
}

/* Returns the file of a kind that belongs to the same material as `albedo`, or NULL. */
static source *partner(source *all, size_t count, const source *albedo, map_kind kind)
{
    for (size_t i = 0; i < count; i++)
        if (all[i].kind == kind && all[i].stem == albedo->stem && strncmp(all[i].path, albedo->path, albedo->stem) == 0)
            return &all[i];
    return NULL;
}

static status read_material(source *all, size_t count, const source *albedo, scene_texture *out)
{
    *out = (scene_texture){0};
    const source *rough = partner(all, count, albedo, MAP_ROUGHNESS), *normal = partner(all, count, albedo, MAP_NORMAL);
    if (!normal) normal = partner(all, count, albedo, MAP_NORMAL_DOWN);
    status s = read_map(albedo, out);
    if (s == OK && rough) s = read_map(rough, out);
    if (s == OK && normal) s = read_map(normal, out);
    if (s != OK) free_texture(out);
    return s;
}

static status read_materials(source *all, size_t count, const char *folder, scene_textures *out)
{
    out->texture = calloc(count + 1, sizeof *out->texture);
    if (!out->texture) return fail(MERLIN_NO_MEMORY, "out of memory for the materials of %s", folder);
    status s = OK;
    for (size_t i = 0; s == OK && i < count; i++) {
        if (all[i].kind != MAP_ALBEDO || partner(all, i, &all[i], MAP_ALBEDO)) continue;
        s = read_material(all, count, &all[i], &out->texture[out->count]);
        out->count += s == OK;
    }
    if (s == OK && out->count == 0)
        s = fail(MERLIN_BAD_INPUT,
                 "%s holds no materials: give pictures named like brick_albedo.png, brick_normal.png, "
                 "brick_roughness.png",
                 folder);
    return s;
}

/* Keeps pictures by content, and files named like pictures, so that reading those reports what is wrong. */
static status keep_pictures(char **names, size_t *count, const char *folder, skipped_files *skipped)
{
    static const char *const endings[] = {".png", ".jpg", ".jpeg", ".tif", ".tiff", ".webp", ".exr", NULL};
    size_t kept = 0;
    status s = OK;
    for (size_t i = 0; i < *count; i++) {
        img_format f = img_format_of(names[i]);
        bool named = strchr(file_name_of(names[i]), '.');
        if (named && (f.is_read || (!f.name && file_ends_in_any(names[i], endings)))) {
            names[kept++] = names[i];
            continue;
        }
        char why[64];
        snprintf(why, sizeof why, "%s is not read", f.name ? f.name : "it");
        if (s == OK && f.name && !f.is_read)
            s = skipped_add(skipped, names[i] + strlen(folder) + strspn(names[i] + strlen(folder), "/"), why);
        free(names[i]);
    }
    *count = kept;
    return s;
}

status scene_textures_read(const char *folder, scene_textures *out)
{
    *out = (scene_textures){0};
    char **names;
    size_t count;
    status s = file_list_deep(folder, NULL, &names, &count);
    if (s != OK) return s;
    s = keep_pictures(names, &count, folder, &out->skipped);
    source *all = calloc(count + 1, sizeof *all);
    if (s == OK && !all) s = fail(MERLIN_NO_MEMORY, "out of memory for the names in %s", folder);
    for (size_t i = 0; s == OK && i < count; i++)
        all[i] = classify(names[i]);
    if (s == OK) s = read_materials(all, count, folder, out);
    free(all);
    file_list_free(names, count);
    if (s != OK) scene_textures_free(out);
    return s;
}

void scene_textures_free(scene_textures *textures)
{
    for (size_t i = 0; i < textures->count; i++)
        free_texture(&textures->texture[i]);
    free(textures->texture);
    skipped_free(&textures->skipped);
    *textures = (scene_textures){0};
}
