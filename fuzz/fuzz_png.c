/* SPDX-License-Identifier: MIT */
/* PNGs from arbitrary bytes. */
#include "fuzz_picture.h"

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    if (size < 8 || memcmp(data, "\x89PNG\r\n\x1a\n", 8) != 0) return 0;
    fuzz_picture(fuzz_file(data, size));
    return 0;
}
