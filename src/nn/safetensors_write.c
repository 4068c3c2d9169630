/* SPDX-License-Identifier: MIT */
/* Writes safetensors files: the whole file is assembled in memory and written at once. */
#include "nn/safetensors.h"

#include <libdeflate.h>
#include <stdlib.h>
#include <string.h>

#include "base/file.h"
#include "base/json/json_put.h"
#include "nn/safetensors_format.h"

static void describe(cJSON *header, const safetensors_tensor *t, size_t begin)
{
    cJSON *item = json_put_object(header, t->name);
    json_put_text(item, "dtype", safetensors_type_name(t->type));
    cJSON *shape = json_put_array(item, "shape"), *offsets = json_put_array(item, "data_offsets");
    for (int i = 0; i < t->rank; i++)
        json_append(shape, cJSON_CreateNumber((double)t->shape[i]));
    json_append(offsets, cJSON_CreateNumber((double)begin));
    json_append(offsets, cJSON_CreateNumber((double)(begin + safetensors_bytes_of(t))));
}

static void describe_metadata(cJSON *header, const char *const (*metadata)[2], size_t count, const char *checksum)
{
    cJSON *item = json_put_object(header, "__metadata__");
    for (size_t i = 0; i < count; i++)
        if (strcmp(metadata[i][0], SAFETENSORS_CHECKSUM) != 0) json_put_text(item, metadata[i][0], metadata[i][1]);
    json_put_text(item, SAFETENSORS_CHECKSUM, checksum);
}

/* Returns the header as malloc'ed JSON; NULL if memory ran out. */
static char *header_of(const safetensors_tensor *tensors, size_t count, const char *const (*metadata)[2],
                       size_t metadata_count)
{
    uint32_t sum = 0;
    cJSON *header = cJSON_CreateObject();
    size_t at = 0;
    for (size_t i = 0; i < count; i++) {
        describe(header, &tensors[i], at);
        at += safetensors_bytes_of(&tensors[i]);
        /* libdeflate restarts the checksum when given NULL, as an empty tensor's data is */
        if (tensors[i].count > 0) sum = libdeflate_crc32(sum, tensors[i].data, safetensors_bytes_of(&tensors[i]));
    }
    char checksum[SAFETENSORS_CHECKSUM_SIZE];
    safetensors_format_checksum(sum, checksum);
    describe_metadata(header, metadata, metadata_count, checksum);
    char *text = json_print_line(header);
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
