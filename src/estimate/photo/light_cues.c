/* SPDX-License-Identifier: MIT */
#include "estimate/photo/light_cues.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/number.h"
#include "image/color.h"
#include "image/resize.h"
#include "optics/camera.h"

enum { FEWEST = 60 }; /* least number of pixels for a median */
static const float BURNT = 0.95f, BEYOND_WHITE = 1.01f;
/* Offset added to luminance before its logarithm, and the limit of black, as a share of the 95th percentile. */
static const float FLOOR = 0.02f;

/* Planes of the maps' size. */
typedef struct planes {
    int width, height;
    img inside;  /* 1 on the object */
    img seen;    /* 1 on the object where it is not burnt out */
    img light;   /* log luminance, smoothed */
    img shading; /* log of the maps' shading under a flash, smoothed in the same way */
    img away;    /* distance to the outline in pixels */
    img away_smooth;
    float radius; /* radius of a disc of the object's area, in pixels */
} planes;

static void planes_free(planes *p)
{
    img *all[] = {&p->inside, &p->seen, &p->light, &p->shading, &p->away, &p->away_smooth};
    for (size_t i = 0; i < sizeof all / sizeof *all; i++)
        img_free(all[i]);
}

static status planes_new(int width, int height, planes *p)
{
    img *all[] = {&p->inside, &p->seen, &p->light, &p->shading, &p->away};
    *p = (planes){.width = width, .height = height};
    status s = OK;
    for (size_t i = 0; i < sizeof all / sizeof *all && s == OK; i++)
        s = img_new(all[i], width, height, 1);
    return s;
}

/* Returns a quantile; sorts the values. */
static float quantile(float *values, size_t count, float share)
{
    if (count == 0) return 0;
    qsort(values, count, sizeof *values, number_ascending);
    return values[(size_t)(share * (float)(count - 1))];
}

/* ---- planes ---- */

/* Computes the distance in pixels to the nearest one that lies in the photograph outside the object, in two passes
 * (Borgefors 1986). */
static void measure_away(const light_frame *frame, planes *p)
{
    const float far = 1e6f, diagonal = 1.41421356f;
    for (int y = 0; y < p->height; y++)
        for (int x = 0; x < p->width; x++) {
            bool in_photo = (float)x >= frame->left && (float)x + 1 <= frame->right && (float)y >= frame->top &&
                            (float)y + 1 <= frame->bottom;
            *img_at(&p->away, x, y) = *img_at(&p->inside, x, y) > 0 || !in_photo ? far : 0;
        }
    static const int near[4][2] = {{-1, 0}, {-1, -1}, {0, -1}, {1, -1}};
    for (int pass = 0, sign = 1; pass < 2; pass++, sign = -1)
        for (int i = 0; i < p->width * p->height; i++) {
            int at = sign > 0 ? i : p->width * p->height - 1 - i, x = at % p->width, y = at / p->width;
            for (int k = 0; k < 4; k++) {
                int to_x = x + sign * near[k][0], to_y = y + sign * near[k][1];
                if (to_x < 0 || to_y < 0 || to_x >= p->width || to_y >= p->height) continue;
                float step = near[k][0] && near[k][1] ? diagonal : 1, over = *img_at(&p->away, to_x, to_y) + step;
                if (over < p->away.data[at]) p->away.data[at] = over;
            }
        }
}

/* Smooths twice by windows of 2 radius + 1 pixels. */
static status smooth(img *plane, int radius)
{
    status s = img_box_sums(plane, radius);
    return s == OK ? img_box_sums(plane, radius) : s;
}

/* Smooths using only pixels that are `seen`; elsewhere the result is arbitrary. */
static status smooth_seen(img *plane, const img *seen, int radius)
{
    img weight;
    status s = img_copy(&weight, seen);
    if (s != OK) return s;
    for (size_t i = 0; i < img_value_count(plane); i++)
        plane->data[i] *= seen->data[i];
    s = smooth(plane, radius);
    if (s == OK) s = smooth(&weight, radius);
    for (size_t i = 0; i < img_value_count(plane) && s == OK; i++)
        plane->data[i] /= fmaxf(weight.data[i], 1);
    img_free(&weight);
    return s;
}

/* Returns the log of n·l / d² of the maps under a flash at the lens. */
static float log_shading(const surface *maps, const camera *view, int x, int y)
{
    const float least = 0.02f, nearest = 0.05f;
    vec3 point = camera_point(view, (float)x + 0.5f, (float)y + 0.5f, *img_at(&maps->depth, x, y));
    float square = fmaxf(vec3_dot(point, point), nearest);
    float facing = -vec3_dot(vec3_of(img_at(&maps->normal, x, y)), point) / sqrtf(square);
    return logf(fmaxf(fmaxf(facing, 0) / square, least));
}

/* Finds the 95th percentile of the object's luminance; *count: number of its pixels. */
static status bright_luminance(const planes *p, float *out, size_t *count)
{
    float *values = malloc(img_value_count(&p->inside) * sizeof *values);
    *count = 0;
    if (!values) return fail(MERLIN_NO_MEMORY, "no memory to judge the light");
    for (size_t i = 0; i < img_value_count(&p->inside); i++)
        if (p->inside.data[i] > 0) values[(*count)++] = p->light.data[i];
    *out = quantile(values, *count, 0.95f);
    free(values);
    return OK;
}

static bool is_burnt(const float color[3], float white)
{
    float most = fmaxf(fmaxf(color[0], color[1]), color[2]) / white;
    return most >= BURNT && most <= BEYOND_WHITE;
}

static status fill_planes(const surface *maps, const img *photo, const light_frame *frame, planes *p, light_cues *out)
{
    const camera view = surface_camera(maps);
    for (size_t i = 0; i < img_value_count(&p->inside); i++) {
        const float *color = photo->data + 3 * i;
        p->inside.data[i] = maps->mask.data[i] >= 0.5f;
        p->seen.data[i] = p->inside.data[i] > 0 && !is_burnt(color, frame->white);
        p->light.data[i] = color_luminance(color);
    }
    float bright = 0;
    size_t count, black = 0;
    status s = bright_luminance(p, &bright, &count);
    if (s != OK) return s;
    p->radius = sqrtf((float)count / 3.14159265f);
    for (size_t i = 0; i < img_value_count(&p->inside); i++) {
        black += p->inside.data[i] > 0 && p->light.data[i] < FLOOR * bright;
        p->light.data[i] = logf(fmaxf(p->light.data[i], 0) + FLOOR * bright + 1e-12f);
        p->shading.data[i] = log_shading(maps, &view, (int)i % p->width, (int)i / p->width);
    }
    out->black = count ? (float)black / (float)count : 0;
    measure_away(frame, p);
    return img_copy(&p->away_smooth, &p->away);
}

static status make_planes(const surface *maps, const img *photo, const light_frame *frame, planes *p, light_cues *out)
{
    status s = planes_new(maps->mask.width, maps->mask.height, p);
    if (s == OK) s = fill_planes(maps, photo, frame, p, out);
    int radius = (int)lroundf((float)p->width / 128), wide = (int)lroundf(0.04f * p->radius);
    if (s == OK) s = smooth_seen(&p->light, &p->seen, radius > 1 ? radius : 1);
    if (s == OK) s = smooth_seen(&p->shading, &p->seen, radius > 1 ? radius : 1);
    for (size_t i = 0; s == OK && i < img_value_count(&p->away_smooth); i++)
        p->away_smooth.data[i] = fminf(p->away_smooth.data[i], (float)p->width);
    return s == OK ? smooth(&p->away_smooth, wide > 1 ? wide : 1) : s;
}

/* ---- slopes ---- */

typedef struct slope {
    float x, y; /* components to the right and down */
} slope;

static slope slope_at(const img *plane, int x, int y)
{
    return (slope){(*img_at(plane, x + 1, y) - *img_at(plane, x - 1, y)) / 2,
                   (*img_at(plane, x, y + 1) - *img_at(plane, x, y - 1)) / 2};
}

/* Returns the unit direction away from the object's middle; 0 on ridges, which are equally far from two sides. */
static slope outward_at(const planes *p, int x, int y)
{
    const float steep = 0.5f;
    slope way = slope_at(&p->away_smooth, x, y);
    float length = hypotf(way.x, way.y);
    /* difference of two windows' sums, whose slope is larger by the number of pixels of a window */
    int wide = (int)lroundf(0.04f * p->radius), side = 2 * (wide > 1 ? wide : 1) + 1;
    if (length < steep * powf((float)side, 4)) return (slope){0, 0};
    return (slope){-way.x / length, -way.y / length};
}

/* Tells whether slopes at a pixel involve the object only. */
static bool is_well_inside(const planes *p, int x, int y)
{
    enum { REACH = 3 };
    if (x < REACH || y < REACH || x >= p->width - REACH || y >= p->height - REACH) return false;
    return *img_at(&p->seen, x, y) > 0 && *img_at(&p->seen, x - REACH, y) > 0 && *img_at(&p->seen, x + REACH, y) > 0 &&
           *img_at(&p->seen, x, y - REACH) > 0 && *img_at(&p->seen, x, y + REACH) > 0;
}

/* Lists of values at the object's pixels, each with room for all of them. */
typedef struct lists {
    float *light_x, *light_y, *rest_x, *rest_y, *steepness, *fall;
    size_t all, band;
} lists;

static void collect_slopes(const planes *p, lists *l)
{
    const float nearest = 2.5f, reach = fmaxf(8, 0.3f * p->radius);
    for (int y = 0; y < p->height; y++)
        for (int x = 0; x < p->width; x++) {
            if (!is_well_inside(p, x, y)) continue;
            slope light = slope_at(&p->light, x, y), shading = slope_at(&p->shading, x, y);
            l->light_x[l->all] = light.x;
            l->light_y[l->all] = light.y;
            l->rest_x[l->all] = light.x - shading.x;
            l->rest_y[l->all] = light.y - shading.y;
            l->steepness[l->all++] = hypotf(light.x, light.y);
            float away = *img_at(&p->away, x, y);
            slope way = outward_at(p, x, y);
            if (away > nearest && away < reach && (way.x != 0 || way.y != 0))
                l->fall[l->band++] = light.x * way.x + light.y * way.y;
        }
}

/* Returns the mean slope without the steepest fifth, which are borders of colours. */
static float mean_tilt(const lists *l)
{
    float *sorted = l->steepness + l->all, limit;
    memcpy(sorted, l->steepness, l->all * sizeof *sorted);
    limit = quantile(sorted, l->all, 0.8f);
    double x = 0, y = 0, count = 0;
    for (size_t i = 0; i < l->all; i++) {
        if (l->steepness[i] > limit) continue;
        x += (double)l->light_x[i];
        y += (double)l->light_y[i];
        count++;
    }
    return count > 0 ? (float)(hypot(x, y) / count) : 0;
}

static status measure_slopes(const planes *p, light_cues *out)
{
    size_t room = img_value_count(&p->inside);
    float *data = malloc(7 * room * sizeof *data);
    if (!data) return fail(MERLIN_NO_MEMORY, "no memory to judge the light");
    lists l = {data, data + room, data + 2 * room, data + 3 * room, data + 4 * room, data + 6 * room, 0, 0};
    collect_slopes(p, &l);
    out->known = l.band >= FEWEST && l.all >= FEWEST;
    out->tilt = mean_tilt(&l) * p->radius;
    out->fall = quantile(l.fall, l.band, 0.5f) * p->radius;
    out->rest = hypotf(quantile(l.rest_x, l.all, 0.5f), quantile(l.rest_y, l.all, 0.5f)) * p->radius;
    free(data);
    return OK;
}

/* ---- shape ---- */

static status measure_shape(const surface *maps, const planes *p, light_cues *out)
{
    size_t room = img_value_count(&p->inside), rim = 0, core = 0, inward = 0;
    double outward = 0;
    float *depths = malloc(2 * room * sizeof *depths);
    if (!depths) return fail(MERLIN_NO_MEMORY, "no memory to judge the shape");
    float *core_depths = depths + room;
    float deepest = 0, reach = fmaxf(5, 0.12f * p->radius);
    for (size_t i = 0; i < room; i++)
        if (p->inside.data[i] > 0 && p->away.data[i] > deepest) deepest = p->away.data[i];
    for (int y = 1; y < p->height - 1; y++)
        for (int x = 1; x < p->width - 1; x++) {
            if (!(*img_at(&p->inside, x, y) > 0)) continue;
            float away = *img_at(&p->away, x, y);
            if (away > 0.5f * deepest) core_depths[core++] = *img_at(&maps->depth, x, y);
            slope way = outward_at(p, x, y);
            if (!(away > 2 && away < reach) || (way.x == 0 && way.y == 0)) continue;
            const float *n = img_at(&maps->normal, x, y);
            float turned = n[0] * way.x - n[1] * way.y;
            outward += (double)turned;
            inward += turned < 0;
            depths[rim++] = *img_at(&maps->depth, x, y);
        }
    out->known = out->known && rim >= FEWEST && core > 0;
    out->outward = rim ? (float)(outward / (double)rim) : 0;
    out->inward = rim ? (float)inward / (float)rim : 0;
    const camera view = surface_camera(maps);
    float middle = quantile(core_depths, core, 0.5f), size = p->radius * camera_pixel_size(&view) * middle;
    out->rise = rim && size > 0 ? (quantile(depths, rim, 0.5f) - middle) / size : 0;
    free(depths);
    return OK;
}

status light_cues_find(const surface *maps, const img *photo, const light_frame *frame, light_cues *out)
{
    *out = (light_cues){0};
    planes p;
    status s = make_planes(maps, photo, frame, &p, out);
    if (s == OK) s = measure_slopes(&p, out);
    if (s == OK) s = measure_shape(maps, &p, out);
    planes_free(&p);
    return s;
}

/* ---- the result ---- */

/* Coefficients of a logistic regression; see docs/notes/doubts.md. */
static const struct {
    float fall, tilt, rest, black, outward, inward, rise, constant;
} WEIGHTS = {1.076f, 1.528f, 1.814f, 32.421f, 3.966f, 8.634f, -4.942f, -3.329f};

float light_cues_elsewhere(const light_cues *cues)
{
    if (!cues->known) return 0;
    float sum = WEIGHTS.constant + WEIGHTS.fall * cues->fall + WEIGHTS.tilt * cues->tilt + WEIGHTS.rest * cues->rest +
                WEIGHTS.black * cues->black + WEIGHTS.outward * cues->outward + WEIGHTS.inward * cues->inward +
                WEIGHTS.rise * cues->rise;
    return 1 / (1 + expf(-sum));
}
