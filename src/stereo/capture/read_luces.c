/* SPDX-License-Identifier: MIT */
#include <stdlib.h>
#include <string.h>

#include "base/file.h"
#include "base/text/text_rows.h"
#include "image/read/read.h"
#include "stereo/arrays/array_file.h"
#include "stereo/capture/capture_parts.h"
#include "stereo/capture/luces.h"

enum { TEXT_MOST = 1 << 22, CAMERA_NUMBERS = 7, NUMBERS_MOST = 16 };
static const double LARGEST = 1e7; /* limit in mm or pixels: captures are not ten kilometres large */

void luces_free(luces_params *p)
{
    free(p->light);
    *p = (luces_params){0};
}

/* Converts positions and directions, which have y down and z away from the camera in this file, unlike in the normals'
 * picture. */
static vec3 turn(const double v[3])
{
    return vec3_make((real)v[0], (real)-v[1], (real)-v[2]);
}

typedef struct numbers {
    const char *where;
    int line, count; /* number of values; 0 if the line begins with something else, as headers do */
    double value[NUMBERS_MOST];
} numbers;

static status numbers_of(const text_row *r, const char *where, numbers *out)
{
    *out = (numbers){.where = where, .line = r->line};
    if (r->word[0].kind == TEXT_WORD) return OK;
    for (size_t i = 0; i < r->count; i++) {
        const text_word *w = &r->word[i];
        if (w->kind != TEXT_NUMBER)
            return fail(MERLIN_BAD_INPUT, "%s:%d: \"%.*s\" is not a finite number", where, r->line,
                        (int)(w->length < 40 ? w->length : 40), w->at);
        if (i == NUMBERS_MOST)
            return fail(MERLIN_BAD_INPUT, "%s:%d: more than %d numbers on a line", where, r->line, NUMBERS_MOST);
        out->value[out->count++] = w->value;
    }
    return OK;
}

static status check_range(const numbers *t)
{
    for (int i = 0; i < t->count; i++)
        if (!(t->value[i] >= -LARGEST && t->value[i] <= LARGEST))
            return fail(MERLIN_BAD_INPUT, "%s:%d: %g is out of range", t->where, t->line, t->value[i]);
    return OK;
}

static bool is_whole(double x, double low, double high)
{
    return x >= low && x <= high && floor(x) == x;
}

static status parse_camera(const numbers *t, luces_params *p)
{
    const double *v = t->value;
    if (t->count != CAMERA_NUMBERS)
        return fail(MERLIN_BAD_INPUT, "%s:%d: expected N_img nrows ncols f x0 y0 mean_distance, found %d numbers",
                    t->where, t->line, t->count);
    if (!is_whole(v[0], 1, PST_MOST_PICTURES) || !is_whole(v[1], 1, IMAGE_MAX_SIDE) ||
        !is_whole(v[2], 1, IMAGE_MAX_SIDE) || !(v[3] > 1e-3) || !(v[6] > 1e-3))
        return fail(MERLIN_BAD_INPUT,
                    "%s:%d: not a camera: %g images of %g rows and %g columns, focal length %g, distance %g", t->where,
                    t->line, v[0], v[1], v[2], v[3], v[6]);
    p->count = (int)v[0];
    p->height = (int)v[1];
    p->width = (int)v[2];
    /* the data set's own code has the centre of the first pixel at 0 */
    p->camera = (pinhole){(float)v[3], (float)v[4] + 0.5f, (float)v[5] + 0.5f, (float)v[6]};
    return OK;
}

/* position, direction, intensity (1 or 3), attenuation; the data set's own files have a further 0 at the end of lines,
 * which its code does not read */
static status parse_light(const numbers *t, merlin_light *out)
{
    const double *v = t->value;
    if (t->count < 8 || t->count > 11)
        return fail(
            MERLIN_BAD_INPUT,
            "%s:%d: expected a light's position, direction, intensity and attenuation (8 or 10 numbers), found %d",
            t->where, t->line, t->count);
    int colours = t->count < 10 ? 1 : 3;
    *out = (merlin_light){.lobe = (float)v[6 + colours]};
    vec3_put(turn(v), out->position);
    vec3_put(vec3_normalize(turn(v + 3)), out->direction);
    for (int k = 0; k < 3; k++) {
        out->intensity[k] = (float)v[6 + (colours == 3 ? k : 0)];
        if (!(out->intensity[k] > 0))
            return fail(MERLIN_BAD_INPUT, "%s:%d: the light's intensity must be above zero", t->where, t->line);
    }
    if (!(out->lobe >= 0))
        return fail(MERLIN_BAD_INPUT, "%s:%d: the attenuation must not be negative", t->where, t->line);
    if (out->lobe > 0 && !(vec3_length(vec3_of(out->direction)) > 0.5f))
        return fail(MERLIN_BAD_INPUT, "%s:%d: the light's direction has no length", t->where, t->line);
    return OK;
}

static status take_camera(const numbers *t, luces_params *p)
{
    status s = parse_camera(t, p);
    if (s != OK) return s;
    p->light = calloc((size_t)p->count, sizeof *p->light);
    return p->light ? OK : fail(MERLIN_NO_MEMORY, "no memory for %d lights", p->count);
}

static status take_rows(const text_rows *rows, const char *where, luces_params *p)
{
    int lights = 0;
    for (size_t i = 0; i < rows->count; i++) {
        numbers t;
        if (rows->row[i].comment) continue;
        status s = numbers_of(&rows->row[i], where, &t);
        if (s == OK && t.count == 0 && lights == 0) continue;
        if (s == OK) s = check_range(&t);
        if (s != OK) return s;
        if (!p->light)
            s = take_camera(&t, p);
        else if (lights++ < p->count)
            s = parse_light(&t, &p->light[lights - 1]);
        if (s != OK) return s;
    }
    if (!p->light)
        return fail(MERLIN_BAD_INPUT, "%s: no camera in it (N_img nrows ncols f x0 y0 mean_distance)", where);
    if (lights != p->count)
        return fail(MERLIN_BAD_INPUT, "%s: %d light%s for %d image%s", where, lights, lights == 1 ? "" : "s", p->count,
                    p->count == 1 ? "" : "s");
    return OK;
}

status luces_parse(const char *text, size_t size, const char *where, luces_params *out)
{
    *out = (luces_params){0};
    text_rows rows;
    status s = text_rows_parse(text, size, where, &rows);
    if (s != OK) return s;
    s = take_rows(&rows, where, out);
    text_rows_free(&rows);
    if (s != OK) luces_free(out);
    return s;
}

static status read_params(const char *folder, luces_params *out)
{
    char *path = file_join(folder, "led_params.txt"), *text;
    size_t size;
    if (!path) return fail(MERLIN_NO_MEMORY, "no memory for a file name");
    status s = file_read(path, TEXT_MOST, &text, &size);
    if (s == OK) {
        s = luces_parse(text, size, path, out);
        free(text);
    }
    free(path);
    return s;
}

/* Fails for an object's folder RAW, which has all files again as the sensor's mosaic, with three colours in one
 * channel. */
static status refuse_mosaics(const char *folder)
{
    char *whole = realpath(folder, NULL);
    bool raw = whole && strcmp(strrchr(whole, '/'), "/RAW") == 0;
    free(whole);
    if (!raw) return OK;
    return fail(MERLIN_BAD_INPUT, "%s holds the sensor's mosaics, which are not read; give the folder above it",
                folder);
}

status pst_read_luces(const char *folder, const merlin_capture_files *options, merlin_capture *c)
{
    luces_params p;
    status s = refuse_mosaics(folder);
    if (s == OK) s = read_params(folder, &p);
    if (s != OK) return s;
    s = pst_take_pictures(folder, true, options, "led_params.txt", (size_t)p.count, c);
    if (s == OK) {
        memcpy(c->light, p.light, (size_t)p.count * sizeof *p.light);
        c->lighting = MERLIN_NEAR_LIGHTS;
        c->intensities_known = c->intensities_listed = true;
        c->camera = p.camera;
        c->width = p.width;
        c->height = p.height;
    }
    luces_free(&p);
    return s;
}

/* Converts the normals. The release has y up and z toward the camera, other copies the axes of led_params.txt; the
 * object's front, which faces the camera, reveals which. */
static void decode_normals(merlin_capture *c)
{
    img *n = &c->normal_true;
    size_t pixels = (size_t)c->width * (size_t)c->height;
    double toward = 0;
    for (size_t i = 0; i < pixels; i++)
        if (c->mask.data[i] > 0) toward += (double)n->data[3 * i + 2] - 0.5;
    for (size_t i = 0; i < pixels; i++) {
        float *v = n->data + 3 * i;
        double theirs[3] = {2 * v[0] - 1, 2 * v[1] - 1, 2 * v[2] - 1};
        vec3 ours = toward < 0 ? turn(theirs) : vec3_make((real)theirs[0], (real)theirs[1], (real)theirs[2]);
        vec3_put(c->mask.data[i] > 0 ? vec3_normalize(ours) : vec3_make(0, 0, 0), v);
    }
}

static status read_normals(const char *path, merlin_capture *c)
{
    int bits;
    status s = img_read_samples(path, false, &c->normal_true, &bits);
    if (s != OK) return s;
    const img *n = &c->normal_true;
    if (n->width != c->width || n->height != c->height || n->channels != 3)
        return fail(MERLIN_BAD_INPUT, "%s is %d x %d with %d channels; expected %d x %d with 3", path, n->width,
                    n->height, n->channels, c->width, c->height);
    decode_normals(c);
    return OK;
}

static status read_depth(const char *path, merlin_capture *c)
{
    number_array a;
    status s = npz_read(path, "zgt", &a);
    if (s != OK) return s;
    if (a.size[0] != (size_t)c->height || a.size[1] != (size_t)c->width || a.size[2] != 1)
        s = fail(MERLIN_BAD_INPUT, "%s holds %zu x %zu depths; expected %d x %d", path, a.size[0], a.size[1], c->height,
                 c->width);
    if (s == OK) s = img_new(&c->depth_true, c->width, c->height, 1);
    for (int y = 0; y < c->height && s == OK; y++)
        for (int x = 0; x < c->width; x++) {
            float depth = a.data[array_at(&a, (size_t)y, (size_t)x, 0)];
            *img_at(&c->depth_true, x, y) = *img_at(&c->mask, x, y) > 0 && isfinite(depth) ? depth : 0;
        }
    array_free(&a);
    return s;
}

status pst_read_luces_truth(const char *folder, merlin_capture *c)
{
    char *normals = file_join(folder, "normals.png"), *depth = file_join(folder, "zgt.npz");
    status s = normals && depth ? OK : fail(MERLIN_NO_MEMORY, "no memory for a file name");
    if (s == OK && file_exists(normals)) s = read_normals(normals, c);
    if (s == OK && file_exists(depth)) s = read_depth(depth, c);
    free(normals);
    free(depth);
    return s;
}
