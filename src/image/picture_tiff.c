/* What stands in the head of a TIFF (TIFF 6.0 and BigTIFF), or of EXIF, which has a TIFF's form, and libvips keeps to
 * itself or does not find. */
#include <stdint.h>
#include <stdio.h>

#include "base/file.h"
#include "image/picture.h"

enum { COMPRESSION = 259, JPEG = 7, PHOTOMETRIC = 262, YCBCR = 6 };
enum { LONG = 4, BIG_TIFF = 43, ORIENTATION = 274, EXTRA_SAMPLES = 338, ASSOCIATED = 1 };
enum { KIND = 254, REDUCED = 1, MOSAIC = 32803, LINEAR_RAW = 34892 };

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

/* More entries than any program writes; a hostile count would be seconds of seeking beyond the file's end. */
enum { MOST_ENTRIES = 4096 };

/* The value of an entry that holds one number of 16 or 32 bits; 0 where there is none such. */
static unsigned value_of(tiff *t, unsigned tag)
{
    t->big_endian = number_at(t, 0, 1) == 'M';
    bool wide = number_at(t, 2, 2) == BIG_TIFF;
    int offset = wide ? 8 : 4, entry = wide ? 20 : 12, counter = wide ? 8 : 2;
    uint64_t folder = number_at(t, (uint64_t)offset, offset), entries = number_at(t, folder, counter);
    for (uint64_t i = 0; i < entries && i < MOST_ENTRIES; i++) {
        uint64_t at = folder + (uint64_t)counter + i * (uint64_t)entry;
        if (number_at(t, at, 2) != tag) continue;
        if (number_at(t, at + 4, offset) != 1) return 0;
        return (unsigned)number_at(t, at + 4 + (uint64_t)offset, number_at(t, at + 2, 2) == LONG ? 4 : 2);
    }
    return 0;
}

bool picture_tiff_is_premultiplied(const char *path)
{
    tiff t = {.file = file_open(path)};
    if (!t.file) return false;
    unsigned extra = value_of(&t, EXTRA_SAMPLES);
    fclose(t.file);
    return extra == ASSOCIATED;
}

status picture_check_tiff(const char *path)
{
    tiff t = {.file = file_open(path)};
    if (!t.file) return fail(ERROR_INPUT, "cannot read %s: it cannot be opened", path);
    /* those of JPEG its decoder makes RGB */
    bool ycbcr = value_of(&t, PHOTOMETRIC) == YCBCR && value_of(&t, COMPRESSION) != JPEG;
    fclose(t.file);
    return ycbcr ? fail(ERROR_INPUT, "cannot read %s: its colours are YCbCr; save it as RGB", path) : OK;
}

bool picture_tiff_is_raw(const char *path)
{
    tiff t = {.file = file_open(path)};
    if (!t.file) return false;
    unsigned meaning = value_of(&t, PHOTOMETRIC);
    bool mosaic = meaning == MOSAIC || meaning == LINEAR_RAW;
    bool first_is_small = value_of(&t, KIND) & REDUCED;
    /* behind the head, "CR" and its version, where TIFFs may have pixels */
    bool canon = number_at(&t, 4, 4) == 16 && number_at(&t, 8, 1) == 'C' && number_at(&t, 9, 1) == 'R' &&
                 number_at(&t, 10, 1) == 2;
    fclose(t.file);
    return mosaic || first_is_small || canon;
}

int picture_exif_orientation(void *exif, size_t size)
{
    tiff t = {.file = fmemopen(exif, size, "rb")};
    if (!t.file) return 1;
    unsigned orientation = value_of(&t, ORIENTATION);
    fclose(t.file);
    return orientation >= 1 && orientation <= 8 ? (int)orientation : 1;
}
