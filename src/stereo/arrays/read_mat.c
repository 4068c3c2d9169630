/* SPDX-License-Identifier: MIT */
/* Reads MATLAB's "MAT-File Format" (MathWorks, version 5 part): a header of 128 bytes, then elements of tag and data,
 * each at a multiple of eight bytes; a matrix is an element of elements: flags, sizes, name, real part. */
#include <stdlib.h>
#include <string.h>

#include "stereo/arrays/array_parts.h"

enum {
    HEADER_SIZE = 128,
    MI_MATRIX = 14,
    MI_COMPRESSED = 15,
    MI_INT32 = 5,
    MI_UINT32 = 6,
    MX_DOUBLE = 6,
    MX_UINT64 = 15
};

typedef struct span {
    const unsigned char *at;
    size_t left;
} span;

typedef struct element {
    uint32_t type;
    span data;
} element;

/* Takes the next element from the span; returns false if it is not complete. Small elements have their data in the tag.
 */
static bool take_element(span *from, element *out)
{
    if (from->left < 8) return false;
    uint32_t type = little32(from->at);
    bool small = type >> 16 != 0;
    size_t size = small ? type >> 16 : little32(from->at + 4);
    if (small ? size > 4 : size > from->left - 8) return false;
    *out = (element){type & 0xffff, {from->at + (small ? 4 : 8), size}};
    /* compressed elements are not padded */
    size_t whole = small ? 8 : 8 + (out->type == MI_COMPRESSED ? size : (size + 7) / 8 * 8);
    if (whole > from->left) whole = from->left;
    from->at += whole;
    from->left -= whole;
    return true;
}

static bool number_type_of(uint32_t type, number_type *out)
{
    static const number_type types[] = {
        [1] = {NUMBER_SIGNED, 1},  [2] = {NUMBER_UNSIGNED, 1}, [3] = {NUMBER_SIGNED, 2}, [4] = {NUMBER_UNSIGNED, 2},
        [5] = {NUMBER_SIGNED, 4},  [6] = {NUMBER_UNSIGNED, 4}, [7] = {NUMBER_FLOAT, 4},  [9] = {NUMBER_FLOAT, 8},
        [12] = {NUMBER_SIGNED, 8}, [13] = {NUMBER_UNSIGNED, 8}};
    if (type >= sizeof types / sizeof *types || types[type].bytes == 0) return false;
    *out = types[type];
    return true;
}

typedef struct wanted {
    const char *where, *variable;
    number_array *out;
    bool found;
} wanted;

static status read_values(span body, const element *sizes, const wanted *w)
{
    uint64_t size[8];
    size_t rank = sizes->data.left / 4;
    if (rank < 1 || rank > 8) return fail(MERLIN_BAD_INPUT, "%s: %s has %zu dimensions", w->where, w->variable, rank);
    for (size_t i = 0; i < rank; i++)
        size[i] = little32(sizes->data.at + 4 * i);
    element real;
    number_type type;
    if (!take_element(&body, &real) || !number_type_of(real.type, &type))
        return fail(MERLIN_BAD_INPUT, "%s: the numbers of %s are damaged", w->where, w->variable);
    w->out->column_major = true;
    status s = array_shape(w->out, size, rank, w->where);
    return s == OK ? array_fill(w->out, real.data.at, real.data.left, type, w->where) : s;
}

static status read_matrix(span body, wanted *w)
{
    element flags, sizes, name;
    if (!take_element(&body, &flags) || flags.type != MI_UINT32 || flags.data.left < 8 ||
        !take_element(&body, &sizes) || sizes.type != MI_INT32 || !take_element(&body, &name))
        return fail(MERLIN_BAD_INPUT, "%s: a variable's head is damaged", w->where);
    size_t length = strlen(w->variable);
    if (name.data.left != length || memcmp(name.data.at, w->variable, length) != 0) return OK;
    uint32_t class = flags.data.at[0];
    if (class < MX_DOUBLE || class > MX_UINT64)
        return fail(MERLIN_BAD_INPUT, "%s: %s is not an array of numbers", w->where, w->variable);
    w->found = true;
    return read_values(body, &sizes, w);
}

/* Tells whether zlib can inflate `size` bytes to this size (its ratio is below 1032). */
static bool possible_size(size_t inflated, size_t size)
{
    return inflated <= ARRAY_MOST_BYTES && inflated / 1032 <= size;
}

static status read_compressed(span packed, wanted *w)
{
    unsigned char tag[8];
    if (!array_inflate(packed.at, packed.left, 15, tag, sizeof tag))
        return fail(MERLIN_BAD_INPUT, "%s: a compressed variable is damaged", w->where);
    size_t size = little32(tag + 4);
    if (little32(tag) != MI_MATRIX) return OK;
    if (!possible_size(size, packed.left))
        return fail(MERLIN_BAD_INPUT, "%s: a compressed variable says it has %zu bytes; the file is damaged", w->where,
                    size);
    unsigned char *bytes = malloc(size + 8);
    if (!bytes) return fail(MERLIN_NO_MEMORY, "no memory for %zu bytes of %s", size, w->where);
    status s = array_inflate(packed.at, packed.left, 15, bytes, size + 8)
                   ? read_matrix((span){bytes + 8, size}, w)
                   : fail(MERLIN_BAD_INPUT, "%s: a compressed variable is damaged", w->where);
    free(bytes);
    return s;
}

static status read_elements(span rest, wanted *w)
{
    element e;
    while (!w->found && rest.left >= 8) {
        if (!take_element(&rest, &e))
            return fail(MERLIN_BAD_INPUT, "%s: the file ends inside a variable; it is damaged", w->where);
        status s = OK;
        if (e.type == MI_COMPRESSED) s = read_compressed(e.data, w);
        if (e.type == MI_MATRIX) s = read_matrix(e.data, w);
        if (s != OK) return s;
    }
    return w->found ? OK : fail(MERLIN_BAD_INPUT, "%s has no variable %s", w->where, w->variable);
}

status mat_parse(const char *bytes, size_t size, const char *where, const char *variable, number_array *out)
{
    *out = (number_array){0};
    const unsigned char *at = (const unsigned char *)bytes;
    if (size < HEADER_SIZE || memcmp(bytes, "MATLAB 5.0", 10) != 0)
        return fail(MERLIN_BAD_INPUT, "%s is not a MATLAB 5 file; in MATLAB: save(..., '-v6') or '-v7'", where);
    if (memcmp(bytes + 126, "IM", 2) != 0)
        return fail(MERLIN_BAD_INPUT, "%s was written on a big-endian machine, which is not read here", where);
    wanted w = {where, variable, out, false};
    status s = read_elements((span){at + HEADER_SIZE, size - HEADER_SIZE}, &w);
    if (s != OK) array_free(out);
    return s;
}

status mat_read(const char *path, const char *variable, number_array *out)
{
    return array_read(mat_parse, path, variable, out);
}
