/* SPDX-License-Identifier: MIT */
/* OpenEXR pictures from arbitrary bytes. */
#include "fuzz_picture.h"

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    if (size < 4 || memcmp(data, "\x76\x2f\x31\x01", 4) != 0) return 0;
    fuzz_picture(fuzz_file(data, size));
    return 0;
}
