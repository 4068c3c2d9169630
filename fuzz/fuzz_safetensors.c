/* SPDX-License-Identifier: MIT */
/* Weights from arbitrary bytes: whatever is accepted must lie inside the bytes and be readable to its end. */
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include "nn/safetensors.h"

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

static void read_tensor(const st_tensor *t, const uint8_t *data, size_t size)
{
    const uint8_t *at = t->data;
    if (at < data || at > data + size || t->count > size) abort();
    if (t->type == ST_I64) return;
    float *values = malloc((t->count + 1) * sizeof *values);
    if (values && st_to_float(t, values) != OK) abort();
    free(values);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    st_file *file;
    if (st_parse(data, size, &file) != OK) {
        if (strchr(status_message(), '\n')) abort();
        return 0;
    }
    for (size_t i = 0; i < st_count(file); i++) {
        const st_tensor *t = st_at(file, i);
        if (st_find(file, t->name) != t) abort();
        read_tensor(t, data, size);
    }
    st_metadata(file, "config");
    st_close(file);
    return 0;
}
