/* SPDX-License-Identifier: MIT */
#include "image/metadata/exif.h"

#include <limits.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "image/metadata/exif_find.h"
#include "image/metadata/exif_text.h"

enum {
    EXPOSURE_TIME = 33434,
    F_NUMBER = 33437,
    SENSITIVITY = 34855,
    FLASH = 37385,
    FOCAL_LENGTH = 37386,
    FOCAL_LENGTH_35MM = 41989,
    SENSOR_RESOLUTION = 41486, /* pixels a unit, along a row */
    SENSOR_UNIT = 41488,
    PIXELS_WIDE = 40962,
    PIXELS_HIGH = 40963,
};
enum { FIRED = 1, NO_FLASH_THERE = 32 }; /* bits of FLASH */
static const double DIAGONAL_35MM = 43.2666, SHORTEST = 1, LONGEST = 5000, BRIGHTEST = 1e12;

/* Returns the page that has an entry: the EXIF page below the first, or the first itself, as in Canon's CR3. */
static uint64_t page_with(const tiff_head *t, unsigned tag)
{
    uint64_t below = tiff_value(t, t->page[0], TIFF_EXIF);
    return below && tiff_count(t, below, tag) ? below : t->page[0];
}

static double number(const tiff_head *t, unsigned tag)
{
    return tiff_real(t, page_with(t, tag), tag);
}

/* Returns the resolution's unit in mm. By the standard 1 is no unit and 2 is inches, also the default; 4 and 5 are
 * extensions of some cameras. */
static double unit_in_mm(const tiff_head *t)
{
    switch ((int)number(t, SENSOR_UNIT)) {
    case 3:
        return 10;
    case 4:
        return 1;
    case 5:
        return 0.001;
    default:
        return 25.4;
    }
}

/* Returns the 35 mm equivalent focal length by the focal length and the sensor's size. */
static double focal_by_sensor(const tiff_head *t)
{
    double resolution = number(t, SENSOR_RESOLUTION), pixels = hypot(number(t, PIXELS_WIDE), number(t, PIXELS_HIGH));
    if (!(resolution > 0) || !(pixels > 0)) return 0;
    double diagonal = pixels / resolution * unit_in_mm(t);
    return number(t, FOCAL_LENGTH) * DIAGONAL_35MM / diagonal;
}

exif_colours exif_colours_of(const tiff_head *t, uint64_t page)
{
    enum { RULE = 1, SRGB = 1, ADOBE = 2 };
    uint32_t space = tiff_value(t, page, TIFF_EXIF_COLOUR_SPACE);
    uint64_t rules = tiff_value(t, page, TIFF_EXIF_INTEROPERABILITY);
    bool r03 = rules && tiff_value_at(t, rules, RULE, 0) == 'R' && tiff_value_at(t, rules, RULE, 1) == '0' &&
               tiff_value_at(t, rules, RULE, 2) == '3';
    if (space == ADOBE || (space != SRGB && r03)) return EXIF_COLOURS_ADOBE;
    return space == SRGB ? EXIF_COLOURS_SRGB : EXIF_COLOURS_UNKNOWN;
}

static int pixels(const tiff_head *t, unsigned tag)
{
    const double count = number(t, tag);
    return count >= 1 && count < INT_MAX ? (int)count : 0;
}

/* Returns the exposure. What is not stated, as the f-number of a lens without contacts, is the same in all pictures of
 * a camera. A sensitivity that does not fit its 16 bits is unknown. */
static double exposure(const tiff_head *t)
{
    enum { UNFIT = 65535 };
    const double time = number(t, EXPOSURE_TIME), f = number(t, F_NUMBER), iso = number(t, SENSITIVITY);
    if (!(time > 0) || iso >= UNFIT) return 0;
    return time * (iso > 0 ? iso : 1) / (f > 0 ? f * f : 1);
}

static void take_facts(const tiff_head *t, exif_facts *out)
{
    uint32_t orientation = tiff_value(t, t->page[0], TIFF_ORIENTATION);
    if (orientation >= 1 && orientation <= 8) out->orientation = (int)orientation;
    out->colours = exif_colours_of(t, tiff_value(t, t->page[0], TIFF_EXIF));
    uint64_t page = page_with(t, FLASH);
    if (tiff_count(t, page, FLASH)) {
        uint32_t flash = tiff_value(t, page, FLASH);
        out->flash = flash & FIRED && !(flash & NO_FLASH_THERE) ? EXIF_FLASH_FIRED : EXIF_FLASH_NONE;
    }
    double focal = number(t, FOCAL_LENGTH_35MM);
    if (!(focal >= SHORTEST)) focal = focal_by_sensor(t);
    if (focal >= SHORTEST && focal <= LONGEST) out->focal_35mm = (float)focal;
    const double bright = exposure(t);
    if (bright < BRIGHTEST) out->exposure = (float)bright;
    out->wide = pixels(t, PIXELS_WIDE);
    out->high = pixels(t, PIXELS_HIGH);
}

void exif_parse_part(const byte_source *whole, uint64_t at, uint64_t size, exif_facts *out)
{
    static const char mark[6] = {'E', 'x', 'i', 'f', 0, 0};
    char first[sizeof mark];
    byte_source part;
    tiff_head t;
    *out = (exif_facts){.orientation = 1};
    byte_source_of_part(&part, whole, at, size);
    if (byte_source_read(&part, 0, first, sizeof first) == sizeof first && memcmp(first, mark, sizeof mark) == 0)
        byte_source_of_part(&part, whole, at + sizeof mark, size - sizeof mark);
    if (tiff_open(&t, &part)) take_facts(&t, out);
}

void exif_parse(const void *exif, size_t size, exif_facts *out)
{
    byte_source memory;
    byte_source_of_memory(&memory, exif, size);
    exif_parse_part(&memory, 0, size, out);
}

static status parse_text(byte_source *from, exif_facts *out)
{
    void *exif;
    size_t size;
    status s = exif_text_find(from, &exif, &size);
    if (s == OK && exif) exif_parse(exif, size, out);
    free(exif);
    return s;
}

status exif_read(const char *path, exif_facts *out)
{
    byte_source file;
    exif_place place;
    status s = OK;
    *out = (exif_facts){.orientation = 1};
    if (!byte_source_open(&file, path)) return OK;
    if (exif_find(&file, &place))
        exif_parse_part(&file, place.at, place.size ? place.size : file.size, out);
    else
        s = parse_text(&file, out);
    byte_source_close(&file);
    return s;
}

static double shape(int width, int height)
{
    return width > height ? (double)width / height : (double)height / width;
}

static bool are_alike(double a, double b)
{
    static const double tolerance = 0.012; /* cameras write 3:2 as 1.494 to 1.51 */
    return fabs(a / b - 1) <= tolerance;
}

float exif_focal_35mm(const exif_facts *facts, int width, int height)
{
    static const double usual[] = {1, 5.0 / 4, 4.0 / 3, 3.0 / 2, 16.0 / 9, 2, 19.5 / 9, 20.0 / 9};
    if (width < 1 || height < 1) return facts->focal_35mm;
    const double seen = shape(width, height);
    if (facts->wide && facts->high && !are_alike(seen, shape(facts->wide, facts->high))) return 0;
    for (size_t i = 0; i < sizeof usual / sizeof *usual; i++)
        if (are_alike(seen, usual[i])) return facts->focal_35mm;
    return 0;
}
