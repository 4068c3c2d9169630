/* SPDX-License-Identifier: MIT */
/* TGAs from arbitrary bytes. */
#include "fuzz_picture.h"

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    if (size < 18 || data[1] > 1) return 0;
    fuzz_picture(fuzz_file(data, size));
    return 0;
}
