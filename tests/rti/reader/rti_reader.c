/* SPDX-License-Identifier: MIT */
#include "rti_reader.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cjson/cJSON.h>

#include "merlin/image.h"

static void *no(const char *path, const char *why)
{
    fprintf(stderr, "%s %s\n", path, why);
    return NULL;
}

/* ---- relight's folders ---- */

static double number(const cJSON *o, const char *name)
{
    const cJSON *item = cJSON_GetObjectItemCaseSensitive(o, name);
    return cJSON_IsNumber(item) ? item->valuedouble : 0;
}

static float *numbers(const cJSON *o, const char *name, int *count)
{
    const cJSON *array = cJSON_GetObjectItemCaseSensitive(o, name), *item;
    float *out = malloc((size_t)(cJSON_GetArraySize(array) + 1) * sizeof *out);
    *count = 0;
    cJSON_ArrayForEach(item, array) out[(*count)++] = (float)item->valuedouble;
    return out;
}

static cJSON *read_json(const char *folder)
{
    char path[4096];
    snprintf(path, sizeof path, "%s/info.json", folder);
    FILE *f = fopen(path, "rb");
    if (!f) return NULL;
    char *text = calloc(1, 1 << 20);
    size_t size = fread(text, 1, (1 << 20) - 1, f);
    fclose(f);
    cJSON *o = size ? cJSON_Parse(text) : NULL;
    free(text);
    return o;
}

/* merlin_image_read takes the codes for sRGB, which is undone. */
static float code_of(float linear)
{
    const float value = linear <= 0.0031308f ? 12.92f * linear : 1.055f * powf(linear, 1 / 2.4f) - 0.055f;
    return roundf(255 * value) / 255;
}

static int read_plane(rti_reader *r, const char *folder, int jpeg, const float *scale, const float *bias)
{
    char path[4096];
    merlin_image image;
    snprintf(path, sizeof path, "%s/plane_%d.jpg", folder, jpeg);
    if (merlin_image_read(path, &image, NULL) != MERLIN_OK) return 0;
    const int fits = image.width == r->width && image.height == r->height;
    for (size_t i = 0; fits && i < (size_t)r->width * (size_t)r->height; i++)
        for (int c = 0; c < 3; c++)
            r->values[i * (size_t)r->planes + (size_t)(3 * jpeg + c)] =
                (code_of(image.data[3 * i + (size_t)c]) - bias[3 * jpeg + c]) * scale[3 * jpeg + c];
    merlin_image_free(&image);
    return fits;
}

static int read_planes(rti_reader *r, const char *folder, const cJSON *material)
{
    int scales, biases, done;
    float *scale = numbers(material, "scale", &scales), *bias = numbers(material, "bias", &biases);
    r->values = calloc((size_t)r->width * (size_t)r->height * (size_t)r->planes, sizeof *r->values);
    done = scales == r->planes && biases == r->planes;
    for (int k = 0; k < r->planes / 3 && done; k++)
        done = read_plane(r, folder, k, scale, bias);
    free(scale);
    free(bias);
    return done;
}

static int read_basis(rti_reader *r, const cJSON *o, const cJSON *material)
{
    int ranges, count;
    float *range = numbers(material, "range", &ranges);
    r->basis = numbers(o, "basis", &count);
    r->sigma = number(o, "sigma");
    const int length = 3 * r->count, fits = ranges == r->planes && count == (r->planes + 1) * length;
    for (int i = 0; i < count && fits; i++)
        r->basis[i] = i < length ? r->basis[i] / 255 : (r->basis[i] - 127) / range[i / length - 1];
    free(range);
    return fits && r->sigma > 0;
}

static rti_reader *open_folder(const char *folder)
{
    cJSON *o = read_json(folder);
    if (!o) return no(folder, "has no info.json");
    const cJSON *material = cJSON_GetArrayItem(cJSON_GetObjectItemCaseSensitive(o, "materials"), 0);
    const char *type = cJSON_GetStringValue(cJSON_GetObjectItemCaseSensitive(o, "type"));
    const char *space = cJSON_GetStringValue(cJSON_GetObjectItemCaseSensitive(o, "colorspace"));
    rti_reader *r = calloc(1, sizeof *r);
    r->width = (int)number(o, "width"), r->height = (int)number(o, "height"), r->planes = (int)number(o, "nplanes");
    snprintf(r->type, sizeof r->type, "%s", type ? type : "");
    snprintf(r->colorspace, sizeof r->colorspace, "%s", space ? space : "");
    r->lights = numbers(o, "lights", &r->count);
    r->count /= 3;
    int done = read_planes(r, folder, material);
    if (done && strcmp(r->type, "rbf") == 0) done = read_basis(r, o, material);
    cJSON_Delete(o);
    if (done) return r;
    rti_reader_close(r);
    return no(folder, "does not hold what its info.json says");
}

/* ---- .ptm files ---- */

static const int PTM_ORDER[6] = {3, 5, 4,
                                 1, 2, 0}; /* which of 1, x, y, xx, xy, yy is in each place of xx, yy, xy, x, y, 1 */

/* One more byte, read beyond what there should be, must not be there. */
static int read_pixels(rti_reader *r, FILE *f, const double scale[6], const double bias[6], int colours)
{
    const int lrgb = strcmp(r->colorspace, "lrgb") == 0;
    for (int c = 0; c < (lrgb ? 1 : 3); c++)
        for (int y = r->height - 1; y >= 0; y--)
            for (int x = 0; x < r->width; x++)
                for (int k = 0; k < 6; k++) {
                    float *values = r->values + ((size_t)y * (size_t)r->width + (size_t)x) * (size_t)r->planes;
                    const int plane = lrgb ? 3 + PTM_ORDER[k] : 3 * PTM_ORDER[k] + c;
                    values[plane] = (float)((getc(f) - bias[k]) * scale[k] / 255);
                }
    for (int y = r->height - 1; y >= 0 && colours; y--)
        for (int x = 0; x < r->width; x++)
            for (int c = 0; c < 3; c++)
                r->values[((size_t)y * (size_t)r->width + (size_t)x) * (size_t)r->planes + (size_t)c] =
                    (float)getc(f) / 255;
    return !feof(f) && getc(f) == EOF;
}

static rti_reader *open_ptm(const char *path)
{
    char kind[32];
    double scale[6], bias[6];
    FILE *f = fopen(path, "rb");
    if (!f) return no(path, "cannot be opened");
    rti_reader *r = calloc(1, sizeof *r);
    int done = fscanf(f, "PTM_1.2\nPTM_FORMAT_%31s\n%d\n%d\n", kind, &r->width, &r->height) == 3;
    for (int k = 0; k < 6; k++)
        done = done && fscanf(f, "%lf", &scale[k]) == 1;
    for (int k = 0; k < 6; k++)
        done = done && fscanf(f, "%lf", &bias[k]) == 1;
    done = done && getc(f) == '\n';
    const int lrgb = done && strcmp(kind, "LRGB") == 0;
    snprintf(r->type, sizeof r->type, "ptm");
    snprintf(r->colorspace, sizeof r->colorspace, lrgb ? "lrgb" : "rgb");
    r->planes = lrgb ? 9 : 18;
    if (done) r->values = calloc((size_t)r->width * (size_t)r->height * (size_t)r->planes, sizeof *r->values);
    done = done && (lrgb || strcmp(kind, "RGB") == 0) && read_pixels(r, f, scale, bias, lrgb);
    fclose(f);
    if (done) return r;
    rti_reader_close(r);
    return no(path, "is no .ptm file");
}

rti_reader *rti_reader_open(const char *path)
{
    const size_t length = strlen(path);
    return length > 4 && strcmp(path + length - 4, ".ptm") == 0 ? open_ptm(path) : open_folder(path);
}

void rti_reader_close(rti_reader *r)
{
    if (!r) return;
    free(r->values);
    free(r->basis);
    free(r->lights);
    free(r);
}

/* ---- light ---- */

static void hsh(const float d[3], double w[9])
{
    const double pi = acos(-1.0), phi = atan2((double)d[1], (double)d[0]);
    const double theta = fmin(acos(fmin((double)d[2], 1)), pi / 2 - 0.15), c = cos(theta), r = sqrt(fmax(c - c * c, 0));
    const double all[9] = {1 / sqrt(2 * pi),
                           sqrt(6 / pi) * cos(phi) * r,
                           sqrt(3 / (2 * pi)) * (2 * c - 1),
                           sqrt(6 / pi) * r * sin(phi),
                           sqrt(30 / pi) * cos(2 * phi) * (c * c - c),
                           sqrt(30 / pi) * cos(phi) * (2 * c - 1) * r,
                           sqrt(5 / (2 * pi)) * (1 - 6 * c + 6 * c * c),
                           sqrt(30 / pi) * (2 * c - 1) * r * sin(phi),
                           sqrt(30 / pi) * (c * c - c) * sin(2 * phi)};
    memcpy(w, all, sizeof all);
}

/* Shares of the lights, which sum to 1. */
static double *shares(const rti_reader *r, const float d[3], rti_viewer viewer)
{
    double *w = malloc((size_t)(r->count + 1) * sizeof *w), sum = 0, near = 0, nearness = 0;
    for (int i = 0; i < r->count; i++) {
        w[i] = 0;
        for (int k = 0; k < 3; k++)
            w[i] += pow((double)(r->lights[3 * i + k] - d[k]), 2);
        near += sqrt(w[i]) * exp(-2 * sqrt(w[i]));
        nearness += exp(-2 * sqrt(w[i]));
    }
    const double sharp = viewer == RTI_OPENLIME ? 8 / (near / nearness) : 1 / (r->sigma * r->sigma);
    for (int i = 0; i < r->count; i++)
        sum += w[i] = exp(-sharp * w[i]);
    for (int i = 0; i < r->count; i++)
        w[i] /= sum;
    return w;
}

static void render_rbf(const rti_reader *r, const float d[3], rti_viewer viewer, float *out)
{
    double *w = shares(r, d, viewer);
    float *vectors = calloc((size_t)(r->planes + 1) * 3, sizeof *vectors);
    for (int p = 0; p <= r->planes; p++)
        for (int i = 0; i < r->count; i++)
            for (int c = 0; c < 3; c++)
                vectors[3 * p + c] += (float)w[i] * r->basis[(p * r->count + i) * 3 + c];
    for (size_t i = 0; i < (size_t)r->width * (size_t)r->height; i++)
        for (int c = 0; c < 3; c++) {
            out[3 * i + (size_t)c] = vectors[c];
            for (int p = 0; p < r->planes; p++)
                out[3 * i + (size_t)c] += r->values[i * (size_t)r->planes + (size_t)p] * vectors[3 * (p + 1) + c];
        }
    free(vectors);
    free(w);
}

void rti_reader_render(const rti_reader *r, const float direction[3], rti_viewer viewer, float *values)
{
    const float length = sqrtf(direction[0] * direction[0] + direction[1] * direction[1] + direction[2] * direction[2]);
    const float d[3] = {direction[0] / length, direction[1] / length, direction[2] / length};
    double w[9] = {1, (double)d[0], (double)d[1], (double)(d[0] * d[0]), (double)(d[0] * d[1]), (double)(d[1] * d[1])};
    if (strcmp(r->type, "rbf") == 0) {
        render_rbf(r, d, viewer, values);
        return;
    }
    if (strcmp(r->type, "hsh") == 0) hsh(d, w);
    const int lrgb = strcmp(r->colorspace, "lrgb") == 0, terms = strcmp(r->type, "hsh") == 0 ? 9 : 6;
    for (size_t i = 0; i < (size_t)r->width * (size_t)r->height; i++) {
        const float *v = r->values + i * (size_t)r->planes;
        for (int c = 0; c < 3; c++) {
            float sum = 0;
            for (int k = 0; k < terms; k++)
                sum += (float)w[k] * v[lrgb ? 3 + k : 3 * k + c];
            values[3 * i + (size_t)c] = lrgb ? v[c] * sum : sum;
        }
    }
}
