/* SPDX-License-Identifier: MIT */
#include <inttypes.h>
#include <math.h>
#include <stdio.h>

#include "lab/train/checkpoint.h"
#include "model/model_export.h"

status train_export(const char *path, nn_params *params, const train_provenance *from)
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
    return model_export(path, params, metadata, known);
}
