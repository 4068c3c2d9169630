/* SPDX-License-Identifier: MIT */
/* EXIF from arbitrary bytes, and the walk to it through files of every kind. */
#include "fuzz_picture.h"
#include "image/metadata/box_file.h"
#include "image/metadata/exif.h"

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    exif_facts facts;
    exif_parse(data, size, &facts);
    const char *path = fuzz_file(data, size);
    exif_read(path, &facts);
    int numbers[3];
    FILE *file = fopen(path, "rb");
    if (!file) abort();
    (void)box_read_colour(file, numbers);
    fclose(file);
    return 0;
}
