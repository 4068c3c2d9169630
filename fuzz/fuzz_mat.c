/* SPDX-License-Identifier: MIT */
/* MATLAB files from arbitrary bytes: whatever is accepted must hold as many numbers as its size says. */
#include <stdint.h>
#include <stdlib.h>

#include "stereo/arrays/array_file.h"

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    number_array a;
    if (mat_parse((const char *)data, size, "fuzz", "Normal_gt", &a) != OK) return 0;
    volatile float last = a.data[array_count(&a) - 1];
    (void)last;
    array_free(&a);
    return 0;
}
