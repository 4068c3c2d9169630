/* SPDX-License-Identifier: MIT */
#include <math.h>
#include <stdlib.h>

#include "base/number.h"
#include "image/color.h"
#include "image/resize.h"
#include "image/write/canvas.h"
#include "image/write/figure.h"

typedef struct layout {
    int columns, rows, tile, margin, gap, label, font;
} layout;

static layout lay_out(int count, int columns, int tile)
{
    int used = count < columns ? count : columns;
    int font = tile / 16 < 11 ? 11 : tile / 16 > 24 ? 24 : tile / 16;
    return (layout){.columns = used,
                    .rows = (count + used - 1) / used,
                    .tile = tile,
                    .margin = font + 4,
                    .gap = font * 3 / 4,
                    .label = 2 * font + 2,
                    .font = font};
}

static int tile_x(const layout *l, int index)
{
    return l->margin + index % l->columns * (l->tile + l->gap);
}

static int tile_y(const layout *l, int index)
{
    return l->margin + index / l->columns * (l->tile + l->label);
}

/* Pastes an image into a tile, at the largest size of its aspect ratio that fits, centred. */
static status paste_tile(canvas *c, const layout *l, int index, const img *image)
{
    if (!image || !image->data || (image->channels != 1 && image->channels != 3))
        return fail(MERLIN_WRONG_USE, "tile %d of a contact sheet is not a grey or colour image", index);
    int larger = image->width > image->height ? image->width : image->height;
    int width = (int)lround((double)image->width * l->tile / larger);
    int height = (int)lround((double)image->height * l->tile / larger);
    img fitted;
    status s = img_resize(image, width < 1 ? 1 : width, height < 1 ? 1 : height, &fitted);
    if (s != OK) return s;
    canvas_paste(c, &fitted, tile_x(l, index) + (l->tile - fitted.width) / 2,
                 tile_y(l, index) + (l->tile - fitted.height) / 2);
    img_free(&fitted);
    return OK;
}

/* Draws texts, by FreeType if it can, else by an SVG, which takes longer. */
static status draw_words(canvas *c, const canvas_words *words, int count, int size)
{
    bool written;
    canvas_drawing d;
    status s = canvas_write_words(c, words, count, size, &written);
    if (s != OK || written) return s;
    s = canvas_draw_begin(c, &d);
    if (s != OK) return s;
    fprintf(d.out, "<g font-size=\"%d\" text-anchor=\"middle\">\n", size);
    for (int i = 0; i < count; i++) {
        fprintf(d.out, "<text x=\"%d\" y=\"%d\">", words[i].x, words[i].y);
        canvas_print_escaped(&d, words[i].text);
        fputs("</text>\n", d.out);
    }
    fputs("</g>\n", d.out);
    return canvas_draw_end(c, &d);
}

static status draw_labels(canvas *c, const layout *l, const figure_tile *tiles, int count)
{
    canvas_words *words = malloc((size_t)count * sizeof *words);
    if (!words) return fail(MERLIN_NO_MEMORY, "no memory for %d labels", count);
    for (int i = 0; i < count; i++)
        words[i] = (canvas_words){tiles[i].label ? tiles[i].label : "", tile_x(l, i) + l->tile / 2,
                                  tile_y(l, i) + l->tile + l->font * 3 / 2};
    status s = draw_words(c, words, count, l->font);
    free(words);
    return s;
}

status figure_sheet(const char *path, const figure_tile *tiles, int count, int columns, int tile_size)
{
    if (count < 1 || columns < 1 || tile_size < 1)
        return fail(MERLIN_WRONG_USE, "a contact sheet needs tiles, columns and a tile size");
    layout l = lay_out(count, columns, tile_size);
    canvas c;
    status s = canvas_new(&c, 2 * l.margin + l.columns * (l.tile + l.gap) - l.gap,
                          2 * l.margin + l.rows * (l.tile + l.label) - l.font);
    if (s != OK) return s;
    for (int i = 0; s == OK && i < count; i++)
        s = paste_tile(&c, &l, i, tiles[i].image);
    if (s == OK) s = draw_labels(&c, &l, tiles, count);
    if (s == OK) s = canvas_write(&c, path);
    canvas_free(&c);
    return s;
}

static status check_map(const img *map, const img *mask, int channels, const char *what)
{
    if (!map->data || map->channels != channels)
        return fail(MERLIN_WRONG_USE, "a %s map has %d channels, not %d", what, channels, map->channels);
    if (mask && (mask->channels != 1 || mask->width != map->width || mask->height != map->height))
        return fail(MERLIN_WRONG_USE, "the mask is not of the size of the %s map", what);
    return OK;
}

status figure_normals(const img *normal, const img *mask, img *out)
{
    *out = (img){0};
    status s = check_map(normal, mask, 3, "normal");
    if (s == OK) s = img_new(out, normal->width, normal->height, 3);
    if (s != OK) return s;
    size_t pixels = (size_t)normal->width * (size_t)normal->height;
    for (size_t i = 0; i < pixels; i++) {
        float cover = mask ? mask->data[i] : 1;
        for (size_t c = 0; cover > 0 && c < 3; c++)
            out->data[3 * i + c] = srgb_decode(cover * 0.5f * (normal->data[3 * i + c] + 1));
    }
    return OK;
}

/* Shows near points bright; the far end stays above black, to differ from what is outside the mask. */
status figure_depth(const img *depth, const img *mask, img *out)
{
    *out = (img){0};
    status s = check_map(depth, mask, 1, "depth");
    if (s == OK) s = img_new(out, depth->width, depth->height, 3);
    if (s != OK) return s;
    size_t pixels = (size_t)depth->width * (size_t)depth->height;
    float near = INFINITY, far = -INFINITY;
    for (size_t i = 0; i < pixels; i++) {
        if ((mask && mask->data[i] < 0.5f) || !isfinite(depth->data[i])) continue;
        near = fminf(near, depth->data[i]);
        far = fmaxf(far, depth->data[i]);
    }
    float scale = far > near ? 1 / (far - near) : 0;
    for (size_t i = 0; i < pixels; i++) {
        float cover = mask ? mask->data[i] : 1;
        if (!(cover > 0) || !isfinite(depth->data[i])) continue;
        float t = clamp((far - depth->data[i]) * scale, 0, 1);
        float shown = srgb_decode(cover * (0.15f + 0.85f * t));
        for (size_t c = 0; c < 3; c++)
            out->data[3 * i + c] = shown;
    }
    return OK;
}
