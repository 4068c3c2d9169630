/* SPDX-License-Identifier: MIT */
/* Writes weights for distribution: as half floats, except batch norm, whose few numbers exceed half's range.
 *
 *     const char *const metadata[][2] = {{"config", json}};
 *     status s = model_export("weights.safetensors", params, metadata, 1);
 */
#ifndef MERLIN_MODEL_MODEL_EXPORT_H
#define MERLIN_MODEL_MODEL_EXPORT_H

#include "nn/nn.h"

/* Writes all parameters under their names, and metadata as key, value pairs; atomically. */
status model_export(const char *path, nn_params *params, const char *const (*metadata)[2], size_t metadata_count);

#endif
