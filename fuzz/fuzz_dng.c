/* SPDX-License-Identifier: MIT */
/* Raw pictures of floats from arbitrary bytes; all others are LibRaw's. */
#include "fuzz_picture.h"
#include "image/formats/picture_dng.h"

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    if (size < 8 || (memcmp(data, "II*", 3) != 0 && memcmp(data, "MM", 2) != 0)) return 0;
    const char *path = fuzz_file(data, size);
    if (picture_is_float_dng(path)) fuzz_picture(path);
    return 0;
}
