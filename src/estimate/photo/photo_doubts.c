/* SPDX-License-Identifier: MIT */
#include "estimate/photo/photo_doubts.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "base/api_needs.h"
#include "base/status.h"
#include "base/warnings.h"
#include "estimate/light/found_light.h"
#include "estimate/object/mask.h"
#include "estimate/surface/exposure.h"
#include "image/color.h"
#include "image/coverage.h"
#include "image/metadata/exif.h"
#include "image/read/read.h"
#include "merlin/merlin.h"

/* Thresholds. merlin/maps.h gives the meaning of the warnings, docs/notes/doubts.md their derivation. */
static const float MUCH_BURNT_OUT = 0.1f, MUCH_CUT = 0.15f, LIKELY_ELSEWHERE = 0.6f;
static const float FULL = 0.97f, FULL_IF_FOUND = 0.66f, NARROW = 5, WIDE = 95;
static const float DARK = 0.02f, LITTLE_OUTWARD = 0.1f, MUCH_INWARD = 0.4f, MUCH_FLAT = 0.6f;
enum { SMALL = 2500, FEW_SHADES = 48, PHOTOGRAPHS_ENOUGH = 7 };

/* ---- the mask ---- */

static size_t object_pixels(const merlin_maps *maps)
{
    return coverage_box_of(&maps->mask).pixels;
}

/* Tells whether much of the object's outline, as long as its box's, is the photograph's edge. */
static bool is_cut(const img *mask)
{
    const coverage_box b = coverage_box_of(mask);
    const float outline = (float)(b.right - b.left + b.bottom - b.top), edge = (float)(mask->width + mask->height);
    return b.pixels > 0 && coverage_of_edge(mask) * edge >= MUCH_CUT * outline;
}

static unsigned doubts_of_mask(const merlin_maps *maps)
{
    const size_t object = object_pixels(maps);
    const float share = (float)object / (float)img_value_count(&maps->mask);
    unsigned doubts = 0;
    if (share >= (maps->mask_source == MERLIN_MASK_FOUND ? FULL_IF_FOUND : FULL)) doubts |= MERLIN_DOUBT_NO_OBJECT;
    if (maps->mask_confidence < MASK_LITTLE_CONFIDENCE) doubts |= MERLIN_DOUBT_OBJECT_UNSURE;
    if (is_cut(&maps->mask) && !(doubts & MERLIN_DOUBT_NO_OBJECT)) doubts |= MERLIN_DOUBT_OBJECT_CUT;
    if (object < SMALL) doubts |= MERLIN_DOUBT_OBJECT_SMALL;
    return doubts;
}

/* ---- the pixels ---- */

typedef struct pixels {
    size_t count, coloured, flat,
        neither; /* counts of fully covered pixels; `neither` counts those that are neither black nor white */
    float shade[FEW_SHADES]; /* distinct values of green, up to a maximum */
    int shades;
    float brightest;
} pixels;

static void note_shade(pixels *p, float value)
{
    if (p->shades == FEW_SHADES) return;
    for (int i = 0; i < p->shades; i++)
        if (p->shade[i] == value) return;
    p->shade[p->shades++] = value;
}

static bool is_color(const float *a, const float *b)
{
    return a[0] == b[0] && a[1] == b[1] && a[2] == b[2];
}

/* Tells whether a pixel and its eight neighbours have exactly the same colour. */
static bool is_flat(const img *photo, const img *mask, int x, int y)
{
    const float *color = img_at(photo, x, y);
    if (x < 1 || y < 1 || x + 1 >= photo->width || y + 1 >= photo->height) return false;
    for (int dy = -1; dy <= 1; dy++)
        for (int dx = -1; dx <= 1; dx++)
            if (*img_at(mask, x + dx, y + dy) < 0.999f || !is_color(img_at(photo, x + dx, y + dy), color)) return false;
    return true;
}

static pixels pixels_of(const merlin_maps *maps)
{
    const float black = 0.002f, white = 0.98f;
    img photo = maps->photo, mask = maps->mask;
    pixels p = {0};
    for (int y = 0; y < photo.height; y++) {
        img_span span = img_row_span(&mask, y);
        for (int x = span.first; x < span.end; x++) {
            const float *color = img_at(&photo, x, y), bright = color_luminance(color);
            if (*img_at(&mask, x, y) < 0.999f) continue;
            p.count++;
            p.coloured += color[0] != color[1] || color[1] != color[2];
            p.brightest = fmaxf(p.brightest, bright);
            note_shade(&p, color[1]);
            if (bright < black || bright > white) continue;
            p.neither++;
            p.flat += is_flat(&photo, &mask, x, y);
        }
    }
    return p;
}

static unsigned doubts_of_pixels(const merlin_maps *maps)
{
    pixels p = pixels_of(maps);
    unsigned doubts = 0;
    if (p.count > 0 && (double)p.coloured < 0.001 * (double)p.count) doubts |= MERLIN_DOUBT_GREY;
    if ((float)p.flat > MUCH_FLAT * (float)p.neither) doubts |= MERLIN_DOUBT_DRAWING;
    if (p.shades < FEW_SHADES && p.brightest < DARK) doubts |= MERLIN_DOUBT_DARK;
    return doubts;
}

/* ---- light and lens ---- */

static unsigned doubts_of_light(const light_cues *cues, const merlin_shot *shot, const merlin_maps *maps)
{
    unsigned doubts = 0;
    bool elsewhere = maps->light_elsewhere >= LIKELY_ELSEWHERE;
    if (maps->light.known ? !found_light_is_flash(&maps->light) : elsewhere) doubts |= MERLIN_DOUBT_LIGHT_ELSEWHERE;
    if (found_light_share(&maps->light).lamp > 0.5f && maps->light.lamp[2] < 0) doubts |= MERLIN_DOUBT_LIGHT_BEHIND;
    if (cues->known && cues->outward < LITTLE_OUTWARD && cues->inward > MUCH_INWARD) doubts |= MERLIN_DOUBT_HOLLOW;
    if (shot->flash == MERLIN_FLASH_NONE && !maps->light.known) doubts |= MERLIN_DOUBT_NO_FLASH;
    return doubts;
}

void doubts_find(const light_cues *cues, const merlin_shot *shot, merlin_maps *maps)
{
    maps->light_elsewhere = light_cues_elsewhere(cues);
    maps->doubts = doubts_of_mask(maps) | doubts_of_pixels(maps) | doubts_of_light(cues, shot, maps);
    if (maps->burnt_out >= MUCH_BURNT_OUT) maps->doubts |= MERLIN_DOUBT_BURNT_OUT;
    if (maps->fov > 0 && maps->fov < NARROW) maps->doubts |= MERLIN_DOUBT_LENS_NARROW;
    if (maps->fov > WIDE) maps->doubts |= MERLIN_DOUBT_LENS_WIDE;
    maps->reduced = shot->reduced;
    maps->frames = shot->frames;
    if (shot->reduced > 1) maps->doubts |= MERLIN_DOUBT_REDUCED;
    if (shot->frames > 1) maps->doubts |= MERLIN_DOUBT_FIRST_FRAME;
}

/* ---- words ---- */

static const struct {
    merlin_doubt doubt;
    const char *code;
} names[] = {
    {MERLIN_DOUBT_NO_OBJECT, "no_object"},
    {MERLIN_DOUBT_BURNT_OUT, "burnt_out"},
    {MERLIN_DOUBT_OBJECT_UNSURE, "object_unsure"},
    {MERLIN_DOUBT_LIGHT_ELSEWHERE, "light_elsewhere"},
    {MERLIN_DOUBT_NO_FLASH, "no_flash_fired"},
    {MERLIN_DOUBT_LIGHT_BEHIND, "light_behind"},
    {MERLIN_DOUBT_HOLLOW, "hollow"},
    {MERLIN_DOUBT_DRAWING, "drawing"},
    {MERLIN_DOUBT_LENS_NARROW, "lens_narrow"},
    {MERLIN_DOUBT_LENS_WIDE, "lens_wide"},
    {MERLIN_DOUBT_DARK, "dark"},
    {MERLIN_DOUBT_OBJECT_CUT, "object_cut"},
    {MERLIN_DOUBT_OBJECT_SMALL, "object_small"},
    {MERLIN_DOUBT_GREY, "grey"},
    {MERLIN_DOUBT_REDUCED, "reduced_size"},
    {MERLIN_DOUBT_FIRST_FRAME, "first_frame"},
    {MERLIN_DOUBT_NORMALS_NOT_UNIT, "normals_not_unit"},
    {MERLIN_DOUBT_ALBEDO_CLAMPED, "albedo_clamped"},
    {MERLIN_DOUBT_ROUGHNESS_CLAMPED, "roughness_clamped"},
    {MERLIN_DOUBT_DEPTH_CLAMPED, "depth_clamped"},
    {MERLIN_DOUBT_NOT_REFINED, "not_refined"},
    {MERLIN_DOUBT_STRENGTHS_UNEQUAL, "strengths_unequal"},
    {MERLIN_DOUBT_LIGHTS_FAR, "lights_far"},
};
enum { NAMES = sizeof names / sizeof *names };

const char *merlin_doubt_code(merlin_doubt doubt)
{
    for (int i = 0; i < NAMES; i++)
        if (names[i].doubt == doubt) return names[i].code;
    return "";
}

static int lens_words(const merlin_maps *maps, char *text, size_t size)
{
    return snprintf(
        text, size,
        "the square around the object is %.1f degrees wide, which no lens of a photograph of an object is: depth is a "
        "guess",
        (double)maps->fov);
}

static int mask_words(const merlin_maps *maps, char *text, size_t size)
{
    double share = 100 * (double)object_pixels(maps) / (double)img_value_count(&maps->mask);
    if (maps->mask_source == MERLIN_MASK_FOUND)
        return snprintf(text, size, "no object stands out: what was found fills %.0f %% of the photograph", share);
    return snprintf(text, size, "the mask covers %.0f %% of the photograph: no outline tells the shape", share);
}

static int light_sentence(const merlin_maps *maps, char *text, size_t size)
{
    char words[MERLIN_LIGHT_WORDS];
    if (!maps->light.known)
        return snprintf(
            text, size,
            "it does not look lit by a flash at the lens, the one light the model knows, and its maps may be "
            "quite wrong: photograph it in the dark by the flash");
    merlin_light_words(&maps->light, words, sizeof words);
    return snprintf(
        text, size,
        "it is lit by %s, as far as the model can tell: shape and material are surer by a flash in the dark, "
        "and how bright the albedo is is a guess",
        words);
}

static const char *plain_words(merlin_doubt doubt)
{
    switch (doubt) {
    case MERLIN_DOUBT_NO_FLASH:
        return "by its EXIF no flash fired, the one light the model knows";
    case MERLIN_DOUBT_LIGHT_BEHIND:
        return "most of its light seems to come from behind the object, whose front then tells little: turn it, or "
               "photograph it by the flash";
    case MERLIN_DOUBT_HOLLOW:
        return "the object came out hollow: along its outline the normals turn inward";
    case MERLIN_DOUBT_DRAWING:
        return "most of it are areas of one colour, as of a drawing or a screenshot: there is no shading to tell a "
               "shape";
    case MERLIN_DOUBT_DARK:
        return "the object is nearly black in this photograph: too few shades to tell its material by";
    case MERLIN_DOUBT_OBJECT_CUT:
        return "the photograph's edge cuts the object off, and its shape is less sure there";
    case MERLIN_DOUBT_GREY:
        return "it is a black-and-white picture: albedo's colour is not to be known";
    case MERLIN_DOUBT_STRENGTHS_UNEQUAL:
        return "the pictures' lights do not seem equally strong, or their exposures were not the same, and normals may "
               "be many degrees off: fix the exposure, or list the strengths in light_intensities.txt";
    case MERLIN_DOUBT_LIGHTS_FAR:
        return "nothing tells the lens, so the lamps were taken to be far away: if they were nearer than some five "
               "times "
               "the object's size, normals are many degrees off, which --fov DEGREES, the field of view, mends";
    default:
        return "";
    }
}

static double percent(float share)
{
    return 100 * (double)share;
}

/* Without an outline the network's shape of a surface that fills the picture is a guess (36 and 53 degrees inside of
 * the owl and the cat of docs/captures.md). */
static int unrefined_words(const merlin_maps *maps, char *text, size_t size)
{
    const bool whole = maps->doubts & MERLIN_DOUBT_NO_OBJECT;
    return snprintf(text, size,
                    "%s: shape is the network's alone, whose normals are off by %s; more pictures, all from one place, "
                    "under lights from more sides, or a list of the lights (--lights) give a better one",
                    maps->photographs < PHOTOGRAPHS_ENOUGH
                        ? "these fewer than 7 pictures do not tell where their lights are"
                        : "photometric stereo does not find the lights of these pictures",
                    whole ? "30 degrees and more where a surface fills the picture" : "15 to 25 degrees");
}

/* Writes the text of a warning about maps that were read and corrected. */
static int mended_words(const merlin_maps *maps, merlin_doubt doubt, char *text, size_t size)
{
    switch (doubt) {
    case MERLIN_DOUBT_NORMALS_NOT_UNIT:
        return snprintf(text, size, "%.3g %% of the normals are not of unit length, and were made so",
                        percent(maps->mended.normal));
    case MERLIN_DOUBT_ALBEDO_CLAMPED:
        return snprintf(text, size, "%.3g %% of the albedo is outside of [0, 1], and was clamped",
                        percent(maps->mended.albedo));
    case MERLIN_DOUBT_ROUGHNESS_CLAMPED:
        return snprintf(text, size, "%.3g %% of the roughness is outside of [0.03, 1], and was clamped",
                        percent(maps->mended.roughness));
    default:
        return snprintf(text, size, "%.3g %% of the depth is out of range, and was clamped",
                        percent(maps->mended.depth));
    }
}

int merlin_doubt_message(const merlin_maps *maps, merlin_doubt doubt, char *text, int size)
{
    size_t room = size > 0 ? (size_t)size : 0;
    switch (doubt) {
    case MERLIN_DOUBT_NO_OBJECT:
        return mask_words(maps, text, room);
    case MERLIN_DOUBT_BURNT_OUT:
        return snprintf(
            text, room,
            "%.0f %% of the object is burnt out, where albedo and roughness are guesses: photograph it darker",
            100 * (double)maps->burnt_out);
    case MERLIN_DOUBT_OBJECT_UNSURE:
        return snprintf(text, room,
                        "it is not sure which part is the object (confidence %.2f): check mask.png; --point X,Y or "
                        "--box X,Y,W,H helps the search, --mask FILE does without",
                        (double)maps->mask_confidence);
    case MERLIN_DOUBT_LIGHT_ELSEWHERE:
        return light_sentence(maps, text, room);
    case MERLIN_DOUBT_LENS_NARROW:
    case MERLIN_DOUBT_LENS_WIDE:
        return lens_words(maps, text, room);
    case MERLIN_DOUBT_REDUCED:
        return snprintf(text, room, "it was read at a reduced size: %d x %d of its pixels became one", maps->reduced,
                        maps->reduced);
    case MERLIN_DOUBT_FIRST_FRAME:
        return snprintf(text, room, "it is an animation, of whose %d pictures the first alone was read", maps->frames);
    case MERLIN_DOUBT_NOT_REFINED:
        return unrefined_words(maps, text, room);
    case MERLIN_DOUBT_OBJECT_SMALL:
        return snprintf(text, room, "the object has %zu pixels alone, of the 65,000 that the model is made for",
                        object_pixels(maps));
    case MERLIN_DOUBT_NORMALS_NOT_UNIT:
    case MERLIN_DOUBT_ALBEDO_CLAMPED:
    case MERLIN_DOUBT_ROUGHNESS_CLAMPED:
    case MERLIN_DOUBT_DEPTH_CLAMPED:
        return mended_words(maps, doubt, text, room);
    default:
        return snprintf(text, room, "%s", plain_words(doubt));
    }
}

void merlin_maps_warnings(const merlin_maps *maps, merlin_warnings *out)
{
    if (out) *out = (merlin_warnings){0};
    for (int i = 0; i < NAMES && maps && out; i++) {
        char message[WARNING_WORDS];
        if (!(maps->doubts & names[i].doubt)) continue;
        merlin_doubt_message(maps, names[i].doubt, message, sizeof message);
        warnings_add(out, names[i].code, "%s", message);
    }
    if (maps && out && maps->noticed) warnings_append(out, maps->noticed);
}

merlin_status merlin_shot_read(const char *path, merlin_shot *out)
{
    if (out) *out = (merlin_shot){0};
    status s = api_needs(__func__, path && out);
    if (s != OK) return s;
    exif_facts facts;
    img_facts file;
    s = exif_read(path, &facts);
    if (s == OK) s = img_look(path, &file);
    if (s != OK) return s;
    *out = (merlin_shot){.flash = (merlin_flash)facts.flash,
                         .focal_35mm = exif_focal_35mm(&facts, file.width, file.height),
                         .reduced = file.reduced,
                         .frames = file.frames};
    return MERLIN_OK;
}
