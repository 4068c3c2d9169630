/* SPDX-License-Identifier: MIT */
/* Writing: the whole file is put together in memory and written at once. */
#include "nn/safetensors.h"

#include <cjson/cJSON.h>
#include <libdeflate.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

#include "base/file.h"
#include "nn/safetensors_format.h"

static bool add_number(cJSON *array, double value)
{
    return cJSON_AddItemToArray(array, cJSON_CreateNumber(value));
}

static bool describe(cJSON *header, const safetensors_tensor *t, size_t begin)
{
    cJSON *item = cJSON_AddObjectToObject(header, t->name);
    if (!item || !cJSON_AddStringToObject(item, "dtype", safetensors_type_name(t->type))) return false;
    cJSON *shape = cJSON_AddArrayToObject(item, "shape"), *offsets = cJSON_AddArrayToObject(item, "data_offsets");
    if (!shape || !offsets) return false;
    for (int i = 0; i < t->rank; i++)
        if (!add_number(shape, (double)t->shape[i])) return false;
    return add_number(offsets, (double)begin) && add_number(offsets, (double)(begin + safetensors_bytes_of(t)));
}

static bool describe_metadata(cJSON *header, const char *const (*metadata)[2], size_t count, const char *checksum)
{
    cJSON *item = cJSON_AddObjectToObject(header, "__metadata__");
    if (!item) return false;
    for (size_t i = 0; i < count; i++) {
        if (strcmp(metadata[i][0], SAFETENSORS_CHECKSUM) == 0) continue;
        if (!cJSON_AddStringToObject(item, metadata[i][0], metadata[i][1])) return false;
    }
    return cJSON_AddStringToObject(item, SAFETENSORS_CHECKSUM, checksum);
}

/* malloc'ed JSON; NULL when memory runs out. */
static char *header_of(const safetensors_tensor *tensors, size_t count, const char *const (*metadata)[2],
                       size_t metadata_count)
{
    uint32_t sum = 0;
    cJSON *header = cJSON_CreateObject();
    bool good = header;
    size_t at = 0;
    for (size_t i = 0; good && i < count; i++) {
        good = describe(header, &tensors[i], at);
        at += safetensors_bytes_of(&tensors[i]);
        /* it starts over when given no buffer, as an empty tensor has none */
        if (tensors[i].count > 0) sum = libdeflate_crc32(sum, tensors[i].data, safetensors_bytes_of(&tensors[i]));
    }
    char checksum[SAFETENSORS_CHECKSUM_SIZE];
    safetensors_format_checksum(sum, checksum);
    good = good && describe_metadata(header, metadata, metadata_count, checksum);
    char *text = good ? cJSON_PrintUnformatted(header) : NULL;
    cJSON_Delete(header);
    return text;
}

static char *assemble(const char *header, const safetensors_tensor *tensors, size_t count, size_t *size)
{
    size_t length = strlen(header), padded = (length + 7) / 8 * 8, total = SAFETENSORS_PREFIX + padded;
    for (size_t i = 0; i < count; i++)
        total += safetensors_bytes_of(&tensors[i]);
    char *file = malloc(total), *p = file;
    if (!file) return NULL;
    for (size_t i = 0; i < SAFETENSORS_PREFIX; i++)
        *p++ = (char)(unsigned char)(padded >> (8 * i));
    memcpy(p, header, length);
    memset(p + length, ' ', padded - length);
    p += padded;
    for (size_t i = 0; i < count; i++) {
        if (tensors[i].count > 0) memcpy(p, tensors[i].data, safetensors_bytes_of(&tensors[i]));
        p += safetensors_bytes_of(&tensors[i]);
    }
    *size = total;
    return file;
}

status safetensors_write(const char *path, const safetensors_tensor *tensors, size_t count,
                         const char *const (*metadata)[2], size_t metadata_count)
{
    char *header = header_of(tensors, count, metadata, metadata_count);
    if (header && strlen(header) > SAFETENSORS_HEADER_LIMIT - 8) {
        free(header);
        return fail(MERLIN_CANNOT_WRITE, "cannot write %s: its header would be over %d bytes", path,
                    SAFETENSORS_HEADER_LIMIT);
    }
    size_t size = 0;
    char *file = header ? assemble(header, tensors, count, &size) : NULL;
    free(header);
    if (!file) return fail(MERLIN_NO_MEMORY, "no memory to write %s", path);
    status s = file_write_durable(path, file, size);
    free(file);
    return s;
}
