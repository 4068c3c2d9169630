/* SPDX-License-Identifier: MIT */
/* The file: GLB or text, its JSON, required extensions. */
#include <stdlib.h>
#include <string.h>

#include "mesh/read/gltf.h"

enum { GLB_HEAD = 12, CHUNK_HEAD = 8, DEEPEST = 64, MOST_VALUES = 2000000 };
enum { CHUNK_JSON = 0x4e4f534a, CHUNK_BINARY = 0x004e4942 };

status gltf_damaged(const char *what)
{
    return fail(MERLIN_BAD_INPUT, "damaged glTF: %s", what);
}

bool gltf_whole(const cJSON *object, const char *key, size_t fallback, size_t *out)
{
    const cJSON *item = cJSON_GetObjectItemCaseSensitive(object, key);
    *out = fallback;
    if (!item) return true;
    if (!cJSON_IsNumber(item) || !(item->valuedouble >= 0 && item->valuedouble <= 0x1p48)) return false;
    *out = (size_t)item->valuedouble;
    return (double)*out == item->valuedouble;
}

/* ---- GLB ---- */

static uint32_t word_at(const uint8_t *at)
{
    uint32_t word;
    memcpy(&word, at, sizeof word);
    return word;
}

/* Takes the chunk at `*at`, which moves behind it. */
static status take_chunk(const uint8_t **at, const uint8_t *end, uint32_t kind, const uint8_t **data, size_t *size)
{
    if ((size_t)(end - *at) < CHUNK_HEAD) return gltf_damaged("it ends within a chunk");
    size_t length = word_at(*at);
    uint32_t found = word_at(*at + 4);
    *at += CHUNK_HEAD;
    if (length > (size_t)(end - *at)) return gltf_damaged("a chunk is shorter than it says");
    if (found == kind) {
        *data = *at;
        *size = length;
    }
    *at += length;
    return OK;
}

/* Finds the JSON of a GLB, else the whole file. */
static status find_json(gltf *g, const char **text, size_t *size)
{
    const uint8_t *at = g->file.data, *end = at + g->file.size, *json = at;
    *size = g->file.size;
    *text = g->file.data;
    if (g->file.size < GLB_HEAD || memcmp(at, "glTF", 4) != 0) return OK;
    if (word_at(at + 4) != 2)
        return fail(MERLIN_BAD_INPUT, "glTF of version %u is not supported; save it as version 2", word_at(at + 4));
    at += GLB_HEAD;
    json = NULL;
    status s = take_chunk(&at, end, CHUNK_JSON, &json, size);
    if (s == OK && !json) s = gltf_damaged("its first chunk is not JSON");
    while (s == OK && !g->binary && (size_t)(end - at) >= CHUNK_HEAD)
        s = take_chunk(&at, end, CHUNK_BINARY, &g->binary, &g->binary_size);
    *text = (const char *)json;
    return s;
}

/* ---- JSON ---- */

/* Limits nesting and size, as the parser recurses for each level and takes a hundred bytes for every value, even of one
 * byte. */
static status check_json(const char *text, size_t size)
{
    size_t depth = 0, values = 0;
    bool quoted = false;
    for (size_t i = 0; i < size; i++) {
        char c = text[i];
        if (quoted) {
            i += c == '\\';
            quoted = c != '"';
        } else if (c == '"') {
            quoted = true;
        } else if (c == '[' || c == '{') {
            if (++depth > DEEPEST) return fail(MERLIN_BAD_INPUT, "its JSON is more than %d levels deep", DEEPEST);
            values++;
        } else if (c == ']' || c == '}') {
            depth -= depth > 0;
        } else {
            values += c == ',';
        }
        if (values > MOST_VALUES) return fail(MERLIN_BAD_INPUT, "its JSON has more than %d values", MOST_VALUES);
    }
    return OK;
}

static status list_items(const cJSON *root, const char *key, gltf_list *out)
{
    const cJSON *array = cJSON_GetObjectItemCaseSensitive(root, key), *item;
    if (!array) return OK;
    size_t count = 0;
    cJSON_ArrayForEach(item, array)
    {
        count++;
    }
    out->at = malloc((count + 1) * sizeof *out->at);
    if (!out->at) return fail(MERLIN_NO_MEMORY, "no memory for the mesh");
    cJSON_ArrayForEach(item, array)
    {
        out->at[out->count++] = item;
    }
    return OK;
}

static status list_all(gltf *g)
{
    status s = list_items(g->root, "nodes", &g->nodes);
    if (s == OK) s = list_items(g->root, "meshes", &g->meshes);
    if (s == OK) s = list_items(g->root, "accessors", &g->accessors);
    if (s == OK) s = list_items(g->root, "bufferViews", &g->views);
    if (s == OK) s = list_items(g->root, "buffers", &g->buffers);
    if (s != OK) return s;
    g->buffer = calloc(g->buffers.count + 1, sizeof *g->buffer);
    g->accessor = calloc(g->accessors.count + 1, sizeof *g->accessor);
    return g->buffer && g->accessor ? OK : fail(MERLIN_NO_MEMORY, "no memory for the mesh");
}

/* Accepts required extensions that are supported or do not affect the surface, and refuses others. */
static status check_extension(const char *name)
{
    static const char *const fine[] = {"KHR_mesh_quantization", "KHR_materials_", "KHR_texture_", "EXT_texture_",
                                       "MSFT_texture_",         "KHR_lights_",    "EXT_lights_",  "KHR_xmp",
                                       "KHR_animation_",        "MSFT_lod"};
    for (size_t i = 0; i < sizeof fine / sizeof *fine; i++)
        if (strncmp(name, fine[i], strlen(fine[i])) == 0) return OK;
    return fail(MERLIN_BAD_INPUT, "its extension %.60s is not supported; export it without", name);
}

static status check_document(const cJSON *root)
{
    const cJSON *asset = cJSON_GetObjectItemCaseSensitive(root, "asset"), *name;
    const char *version = cJSON_GetStringValue(cJSON_GetObjectItemCaseSensitive(asset, "version"));
    if (!version) return fail(MERLIN_BAD_INPUT, "not a glTF file");
    if (version[0] != '2')
        return fail(MERLIN_BAD_INPUT, "glTF of version %.10s is not supported; save it as version 2", version);
    cJSON_ArrayForEach(name, cJSON_GetObjectItemCaseSensitive(root, "extensionsRequired"))
    {
        status s = cJSON_IsString(name) ? check_extension(name->valuestring) : OK;
        if (s != OK) return s;
    }
    return OK;
}

static status read_document(gltf *g)
{
    const char *text;
    size_t size;
    status s = find_json(g, &text, &size);
    if (s == OK) s = check_json(text, size);
    if (s != OK) return s;
    g->root = cJSON_ParseWithLength(text, size);
    if (!g->root) return gltf_damaged("its JSON cannot be read");
    s = check_document(g->root);
    return s == OK ? list_all(g) : s;
}

status gltf_parse(const void *bytes, size_t size, const char *folder, gltf **out)
{
    *out = NULL;
    gltf *g = calloc(1, sizeof *g);
    if (!g) return fail(MERLIN_NO_MEMORY, "no memory for the mesh");
    *g = (gltf){.folder = folder, .file = {bytes, size}, .bytes = size};
    status s = read_document(g);
    if (s == OK)
        *out = g;
    else
        gltf_close(g);
    return s;
}

void gltf_close(gltf *g)
{
    if (!g) return;
    for (size_t i = 0; g->buffer && i < g->buffers.count; i++) {
        free(g->buffer[i].decoded);
        file_unmap(&g->buffer[i].file);
    }
    free(g->buffer);
    free(g->accessor);
    const gltf_list *lists[] = {&g->nodes, &g->meshes, &g->accessors, &g->views, &g->buffers};
    for (size_t i = 0; i < sizeof lists / sizeof *lists; i++)
        free(lists[i]->at);
    cJSON_Delete(g->root);
    free(g);
}
