/* SPDX-License-Identifier: MIT */
/* Buffers of a document: its own chunk, embedded as a data: URI, or a file beside it. */
#include <ctype.h>
#include <stdlib.h>
#include <string.h>

#include "mesh/read/gltf.h"
#include "mesh/read/mesh_limits.h"

/* Returns the value of a base 64 digit; -1 for other characters. */
static int value_of(char c)
{
    if (c >= 'A' && c <= 'Z') return c - 'A';
    if (c >= 'a' && c <= 'z') return c - 'a' + 26;
    if (c >= '0' && c <= '9') return c - '0' + 52;
    return c == '+' || c == '-' ? 62 : c == '/' || c == '_' ? 63 : -1;
}

static status decode(const char *text, uint8_t **out, size_t *size)
{
    size_t length = strlen(text);
    while (length > 0 && text[length - 1] == '=')
        length--;
    uint8_t *to = *out = malloc(length / 4 * 3 + 3);
    if (!to) return fail(MERLIN_NO_MEMORY, "no memory for the mesh");
    uint32_t bits = 0;
    for (size_t i = 0; i < length; i++) {
        int value = value_of(text[i]);
        if (value < 0) return gltf_damaged("a data: URI that is not base 64");
        bits = bits << 6 | (uint32_t)value;
        if (i % 4 > 0) *to++ = (uint8_t)(bits >> (6 - 2 * (i % 4)));
    }
    *size = (size_t)(to - *out);
    return OK;
}

/* Decodes a data: URI. */
static status take_data(gltf_buffer *b, const char *uri)
{
    const char *comma = strchr(uri, ',');
    if (!comma || comma - uri < 7 || strncmp(comma - 7, ";base64", 7) != 0)
        return fail(MERLIN_BAD_INPUT, "a data: URI that is not base 64 is not supported");
    status s = decode(comma + 1, &b->decoded, &b->size);
    b->data = b->decoded;
    return s;
}

/* Replaces %20 and the like in a file's name, in place. */
static bool unescape(char *name)
{
    char *to = name;
    for (; *name; name++) {
        char digits[3] = {0};
        if (*name == '%' && isxdigit((unsigned char)name[1]) && isxdigit((unsigned char)name[2])) {
            memcpy(digits, name + 1, 2);
            *to = (char)strtol(digits, NULL, 16);
            if (*to++ == 0) return false;
            name += 2;
        } else {
            *to++ = *name;
        }
    }
    *to = 0;
    return true;
}

/* Maps a file beside the document. */
static status map_file(const gltf *g, gltf_buffer *b, const char *uri)
{
    if (!g->folder || strstr(uri, "://")) return fail(MERLIN_BAD_INPUT, "its buffer %.60s is no file beside it", uri);
    char *name = strdup(uri), *path = NULL;
    status s = name ? OK : fail(MERLIN_NO_MEMORY, "no memory for the mesh");
    if (s == OK && !unescape(name)) s = gltf_damaged("a URI with a zero");
    if (s == OK && !(path = file_join(g->folder, name))) s = fail(MERLIN_NO_MEMORY, "no memory for the mesh");
    if (s == OK) s = file_map(path, MESH_BYTES - g->bytes, &b->file);
    b->data = b->file.data;
    b->size = b->file.size;
    free(path);
    free(name);
    return s;
}

static status load(gltf *g, size_t index)
{
    gltf_buffer *b = &g->buffer[index];
    const cJSON *about = g->buffers.at[index];
    const char *uri = cJSON_GetStringValue(cJSON_GetObjectItemCaseSensitive(about, "uri"));
    size_t size;
    if (!gltf_whole(about, "byteLength", 0, &size)) return gltf_damaged("a buffer without a size");
    status s = OK;
    if (!uri && index == 0 && g->binary) {
        b->data = g->binary;
        b->size = g->binary_size;
    } else if (!uri) {
        s = fail(MERLIN_BAD_INPUT, "its buffer %zu is not in the file; save it without compression", index);
    } else {
        s = strncmp(uri, "data:", 5) == 0 ? take_data(b, uri) : map_file(g, b, uri);
        g->bytes += b->size;
    }
    if (s == OK && b->size < size) s = gltf_damaged("a buffer is shorter than it says");
    if (s == OK && g->bytes > MESH_BYTES) s = fail(MERLIN_BAD_INPUT, "more than %d bytes", MESH_BYTES);
    b->loaded = s == OK;
    return s;
}

status gltf_find_bytes(gltf *g, size_t buffer, size_t offset, size_t size, const uint8_t **out)
{
    if (buffer >= g->buffers.count) return gltf_damaged("a buffer that is not there");
    status s = g->buffer[buffer].loaded ? OK : load(g, buffer);
    if (s != OK) return s;
    const gltf_buffer *b = &g->buffer[buffer];
    if (offset > b->size || size > b->size - offset) return gltf_damaged("a buffer is too short for what is in it");
    *out = b->data + offset;
    return OK;
}
