/* SPDX-License-Identifier: MIT */
/* merlin_view_write: writes the page with its maps into a file. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "base/api_needs.h"
#include "base/file.h"
#include "estimate/relight/maps_surface.h"
#include "image/resize.h"
#include "image/write/write.h"
#include "merlin/view.h"
#include "view/view_page.h"
#include "view/view_planes.h"
#include "view/view_scene.h"

/* Data between the page's two parts. */
typedef struct page {
    char *scene; /* JSON */
    view_planes planes;
    uint8_t *photo; /* PNG; NULL: none */
    size_t photo_size;
} page;

static void page_free(page *p)
{
    free(p->scene);
    free(p->photo);
    view_planes_free(&p->planes);
}

/* ---- printing ---- */

static void print_lines(FILE *f, const char *const *lines)
{
    for (; *lines; lines++)
        fprintf(f, "%s\n", *lines);
}

static void print_base64(FILE *f, const uint8_t *data, size_t size)
{
    static const char letters[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    for (size_t i = 0; i < size; i += 3) {
        const uint32_t second = i + 1 < size ? data[i + 1] : 0, third = i + 2 < size ? data[i + 2] : 0;
        const uint32_t bits = (uint32_t)data[i] << 16 | second << 8 | third;
        const char word[4] = {letters[bits >> 18], letters[bits >> 12 & 63],
                              i + 1 < size ? letters[bits >> 6 & 63] : '=', i + 2 < size ? letters[bits & 63] : '='};
        fwrite(word, 1, sizeof word, f);
    }
}

/* Prints an element that a browser keeps as text and does not execute. */
static void print_map(FILE *f, const char *name, const uint8_t *data, size_t size)
{
    fprintf(f, "<script type=\"application/octet-stream\" id=\"map-%s\">", name);
    print_base64(f, data, size);
    fputs("</script>\n", f);
}

static void print_page(FILE *f, const void *context)
{
    const page *p = context;
    print_lines(f, view_page_head);
    fprintf(f, "<script type=\"application/json\" id=\"scene\">%s</script>\n", p->scene);
    for (size_t i = 0; i < p->planes.count; i++)
        print_map(f, p->planes.at[i].name, p->planes.at[i].data, p->planes.at[i].size);
    if (p->photo) print_map(f, "photo", p->photo, p->photo_size);
    print_lines(f, view_page_tail);
}

/* ---- data ---- */

/* Encodes the square's photograph. */
static status take_photo(const merlin_maps *maps, int side, page *p)
{
    img part = {0}, shown = {0};
    status s = crop_take(&maps->photo, crop_of(maps), &maps->mask, &part);
    if (s == OK && side != part.width) {
        s = img_resize(&part, side, side, &shown);
        img_free(&part);
        part = shown;
    }
    if (s == OK) s = img_encode_picture("the page's photograph", &part, IMG_PNG, &p->photo, &p->photo_size);
    img_free(&part);
    return s;
}

/* Finds the white for which lamps of power 1, anywhere on the frontal hemisphere, leave a captured surface below 1. */
static status meter(const relighter *s, float *white)
{
    enum { AROUND = 8 };
    const float cosine = 0.5f, sine = sqrtf(1 - cosine * cosine);
    lamp lamps[AROUND + 1] = {lamp_at(vec3_make(0, 0, 0))};
    for (int i = 0; i < AROUND; i++) {
        const float phi = 2 * PI * (float)i / AROUND;
        lamps[i + 1] = lamp_at(vec3_make(sine * cosf(phi), sine * sinf(phi), cosine - 1));
    }
    return relighter_meter(s, lamps, AROUND + 1, white);
}

static status fill(const merlin_maps *maps, const merlin_view_params *params, page *p)
{
    const int most = params->side ? params->side : MERLIN_VIEW_SIDE;
    relighter s;
    status done = relighter_new(NULL, maps, maps->crop.side > most ? most : 0, MERLIN_BY_BRDF_DIRECT, &s);
    if (done != OK) return done;
    float white = s.white;
    if (maps->captured) done = meter(&s, &white);
    const view_ranges ranges = view_ranges_of(&s);
    if (done == OK) done = view_scene_text(maps, params, &s, &ranges, white, &p->scene);
    if (done == OK) done = view_planes_make(&s, &ranges, &p->planes);
    const int side = s.full.mask.width;
    relighter_free(&s);
    if (done == OK && !maps->captured) done = take_photo(maps, side, p);
    return done;
}

static status check_side(int side)
{
    if (side == 0 || (side >= MERLIN_VIEW_LEAST_SIDE && side <= MERLIN_VIEW_MOST_SIDE)) return OK;
    return fail(MERLIN_WRONG_USE, "a page's side is %d to %d pixels, not %d", MERLIN_VIEW_LEAST_SIDE,
                MERLIN_VIEW_MOST_SIDE, side);
}

/* Refuses other names: a file of another kind would be lost, and no browser opens the page. */
static status check_name(const char *path)
{
    static const char *const endings[] = {".html", ".htm", NULL};
    if (file_ends_in_any(file_name_of(path), endings)) return OK;
    return fail(MERLIN_WRONG_USE, "%s: the page's name ends in .html or .htm", path);
}

merlin_status merlin_view_write(const merlin_maps *maps, const merlin_view_params *params, const char *path)
{
    static const merlin_view_params usual = {0};
    const merlin_view_params *how = params ? params : &usual;
    page p = {.scene = NULL};
    status s = api_needs(__func__, maps && path);
    if (s == OK) s = check_side(how->side);
    if (s == OK) s = check_name(path);
    if (s == OK) s = fill(maps, how, &p);
    if (s == OK) s = file_print(path, print_page, &p);
    page_free(&p);
    return s;
}
