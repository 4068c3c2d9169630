/* SPDX-License-Identifier: MIT */
#include "model/model_export.h"

#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include "base/half.h"
#include "nn/safetensors.h"

/* Tells whether a parameter stays float32: batch norm has few numbers, and its variances exceed half's range. */
static bool keeps_float32(const nn_param *p)
{
    return p->rank == 1;
}

static void convert(nn_params *params, safetensors_tensor *tensors, uint16_t *halves)
{
    for (size_t i = 0; i < nn_params_count(params); i++) {
        const nn_param *p = nn_params_at(params, i);
        tensors[i] = (safetensors_tensor){
            .name = p->name, .type = SAFETENSORS_F32, .rank = p->rank, .count = p->count, .data = p->value};
        memcpy(tensors[i].shape, p->shape, sizeof p->shape);
        if (keeps_float32(p)) continue;
        tensors[i].type = SAFETENSORS_F16;
        tensors[i].data = halves;
        for (size_t k = 0; k < p->count; k++)
            *halves++ = float_to_half(p->value[k]);
    }
}

status model_export(const char *path, nn_params *params, const char *const (*metadata)[2], size_t metadata_count)
{
    size_t count = nn_params_count(params);
    safetensors_tensor *tensors = calloc(count, sizeof *tensors);
    uint16_t *halves = malloc((nn_params_values(params) + 1) * sizeof *halves);
    status s = tensors && halves ? OK : fail(MERLIN_NO_MEMORY, "out of memory writing %s", path);
    if (s == OK) {
        convert(params, tensors, halves);
        s = safetensors_write(path, tensors, count, metadata, metadata_count);
    }
    free(halves);
    free(tensors);
    return s;
}
