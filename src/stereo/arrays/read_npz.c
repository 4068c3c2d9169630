/* SPDX-License-Identifier: MIT */
/* Reads NumPy's .npz: a ZIP archive (PKWARE's APPNOTE.TXT; sizes are taken from the central directory, as streaming
 * writers omit them from the local headers) of .npy files (NumPy Enhancement Proposal 1): magic, version, a Python
 * dictionary, numbers. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "stereo/arrays/array_parts.h"

enum { END_SIZE = 22, ENTRY_SIZE = 46, LOCAL_SIZE = 30, MOST_COMMENT = 65535, STORED = 0, DEFLATED = 8 };

typedef struct zip {
    const unsigned char *bytes;
    size_t size;
    const char *where;
} zip;

typedef struct member {
    uint32_t method, packed, whole, offset;
} member;

static status damaged(const zip *z, const char *what)
{
    return fail(MERLIN_BAD_INPUT, "%s: %s is damaged", z->where, what);
}

/* Returns the end record, which a comment may follow; NULL if there is none. */
static const unsigned char *find_end(const zip *z)
{
    for (size_t back = END_SIZE; back <= z->size && back <= END_SIZE + MOST_COMMENT; back++) {
        const unsigned char *p = z->bytes + z->size - back;
        if (little32(p) == 0x06054b50) return p;
    }
    return NULL;
}

static bool is_named(const unsigned char *name, size_t length, const char *wanted)
{
    size_t n = strlen(wanted);
    if (length < n || memcmp(name, wanted, n) != 0) return false;
    return length == n || (length == n + 4 && memcmp(name + n, ".npy", 4) == 0);
}

static status find_member(const zip *z, const char *name, member *out)
{
    const unsigned char *end = find_end(z);
    if (!end) return fail(MERLIN_BAD_INPUT, "%s is not an .npz file, or it is cut off", z->where);
    uint32_t count = little16(end + 10);
    size_t at = little32(end + 16);
    for (uint32_t i = 0; i < count; i++) {
        if (at > z->size || z->size - at < ENTRY_SIZE) return damaged(z, "its directory");
        const unsigned char *e = z->bytes + at;
        size_t length = little16(e + 28), whole = ENTRY_SIZE + length + little16(e + 30) + little16(e + 32);
        if (little32(e) != 0x02014b50 || z->size - at < whole) return damaged(z, "its directory");
        if (is_named(e + ENTRY_SIZE, length, name)) {
            *out = (member){little16(e + 10), little32(e + 20), little32(e + 24), little32(e + 42)};
            return OK;
        }
        at += whole;
    }
    return fail(MERLIN_BAD_INPUT, "%s has no array %s", z->where, name);
}

static status unpack(const zip *z, const member *m, unsigned char **out)
{
    if (m->offset > z->size || z->size - m->offset < LOCAL_SIZE) return damaged(z, "an entry");
    const unsigned char *local = z->bytes + m->offset;
    size_t head = LOCAL_SIZE + little16(local + 26) + little16(local + 28), left = z->size - m->offset;
    if (little32(local) != 0x04034b50 || left < head || left - head < m->packed) return damaged(z, "an entry");
    if (m->whole > ARRAY_MOST_BYTES || m->whole / 1032 > m->packed) return damaged(z, "an entry's size");
    if (m->method == STORED && m->packed != m->whole) return damaged(z, "an entry's size");
    unsigned char *bytes = malloc((size_t)m->whole + 1);
    if (!bytes) return fail(MERLIN_NO_MEMORY, "no memory for %u bytes of %s", m->whole, z->where);
    status s = OK;
    if (m->method == STORED)
        memcpy(bytes, local + head, m->whole);
    else if (m->method != DEFLATED)
        s = fail(MERLIN_BAD_INPUT, "%s: packed by method %u; only deflate is read", z->where, m->method);
    else if (!array_inflate(local + head, m->packed, -15, bytes, m->whole))
        s = damaged(z, "packed data");
    if (s == OK)
        *out = bytes;
    else
        free(bytes);
    return s;
}

/* Returns what follows 'key': in the header's dictionary; NULL if it is not there. */
static const char *value_of(const char *header, const char *key)
{
    const char *at = strstr(header, key);
    at = at ? strchr(at, ':') : NULL;
    return at ? at + 1 + strspn(at + 1, " ") : NULL;
}

static bool parse_type(const char *text, number_type *out)
{
    char order, kind;
    int bytes;
    if (!text || sscanf(text, "'%c%c%d'", &order, &kind, &bytes) != 3) return false;
    if (order != '<' && !(order == '|' && bytes == 1)) return false;
    if (bytes != 1 && bytes != 2 && bytes != 4 && bytes != 8) return false;
    out->bytes = (size_t)bytes;
    out->kind = kind == 'f' ? NUMBER_FLOAT : kind == 'i' ? NUMBER_SIGNED : NUMBER_UNSIGNED;
    return kind == 'i' || kind == 'u' || (kind == 'f' && bytes > 1);
}

static bool parse_shape(const char *text, uint64_t size[8], size_t *rank)
{
    *rank = 0;
    if (!text || *text++ != '(') return false;
    while (*rank < 8) {
        text += strspn(text, " ,");
        if (*text == ')') return *rank > 0;
        char *end;
        if (*text < '0' || *text > '9') return false;
        size[(*rank)++] = strtoull(text, &end, 10);
        text = end;
    }
    return false;
}

static status parse_header(const zip *z, const char *header, number_array *out, number_type *type)
{
    uint64_t size[8];
    size_t rank;
    const char *order = value_of(header, "'fortran_order'");
    if (!parse_type(value_of(header, "'descr'"), type) || !order ||
        !parse_shape(value_of(header, "'shape'"), size, &rank))
        return fail(MERLIN_BAD_INPUT, "%s: the array is not of little-endian numbers, or its header is damaged",
                    z->where);
    out->column_major = strncmp(order, "True", 4) == 0;
    return array_shape(out, size, rank, z->where);
}

static status parse_npy(const zip *z, const unsigned char *bytes, size_t size, number_array *out)
{
    if (size < 12 || memcmp(bytes, "\x93NUMPY", 6) != 0) return damaged(z, "the array's head");
    size_t start = bytes[6] >= 2 ? 12 : 10, length = bytes[6] >= 2 ? little32(bytes + 8) : little16(bytes + 8);
    if (length > size - start) return damaged(z, "the array's head");
    char *header = strndup((const char *)bytes + start, length);
    if (!header) return fail(MERLIN_NO_MEMORY, "no memory for a header of %zu bytes", length);
    number_type type;
    status s = parse_header(z, header, out, &type);
    free(header);
    return s == OK ? array_fill(out, bytes + start + length, size - start - length, type, z->where) : s;
}

status npz_parse(const char *bytes, size_t size, const char *where, const char *name, number_array *out)
{
    *out = (number_array){0};
    zip z = {(const unsigned char *)bytes, size, where};
    member m = {0};
    unsigned char *npy = NULL;
    status s = find_member(&z, name, &m);
    if (s == OK) s = unpack(&z, &m, &npy);
    if (s != OK) return s;
    s = parse_npy(&z, npy, m.whole, out);
    free(npy);
    if (s != OK) array_free(out);
    return s;
}

status npz_read(const char *path, const char *name, number_array *out)
{
    return array_read(npz_parse, path, name, out);
}
