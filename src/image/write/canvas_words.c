/* SPDX-License-Identifier: MIT */
/* Text by FreeType directly: an SVG's font lookup and text layout take as long as the network. */
#include <ft2build.h>

#include FT_FREETYPE_H
#include FT_MODULE_H
#include FT_OUTLINE_H

#include <stdint.h>
#include <stdlib.h>

#include "image/write/canvas.h"

/* FreeType's units a pixel. */
enum { PIXEL = 64 };

typedef struct pen {
    FT_Face face;
    canvas *on;
    FT_Pos x; /* where the next character begins */
    int baseline;
    FT_UInt before; /* glyph of the previous character; 0: none */
} pen;

/* Returns the next character of UTF-8; 0 at the end and for invalid bytes. */
static unsigned long next_letter(const char **words)
{
    const unsigned char *at = (const unsigned char *)*words;
    int more = *at < 0x80 ? 0 : *at >= 0xf0 ? 3 : *at >= 0xe0 ? 2 : *at >= 0xc0 ? 1 : -1;
    if (more < 0) return 0;
    unsigned long letter = more ? *at & (0x3fu >> more) : *at;
    for (int i = 1; i <= more; i++) {
        if ((at[i] & 0xc0) != 0x80) return 0;
        letter = letter << 6 | (at[i] & 0x3f);
    }
    *words += *at ? more + 1 : 0;
    return letter;
}

/* Loads the glyph of a character and moves the pen to where it begins; returns the rest of its advance. */
static FT_Pos load(pen *p, unsigned long letter)
{
    FT_UInt glyph = FT_Get_Char_Index(p->face, letter);
    FT_Vector kerning = {0, 0};
    if (p->before) (void)FT_Get_Kerning(p->face, p->before, glyph, FT_KERNING_UNFITTED, &kerning);
    p->before = glyph;
    p->x += kerning.x;
    if (FT_Load_Glyph(p->face, glyph, FT_LOAD_NO_HINTING | FT_LOAD_NO_BITMAP)) return 0;
    return p->face->glyph->linearHoriAdvance / (65536 / PIXEL);
}

static FT_Pos width_of(pen p, const char *words)
{
    p.x = 0;
    for (unsigned long letter; (letter = next_letter(&words));)
        p.x += load(&p, letter);
    return p.x;
}

static void lay_over(const pen *p, const FT_Bitmap *cover, int left, int top)
{
    static const uint8_t ink[3] = {CANVAS_INK};
    for (int row = 0; row < (int)cover->rows; row++)
        for (int column = 0; column < (int)cover->width; column++) {
            int x = left + column, y = top + row, alpha = cover->buffer[row * cover->pitch + column];
            if (!alpha || x < 0 || y < 0 || x >= p->on->width || y >= p->on->height) continue;
            uint8_t *to = p->on->rgb + 3 * ((size_t)y * (size_t)p->on->width + (size_t)x);
            for (int c = 0; c < 3; c++)
                to[c] = (uint8_t)((to[c] * (255 - alpha) + ink[c] * alpha + 127) / 255);
        }
}

static void write_words(pen *p, const char *words)
{
    for (unsigned long letter; (letter = next_letter(&words));) {
        FT_Pos advance = load(p, letter);
        FT_GlyphSlot glyph = p->face->glyph;
        FT_Outline_Translate(&glyph->outline, p->x % PIXEL, 0);
        if (!FT_Render_Glyph(glyph, FT_RENDER_MODE_NORMAL))
            lay_over(p, &glyph->bitmap, (int)(p->x / PIXEL) + glyph->bitmap_left, p->baseline - glyph->bitmap_top);
        p->x += advance;
    }
}

static bool has_letters(FT_Face face, const char *words)
{
    for (unsigned long letter; (letter = next_letter(&words));)
        if (!FT_Get_Char_Index(face, letter)) return false;
    return *words == 0;
}

static bool write_all(canvas *c, FT_Face face, const canvas_words *words, int count, int size)
{
    if (FT_Set_Pixel_Sizes(face, 0, (FT_UInt)size)) return false;
    for (int i = 0; i < count; i++)
        if (!has_letters(face, words[i].text)) return false;
    for (int i = 0; i < count; i++) {
        pen p = {.face = face, .on = c, .baseline = words[i].y};
        p.x = (FT_Pos)words[i].x * PIXEL - width_of(p, words[i].text) / 2;
        if (p.x < 0) p.x = 0;
        write_words(&p, words[i].text);
    }
    return true;
}

/* ---- memory: FreeType goes on without what there was none for, parts of itself and letters ---- */

static void *allocate(FT_Memory memory, long size)
{
    void *block = malloc((size_t)size);
    if (!block) *(bool *)memory->user = true;
    return block;
}

static void release(FT_Memory memory, void *block)
{
    (void)memory;
    free(block);
}

static void *reallocate(FT_Memory memory, long before, long size, void *block)
{
    (void)before;
    void *larger = realloc(block, (size_t)size);
    if (!larger) *(bool *)memory->user = true;
    return larger;
}

status canvas_write_words(canvas *c, const canvas_words *words, int count, int size, bool *written)
{
    bool lacked = false;
    struct FT_MemoryRec_ memory = {&lacked, allocate, release, reallocate};
    FT_Library library;
    FT_Face face;
    *written = false;
    if (!FT_New_Library(&memory, &library)) {
        FT_Add_Default_Modules(library);
        *written = !FT_New_Face(library, MERLIN_FONT, 0, &face) && write_all(c, face, words, count, size);
        FT_Done_Library(library); /* frees its faces, too */
    }
    return lacked ? fail(MERLIN_NO_MEMORY, "no memory for a figure's words") : OK;
}
