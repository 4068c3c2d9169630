/* SPDX-License-Identifier: MIT */
#include "lab/render/contents.h"

#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/file.h"
#include "base/memory.h"

/* Constants of Fowler, Noll and Vo's FNV-1a, here over words of 64 bits; a shift mixes high bits into low ones, which
 * multiplication alone does not. */
static const uint64_t FNV_BASIS = 0xcbf29ce484222325u, FNV_PRIME = 0x100000001b3u;

static uint64_t mix(uint64_t sum, uint64_t word)
{
    sum = (sum ^ word) * FNV_PRIME;
    return sum ^ sum >> 32;
}

static uint64_t sum_of(const void *data, size_t size, uint64_t sum)
{
    const char *at = data;
    sum = mix(sum, size);
    for (; size >= sizeof sum; at += sizeof sum, size -= sizeof sum) {
        uint64_t word;
        memcpy(&word, at, sizeof word);
        sum = mix(sum, word);
    }
    for (; size > 0; at++, size--)
        sum = mix(sum, (unsigned char)*at);
    return sum;
}

/* Adds a file's content under a name. */
static status add_file(const char *path, const char *name, uint64_t *sum)
{
    file_view view;
    status s = file_map(path, SIZE_MAX, &view);
    if (s != OK) return s;
    *sum += sum_of(view.data, view.size, sum_of(name, strlen(name), FNV_BASIS));
    file_unmap(&view);
    return OK;
}

/* Adds files; the sum does not depend on their order. */
static status add_files(char *const *paths, size_t count, const char *folder, uint64_t *sum)
{
    status s = OK;
    for (size_t i = 0; i < count && s == OK; i++) {
        const char *inside = paths[i] + strlen(folder);
        s = add_file(paths[i], inside + strspn(inside, "/"), sum);
    }
    return s;
}

typedef struct source {
    const char *words, *path;
    bool folder, deep;
    const char *const *endings; /* NULL: all files */
} source;

static status describe(const source *from, FILE *out)
{
    uint64_t sum = 0;
    char **paths = NULL;
    size_t count = 0;
    status s;
    if (!from->folder)
        s = add_file(from->path, "", &sum);
    else if (from->deep)
        s = file_list_deep(from->path, from->endings, &paths, &count);
    else
        s = file_list(from->path, from->endings, &paths, &count);
    if (s == OK) s = add_files(paths, count, from->path, &sum);
    file_list_free(paths, count);
    if (s == OK) fprintf(out, "contents of %s %016" PRIx64 "\n", from->words, sum);
    return s;
}

status contents_describe(const render_options *o, char **lines)
{
    /* with the buffers of .gltf; the samples themselves may be written among meshes */
    static const char *const meshes[] = {".ply", ".obj", ".gltf", ".glb", ".bin", NULL};
    const source sources[] = {{"mesh", o->mesh, false, false, NULL},
                              {"environments", o->environment_folder, true, false, NULL},
                              {"materials", o->material_folder, true, true, NULL},
                              {"meshes", o->mesh_folder, true, true, meshes}};
    size_t size;
    status s = OK;
    *lines = NULL;
    FILE *out = open_memstream(lines, &size);
    if (!out) return fail(MERLIN_NO_MEMORY, "no memory to describe what samples are made of");
    for (size_t i = 0; i < sizeof sources / sizeof sources[0] && s == OK; i++)
        if (sources[i].path) s = describe(&sources[i], out);
    bool complete = memory_stream_close(out, lines);
    if (s == OK && !complete) s = fail(MERLIN_NO_MEMORY, "no memory to describe what samples are made of");
    if (s == OK) return OK;
    free(*lines);
    *lines = NULL;
    return s;
}
