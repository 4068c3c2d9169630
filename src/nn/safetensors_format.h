/* SPDX-License-Identifier: MIT */
/* Constants and functions shared by the reader and the writer of safetensors files. Internal to src/nn.
 *
 * A file is the length of its header (8 bytes, little-endian), the header (JSON, padded with spaces), the data. */
#ifndef MERLIN_NN_SAFETENSORS_FORMAT_H
#define MERLIN_NN_SAFETENSORS_FORMAT_H

#include <stdint.h>
#include <stdio.h>

#include "nn/safetensors_tensor.h"

enum {
    SAFETENSORS_PREFIX = 8,
    SAFETENSORS_HEADER_LIMIT = 1 << 20,
    SAFETENSORS_TYPES = SAFETENSORS_I64 + 1,
    SAFETENSORS_CHECKSUM_SIZE = 9
};

#define SAFETENSORS_CHECKSUM "crc32"

static inline void safetensors_format_checksum(uint32_t sum, char out[SAFETENSORS_CHECKSUM_SIZE])
{
    snprintf(out, SAFETENSORS_CHECKSUM_SIZE, "%08x", (unsigned)sum);
}

#endif
