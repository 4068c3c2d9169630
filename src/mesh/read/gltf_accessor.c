/* SPDX-License-Identifier: MIT */
/* Accessors: numbers of six types in a buffer, packed or strided, some of them replaced by sparse values. */
#include <math.h>
#include <string.h>

#include "mesh/read/gltf.h"

enum { I8 = 5120, U8, I16, U16, U32 = 5125, F32, COUNT_LIMIT = 20000000 };

static size_t bytes_of(size_t type)
{
    switch (type) {
    case I8:
    case U8:
        return 1;
    case I16:
    case U16:
        return 2;
    case U32:
    case F32:
        return 4;
    default:
        return 0;
    }
}

static int components_of(const char *type)
{
    static const char *const names[] = {"SCALAR", "VEC2", "VEC3", "VEC4"};
    for (int i = 0; type && i < 4; i++)
        if (strcmp(type, names[i]) == 0) return i + 1;
    return 0;
}

/* Finds `count` elements of `size` bytes in the view that `about` names; *stride becomes their distance. */
static status find_elements(gltf *g, const cJSON *about, size_t count, size_t size, const uint8_t **data,
                            size_t *stride)
{
    size_t view, offset, buffer, start, length;
    if (!gltf_whole(about, "bufferView", SIZE_MAX, &view) || !gltf_whole(about, "byteOffset", 0, &offset) ||
        view >= g->views.count)
        return gltf_damaged("a buffer view that is not there");
    const cJSON *v = g->views.at[view];
    if (!gltf_whole(v, "buffer", SIZE_MAX, &buffer) || !gltf_whole(v, "byteOffset", 0, &start) ||
        !gltf_whole(v, "byteLength", 0, &length) || !gltf_whole(v, "byteStride", 0, stride))
        return gltf_damaged("a buffer view that is not whole");
    if (*stride == 0) *stride = size;
    if (*stride < size || *stride > 252) return gltf_damaged("a buffer view whose elements overlap");
    size_t needed = count > 0 ? (count - 1) * *stride + size : 0;
    if (offset > length || needed > length - offset) return gltf_damaged("a buffer view is too short");
    return gltf_find_bytes(g, buffer, start + offset, needed, data);
}

static size_t whole_at(const uint8_t *at, int type)
{
    uint16_t half;
    uint32_t word;
    switch (type) {
    case U8:
        return *at;
    case U16:
        memcpy(&half, at, sizeof half);
        return half;
    default:
        memcpy(&word, at, sizeof word);
        return word;
    }
}

static double number_at(const uint8_t *at, int type, bool normalized)
{
    union {
        int8_t i8;
        int16_t i16;
        float f32;
    } u;
    memcpy(&u, at, bytes_of((size_t)type));
    switch (type) {
    case I8:
        return normalized ? fmax(u.i8 / 127.0, -1) : u.i8;
    case I16:
        return normalized ? fmax(u.i16 / 32767.0, -1) : u.i16;
    case F32:
        return (double)u.f32;
    case U8:
        return (double)whole_at(at, type) / (normalized ? 255.0 : 1);
    case U16:
        return (double)whole_at(at, type) / (normalized ? 65535.0 : 1);
    default:
        return (double)whole_at(at, type) / (normalized ? 4294967295.0 : 1);
    }
}

static status read_sparse(gltf *g, const cJSON *about, gltf_accessor *a)
{
    const cJSON *indices = cJSON_GetObjectItemCaseSensitive(about, "indices");
    const cJSON *values = cJSON_GetObjectItemCaseSensitive(about, "values");
    size_t type, stride = 0, size = bytes_of((size_t)a->type) * (size_t)a->components;
    if (!gltf_whole(about, "count", 0, &a->sparse_count) || !gltf_whole(indices, "componentType", 0, &type) ||
        (type != U8 && type != U16 && type != U32))
        return gltf_damaged("a sparse accessor that is not whole");
    if (a->sparse_count > a->count) return gltf_damaged("a sparse accessor replaces more than there is");
    a->sparse_type = (int)type;
    status s = find_elements(g, indices, a->sparse_count, bytes_of(type), &a->sparse_index, &stride);
    if (s == OK && stride != bytes_of(type)) s = gltf_damaged("a sparse accessor whose elements lie apart");
    if (s == OK) s = find_elements(g, values, a->sparse_count, size, &a->sparse_value, &stride);
    if (s == OK && stride != size) s = gltf_damaged("a sparse accessor whose elements lie apart");
    size_t next = 0;
    for (size_t i = 0; s == OK && i < a->sparse_count; i++) {
        size_t place = whole_at(a->sparse_index + i * bytes_of(type), a->sparse_type);
        if (place < next || place >= a->count) s = gltf_damaged("a sparse accessor whose places do not ascend");
        next = place + 1;
    }
    return s;
}

static status read_accessor(gltf *g, const cJSON *about, gltf_accessor *a)
{
    const cJSON *sparse = cJSON_GetObjectItemCaseSensitive(about, "sparse");
    size_t type;
    a->components = components_of(cJSON_GetStringValue(cJSON_GetObjectItemCaseSensitive(about, "type")));
    a->normalized = cJSON_IsTrue(cJSON_GetObjectItemCaseSensitive(about, "normalized"));
    if (!gltf_whole(about, "count", 0, &a->count) || !gltf_whole(about, "componentType", 0, &type) ||
        bytes_of(type) == 0 || a->components == 0)
        return gltf_damaged("an accessor without type or count");
    a->type = (int)type;
    if (a->count > COUNT_LIMIT)
        return fail(MERLIN_BAD_INPUT, "%zu vertices or corners; at most %d", a->count, COUNT_LIMIT);
    bool stored = cJSON_HasObjectItem(about, "bufferView");
    if (!stored && !sparse) return fail(MERLIN_BAD_INPUT, "a mesh that is not stored; save it without compression");
    status s =
        stored ? find_elements(g, about, a->count, bytes_of(type) * (size_t)a->components, &a->data, &a->stride) : OK;
    return s == OK && sparse ? read_sparse(g, sparse, a) : s;
}

status gltf_find_accessor(gltf *g, size_t index, gltf_accessor *out)
{
    if (index >= g->accessors.count) return gltf_damaged("an accessor that is not there");
    gltf_accessor *a = &g->accessor[index];
    status s = a->known ? OK : read_accessor(g, g->accessors.at[index], a);
    a->known = s == OK;
    *out = *a;
    return s;
}

/* Returns where the i-th element is; NULL for zero. */
static const uint8_t *element_at(const gltf_accessor *a, size_t i)
{
    size_t low = 0, high = a->sparse_count, place_bytes = bytes_of((size_t)a->sparse_type);
    while (low < high) {
        size_t middle = (low + high) / 2, place = whole_at(a->sparse_index + middle * place_bytes, a->sparse_type);
        if (place == i) return a->sparse_value + middle * bytes_of((size_t)a->type) * (size_t)a->components;
        if (place < i)
            low = middle + 1;
        else
            high = middle;
    }
    return a->data ? a->data + i * a->stride : NULL;
}

void gltf_numbers(const gltf_accessor *a, size_t i, double *out)
{
    const uint8_t *at = element_at(a, i);
    for (int k = 0; k < a->components; k++)
        out[k] = at ? number_at(at + (size_t)k * bytes_of((size_t)a->type), a->type, a->normalized) : 0;
}

size_t gltf_place(const gltf_accessor *a, size_t i)
{
    const uint8_t *at = element_at(a, i);
    return at ? whole_at(at, a->type) : 0;
}

bool gltf_holds_places(const gltf_accessor *a)
{
    return a->components == GLTF_SCALAR && (a->type == U8 || a->type == U16 || a->type == U32);
}
