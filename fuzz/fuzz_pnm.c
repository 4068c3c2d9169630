/* SPDX-License-Identifier: MIT */
/* netpbm's pictures from arbitrary bytes. */
#include "fuzz_picture.h"

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    if (size < 3 || data[0] != 'P') return 0;
    fuzz_picture(fuzz_file(data, size));
    return 0;
}
