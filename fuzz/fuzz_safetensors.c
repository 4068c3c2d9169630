/* SPDX-License-Identifier: MIT */
/* Weights from arbitrary bytes: whatever is accepted must lie inside the bytes and be readable to its end. */
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include "nn/safetensors.h"

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

static void read_tensor(const safetensors_tensor *t, const uint8_t *data, size_t size)
{
    const uint8_t *at = t->data;
    if (at < data || at > data + size || t->count > size) abort();
    if (t->type == SAFETENSORS_I64) return;
    float *values = malloc((t->count + 1) * sizeof *values);
    if (values && safetensors_to_float(t, values) != OK) abort();
    free(values);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    safetensors_file *file;
    if (safetensors_parse(data, size, &file) != OK) {
        if (strchr(status_message(), '\n')) abort();
        return 0;
    }
    for (size_t i = 0; i < safetensors_count(file); i++) {
        const safetensors_tensor *t = safetensors_at(file, i);
        if (safetensors_find(file, t->name) != t) abort();
        read_tensor(t, data, size);
    }
    safetensors_metadata(file, "config");
    safetensors_close(file);
    return 0;
}
