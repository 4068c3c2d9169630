/* SPDX-License-Identifier: MIT */
#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/half.h"
#include "lab/train/checkpoint.h"
#include "nn/safetensors.h"

/* Batch norm is a few numbers, and its variances span more than a half float. */
static bool keeps_float32(const nn_param *p)
{
    return p->rank == 1;
}

static size_t halves_needed(nn_params *params)
{
    size_t n = 0;
    for (size_t i = 0; i < nn_params_count(params); i++)
        n += nn_params_at(params, i)->count;
    return n;
}

static void convert(nn_params *params, st_tensor *tensors, uint16_t *halves)
{
    for (size_t i = 0; i < nn_params_count(params); i++) {
        const nn_param *p = nn_params_at(params, i);
        tensors[i] = (st_tensor){.name = p->name, .type = ST_F32, .rank = p->rank, .count = p->count, .data = p->value};
        memcpy(tensors[i].shape, p->shape, sizeof p->shape);
        if (keeps_float32(p)) continue;
        tensors[i].type = ST_F16;
        tensors[i].data = halves;
        for (size_t k = 0; k < p->count; k++)
            *halves++ = float_to_half(p->value[k]);
    }
}

static status write_weights(const char *path, const st_tensor *tensors, size_t count, const trn_provenance *from)
{
    char presentations[32], samples[32], size[16], version[16], loss[32];
    snprintf(presentations, sizeof presentations, "%" PRId64, from->presentations);
    snprintf(samples, sizeof samples, "%" PRId64, from->samples);
    snprintf(size, sizeof size, "%d", from->size);
    snprintf(version, sizeof version, "%d", from->generator_version);
    snprintf(loss, sizeof loss, "%.6g", from->validation_loss);
    const char *const metadata[][2] = {{"config", from->config},
                                       {"training", from->training},
                                       {"presentations", presentations},
                                       {"samples", samples},
                                       {"size", size},
                                       {"generator_version", version},
                                       {"note", from->note ? from->note : ""},
                                       {"validation_loss", loss}};
    size_t known = sizeof metadata / sizeof *metadata - !isfinite(from->validation_loss);
    return st_write(path, tensors, count, metadata, known);
}

status train_export(const char *path, nn_params *params, const trn_provenance *from)
{
    size_t count = nn_params_count(params);
    st_tensor *tensors = calloc(count, sizeof *tensors);
    uint16_t *halves = malloc((halves_needed(params) + 1) * sizeof *halves);
    status s = tensors && halves ? OK : fail(ERROR_MEMORY, "out of memory writing %s", path);
    if (s == OK) {
        convert(params, tensors, halves);
        s = write_weights(path, tensors, count, from);
    }
    free(halves);
    free(tensors);
    return s;
}
