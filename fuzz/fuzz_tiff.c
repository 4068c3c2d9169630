/* SPDX-License-Identifier: MIT */
/* TIFFs, and what EXIF holds from arbitrary bytes. */
#include "fuzz_picture.h"

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    if (size < 4 || (memcmp(data, "II", 2) != 0 && memcmp(data, "MM", 2) != 0)) return 0;
    fuzz_picture(fuzz_file(data, size));
    return 0;
}
