/* SPDX-License-Identifier: MIT */
#include "estimate/object/object_view.h"

#include <math.h>
#include <stdlib.h>

#include "base/number.h"
#include "estimate/surface/exposure.h"
#include "image/resize.h"

static const float LEAST_WHITE = 0.5f, MOST_GAIN = 64;
/* Share of its strength that a tie keeps across the sharpest edge; weight of a place, in units of the picture's longer
 * side, relative to a colour. */
static const float LEAST_TIE = 0.02f, PLACE_WEIGHT = 0.4f;

static void size_of(const img *photo, int side, int *width, int *height)
{
    int longest = photo->width > photo->height ? photo->width : photo->height;
    float scale = longest > side ? (float)side / (float)longest : 1;
    *width = (int)fmaxf(roundf((float)photo->width * scale), 1);
    *height = (int)fmaxf(roundf((float)photo->height * scale), 1);
}

status object_view_exposure(const img *photo, int side, float *exposure)
{
    int width, height;
    img small = {0}, all = {0};
    size_of(photo, side, &width, &height);
    status s = img_resize(photo, width, height, &small);
    if (s == OK) s = img_new(&all, width, height, 1);
    float brightest = 0;
    for (size_t i = 0; s == OK && i < img_value_count(&small); i++) {
        brightest = fmaxf(brightest, small.data[i]);
        all.data[i / 3] = 1;
    }
    if (s == OK && brightest < LEAST_WHITE)
        *exposure = LEAST_WHITE / fmaxf(brightest, LEAST_WHITE / MOST_GAIN);
    else if (s == OK)
        *exposure = fminf(exposure_gain(&small, &all) / EXPOSURE_WHITE, 1);
    img_free(&small);
    img_free(&all);
    return s;
}

status object_view_new(const img *photo, int side, float exposure, object_view *out)
{
    *out = (object_view){0};
    size_of(photo, side, &out->width, &out->height);
    size_t count = out->count = (size_t)out->width * (size_t)out->height;
    status s = img_resize(photo, out->width, out->height, &out->color);
    if (s != OK) return s;
    float *values = malloc(MIXTURE_VALUES * count * sizeof *values);
    if (!values) return fail(MERLIN_NO_MEMORY, "no memory to look for the object");
    out->pixels.count = count;
    for (int k = 0; k < MIXTURE_VALUES; k++)
        out->pixels.value[k] = values + (size_t)k * count;
    float place = PLACE_WEIGHT / (float)(out->width > out->height ? out->width : out->height);
    for (size_t i = 0; i < count; i++) {
        for (size_t k = 0; k < 3; k++) {
            float *value = &out->color.data[3 * i + k];
            *value = sqrtf(clamp(exposure * *value, 0, 1));
            out->pixels.value[k][i] = *value;
        }
        size_t row = i / (size_t)out->width;
        out->pixels.value[3][i] = place * ((float)(i % (size_t)out->width) + 0.5f);
        out->pixels.value[4][i] = place * ((float)row + 0.5f);
    }
    return OK;
}

void object_view_free(object_view *v)
{
    img_free(&v->color);
    free(v->pixels.value[0]);
    *v = (object_view){0};
}

static float square_between(const object_view *v, size_t i, size_t j)
{
    const float *a = v->color.data + 3 * i, *b = v->color.data + 3 * j;
    float r = a[0] - b[0], g = a[1] - b[1], c = a[2] - b[2];
    return r * r + g * g + c * c;
}

/* Returns the mean squared difference of neighbours. */
static float usual_square(const object_view *v)
{
    double sum = 0;
    size_t pairs = 0, width = (size_t)v->width;
    for (size_t i = 0; i < v->count; i++) {
        if (i % width + 1 < width) {
            sum += (double)square_between(v, i, i + 1);
            pairs++;
        }
        if (i + width < v->count) {
            sum += (double)square_between(v, i, i + width);
            pairs++;
        }
    }
    return (float)(sum / (double)(pairs ? pairs : 1));
}

void object_view_tie(const object_view *v, float strength, grid_cut *g)
{
    const float sharp = 2 * fmaxf(usual_square(v), 1e-7f), diagonal = 0.70710678f;
    for (int d = 0; d < GRID_DIRECTIONS; d += 2)
        for (size_t i = 0; i < v->count; i++) {
            size_t j = grid_beside(v->width, v->height, i, d);
            if (j == SIZE_MAX) continue;
            float like = expf(-square_between(v, i, j) / sharp) + LEAST_TIE;
            g->tie[d][i] = (int32_t)(strength * like * (d < GRID_DOWN_RIGHT ? 1 : diagonal));
        }
}
