/* SPDX-License-Identifier: MIT */
/* Reads safetensors files: the header is parsed into a list of tensors sorted by position, each is checked, then the
 * list as a whole, then the data's checksum. */
#include "nn/safetensors.h"

#include <cjson/cJSON.h>
#include <errno.h>
#include <libdeflate.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

#include "base/file.h"
#include "base/half.h"
#include "nn/safetensors_format.h"

/* Largest file that is read. Files are mapped, not copied; checkpoints are four times a model's size, and one that was
 * written must be readable. */
static const size_t FILE_LIMIT = (size_t)1 << 36;
enum { WORTH_SHARING = 1 << 16 /* values: for fewer a second thread is not woken */ };

struct safetensors_file {
    file_view view; /* the mapped bytes, if safetensors_open mapped them */
    cJSON *header;
    safetensors_tensor *tensors; /* sorted by position */
    const safetensors_tensor **by_name;
    size_t count;
    const char *where;
    const unsigned char *data;
    size_t data_size;
};

const char *safetensors_type_name(safetensors_type type)
{
    static const char *const names[SAFETENSORS_TYPES] = {"F32", "F16", "BF16", "I64"};
    return names[type];
}

/* Returns where a tensor begins in the data. */
static size_t begin_of(const safetensors_file *f, const safetensors_tensor *t)
{
    return (size_t)((const unsigned char *)t->data - f->data);
}

/* Reads a non-negative whole number that a double holds exactly. */
static bool read_size(const cJSON *item, size_t *out)
{
    if (!cJSON_IsNumber(item)) return false;
    double d = item->valuedouble;
    if (!(d >= 0 && d <= 0x1p53) || d != (double)(uint64_t)d) return false;
    *out = (size_t)d;
    return true;
}

static bool read_type(const cJSON *item, safetensors_type *out)
{
    if (!cJSON_IsString(item)) return false;
    for (int t = 0; t < SAFETENSORS_TYPES; t++) {
        if (strcmp(item->valuestring, safetensors_type_name((safetensors_type)t)) != 0) continue;
        *out = (safetensors_type)t;
        return true;
    }
    return false;
}

static bool read_shape(const cJSON *item, safetensors_tensor *t)
{
    int rank = cJSON_IsArray(item) ? cJSON_GetArraySize(item) : -1;
    if (rank < 0 || rank > 4) return false;
    t->rank = rank;
    t->count = 1;
    const cJSON *dimension;
    int i = 0;
    cJSON_ArrayForEach(dimension, item)
    {
        size_t size;
        if (!read_size(dimension, &size) || __builtin_mul_overflow(t->count, size, &t->count)) return false;
        t->shape[i++] = (int64_t)size;
    }
    return true;
}

static status read_tensor(const safetensors_file *f, const cJSON *item, safetensors_tensor *t)
{
    const cJSON *type = cJSON_GetObjectItemCaseSensitive(item, "dtype");
    const cJSON *shape = cJSON_GetObjectItemCaseSensitive(item, "shape");
    const cJSON *offsets = cJSON_GetObjectItemCaseSensitive(item, "data_offsets");
    *t = (safetensors_tensor){.name = item->string};
    if (!cJSON_IsObject(item) || cJSON_GetArraySize(item) != 3 || !type || !shape || !offsets)
        return fail(MERLIN_BAD_INPUT, "%s: the tensor \"%s\" needs dtype, shape and data_offsets", f->where, t->name);
    if (!read_type(type, &t->type))
        return fail(MERLIN_BAD_INPUT, "%s: the tensor \"%s\" has a type other than F32, F16, BF16 or I64", f->where,
                    t->name);
    if (!read_shape(shape, t))
        return fail(MERLIN_BAD_INPUT, "%s: the tensor \"%s\" has no shape of up to four sizes", f->where, t->name);
    size_t begin, end, bytes;
    if (!cJSON_IsArray(offsets) || cJSON_GetArraySize(offsets) != 2 || !read_size(offsets->child, &begin) ||
        !read_size(offsets->child->next, &end) || begin > end)
        return fail(MERLIN_BAD_INPUT, "%s: the tensor \"%s\" has no usable data_offsets", f->where, t->name);
    if (__builtin_mul_overflow(t->count, safetensors_type_size(t->type), &bytes) || bytes != end - begin)
        return fail(MERLIN_BAD_INPUT, "%s: the shape of the tensor \"%s\" does not fit its %zu bytes", f->where,
                    t->name, end - begin);
    if (end > f->data_size)
        return fail(MERLIN_BAD_INPUT, "%s is truncated: the tensor \"%s\" ends at byte %zu of %zu", f->where, t->name,
                    end, f->data_size);
    t->data = f->data + begin;
    return OK;
}

static int compare_places(const void *a, const void *b)
{
    const safetensors_tensor *x = a, *y = b;
    if (x->data != y->data) return (const char *)x->data < (const char *)y->data ? -1 : 1;
    size_t size_x = safetensors_bytes_of(x), size_y = safetensors_bytes_of(y);
    if (size_x != size_y) return size_x < size_y ? -1 : 1;
    return strcmp(x->name, y->name);
}

/* Checks that the tensors tile the data without gaps, overlaps or a remainder. */
static status check_places(const safetensors_file *f)
{
    size_t expected = 0;
    for (size_t i = 0; i < f->count; i++) {
        const safetensors_tensor *t = &f->tensors[i];
        if (begin_of(f, t) != expected)
            return fail(MERLIN_BAD_INPUT, "%s: the tensor \"%s\" %s", f->where, t->name,
                        begin_of(f, t) < expected ? "overlaps another" : "has a hole before it");
        expected += safetensors_bytes_of(t);
    }
    if (expected != f->data_size)
        return fail(MERLIN_BAD_INPUT, "%s has %zu bytes behind its last tensor", f->where, f->data_size - expected);
    return OK;
}

static int compare_names(const void *a, const void *b)
{
    return strcmp(*(const char *const *)a, *(const char *const *)b);
}

/* Tells whether a name can be part of a message, which is one line on a terminal. */
static bool is_printable(const char *name)
{
    for (; *name; name++)
        if ((unsigned char)*name < ' ' || *name == 0x7f) return false;
    return true;
}

static status check_keys(const safetensors_file *f, const cJSON *object)
{
    size_t count = (size_t)cJSON_GetArraySize(object), i = 0;
    const char **names = malloc((count + 1) * sizeof *names);
    if (!names) return fail(MERLIN_NO_MEMORY, "no memory for the names in %s", f->where);
    const cJSON *item;
    status s = OK;
    cJSON_ArrayForEach(item, object)
    {
        if (!is_printable(item->string))
            s = fail(MERLIN_BAD_INPUT, "%s: a name has characters that do not print", f->where);
        names[i++] = item->string;
    }
    qsort(names, count, sizeof *names, compare_names);
    for (i = 1; s == OK && i < count; i++)
        if (strcmp(names[i - 1], names[i]) == 0)
            s = fail(MERLIN_BAD_INPUT, "%s: \"%s\" is there twice", f->where, names[i]);
    free(names);
    return s;
}

static status check_metadata(const safetensors_file *f, const cJSON *metadata)
{
    if (!cJSON_IsObject(metadata)) return fail(MERLIN_BAD_INPUT, "%s: __metadata__ is not an object", f->where);
    const cJSON *item;
    cJSON_ArrayForEach(item, metadata)
    {
        if (!cJSON_IsString(item))
            return fail(MERLIN_BAD_INPUT, "%s: the metadata \"%s\" is not a string", f->where, item->string);
    }
    return check_keys(f, metadata);
}

static status read_tensors(safetensors_file *f)
{
    status s = check_keys(f, f->header);
    if (s != OK) return s;
    f->tensors = calloc((size_t)cJSON_GetArraySize(f->header) + 1, sizeof *f->tensors);
    if (!f->tensors) return fail(MERLIN_NO_MEMORY, "no memory for the tensors of %s", f->where);
    const cJSON *item;
    cJSON_ArrayForEach(item, f->header)
    {
        s = strcmp(item->string, "__metadata__") == 0 ? check_metadata(f, item)
                                                      : read_tensor(f, item, &f->tensors[f->count++]);
        if (s != OK) return s;
    }
    qsort(f->tensors, f->count, sizeof *f->tensors, compare_places);
    return check_places(f);
}

static int compare_tensors(const void *a, const void *b)
{
    return strcmp((*(const safetensors_tensor *const *)a)->name, (*(const safetensors_tensor *const *)b)->name);
}

static status index_names(safetensors_file *f)
{
    f->by_name = malloc((f->count + 1) * sizeof *f->by_name);
    if (!f->by_name) return fail(MERLIN_NO_MEMORY, "no memory for the names in %s", f->where);
    for (size_t i = 0; i < f->count; i++)
        f->by_name[i] = &f->tensors[i];
    qsort(f->by_name, f->count, sizeof *f->by_name, compare_tensors);
    return OK;
}

static status check_sum(const safetensors_file *f)
{
    const char *written = safetensors_metadata(f, SAFETENSORS_CHECKSUM);
    if (!written) return OK;
    char found[SAFETENSORS_CHECKSUM_SIZE];
    safetensors_format_checksum(libdeflate_crc32(0, f->data, f->data_size), found);
    if (strcmp(written, found) == 0) return OK;
    return fail(MERLIN_BAD_INPUT, "%s was altered: its data's checksum is %s, not the recorded one; get the file again",
                f->where, found);
}

static bool only_spaces(const char *begin, const char *end)
{
    while (begin < end && *begin == ' ')
        begin++;
    return begin == end;
}

static status read_header(safetensors_file *f, const unsigned char *bytes, size_t size)
{
    uint64_t length = 0;
    for (size_t i = 0; i < SAFETENSORS_PREFIX && i < size; i++)
        length |= (uint64_t)bytes[i] << (8 * i);
    if (size <= SAFETENSORS_PREFIX || bytes[SAFETENSORS_PREFIX] != '{' || length < 2 ||
        length > SAFETENSORS_HEADER_LIMIT)
        return fail(MERLIN_BAD_INPUT, "%s is not a safetensors file", f->where);
    if (length > size - SAFETENSORS_PREFIX)
        return fail(MERLIN_BAD_INPUT, "%s is truncated: %zu bytes do not hold its header", f->where, size);
    const char *header = (const char *)bytes + SAFETENSORS_PREFIX, *end = NULL;
    errno = 0;
    f->header = cJSON_ParseWithLengthOpts(header, (size_t)length, &end, false);
    if (!f->header && status_by_errno(MERLIN_BAD_INPUT) == MERLIN_NO_MEMORY)
        return fail(MERLIN_NO_MEMORY, "no memory to read the header of %s", f->where);
    if (!cJSON_IsObject(f->header) || !only_spaces(end, header + length))
        return fail(MERLIN_BAD_INPUT, "%s is not a safetensors file: its header is not a JSON object", f->where);
    f->data = bytes + SAFETENSORS_PREFIX + length;
    f->data_size = size - SAFETENSORS_PREFIX - (size_t)length;
    status s = read_tensors(f);
    if (s == OK) s = index_names(f);
    return s == OK ? check_sum(f) : s;
}

/* Parses a file and takes over `view`. */
static status parse(const char *where, file_view view, const void *bytes, size_t size, safetensors_file **out)
{
    safetensors_file *f = calloc(1, sizeof *f);
    if (!f) {
        file_unmap(&view);
        return fail(MERLIN_NO_MEMORY, "no memory to read %s", where);
    }
    f->view = view;
    f->where = where;
    status s = read_header(f, bytes, size);
    f->where = NULL;
    if (s != OK) {
        safetensors_close(f);
        return s;
    }
    *out = f;
    return OK;
}

status safetensors_parse(const void *bytes, size_t size, safetensors_file **out)
{
    return parse("the weights", (file_view){0}, bytes, size, out);
}

status safetensors_open(const char *path, safetensors_file **out)
{
    file_view view;
    status s = file_map(path, FILE_LIMIT, &view);
    return s == OK ? parse(path, view, view.data, view.size, out) : s;
}

void safetensors_close(safetensors_file *f)
{
    if (!f) return;
    cJSON_Delete(f->header);
    free(f->tensors);
    free(f->by_name);
    file_unmap(&f->view);
    free(f);
}

size_t safetensors_count(const safetensors_file *f)
{
    return f->count;
}

const safetensors_tensor *safetensors_at(const safetensors_file *f, size_t i)
{
    return &f->tensors[i];
}

const safetensors_tensor *safetensors_find(const safetensors_file *f, const char *name)
{
    const safetensors_tensor sought = {.name = name}, *key = &sought;
    const safetensors_tensor **found = bsearch(&key, f->by_name, f->count, sizeof *f->by_name, compare_tensors);
    return found ? *found : NULL;
}

const char *safetensors_metadata(const safetensors_file *f, const char *key)
{
    const cJSON *metadata = cJSON_GetObjectItemCaseSensitive(f->header, "__metadata__");
    return cJSON_GetStringValue(cJSON_GetObjectItemCaseSensitive(metadata, key));
}

status safetensors_to_float(const safetensors_tensor *t, float *out)
{
    if (t->type == SAFETENSORS_I64)
        return fail(MERLIN_BAD_INPUT, "the tensor \"%s\" holds integers, not weights", t->name);
    if (t->type == SAFETENSORS_F32) {
        memcpy(out, t->data, t->count * sizeof *out);
        return OK;
    }
    const unsigned char *from = t->data;
#pragma omp parallel for simd schedule(static) if (t->count > WORTH_SHARING)
    for (size_t i = 0; i < t->count; i++) {
        uint16_t h;
        memcpy(&h, from + 2 * i, sizeof h);
        out[i] = t->type == SAFETENSORS_F16 ? half_to_float(h) : bf16_to_float(h);
    }
    return OK;
}
