/* SPDX-License-Identifier: MIT */
/* Radiance pictures from arbitrary bytes. */
#include "fuzz_picture.h"

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    if (size < 6 || memcmp(data, "#?", 2) != 0) return 0;
    fuzz_picture(fuzz_file(data, size));
    return 0;
}
