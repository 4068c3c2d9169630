/* SPDX-License-Identifier: MIT */
#include "image/formats/picture_rows.h"

#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include "image/metadata/picture_size.h"
#include "image/primaries.h"

struct picture_rows {
    picture_layout layout;
    int channels; /* colour channels: 1 or 3 */
    int reduction;
    bool decode;
    float full;    /* code of the value 1 */
    float *table;  /* linear values of integers that are decoded; else NULL */
    bool coded;    /* floats have a curve, too */
    bool mixed;    /* converted by the matrix */
    double mix[9]; /* matrix to sRGB's primaries */
    float *line;   /* colours of one row */
    float *cover;  /* alpha of that row, 1 without */
    float *weight; /* for reduced pictures: the total weight in each pixel of color */
    img *color, *alpha;
};

int picture_reduction(long long width, long long height)
{
    int by = 1;
    for (;; by++) {
        long long w = (width + by - 1) / by, h = (height + by - 1) / by;
        if (w <= IMAGE_MAX_SIDE && h <= IMAGE_MAX_SIDE && w * h <= IMAGE_MOST_PIXELS) return by;
    }
}

static bool has_alpha(const picture_layout *l)
{
    return l->alpha && l->bands > 1;
}

static status set_mix(picture_rows *r)
{
    const picture_light *light = &r->layout.light;
    r->mixed = r->decode && r->channels == 3 && light->has_primaries;
    if (!r->mixed || primaries_to_srgb(light->xy, r->mix)) return OK;
    return fail(MERLIN_BAD_INPUT, "its primaries are those of no colours");
}

static status make_buffers(picture_rows *r)
{
    const picture_layout *l = &r->layout;
    size_t width = (size_t)l->width;
    r->line = malloc(width * (size_t)r->channels * sizeof *r->line);
    r->cover = malloc(width * sizeof *r->cover);
    if (r->decode && l->sample != PICTURE_FLOAT) r->table = picture_light_table(&l->light, l->sample == PICTURE_UINT16);
    bool sums = r->reduction > 1;
    if (sums) r->weight = calloc(img_value_count(r->color) / (size_t)r->channels, sizeof *r->weight);
    bool complete = r->line && r->cover && (!sums || r->weight);
    if (r->decode && l->sample != PICTURE_FLOAT) complete &= r->table != NULL;
    return complete ? OK : fail(MERLIN_NO_MEMORY, "no memory for a picture of %d x %d pixels", l->width, l->height);
}

static status make_images(picture_rows *r, img *color, img *alpha)
{
    const picture_layout *l = &r->layout;
    bool sideways = l->orientation > 4;
    int by = r->reduction, w = (l->width + by - 1) / by, h = (l->height + by - 1) / by;
    int width = sideways ? h : w, height = sideways ? w : h;
    status s = img_new(color, width, height, r->channels);
    if (s == OK && alpha && has_alpha(l)) s = img_new(alpha, width, height, 1);
    r->color = color;
    r->alpha = alpha && alpha->data ? alpha : NULL;
    return s;
}

status picture_rows_new(const picture_layout *layout, picture_colour how, img *color, img *alpha, picture_rows **out)
{
    *out = NULL;
    picture_rows *r = calloc(1, sizeof *r);
    if (!r) return fail(MERLIN_NO_MEMORY, "no memory for a picture's rows");
    r->layout = *layout;
    r->channels = layout->bands - has_alpha(layout) < 3 ? 1 : 3;
    r->reduction = picture_reduction(layout->width, layout->height);
    r->decode = how == PICTURE_LINEARIZE;
    r->coded = r->decode && layout->coded && layout->light.said && layout->sample == PICTURE_FLOAT;
    float full = layout->sample == PICTURE_UINT8 ? 255 : layout->sample == PICTURE_UINT16 ? 65535 : 1;
    r->full = full / (layout->scale > 0 ? layout->scale : 1);
    status s = set_mix(r);
    if (s == OK) s = make_images(r, color, alpha);
    if (s == OK) s = make_buffers(r);
    if (s == OK)
        *out = r;
    else
        picture_rows_free(r);
    return s;
}

static float code_at(const picture_rows *r, const void *samples, size_t i)
{
    switch (r->layout.sample) {
    case PICTURE_UINT8:
        return (float)((const uint8_t *)samples)[i] / r->full;
    case PICTURE_UINT16:
        return (float)((const uint16_t *)samples)[i] / r->full;
    case PICTURE_FLOAT:
        break;
    }
    return ((const float *)samples)[i] / r->full;
}

/* Returns the linear light of a code between two table entries. */
static float light_of(const picture_rows *r, float code)
{
    float last = r->layout.sample == PICTURE_UINT16 ? 65535.0f : 255.0f;
    return r->table[(int)((code < 1 ? code > 0 ? code : 0 : 1) * last + 0.5f)];
}

static void take_cover(picture_rows *r, const void *samples)
{
    const picture_layout *l = &r->layout;
    bool there = has_alpha(l);
    for (size_t x = 0, n = (size_t)l->width, bands = (size_t)l->bands; x < n; x++)
        r->cover[x] = there ? code_at(r, samples, x * bands + bands - 1) : 1;
}

/* Converts ordinary colours through the table. */
static void take_codes(picture_rows *r, const void *samples)
{
    size_t bands = (size_t)r->layout.bands, channels = (size_t)r->channels, width = (size_t)r->layout.width;
    const uint8_t *narrow = samples;
    const uint16_t *wide = samples;
    bool is_wide = r->layout.sample == PICTURE_UINT16;
    for (size_t x = 0; x < width; x++)
        for (size_t c = 0; c < channels; c++)
            r->line[x * channels + c] = r->table[is_wide ? wide[x * bands + c] : narrow[x * bands + c]];
}

/* Converts colours that are scaled, or premultiplied by alpha. */
static void take_values(picture_rows *r, const void *samples)
{
    const float least = 1e-6f; /* below this alpha there is no object, and dividing would amplify noise */
    size_t bands = (size_t)r->layout.bands, channels = (size_t)r->channels, width = (size_t)r->layout.width;
    bool divided = r->layout.premultiplied && has_alpha(&r->layout);
    for (size_t x = 0; x < width; x++) {
        float cover = divided && r->cover[x] > least ? r->cover[x] : 1;
        for (size_t c = 0; c < channels; c++) {
            float value = code_at(r, samples, x * bands + c) / cover;
            r->line[x * channels + c] = r->table   ? light_of(r, value)
                                        : r->coded ? picture_light_of_float(&r->layout.light, value)
                                                   : value;
        }
    }
}

static void mix_line(picture_rows *r)
{
    const double *m = r->mix;
    for (int x = 0; x < r->layout.width; x++) {
        float *at = r->line + 3 * (size_t)x;
        const double v[3] = {(double)at[0], (double)at[1], (double)at[2]};
        for (int c = 0; c < 3; c++)
            at[c] = (float)(m[3 * c] * v[0] + m[3 * c + 1] * v[1] + m[3 * c + 2] * v[2]);
    }
}

/* Returns the pixel of an upright picture of this size at which the file's pixel is seen, by the EXIF standard's table.
 */
static size_t place_of(const picture_rows *r, const img *image, int x, int y)
{
    int o = r->layout.orientation, right = image->width - 1, below = image->height - 1, to_x = x, to_y = y;
    if (o > 4) {
        to_x = y;
        to_y = x;
    }
    if (o == 2 || o == 3 || o == 6 || o == 7) to_x = right - to_x;
    if (o == 3 || o == 4 || o == 7 || o == 8) to_y = below - to_y;
    return (size_t)to_y * (size_t)image->width + (size_t)to_x;
}

static void place_line(picture_rows *r, int y)
{
    size_t channels = (size_t)r->channels;
    int width = r->layout.width;
    if (r->layout.orientation <= 1)
        memcpy(img_at(r->color, 0, y), r->line, (size_t)width * channels * sizeof *r->line);
    else
        for (int x = 0; x < width; x++)
            memcpy(r->color->data + place_of(r, r->color, x, y) * channels, r->line + (size_t)x * channels,
                   channels * sizeof *r->line);
    if (r->alpha)
        for (int x = 0; x < width; x++)
            r->alpha->data[place_of(r, r->alpha, x, y)] = r->cover[x];
}

/* Adds a row to the reduced picture, weighted by alpha: pixels that show nothing hardly count. */
static void add_line(picture_rows *r, int y)
{
    const float least = 1e-4f;
    size_t channels = (size_t)r->channels;
    int by = r->reduction;
    for (int x = 0; x < r->layout.width; x++) {
        size_t at = place_of(r, r->color, x / by, y / by);
        float weight = r->cover[x] > least ? r->cover[x] : least;
        r->weight[at] += weight;
        for (size_t c = 0; c < channels; c++)
            r->color->data[at * channels + c] += weight * r->line[(size_t)x * channels + c];
        if (r->alpha) r->alpha->data[at] += r->cover[x];
    }
}

void picture_rows_put(picture_rows *r, int y, const void *samples)
{
    take_cover(r, samples);
    if (r->table && !r->layout.premultiplied && !(r->layout.scale > 0))
        take_codes(r, samples);
    else
        take_values(r, samples);
    if (r->mixed) mix_line(r);
    if (r->reduction > 1)
        add_line(r, y);
    else
        place_line(r, y);
}

/* Returns how many of the file's pixels along a side are averaged into one of the reduced picture. */
static int share(int size, int by, int at)
{
    return size - at * by < by ? size - at * by : by;
}

static void average(picture_rows *r)
{
    size_t channels = (size_t)r->channels;
    int by = r->reduction, w = r->layout.width, h = r->layout.height;
    for (size_t i = 0; i < img_value_count(r->color); i++)
        if (r->weight[i / channels] > 0) r->color->data[i] /= r->weight[i / channels];
    for (int y = 0; r->alpha && y * by < h; y++)
        for (int x = 0; x * by < w; x++)
            r->alpha->data[place_of(r, r->alpha, x, y)] /= (float)(share(w, by, x) * share(h, by, y));
}

void picture_rows_free(picture_rows *r)
{
    if (!r) return;
    if (r->reduction > 1 && r->weight) average(r);
    free(r->table);
    free(r->line);
    free(r->cover);
    free(r->weight);
    free(r);
}

status picture_reduce(img *image)
{
    if (!image->data || picture_reduction(image->width, image->height) == 1) return OK;
    const picture_layout layout = {
        .width = image->width, .height = image->height, .bands = image->channels, .sample = PICTURE_FLOAT};
    img reduced = {0};
    picture_rows *rows;
    status s = picture_rows_new(&layout, PICTURE_AS_IT_IS, &reduced, NULL, &rows);
    for (int y = 0; s == OK && y < image->height; y++)
        picture_rows_put(rows, y, img_at(image, 0, y));
    picture_rows_free(s == OK ? rows : NULL);
    if (s != OK) return s;
    img_free(image);
    *image = reduced;
    return OK;
}
