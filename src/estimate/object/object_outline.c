/* SPDX-License-Identifier: MIT */
/* Transfers an object's outline from the small picture of the search to the photograph, level by level. */
#include <math.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

#include "base/number.h"
#include "estimate/object/object_search.h"
#include "image/resize.h"

enum { LARGEST_SIDE = 512, BAND = 3 };
/* Ties between similar neighbours in log odds, and the weight of colours relative to them. */
static const float TIE = 8, COLOR_WEIGHT = 0.6f;

/* An object's mask at one size. */
typedef struct outline {
    int width, height;
    uint8_t *object;
} outline;

static status no_memory(void)
{
    return fail(MERLIN_NO_MEMORY, "no memory to look for the object");
}

/* Makes the pixels near the other side free. */
static void free_band(const outline *o, int radius, grid_cut *g)
{
    size_t w = (size_t)o->width, h = (size_t)o->height;
    memset(g->free, 0, w * h);
    for (size_t i = 0; i < w * h; i++) {
        bool right = i % w + 1 < w && o->object[i] != o->object[i + 1];
        bool below = i + w < w * h && o->object[i] != o->object[i + w];
        if (!right && !below) continue;
        int x = (int)(i % w), y = (int)(i / w);
        for (int v = y - radius; v <= y + radius + 1; v++)
            for (int u = x - radius; u <= x + radius + 1; u++)
                if (u >= 0 && v >= 0 && u < (int)w && v < (int)h) g->free[(size_t)v * w + (size_t)u] = 1;
    }
}

static status double_size(const object_view *v, outline *o)
{
    uint8_t *larger = calloc(v->count, 1);
    if (!larger) return no_memory();
    for (int y = 0; y < v->height; y++)
        for (int x = 0; x < v->width; x++) {
            int u = (int)(((float)x + 0.5f) / (float)v->width * (float)o->width);
            int w = (int)(((float)y + 0.5f) / (float)v->height * (float)o->height);
            larger[y * v->width + x] = o->object[w * o->width + u];
        }
    free(o->object);
    *o = (outline){v->width, v->height, larger};
    return OK;
}

/* Computes the classification by colours in the band only. */
static status band_toward(const object_candidate *c, const object_view *v, grid_cut *g)
{
    size_t count = 0, n = 0;
    for (size_t i = 0; i < v->count; i++)
        count += g->free[i];
    float *memory = malloc((count + 1) * (MIXTURE_VALUES + 2) * sizeof *memory);
    int32_t *toward = malloc((count + 1) * sizeof *toward);
    if (memory && toward) {
        mixture_pixels band = {.count = count};
        for (int k = 0; k < MIXTURE_VALUES; k++)
            band.value[k] = memory + (size_t)k * count;
        for (size_t i = 0; i < v->count; i++) {
            if (!g->free[i]) continue;
            for (int k = 0; k < MIXTURE_VALUES; k++)
                band.value[k][n] = v->pixels.value[k][i];
            n++;
        }
        object_toward(c, &band, memory + MIXTURE_VALUES * count, toward);
        n = 0;
        for (size_t i = 0; i < v->count; i++)
            if (g->free[i]) g->toward[i] = (int32_t)(COLOR_WEIGHT * (float)toward[n++]);
    }
    status s = memory && toward ? OK : no_memory();
    free(memory);
    free(toward);
    return s;
}

static status follow(const object_search *s, const object_candidate *c, const img *photo, int side, outline *o)
{
    object_view view;
    grid_cut g = {0};
    status st = object_view_new(photo, side, s->exposure, &view);
    if (st == OK) st = double_size(&view, o);
    if (st == OK) st = grid_cut_new(&g, view.width, view.height);
    if (st == OK) {
        free_band(o, BAND, &g);
        object_view_tie(&view, OBJECT_UNIT * TIE, &g);
        st = band_toward(c, &view, &g);
    }
    if (st == OK) st = grid_cut_solve(&g, o->object);
    grid_cut_free(&g);
    object_view_free(&view);
    return st;
}

/* Enlarges the mask to the photograph's size, with edges that follow it. */
static status enlarge(const outline *o, const img *photo, float exposure, img *mask)
{
    img small = {0};
    float epsilon = 1e-4f / (exposure * exposure);
    status s = img_new(&small, o->width, o->height, 1);
    for (size_t i = 0; s == OK && i < img_value_count(&small); i++)
        small.data[i] = o->object[i];
    if (s == OK && (photo->width != o->width || photo->height != o->height))
        s = img_guided_upsample(&small, NULL, photo, NULL, 2, epsilon, mask);
    else if (s == OK)
        s = img_copy(mask, &small);
    img_free(&small);
    for (size_t i = 0; s == OK && i < img_value_count(mask); i++)
        mask->data[i] = clamp((mask->data[i] - 0.3f) / 0.4f, 0, 1);
    return s;
}

status object_outline(const object_search *s, const object_candidate *c, const img *photo, img *mask)
{
    outline o = {s->view.width, s->view.height, malloc(s->view.count)};
    int longest = photo->width > photo->height ? photo->width : photo->height,
        side = o.width > o.height ? o.width : o.height;
    const int largest = longest < LARGEST_SIDE ? longest : LARGEST_SIDE;
    if (!o.object) return no_memory();
    memcpy(o.object, c->object, s->view.count);
    status st = OK;
    while (st == OK && side < largest) {
        side = 2 * side < largest ? 2 * side : largest;
        st = follow(s, c, photo, side, &o);
    }
    if (st == OK) st = enlarge(&o, photo, s->exposure, mask);
    free(o.object);
    return st;
}
