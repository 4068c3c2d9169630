/* SPDX-License-Identifier: MIT */
/* EXIF from arbitrary bytes, and the walk to it through files of every kind. */
#include "fuzz_picture.h"
#include "image/metadata/box_file.h"
#include "image/metadata/byte_source.h"
#include "image/metadata/exif.h"

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    exif_facts facts;
    exif_parse(data, size, &facts);
    const char *path = fuzz_file(data, size);
    exif_read(path, &facts);
    int numbers[3];
    byte_source file;
    if (!byte_source_open(&file, path)) abort();
    (void)box_read_colour(&file, numbers);
    byte_source_close(&file);
    return 0;
}
