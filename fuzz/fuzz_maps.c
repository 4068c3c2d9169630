/* SPDX-License-Identifier: MIT */
/* maps.exr from arbitrary bytes: whatever is accepted must be complete and finite. */
#include <math.h>
#include <string.h>

#include "fuzz_file.h"
#include "merlin/merlin.h"

static void check(const merlin_image *image, int channels)
{
    if (image->channels != channels) abort();
    size_t count = (size_t)image->width * (size_t)image->height * (size_t)channels;
    for (size_t i = 0; i < count; i++)
        if (!isfinite(image->data[i])) abort();
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    merlin_maps maps;
    if (merlin_maps_read(fuzz_folder("maps.exr", data, size), &maps) != MERLIN_OK) {
        if (strchr(merlin_error(), '\n')) abort();
        return 0;
    }
    check(&maps.albedo, 3);
    check(&maps.normal, 3);
    check(&maps.roughness, 1);
    check(&maps.depth, 1);
    check(&maps.mask, 1);
    check(&maps.photo, 3);
    if (!(maps.gain > 0) || maps.crop.side < 1) abort();
    merlin_maps_free(&maps);
    return 0;
}
