/* SPDX-License-Identifier: MIT */
#include "lab/train/samples/nfps_sample.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/number.h"
#include "nfps/nfps_inputs.h"
#include "optics/light.h"

/* Shares of presentations: a part of the object at full resolution; lights that are estimates. */
static const float PART = 0.5f, ESTIMATED = 0.3f;
/* Standard deviations of a known light's errors: of its position, and of the logarithm of its strength. */
static const float KNOWN_PLACE = 0.005f, KNOWN_STRENGTH = 0.02f;
/* The same of an estimated light: of its direction (radians) and of the logarithms of distance and strength. */
static const float ESTIMATED_DIRECTION = 0.15f, ESTIMATED_DISTANCE = 0.2f, ESTIMATED_STRENGTH = 0.15f;
/* Largest errors of the normals of the scale before, as sums to unit vectors: over a quarter of the frame, and over a
 * sixteenth; of the logarithm of depth there, and its slope over the frame. */
static const float WIDE_ERROR = 0.5f, NARROW_ERROR = 0.25f, DEPTH_ERROR = 0.03f, DEPTH_SLOPE = 0.1f;
enum { WIDE_CELLS = 4, NARROW_CELLS = 16 };

/* A window of a sample at some resolution. Arrays are by pixel. */
typedef struct window {
    int size, factor, left, top; /* pixels of the sample a pixel, and where the window begins there */
    size_t pixels;
    float *mask, *normal, *depth, *images, *point, *view, *known, *work; /* known: normals of the scale before */
    float *memory;
} window;

static size_t column_of(const window *w, size_t pixel)
{
    return pixel % (size_t)w->size;
}

static size_t row_of(const window *w, size_t pixel)
{
    return pixel / (size_t)w->size;
}

static status window_new(int size, int pictures, window *w)
{
    const size_t n = (size_t)size * (size_t)size, k = (size_t)pictures;
    *w = (window){.size = size, .pixels = n, .memory = calloc(n * (1 + 3 + 1 + 3 + 3 + 3 + 4 * k), sizeof(float))};
    if (!w->memory) return fail(MERLIN_NO_MEMORY, "out of memory for a batch");
    w->mask = w->memory;
    w->depth = w->mask + n;
    w->normal = w->depth + n;
    w->known = w->normal + 3 * n;
    w->point = w->known + 3 * n;
    w->view = w->point + 3 * n;
    w->images = w->view + 3 * n;
    w->work = w->images + 3 * k * n;
    return OK;
}

/* Chooses `pictures` of the view's targets. */
static void choose(const train_view *v, rng *r, int pictures, int *chosen)
{
    int order[TRAIN_LAMPS] = {0};
    for (int i = 0; i < v->lamp_count; i++)
        order[i] = i;
    for (int k = 0; k < pictures; k++) {
        const int other = k + rng_below(r, v->lamp_count - k), one = order[other];
        order[other] = order[k];
        chosen[k] = one;
    }
}

/* Averages the view's pixels under one of the window's. Normals and depth are those of the covered ones. */
static void average(const train_view *v, const int *chosen, int pictures, int x, int y, window *w)
{
    const size_t to = (size_t)y * (size_t)w->size + (size_t)x, side = (size_t)v->size;
    const float share = 1 / (float)(w->factor * w->factor);
    float depth = 0, cover = 0;
    vec3 normal = {0};
    for (int dy = 0; dy < w->factor; dy++)
        for (int dx = 0; dx < w->factor; dx++) {
            const size_t from = (size_t)(w->top + y * w->factor + dy) * side + (size_t)(w->left + x * w->factor + dx);
            const float mask = v->mask[from];
            if (!(mask > 0)) continue;
            cover += mask;
            depth += mask * v->depth[from];
            normal = vec3_fma(normal, mask, vec3_of(v->normal + 3 * from));
            for (int k = 0; k < pictures; k++) {
                const float *light = v->lamps + TRAIN_LAMP_VALUES * ((size_t)chosen[k] * side * side + from);
                float *sum = w->images + 3 * ((size_t)k * w->pixels + to);
                for (int c = 0; c < 3; c++)
                    sum[c] += share * light[c];
            }
        }
    w->mask[to] = cover * share;
    w->depth[to] = cover > 0 ? depth / cover : 0;
    vec3_put(vec3_normalize(normal), w->normal + 3 * to);
}

static void cut(const train_view *v, const int *chosen, int pictures, window *w)
{
    for (int y = 0; y < w->size; y++)
        for (int x = 0; x < w->size; x++)
            average(v, chosen, pictures, x, y, w);
}

/* ---- what is known before ---- */

/* Smooth noise: normal numbers on the corners of so many cells a side, linear between. */
typedef struct noise {
    int cells;
    float value[(NARROW_CELLS + 1) * (NARROW_CELLS + 1)];
} noise;

static noise noise_draw(rng *r, int cells, float deviation)
{
    noise n = {.cells = cells};
    for (int i = 0; i < (cells + 1) * (cells + 1); i++)
        n.value[i] = deviation * rng_normal(r);
    return n;
}

/* x, y: in [0, 1]. */
static float noise_at(const noise *n, float x, float y)
{
    const float u = x * (float)n->cells, v = y * (float)n->cells;
    const int i = (int)u < n->cells ? (int)u : n->cells - 1, j = (int)v < n->cells ? (int)v : n->cells - 1;
    const float *at = n->value + j * (n->cells + 1) + i, a = u - (float)i, b = v - (float)j;
    const float upper = at[0] + a * (at[1] - at[0]),
                lower = at[n->cells + 1] + a * (at[n->cells + 2] - at[n->cells + 1]);
    return upper + b * (lower - upper);
}

/* Blurs the true normals over (2 radius + 1)² covered pixels. */
static void blur(const window *w, int radius)
{
    for (int y = 0; y < w->size; y++)
        for (int x = 0; x < w->size; x++) {
            vec3 sum = {0};
            for (int dy = -radius; dy <= radius; dy++)
                for (int dx = -radius; dx <= radius; dx++) {
                    const int u = x + dx, v = y + dy;
                    if (u < 0 || v < 0 || u >= w->size || v >= w->size) continue;
                    const size_t i = (size_t)v * (size_t)w->size + (size_t)u;
                    sum = vec3_fma(sum, w->mask[i], vec3_of(w->normal + 3 * i));
                }
            vec3_put(vec3_normalize(sum), w->known + 3 * ((size_t)y * (size_t)w->size + (size_t)x));
        }
}

/* Makes normals as a coarser scale finds them: blurred, and wrong by as much as its share of all presentations. */
static void spoil_normals(const window *w, rng *r)
{
    const int radius = 1 + rng_below(r, 3);
    const float u = rng_uniform(r), wide = WIDE_ERROR * u * u, narrow = NARROW_ERROR * rng_uniform(r) * u;
    noise n[4];
    for (int i = 0; i < 4; i++)
        n[i] = i < 2 ? noise_draw(r, WIDE_CELLS, wide) : noise_draw(r, NARROW_CELLS, narrow);
    blur(w, radius);
    for (size_t i = 0; i < w->pixels; i++) {
        if (!(w->mask[i] > 0.5f)) continue;
        const float x = (float)column_of(w, i) / (float)w->size, y = (float)row_of(w, i) / (float)w->size;
        vec3 normal = vec3_of(w->known + 3 * i), view = vec3_of(w->view + 3 * i);
        normal.x += noise_at(&n[0], x, y) + noise_at(&n[2], x, y);
        normal.y += noise_at(&n[1], x, y) + noise_at(&n[3], x, y);
        const float facing = vec3_dot(normal, view);
        if (facing < 0.05f) normal = vec3_fma(normal, 0.05f - facing, view);
        vec3_put(vec3_normalize(normal), w->known + 3 * i);
    }
}

static float mean_log_depth(const window *w)
{
    double sum = 0, count = 0;
    for (size_t i = 0; i < w->pixels; i++)
        if (w->mask[i] > 0.5f) {
            sum += (double)logf(w->depth[i]);
            count++;
        }
    return count > 0 ? (float)(sum / count) : 0;
}

/* Replaces depth by one as integrated normals have it: of the same mean, with less or more relief, tilted and bent. */
static void spoil_depth(const window *w, rng *r)
{
    const float mean = mean_log_depth(w), u = rng_uniform(r), relief = 1 + u * rng_range(r, -0.5f, 0.25f);
    const float right = DEPTH_SLOPE * u * rng_normal(r), down = DEPTH_SLOPE * u * rng_normal(r);
    const noise n = noise_draw(r, WIDE_CELLS, DEPTH_ERROR * u);
    for (size_t i = 0; i < w->pixels; i++) {
        if (!(w->mask[i] > 0.5f)) continue;
        const float x = (float)column_of(w, i) / (float)w->size, y = (float)row_of(w, i) / (float)w->size;
        const float bend = right * (x - 0.5f) + down * (y - 0.5f) + noise_at(&n, x, y);
        w->depth[i] = expf(mean + relief * (logf(w->depth[i]) - mean) + bend);
    }
}

static void flatten_depth(const window *w)
{
    const float mean = expf(mean_log_depth(w));
    for (size_t i = 0; i < w->pixels; i++)
        w->depth[i] = mean;
}

/* ---- lights and cameras ---- */

static nfps_light light_known(const train_lamp *of, rng *r)
{
    const vec3 error = vec3_make(rng_normal(r), rng_normal(r), rng_normal(r));
    return (nfps_light){vec3_fma(of->at, KNOWN_PLACE, error), of->distant, of->axis, of->lobe};
}

static nfps_light light_estimated(const train_lamp *of, rng *r)
{
    const vec3 error = vec3_make(rng_normal(r), rng_normal(r), rng_normal(r));
    const float factor = expf(ESTIMATED_DISTANCE * rng_normal(r));
    const vec3 way = of->distant ? of->at : vec3_sub(of->at, object_middle);
    const float far = vec3_length(way);
    const vec3 toward = vec3_normalize(vec3_fma(vec3_scale(way, 1 / far), ESTIMATED_DIRECTION, error));
    if (of->distant) return (nfps_light){.at = toward, .distant = true};
    return (nfps_light){.at = vec3_fma(object_middle, far * factor, toward)};
}

/* Exposes a picture: a light's strength, a sensor that saturates at `white`, and its noise. */
static void expose(const window *w, float *image, float gain, float white, float read, rng *r)
{
    for (size_t i = 0; i < 3 * w->pixels; i++)
        if (w->mask[i / 3] > 0.5f) image[i] = clamp(gain * image[i] + read * white * rng_normal(r), 0.0f, white);
}

/* Returns the mean of all pictures' light over the object. */
static float mean_light(const window *w, int pictures)
{
    double sum = 0, count = 0;
    for (size_t i = 0; i < 3 * (size_t)pictures * w->pixels; i++)
        if (w->mask[i / 3 % w->pixels] > 0.5f) {
            sum += (double)w->images[i];
            count++;
        }
    return count > 0 ? (float)(sum / count) : 1;
}

/* ---- a stage ---- */

/* Computes each pixel's view, then its point, for which depth must be final. */
static void place_views(const train_view *v, const window *w, bool points)
{
    for (size_t i = 0; i < w->pixels; i++) {
        const float x = (float)column_of(w, i) + 0.5f, y = (float)row_of(w, i) + 0.5f;
        const vec3 ray =
            camera_point(&v->lens, (float)w->left + x * (float)w->factor, (float)w->top + y * (float)w->factor, 1);
        if (points)
            vec3_put(vec3_scale(ray, w->depth[i]), w->point + 3 * i);
        else
            vec3_put(vec3_scale(vec3_normalize(ray), -1), w->view + 3 * i);
    }
}

/* Choices that both stages share. */
typedef struct capture {
    int pictures, chosen[TRAIN_LAMPS];
    nfps_light light[TRAIN_LAMPS];
    float gain[TRAIN_LAMPS], white, read;
    bool estimated;
} capture;

static capture capture_draw(const train_view *v, int pictures, rng *r)
{
    capture c = {.pictures = pictures, .estimated = rng_uniform(r) < ESTIMATED};
    choose(v, r, pictures, c.chosen);
    for (int k = 0; k < pictures; k++) {
        const train_lamp *of = &v->lamp[c.chosen[k]];
        c.light[k] = c.estimated ? light_estimated(of, r) : light_known(of, r);
        c.gain[k] = expf((c.estimated ? ESTIMATED_STRENGTH : KNOWN_STRENGTH) * rng_normal(r));
    }
    c.white = expf(rng_range(r, logf(3), logf(30)));
    c.read = 0.004f * rng_uniform(r);
    return c;
}

/* Stores a stage's inputs; its window is cut. */
static void store(const train_view *v, const capture *c, rng *r, const window *w, const nfps_stage_place *place)
{
    place_views(v, w, false);
    if (place->normal) {
        spoil_normals(w, r);
        spoil_depth(w, r);
    } else {
        flatten_depth(w);
    }
    place_views(v, w, true);
    const float white = c->white * mean_light(w, c->pictures);
    for (int k = 0; k < c->pictures; k++)
        expose(w, w->images + 3 * (size_t)k * w->pixels, c->gain[k], white, c->read, r);
    const nfps_scene scene = {w->pixels, c->pictures, w->mask, w->point, w->view, c->light, c->estimated};
    nfps_encode(&scene, w->images, w->work, &place->in);
    nfps_turn_all(&scene, w->normal, place->normal_true);
    if (place->normal) nfps_turn_all(&scene, w->known, place->normal);
    for (size_t i = 0; i < w->pixels; i++) {
        place->mask[i] = w->mask[i] > 0.5f ? 1 : 0;
        place->loss_mask[i] = w->mask[i] >= 0.999f ? 1 : 0;
    }
}

/* Places the window of the finer stage: the whole, or a part around a pixel of the object. */
static void place_window(const train_view *v, rng *r, window *w)
{
    const bool part = rng_uniform(r) < PART;
    w->factor = part ? 1 : v->size / w->size;
    if (!part) return;
    const int most = v->size - w->size;
    for (int i = 0; i < 16; i++) {
        w->left = rng_below(r, most + 1);
        w->top = rng_below(r, most + 1);
        if (v->mask[(size_t)(w->top + w->size / 2) * (size_t)v->size + (size_t)(w->left + w->size / 2)] > 0.5f) return;
    }
    w->left = w->top = most / 2;
}

static status fill_stage(const train_view *v, const capture *c, rng *r, int size, const nfps_stage_place *place)
{
    window w;
    status s = window_new(size, c->pictures, &w);
    if (s != OK) return s;
    w.factor = v->size / size;
    if (place->normal) place_window(v, r, &w);
    cut(v, c->chosen, c->pictures, &w);
    store(v, c, r, &w, place);
    free(w.memory);
    return OK;
}

status nfps_sample_fill(const train_view *v, rng *r, const nfps_place *place)
{
    if (v->lamp_count < place->pictures)
        return fail(MERLIN_BAD_INPUT,
                    "a sample has %d targets, and %d pictures were asked for: render with more "
                    "--targets or --leds",
                    v->lamp_count, place->pictures);
    const capture c = capture_draw(v, place->pictures, r);
    status s = fill_stage(v, &c, r, place->size / 2, &place->first);
    return s == OK ? fill_stage(v, &c, r, place->size, &place->refining) : s;
}
