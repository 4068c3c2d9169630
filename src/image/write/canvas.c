/* SPDX-License-Identifier: MIT */
#include "image/write/canvas.h"

#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "image/color.h"
#include "image/vips_library.h"
#include "image/vips_start.h"
#include "image/write/codes.h"

status canvas_new(canvas *out, int width, int height)
{
    static const uint8_t ground[3] = {CANVAS_GROUND};
    *out = (canvas){0};
    if (width < 1 || height < 1) return fail(MERLIN_WRONG_USE, "a figure of %d x %d pixels cannot be", width, height);
    size_t count = 3 * (size_t)width * (size_t)height;
    uint8_t *rgb = malloc(count);
    if (!rgb) return fail(MERLIN_NO_MEMORY, "no memory for a figure of %d x %d pixels", width, height);
    const size_t row = 3 * (size_t)width;
    for (size_t i = 0; i < row; i++)
        rgb[i] = ground[i % 3];
    for (size_t at = row; at < count; at += row)
        memcpy(rgb + at, rgb, row);
    *out = (canvas){width, height, rgb};
    return OK;
}

void canvas_free(canvas *c)
{
    free(c->rgb);
    *c = (canvas){0};
}

void canvas_paste(canvas *c, const img *image, int x, int y)
{
    for (int row = 0; row < image->height; row++) {
        uint8_t *to = c->rgb + 3 * ((size_t)(y + row) * (size_t)c->width + (size_t)x);
        const size_t width = (size_t)image->width, values = width * (size_t)image->channels;
        srgb_codes8(img_at(image, 0, row), values, to);
        for (size_t i = width; values == width && i-- > 0;) /* in place, so that grey pixels are spread from the end */
            to[3 * i] = to[3 * i + 1] = to[3 * i + 2] = to[i];
    }
}

status canvas_draw_begin(const canvas *c, canvas_drawing *d)
{
    *d = (canvas_drawing){0};
    status s = vips_begin();
    if (s != OK) return s;
    d->out = open_memstream(&d->text, &d->size);
    if (!d->out) return fail(MERLIN_NO_MEMORY, "no memory for a drawing");
    fprintf(d->out,
            "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"%d\" height=\"%d\" font-family=\"" CANVAS_FONT
            "\" fill=\"" CANVAS_INK_CSS "\">\n",
            c->width, c->height);
    return OK;
}

void canvas_print_escaped(canvas_drawing *d, const char *words)
{
    char *valid = vips()->g_utf8_make_valid(words, -1);
    char *escaped = vips()->g_markup_escape_text(valid, -1);
    fputs(escaped, d->out);
    vips()->g_free(escaped);
    vips()->g_free(valid);
}

/* Blends a drawing's pixels, rgba with straight alpha, over the canvas. */
static void lay_over(canvas *c, const uint8_t *rgba)
{
    size_t pixels = (size_t)c->width * (size_t)c->height;
    for (size_t i = 0; i < pixels; i++) {
        int alpha = rgba[4 * i + 3];
        if (!alpha) continue;
        for (size_t k = 0; k < 3; k++) {
            int below = c->rgb[3 * i + k], above = rgba[4 * i + k];
            c->rgb[3 * i + k] = (uint8_t)((below * (255 - alpha) + above * alpha + 127) / 255);
        }
    }
}

static status draw(canvas *c, const canvas_drawing *d)
{
    VipsImage *image = NULL;
    if (vips()->svgload_buffer(d->text, d->size, &image, NULL))
        return vips_refusal(MERLIN_DEVICE_FAILED, "draw", "a figure");
    size_t size = 0;
    uint8_t *rgba = vips()->image_write_to_memory(image, &size);
    vips()->g_object_unref(image);
    if (!rgba) return vips_refusal(MERLIN_DEVICE_FAILED, "draw", "a figure");
    status s = OK;
    if (size == 4 * (size_t)c->width * (size_t)c->height)
        lay_over(c, rgba);
    else
        s = fail(MERLIN_DEVICE_FAILED, "cannot draw a figure: the drawing has another size than its canvas");
    vips()->g_free(rgba);
    return s;
}

status canvas_draw_end(canvas *c, canvas_drawing *d)
{
    fputs("</svg>\n", d->out);
    status s = memory_stream_close(d->out, &d->text) ? OK : fail(MERLIN_NO_MEMORY, "no memory for a drawing");
    if (s == OK) s = draw(c, d);
    free(d->text);
    *d = (canvas_drawing){0};
    return s;
}

static void copy_row(const void *context, int y, void *codes)
{
    const canvas *c = context;
    size_t row = 3 * (size_t)c->width;
    memcpy(codes, c->rgb + (size_t)y * row, row);
}

status canvas_write(const canvas *c, const char *path)
{
    return codes_write_png(path, &(code_rows){c->width, c->height, 3, false, true, copy_row, c});
}
