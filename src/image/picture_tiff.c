/* What a TIFF's head says (TIFF 6.0 and BigTIFF) and libvips keeps to itself: whether its colours are multiplied by
 * their alpha. */
#include <stdint.h>
#include <stdio.h>

#include "base/file.h"
#include "image/picture.h"

enum { BIG_TIFF = 43, EXTRA_SAMPLES = 338, ASSOCIATED = 1 };

typedef struct tiff {
    FILE *file;
    bool big_endian;
} tiff;

/* The number in so many bytes at a place of the file; 0 where there is none. */
static uint64_t number_at(const tiff *t, uint64_t at, int bytes)
{
    unsigned char b[8];
    uint64_t number = 0;
    if (at > INT64_MAX) return 0;
    if (fseeko(t->file, (off_t)at, SEEK_SET) != 0 || fread(b, 1, (size_t)bytes, t->file) != (size_t)bytes) return 0;
    for (int i = 0; i < bytes; i++)
        number = number << 8 | b[t->big_endian ? i : bytes - 1 - i];
    return number;
}

static bool is_premultiplied(const tiff *t)
{
    bool wide = number_at(t, 2, 2) == BIG_TIFF;
    int offset = wide ? 8 : 4, entry = wide ? 20 : 12, counter = wide ? 8 : 2;
    uint64_t folder = number_at(t, (uint64_t)offset, offset), entries = number_at(t, folder, counter);
    for (uint64_t i = 0; i < entries && i <= UINT16_MAX; i++) {
        uint64_t at = folder + (uint64_t)counter + i * (uint64_t)entry;
        if (number_at(t, at, 2) != EXTRA_SAMPLES) continue;
        /* one value of 16 bits stands where otherwise its place does */
        return number_at(t, at + 4, offset) == 1 && number_at(t, at + 4 + (uint64_t)offset, 2) == ASSOCIATED;
    }
    return false;
}

bool picture_tiff_is_premultiplied(const char *path)
{
    tiff t = {.file = file_open(path)};
    if (!t.file) return false;
    t.big_endian = getc(t.file) == 'M';
    bool premultiplied = is_premultiplied(&t);
    fclose(t.file);
    return premultiplied;
}
