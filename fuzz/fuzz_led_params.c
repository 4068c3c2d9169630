/* SPDX-License-Identifier: MIT */
/* LUCES light files from arbitrary bytes: whatever is accepted must be finite and complete. */
#include <stdint.h>
#include <stdlib.h>

#include "base/vec.h"
#include "stereo/capture/luces.h"

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    luces_params p;
    if (luces_parse((const char *)data, size, "fuzz", &p) != OK) return 0;
    if (p.count < 1 || p.width < 1 || p.height < 1 || !(p.camera.focal > 0)) abort();
    for (int i = 0; i < p.count; i++)
        if (!isfinite(vec3_length(vec3_of(p.light[i].position))) || !(p.light[i].intensity[2] > 0)) abort();
    luces_free(&p);
    return 0;
}
