/* SPDX-License-Identifier: MIT */
#include "image/read/read.h"

#include <math.h>
#include <stdbool.h>
#include <stdint.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "base/file.h"
#include "base/messages.h"
#include "base/number.h"
#include "image/formats/img_format.h"
#include "image/formats/picture_rows.h"
#include "image/plain/picture_plain.h"
#include "image/read/mask_values.h"

static status check_plain(const char *path)
{
    struct stat about;
    if (stat(path, &about) != 0) return fail_by_errno(MERLIN_BAD_INPUT, "cannot read %s", path);
    if (S_ISDIR(about.st_mode)) return fail(MERLIN_BAD_INPUT, "cannot read %s: it is a folder, not a picture", path);
    return S_ISREG(about.st_mode) ? OK : fail(MERLIN_BAD_INPUT, "cannot read %s: it is not a plain file", path);
}

/* Checks a path before any decoder opens it, and finds the kind of picture. */
static status look_at(const char *path, picture_kind *kind)
{
    static const char *const videos[] = {".mp4", ".m4v", ".mov", ".mkv", ".webm", ".avi", NULL};
    status s = check_plain(path); /* before it is opened: opening a device may have effects */
    if (s != OK) return s;
    int descriptor = file_open_descriptor(path);
    char first;
    if (descriptor < 0) return fail_by_errno(MERLIN_BAD_INPUT, "cannot read %s", path);
    bool empty = read(descriptor, &first, 1) < 1;
    close(descriptor);
    if (empty) return fail(MERLIN_BAD_INPUT, "cannot read %s: the file is empty", path);
    img_format format = img_format_of(path);
    *kind = format.kind;
    if (format.is_read) return OK;
    if (format.name)
        return fail(MERLIN_BAD_INPUT, "cannot read %s: its format, %s, is not read here; save it as PNG or TIFF", path,
                    format.name);
    return fail(MERLIN_BAD_INPUT,
                "cannot read %s: it is not a picture of a kind known here (PNG, JPEG, TIFF, WebP, HEIC, GIF, BMP, TGA, "
                "PNM, EXR, HDR, raw)%s",
                path, file_ends_in_any(path, videos) ? ", nor a video" : "");
}

static bool is_plain(picture_kind kind)
{
    return kind == PICTURE_PNM || kind == PICTURE_BMP || kind == PICTURE_TGA;
}

static status look_with_decoder(const char *path, picture_kind kind, picture_head *head)
{
    if (kind == PICTURE_EXR) return picture_look_exr(path, head);
    if (kind == PICTURE_RAW) return picture_look_raw(path, head);
    *head = (picture_head){.plain = false};
    if (is_plain(kind)) return picture_read_plain(path, kind, PICTURE_AS_IT_IS, NULL, NULL, head);
    if (kind != PICTURE_PNG) return picture_look(path, kind, head);
    status s = picture_read_png(path, PICTURE_AS_IT_IS, NULL, NULL, head);
    return s == OK && !head->plain ? picture_look(path, kind, head) : s;
}

static status look_into(const char *path, picture_kind kind, picture_head *head)
{
    messages_mute();
    status s = look_with_decoder(path, kind, head);
    messages_unmute();
    return s;
}

/* Returns a side in blocks of pixels; a file may claim as many pixels as an int holds. */
static int blocks_of(int side, int by)
{
    return (int)(((long long)side + by - 1) / by);
}

status img_read_size(const char *path, int *width, int *height)
{
    picture_kind kind;
    picture_head head = {.width = 0};
    status s = look_at(path, &kind);
    if (s == OK) s = look_into(path, kind, &head);
    int by = s == OK ? picture_reduction(head.width, head.height) : 1;
    *width = blocks_of(head.width, by);
    *height = blocks_of(head.height, by);
    return s;
}

status img_look(const char *path, img_facts *out)
{
    picture_kind kind;
    picture_head head = {.width = 0};
    *out = (img_facts){.reduced = 1, .frames = 1};
    status s = look_at(path, &kind);
    if (s == OK) s = look_into(path, kind, &head);
    if (s != OK) return s == MERLIN_NO_MEMORY ? s : OK;
    out->reduced = picture_reduction(head.width, head.height);
    if (head.frames > 1) out->frames = head.frames;
    out->width = head.width;
    out->height = head.height;
    return OK;
}

static status check_finite(const char *path, const img *image)
{
    ptrdiff_t count = (ptrdiff_t)image->width * image->height * image->channels;
    ptrdiff_t bad = 0;
    for (ptrdiff_t i = 0; i < count; i++)
        bad += !isfinite(image->data[i]);
    if (!bad) return OK;
    return fail(MERLIN_BAD_INPUT, "cannot read %s: %td of its values are not finite numbers (NaN or infinity)", path,
                bad);
}

static status decode_pixels(const char *path, picture_kind kind, picture_colour how, img *color, img *alpha)
{
    picture_head head = {.plain = false};
    if (kind == PICTURE_EXR || kind == PICTURE_RAW) {
        status whole =
            kind == PICTURE_EXR ? picture_read_exr(path, how, color, alpha) : picture_read_raw(path, how, color);
        if (whole == OK) whole = picture_reduce(color);
        return whole == OK && alpha ? picture_reduce(alpha) : whole;
    }
    status s = is_plain(kind)        ? picture_read_plain(path, kind, how, color, alpha, &head)
               : kind == PICTURE_PNG ? picture_read_png(path, how, color, alpha, &head)
                                     : OK;
    return s == OK && !head.plain ? picture_decode(path, kind, how, color, alpha) : s;
}

static status read_pixels(const char *path, picture_kind kind, picture_colour how, img *color, img *alpha)
{
    messages_mute();
    status s = decode_pixels(path, kind, how, color, alpha);
    messages_unmute();
    return s;
}

static status read_any(const char *path, picture_colour how, img *color, img *alpha)
{
    picture_kind kind;
    status s = look_at(path, &kind);
    if (s == OK) s = read_pixels(path, kind, how, color, alpha);
    if (s == OK) s = check_finite(path, color);
    if (s == OK && alpha && alpha->data) s = check_finite(path, alpha);
    return s;
}

static void clamp_unit(img *image)
{
    size_t count = (size_t)image->width * (size_t)image->height * (size_t)image->channels;
    for (size_t i = 0; i < count; i++)
        image->data[i] = clamp(image->data[i], 0, 1);
}

status img_read(const char *path, img *color, img *alpha)
{
    *color = (img){0};
    if (alpha) *alpha = (img){0};
    status s = read_any(path, PICTURE_LINEARIZE, color, alpha);
    if (s == OK) s = img_make_color(color);
    if (s == OK && alpha && alpha->data) clamp_unit(alpha);
    if (s == OK) return OK;
    img_free(color);
    img_free(alpha);
    return s;
}

/* Decides whether samples are decoded. Without a stated curve or profile 16 bits are taken for a measurement; with one
 * they come from a program for photographs. */
static picture_colour colour_of_samples(picture_kind kind, const picture_head *head, bool decode)
{
    bool coded = head->bits == 8 || head->profile || head->light.said;
    return kind != PICTURE_EXR && decode && coded ? PICTURE_LINEARIZE : PICTURE_AS_IT_IS;
}

static status read_samples(const char *path, bool decode, img *color, int *bits)
{
    picture_kind kind;
    picture_head head;
    status s = look_at(path, &kind);
    if (s == OK) s = look_into(path, kind, &head);
    if (s != OK) return s;
    *bits = decode && picture_light_is_bright(&head.light) ? 32 : head.bits;
    return read_pixels(path, kind, colour_of_samples(kind, &head, decode), color, NULL);
}

status img_read_samples(const char *path, bool decode, img *color, int *bits)
{
    *color = (img){0};
    status s = read_samples(path, decode, color, bits);
    if (s == OK) s = check_finite(path, color);
    if (s != OK) img_free(color);
    return s;
}

/* Sets grey to the mean of the channels. */
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

status img_read_grey(const char *path, img *grey)
{
    *grey = (img){0};
    img color = {0};
    status s = read_any(path, PICTURE_AS_SHOWN, &color, NULL);
    if (s == OK) s = color_to_grey(&color, grey);
    if (s == OK) clamp_unit(grey);
    img_free(&color);
    return s;
}

static bool is_lossy(const char *path)
{
    picture_kind kind = img_format_of(path).kind;
    return kind == PICTURE_JPEG || kind == PICTURE_WEBP || kind == PICTURE_HEIC;
}

/* Reads a mask: a cut-out's shape is in its alpha, a black and white drawing's in its colour. */
status img_read_mask(const char *path, img *mask)
{
    *mask = (img){0};
    img color = {0}, alpha = {0};
    status s = read_any(path, PICTURE_AS_SHOWN, &color, &alpha);
    if (s == OK && alpha.data && !mask_is_even(&alpha))
        s = mask_from_alpha(&alpha, mask);
    else if (s == OK)
        s = mask_from_values(path, &color, is_lossy(path), mask);
    img_free(&color);
    img_free(&alpha);
    return s;
}
