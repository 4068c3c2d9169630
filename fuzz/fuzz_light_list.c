/* SPDX-License-Identifier: MIT */
/* Light lists from arbitrary bytes: whatever is accepted must be finite and few enough. */
#include <stdint.h>
#include <stdlib.h>

#include "base/lights/light_list.h"

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    light_list lights;
    if (light_list_parse((const char *)data, size, "fuzz", &lights) != OK) return 0;
    if (lights.count == 0 || lights.count > LIGHT_LIST_MAX) abort();
    for (size_t i = 0; i < lights.count; i++)
        if (!isfinite(lights.at[i].x) || !isfinite(lights.at[i].y) || !isfinite(lights.at[i].z)) abort();
    light_list_free(&lights);
    return 0;
}
