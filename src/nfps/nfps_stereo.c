/* SPDX-License-Identifier: MIT */
#include "nfps/nfps_stereo.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "image/resize.h"
#include "nn/nn.h"
#include "stereo/fit/field_fit.h"
#include "stereo/integrate/integrate.h"

/* Sides of the coarsest scale and of the largest; what is larger than that is enlarged from it. A scale that would be
 * nearly the finest one is left out. */
enum { COARSEST = 32, LARGEST = 512, MOST_SCALES = 8 };
static const float NEARLY = 0.7f;

/* The square around the object, in the pictures' pixels, and the pictures that are used. */
typedef struct frame {
    const merlin_capture *capture;
    int left, top, side;
    int count, picture[NN_LARGEST_GROUP];
    nfps_light light[NN_LARGEST_GROUP]; /* of those */
    float distance;
} frame;

/* The square at one scale. */
typedef struct scale {
    int size;
    pinhole camera;
    img mask, normal, depth;
    float *images, *point, *view;
} scale;

static nfps_light light_of(const merlin_light *from)
{
    return (nfps_light){vec3_of(from->position), false, vec3_normalize(vec3_of(from->direction)), from->lobe};
}

static status frame_of(const merlin_capture *c, frame *f)
{
    pst_problem p = {.capture = c};
    status s = pst_list_pixels(c, &p);
    if (s != OK) return s;
    const pst_bounds b = pst_bounds_of(&p);
    free(p.pixel);
    const int width = b.right - b.left + 1, height = b.bottom - b.top + 1, longer = width > height ? width : height;
    *f = (frame){.capture = c, .side = (longer + COARSEST - 1) / COARSEST * COARSEST};
    f->left = (b.left + b.right + 1 - f->side) / 2;
    f->top = (b.top + b.bottom + 1 - f->side) / 2;
    f->count = c->count < NN_LARGEST_GROUP ? c->count : NN_LARGEST_GROUP;
    for (int k = 0; k < f->count; k++) {
        f->picture[k] = (int)((size_t)k * (size_t)c->count / (size_t)f->count);
        f->light[k] = light_of(&c->light[f->picture[k]]);
    }
    f->distance = c->camera.distance > 0 ? c->camera.distance : pst_lights_reach(c);
    return OK;
}

/* Lists the scales' sizes; returns how many there are. */
static int list_sizes(int side, int largest, int sizes[MOST_SCALES])
{
    const int finest = side < largest ? side : largest;
    int count = 0;
    for (int size = COARSEST; (float)size < NEARLY * (float)finest; size *= 2)
        sizes[count++] = size;
    sizes[count++] = finest;
    return count;
}

static void scale_free(scale *l)
{
    img_free(&l->mask);
    img_free(&l->normal);
    img_free(&l->depth);
    free(l->images);
    free(l->point);
    free(l->view);
    *l = (scale){0};
}

/* Cuts a map of the pictures' size out and brings it to a size. */
static status cut(const frame *f, const img *map, int size, img *out)
{
    img square = {0};
    status s = img_crop(map, f->left, f->top, f->side, f->side, &square);
    if (s == OK) s = img_resize(&square, size, size, out);
    img_free(&square);
    return s;
}

/* Returns a picture's square as floats of 3 channels, divided by its light's intensity, black outside the mask. */
static status read_square(const frame *f, int k, img *out)
{
    const merlin_capture *c = f->capture;
    const size_t channels = (size_t)c->channels;
    float factor[3];
    status s = img_new(out, f->side, f->side, 3);
    for (size_t ch = 0; ch < 3; ch++) {
        const float e = c->intensities_known ? c->light[k].intensity[channels == 3 ? ch : 0] : 0;
        factor[ch] = 1 / (65535.0f * (e > 0 ? e : 1));
    }
    for (int y = 0; y < f->side && s == OK; y++)
        for (int x = 0; x < f->side; x++) {
            const int column = f->left + x, row = f->top + y;
            if (column < 0 || row < 0 || column >= c->width || row >= c->height) continue;
            const size_t i = (size_t)row * (size_t)c->width + (size_t)column;
            for (size_t ch = 0; ch < 3 && c->mask.data[i] > 0.5f; ch++)
                img_at(out, x, y)[ch] =
                    factor[ch] * (float)pst_code(&c->picture[k], i * channels + (channels == 3 ? ch : 0));
        }
    return s;
}

/* Brings all pictures to all scales. */
static status scale_pictures(const frame *f, scale *scales, int count)
{
    status s = OK;
    for (int k = 0; k < f->count && s == OK; k++) {
        img square = {0};
        s = read_square(f, f->picture[k], &square);
        for (int i = 0; i < count && s == OK; i++) {
            const size_t values = 3 * (size_t)scales[i].size * (size_t)scales[i].size;
            img small = {0};
            s = img_resize(&square, scales[i].size, scales[i].size, &small);
            if (s == OK) memcpy(scales[i].images + (size_t)k * values, small.data, values * sizeof *small.data);
            img_free(&small);
        }
        img_free(&square);
    }
    return s;
}

/* Makes ones of the pixels that are covered by half and more, or by half of what any is: nothing else would be left of
 * a ring or a chain in few pixels. */
static void settle_mask(img *mask)
{
    float most = 0;
    for (size_t i = 0; i < img_value_count(mask); i++)
        most = fmaxf(most, mask->data[i]);
    for (size_t i = 0; i < img_value_count(mask); i++)
        mask->data[i] = mask->data[i] > 0.5f * fminf(most, 1) ? 1 : 0;
}

static status scale_new(const frame *f, int size, scale *l)
{
    const size_t pixels = (size_t)size * (size_t)size;
    const merlin_capture *c = f->capture;
    const float ratio = (float)size / (float)f->side;
    *l = (scale){.size = size, .point = calloc(3 * pixels, sizeof(float)), .view = calloc(3 * pixels, sizeof(float))};
    if (!l->point || !l->view) return fail(MERLIN_NO_MEMORY, "no memory for %d x %d pixels", size, size);
    l->camera = (pinhole){.focal = c->camera.focal * ratio,
                          .x = (c->camera.x - (float)f->left) * ratio,
                          .y = (c->camera.y - (float)f->top) * ratio,
                          .distance = f->distance};
    status s = img_new(&l->normal, size, size, 3);
    if (s == OK) s = img_new(&l->depth, size, size, 1);
    if (s == OK) s = cut(f, &c->mask, size, &l->mask);
    if (s == OK) settle_mask(&l->mask);
    l->images = calloc((size_t)f->count * 3 * pixels, sizeof *l->images);
    return s == OK && !l->images ? fail(MERLIN_NO_MEMORY, "no memory for %d pictures", f->count) : s;
}

/* Brings normals and depth of a coarser scale to this one's pixels. */
static status enlarge(const scale *from, scale *to)
{
    const size_t pixels = (size_t)to->size * (size_t)to->size;
    img normal = {0}, depth = {0}, cover = {0};
    status s = img_resize(&from->normal, to->size, to->size, &normal);
    if (s == OK) s = img_resize(&from->depth, to->size, to->size, &depth);
    if (s == OK) s = img_resize(&from->mask, to->size, to->size, &cover);
    for (size_t i = 0; s == OK && i < pixels; i++) {
        if (!(to->mask.data[i] > 0.5f)) continue;
        const vec3 n = vec3_normalize(vec3_of(normal.data + 3 * i));
        vec3_put(n.z > 0 ? n : vec3_make(0, 0, 1), to->normal.data + 3 * i);
        /* both are zero outside, so that their ratio is the depth up to the outline */
        to->depth.data[i] = cover.data[i] > 0.1f ? depth.data[i] / cover.data[i] : to->camera.distance;
    }
    img_free(&normal);
    img_free(&depth);
    img_free(&cover);
    return s;
}

static void place_points(const scale *l)
{
    for (size_t i = 0; i < (size_t)l->size * (size_t)l->size; i++) {
        const vec3 ray = pst_ray(&l->camera, (int)(i % (size_t)l->size), (int)(i / (size_t)l->size));
        vec3_put(vec3_scale(ray, l->depth.data[i]), l->point + 3 * i);
        vec3_put(vec3_scale(vec3_normalize(ray), -1), l->view + 3 * i);
    }
}

/* Finds this scale's normals, from those of the scale before (before NULL: there is none), and integrates them. */
static status solve_scale(const nfps_network *n, const frame *f, const nfps_options *o, const scale *before, scale *l)
{
    const size_t pixels = (size_t)l->size * (size_t)l->size;
    status s = before ? enlarge(before, l) : OK;
    for (size_t i = 0; i < pixels && !before; i++)
        l->depth.data[i] = f->distance;
    place_points(l);
    const nfps_scene scene = {pixels, f->count, l->mask.data, l->point, l->view, f->light, o->estimated};
    img depth = {0};
    if (s == OK) s = nfps_network_run(n, &scene, l->size, l->images, before ? l->normal.data : NULL, l->normal.data);
    if (s == OK) s = pst_integrate(&l->normal, &l->mask, &l->camera, &(pst_integration){0}, &depth);
    if (s != OK) return s;
    img_free(&l->depth);
    l->depth = depth;
    return OK;
}

/* Brings the finest scale back into the picture. */
static status put_back(const frame *f, const scale *l, img *normal, img *depth)
{
    const merlin_capture *c = f->capture;
    scale whole = {.size = f->side, .camera = l->camera};
    status s = cut(f, &c->mask, f->side, &whole.mask);
    if (s == OK) s = img_new(&whole.normal, f->side, f->side, 3);
    if (s == OK) s = img_new(&whole.depth, f->side, f->side, 1);
    if (s == OK) s = enlarge(l, &whole);
    if (s == OK) s = img_crop(&whole.normal, -f->left, -f->top, c->width, c->height, normal);
    if (s == OK) s = img_crop(&whole.depth, -f->left, -f->top, c->width, c->height, depth);
    scale_free(&whole);
    return s;
}

static status check(const merlin_capture *c)
{
    if (c->lighting != MERLIN_NEAR_LIGHTS)
        return fail(MERLIN_WRONG_USE, "method nfps needs light positions, which this capture does not have");
    if (!(c->camera.focal > 0)) return fail(MERLIN_WRONG_USE, "method nfps needs the camera's focal length");
    if (c->count < 2) return fail(MERLIN_BAD_INPUT, "method nfps needs pictures under 2 or more lights");
    return OK;
}

status nfps_stereo(const nfps_network *n, const merlin_capture *c, const nfps_options *options, img *normal, img *depth)
{
    *normal = *depth = (img){0};
    frame f;
    int sizes[MOST_SCALES];
    status s = check(c);
    if (s == OK) s = frame_of(c, &f);
    if (s != OK) return s;
    const int count = list_sizes(f.side, options->largest ? options->largest : LARGEST, sizes);
    scale scales[MOST_SCALES] = {0};
    for (int i = 0; i < count && s == OK; i++)
        s = scale_new(&f, sizes[i], &scales[i]);
    if (s == OK) s = scale_pictures(&f, scales, count);
    for (int i = 0; i < count && s == OK; i++) {
        watch_tell(options->watch, "solving", (double)i / count);
        if (watch_stops(options->watch)) s = fail(MERLIN_STOPPED, "stopped");
        if (s == OK) s = solve_scale(n, &f, options, i ? &scales[i - 1] : NULL, &scales[i]);
    }
    if (s == OK) s = put_back(&f, &scales[count - 1], normal, depth);
    for (int i = 0; i < count; i++)
        scale_free(&scales[i]);
    if (s != OK) {
        img_free(normal);
        img_free(depth);
    }
    return s;
}

static status find(const void *context, const merlin_capture *c, const watch *w, img *normal, img *depth)
{
    return nfps_stereo(context, c, &(nfps_options){.watch = w}, normal, depth);
}

pst_guide nfps_guide(const nfps_network *n)
{
    return (pst_guide){.find = n ? find : NULL, .context = n};
}
