/* EXIF from arbitrary bytes, and the walk to it through files of every kind. */
#include "fuzz_picture.h"
#include "image/exif.h"

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    exif_facts facts;
    exif_parse(data, size, &facts);
    exif_read(fuzz_file(data, size), &facts);
    return 0;
}
