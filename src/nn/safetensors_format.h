/* SPDX-License-Identifier: MIT */
/* What reader and writer of safetensors files share. Internal to src/nn.
 *
 * A file is the length of its header (8 bytes, little-endian), the header (JSON, padded with spaces), the data. */
#ifndef MERLIN_NN_SAFETENSORS_FORMAT_H
#define MERLIN_NN_SAFETENSORS_FORMAT_H

#include <stdint.h>
#include <stdio.h>

#include "nn/safetensors_tensor.h"

enum { ST_PREFIX = 8, ST_HEADER_LIMIT = 1 << 20, ST_TYPES = ST_I64 + 1, ST_CHECKSUM_SIZE = 9 };

#define ST_CHECKSUM "crc32"

static inline void st_format_checksum(uint32_t sum, char out[ST_CHECKSUM_SIZE])
{
    snprintf(out, ST_CHECKSUM_SIZE, "%08x", (unsigned)sum);
}

#endif
