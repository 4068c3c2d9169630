#include <math.h>
#include <png.h>
#include <setjmp.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>

#include "base/file.h"
#include "image/picture.h"

/* A file on its way in; libpng leaves by longjmp, so that what is to be freed is kept here. */
typedef struct reader {
    FILE *file;
    png_structp png;
    png_infop info;
    int width, height, bands;
    bool wide, plain;
    float exponent; /* from code to light, where the file says another than sRGB's; else 0 */
    uint8_t *codes; /* height × width × bands, of 8 or 16 bits */
    png_bytep *rows;
    char words[128];
} reader;

static void leave(png_structp png, png_const_charp words)
{
    reader *r = png_get_error_ptr(png);
    snprintf(r->words, sizeof r->words, "%s", words);
    png_longjmp(png, 1);
}

static void say_nothing(png_structp png, png_const_charp words)
{
    (void)png;
    (void)words;
}

static void reader_free(reader *r)
{
    free(r->rows);
    free(r->codes);
    png_destroy_read_struct(&r->png, &r->info, NULL);
    if (r->file) fclose(r->file);
}

static bool reader_open(reader *r, const char *path)
{
    *r = (reader){.file = file_open(path)};
    r->png = png_create_read_struct(PNG_LIBPNG_VER_STRING, r, leave, say_nothing);
    r->info = r->png ? png_create_info_struct(r->png) : NULL;
    return r->file && r->info;
}

/* What is near the gamma of screens means sRGB (as the PNG specification has it), whose curve is no power; ImageMagick
 * keeps linear pictures as PNGs of gamma 1. */
static float exponent_of(const reader *r)
{
    double gamma = 0;
    bool known = png_get_gAMA(r->png, r->info, &gamma) && !png_get_valid(r->png, r->info, PNG_INFO_sRGB);
    if (!known || !(gamma >= 0.1 && gamma <= 10) || fabs(gamma * 2.2 - 1) < 0.05) return 0;
    return (float)(1 / gamma);
}

/* All that there is becomes grey or RGB, with alpha or without, of 8 or 16 bits. */
static bool read_head(reader *r)
{
    if (setjmp(png_jmpbuf(r->png))) return false;
    png_init_io(r->png, r->file);
    png_set_user_limits(r->png, PNG_UINT_31_MAX, PNG_UINT_31_MAX);
    png_read_info(r->png, r->info);
    r->width = (int)png_get_image_width(r->png, r->info);
    r->height = (int)png_get_image_height(r->png, r->info);
    r->plain = !png_get_valid(r->png, r->info, PNG_INFO_iCCP);
    r->exponent = exponent_of(r);
    png_set_expand(r->png);
    png_set_swap(r->png); /* of 16 bits, the largest first in the file */
    (void)png_set_interlace_handling(r->png);
    png_read_update_info(r->png, r->info);
    r->wide = png_get_bit_depth(r->png, r->info) == 16;
    r->bands = png_get_channels(r->png, r->info);
    return true;
}

static bool read_rows(reader *r)
{
    if (setjmp(png_jmpbuf(r->png))) return false;
    png_read_image(r->png, r->rows);
    return true;
}

/* Some write the orientation behind the pixels (ImageMagick); what is damaged there does no harm. */
static int read_orientation(reader *r)
{
    png_bytep exif = NULL;
    png_uint_32 size = 0;
    if (setjmp(png_jmpbuf(r->png)) == 0) png_read_end(r->png, r->info);
    if (!png_get_eXIf_1(r->png, r->info, &size, &exif)) return 1;
    return picture_exif_orientation(exif, size);
}

static status read_codes(reader *r, const char *path)
{
    size_t line = (size_t)r->width * (size_t)r->bands * (r->wide ? 2 : 1);
    r->codes = malloc(line * (size_t)r->height);
    r->rows = malloc((size_t)r->height * sizeof *r->rows);
    if (!r->codes || !r->rows) return fail(ERROR_MEMORY, "no memory to read %s", path);
    for (int y = 0; y < r->height; y++)
        r->rows[y] = r->codes + (size_t)y * line;
    return read_rows(r) ? OK : fail(ERROR_INPUT, "cannot read %s: it is damaged or cut short (%s)", path, r->words);
}

static void apply_exponent(float exponent, img *color)
{
    size_t count = img_value_count(color);
    for (size_t i = 0; i < count; i++)
        color->data[i] = powf(color->data[i], exponent);
}

static status take(const reader *r, picture_colour how, img *color, img *alpha)
{
    int channels = r->bands < 3 ? 1 : 3;
    status s = img_new(color, r->width, r->height, channels);
    if (s != OK) return s;
    bool decode = how == PICTURE_LINEARIZE;
    picture_take_codes(r->codes, r->wide, r->bands, 0, decode && r->exponent == 0, color);
    if (decode && r->exponent > 0 && r->exponent != 1) apply_exponent(r->exponent, color);
    if (!alpha || r->bands == channels) return OK;
    s = img_new(alpha, r->width, r->height, 1);
    if (s == OK) picture_take_codes(r->codes, r->wide, r->bands, channels, false, alpha);
    return s;
}

static status read_open(reader *r, const char *path, picture_colour how, img *color, img *alpha)
{
    if (!read_head(r)) return fail(ERROR_INPUT, "cannot read %s: %s", path, r->words);
    status s = picture_check_size(path, r->width, r->height);
    if (s != OK || !r->plain || !color) return s;
    s = read_codes(r, path);
    if (s == OK) s = take(r, how, color, alpha);
    int orientation = s == OK ? read_orientation(r) : 1;
    if (s == OK) s = picture_turn(color, orientation);
    return s == OK && alpha && alpha->data ? picture_turn(alpha, orientation) : s;
}

status picture_read_png(const char *path, picture_colour how, img *color, img *alpha, picture_head *head)
{
    reader r;
    status s = reader_open(&r, path) ? OK : fail(ERROR_INPUT, "cannot read %s: it cannot be opened", path);
    if (s == OK) s = read_open(&r, path, how, color, alpha);
    *head = (picture_head){.width = r.width, .height = r.height, .bits = r.wide ? 16 : 8, .plain = r.plain};
    reader_free(&r);
    return s;
}
