#include "image/read.h"

#include <errno.h>
#include <math.h>
#include <stdbool.h>
#include <stdio.h>
#include <string.h>
#include <sys/stat.h>

#include "image/picture.h"

/* Says what is wrong with a path before any decoder sees it, and whether the file is EXR. */
static status look_at(const char *path, bool *is_exr)
{
    static const unsigned char exr_magic[4] = {0x76, 0x2f, 0x31, 0x01};
    struct stat about;
    FILE *f = fopen(path, "rb");
    if (!f || fstat(fileno(f), &about) != 0) {
        status s = fail(ERROR_INPUT, "cannot read %s: %s", path, strerror(errno));
        if (f) fclose(f);
        return s;
    }
    unsigned char magic[4] = {0};
    bool regular = S_ISREG(about.st_mode);
    size_t got = regular ? fread(magic, 1, sizeof magic, f) : 0;
    fclose(f);
    if (S_ISDIR(about.st_mode)) return fail(ERROR_INPUT, "cannot read %s: it is a folder, not a picture", path);
    if (!regular) return fail(ERROR_INPUT, "cannot read %s: it is not a plain file", path);
    if (got == 0) return fail(ERROR_INPUT, "cannot read %s: the file is empty", path);
    *is_exr = got == sizeof magic && memcmp(magic, exr_magic, sizeof magic) == 0;
    return OK;
}

static status check_finite(const char *path, const img *image)
{
    ptrdiff_t count = (ptrdiff_t)image->width * image->height * image->channels;
    ptrdiff_t bad = 0;
    for (ptrdiff_t i = 0; i < count; i++)
        bad += !isfinite(image->data[i]);
    if (!bad) return OK;
    return fail(ERROR_INPUT, "cannot read %s: %td of its values are not finite numbers (NaN or infinity)", path, bad);
}

static status read_any(const char *path, picture_colour how, img *color, img *alpha)
{
    bool is_exr = false;
    status s = look_at(path, &is_exr);
    if (s == OK) s = is_exr ? picture_read_exr(path, color, alpha) : picture_decode(path, how, color, alpha);
    if (s == OK) s = check_finite(path, color);
    if (s == OK && alpha && alpha->data) s = check_finite(path, alpha);
    return s;
}

static void clamp_unit(img *image)
{
    size_t count = (size_t)image->width * (size_t)image->height * (size_t)image->channels;
    for (size_t i = 0; i < count; i++)
        image->data[i] = fminf(fmaxf(image->data[i], 0), 1);
}

static status grey_to_color(img *image)
{
    if (image->channels == 3) return OK;
    img color;
    status s = img_new(&color, image->width, image->height, 3);
    if (s != OK) return s;
    size_t pixels = (size_t)image->width * (size_t)image->height;
    for (size_t i = 0; i < 3 * pixels; i++)
        color.data[i] = image->data[i / 3];
    img_free(image);
    *image = color;
    return OK;
}

status img_read(const char *path, img *color, img *alpha)
{
    *color = (img){0};
    if (alpha) *alpha = (img){0};
    status s = read_any(path, PICTURE_LINEARIZE, color, alpha);
    if (s == OK) s = grey_to_color(color);
    if (s == OK && alpha && alpha->data) clamp_unit(alpha);
    if (s == OK) return OK;
    img_free(color);
    img_free(alpha);
    return s;
}

static status read_samples(const char *path, bool decode_8_bit, img *color, int *bits)
{
    bool is_exr = false;
    *bits = 32;
    status s = look_at(path, &is_exr);
    if (s != OK || is_exr) return s == OK ? picture_read_exr(path, color, NULL) : s;
    s = picture_bits(path, bits);
    if (s != OK) return s;
    return picture_decode(path, *bits == 8 && decode_8_bit ? PICTURE_LINEARIZE : PICTURE_AS_IT_IS, color, NULL);
}

status img_read_samples(const char *path, bool decode_8_bit, img *color, int *bits)
{
    *color = (img){0};
    status s = read_samples(path, decode_8_bit, color, bits);
    if (s == OK) s = check_finite(path, color);
    if (s != OK) img_free(color);
    return s;
}

static bool is_opaque(const img *alpha)
{
    size_t pixels = (size_t)alpha->width * (size_t)alpha->height;
    for (size_t i = 0; i < pixels; i++)
        if (alpha->data[i] < 1) return false;
    return true;
}

/* The mean of the channels. */
static status color_to_grey(const img *color, img *grey)
{
    status s = img_new(grey, color->width, color->height, 1);
    if (s != OK) return s;
    size_t pixels = (size_t)color->width * (size_t)color->height, n = (size_t)color->channels;
    for (size_t i = 0; i < pixels; i++) {
        float sum = 0;
        for (size_t c = 0; c < n; c++)
            sum += color->data[i * n + c];
        grey->data[i] = sum / (float)n;
    }
    return OK;
}

/* A cut-out's shape is in its alpha; a black and white drawing's is in its colour. */
status img_read_mask(const char *path, img *mask)
{
    *mask = (img){0};
    img color = {0}, alpha = {0};
    status s = read_any(path, PICTURE_AS_IT_IS, &color, &alpha);
    if (s == OK) {
        if (alpha.data && !is_opaque(&alpha)) {
            *mask = alpha;
            alpha = (img){0};
        } else {
            s = color_to_grey(&color, mask);
        }
        if (s == OK) clamp_unit(mask);
    }
    img_free(&color);
    img_free(&alpha);
    return s;
}
