/* SPDX-License-Identifier: MIT */
#include "lab/train/samples/motion.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "lab/render/sample.h"
#include "optics/camera.h"
#include "optics/sh.h"

/* Computes the rotation about the axis x, y or z. */
static void rotation_about(int axis, float angle, float out[3][3])
{
    int a = (axis + 1) % 3, b = (axis + 2) % 3;
    memset(out, 0, 9 * sizeof(float));
    out[axis][axis] = 1;
    out[a][a] = out[b][b] = cosf(angle);
    out[a][b] = -sinf(angle);
    out[b][a] = sinf(angle);
}

train_motion train_motion_draw(const train_config *c, rng *r)
{
    float reach = (float)c->camera_turn * DEGREE, axis[3][3][3], both[3][3];
    train_motion m = {.turned = c->camera_turn > 0};
    for (int k = 0; k < 3; k++)
        rotation_about(k, reach * rng_range(r, -1, 1), axis[k]);
    for (int i = 0; i < 9; i++)
        both[i / 3][i % 3] = axis[1][i / 3][0] * axis[2][0][i % 3] + axis[1][i / 3][1] * axis[2][1][i % 3] +
                             axis[1][i / 3][2] * axis[2][2][i % 3];
    for (int i = 0; i < 9; i++)
        m.turn[i / 3][i % 3] = axis[0][i / 3][0] * both[0][i % 3] + axis[0][i / 3][1] * both[1][i % 3] +
                               axis[0][i / 3][2] * both[2][i % 3];
    m.distance = expf((float)c->distance_jitter * rng_range(r, -1, 1));
    return m;
}

bool train_motion_moves(const train_motion *m)
{
    return m->turned || m->distance != 1;
}

/* Images that are resampled for a turned camera: maps are weighted by coverage, images contain it. */
enum { MAX_LAYERS = 7 };
typedef struct layer {
    float *data;
    const float *from;
    int channels;
    bool map;
} layer;

typedef struct picture {
    int size, layers;
    layer layer[MAX_LAYERS];
    const float *coverage;
    float *memory;
} picture;

static status copy_picture(const train_view *v, picture *out)
{
    const layer all[MAX_LAYERS] = {
        {v->albedo, NULL, 3, true}, {v->normal, NULL, 3, true},  {v->roughness, NULL, 1, true},
        {v->depth, NULL, 1, true},  {v->direct, NULL, 3, false}, {v->indirect, NULL, 3, false},
        {v->env, NULL, 3, false},
    };
    size_t pixels = (size_t)v->size * (size_t)v->size, floats = pixels;
    *out = (picture){.size = v->size, .layers = v->env ? MAX_LAYERS : MAX_LAYERS - 1};
    for (int i = 0; i < out->layers; i++)
        floats += pixels * (size_t)all[i].channels;
    float *at = out->memory = malloc(floats * sizeof *at);
    if (!at) return fail(MERLIN_NO_MEMORY, "out of memory for turning a picture");
    memcpy(at, v->mask, pixels * sizeof *at);
    out->coverage = at;
    at += pixels;
    for (int i = 0; i < out->layers; i++) {
        size_t count = pixels * (size_t)all[i].channels;
        out->layer[i] = all[i];
        out->layer[i].from = memcpy(at, all[i].data, count * sizeof *at);
        at += count;
    }
    return OK;
}

/* The four pixels around a position, their bilinear weights, and those times coverage. */
typedef struct taps {
    size_t pixel[4];
    float share[4], covered[4], coverage;
} taps;

/* Returns the taps at x and y, in pixels, the first one's middle at 0. Pixels outside the frame have no weight. */
static taps taps_at(const picture *p, float x, float y)
{
    taps t = {.coverage = 0};
    int left = (int)floorf(x), top = (int)floorf(y);
    float fx = x - (float)left, fy = y - (float)top;
    for (int k = 0; k < 4; k++) {
        int i = left + (k & 1), j = top + (k >> 1);
        if (i < 0 || j < 0 || i >= p->size || j >= p->size) continue;
        t.pixel[k] = (size_t)j * (size_t)p->size + (size_t)i;
        t.share[k] = (k & 1 ? fx : 1 - fx) * (k >> 1 ? fy : 1 - fy);
        t.covered[k] = t.share[k] * p->coverage[t.pixel[k]];
        t.coverage += t.covered[k];
    }
    return t;
}

static void resample(const picture *p, const taps *t, size_t to)
{
    for (int l = 0; l < p->layers; l++) {
        const layer *a = &p->layer[l];
        size_t n = (size_t)a->channels;
        for (size_t c = 0; c < n; c++) {
            float sum = 0;
            for (int k = 0; k < 4 && t->coverage > 0; k++)
                sum += (a->map ? t->covered[k] : t->share[k]) * a->from[n * t->pixel[k] + c];
            a->data[n * to + c] = a->map && t->coverage > 0 ? sum / t->coverage : sum;
        }
    }
}

static vec3 turned(const float m[3][3], vec3 v)
{
    return vec3_make(m[0][0] * v.x + m[0][1] * v.y + m[0][2] * v.z, m[1][0] * v.x + m[1][1] * v.y + m[1][2] * v.z,
                     m[2][0] * v.x + m[2][1] * v.y + m[2][2] * v.z);
}

/* Applies the inverse of a rotation. */
static vec3 turned_back(const float m[3][3], vec3 v)
{
    return vec3_make(m[0][0] * v.x + m[1][0] * v.y + m[2][0] * v.z, m[0][1] * v.x + m[1][1] * v.y + m[2][1] * v.z,
                     m[0][2] * v.x + m[1][2] * v.y + m[2][2] * v.z);
}

static void turn_pixel(const train_view *v, const picture *p, const camera *eye, const float turn[3][3], int x, int y)
{
    size_t to = (size_t)y * (size_t)v->size + (size_t)x;
    float column, row;
    vec3 from = turned_back(turn, camera_point(eye, (float)x + 0.5f, (float)y + 0.5f, 1));
    camera_project(eye, from, &column, &row);
    taps t = taps_at(p, column - 0.5f, row - 0.5f);
    resample(p, &t, to);
    v->mask[to] = fminf(t.coverage, 1);
    if (t.coverage <= 0) return;
    v->depth[to] /= -from.z;
    float *normal = v->normal + 3 * to;
    vec3_put(sample_normal(vec3_normalize(turned(turn, vec3_of(normal)))), normal);
}

static bool is_cut_off(const train_view *v)
{
    size_t n = (size_t)v->size;
    float sum = 0;
    for (size_t i = 0; i < n; i++)
        sum += v->mask[i] + v->mask[n * (n - 1) + i] + v->mask[n * i] + v->mask[n * i + n - 1];
    return sum > 0;
}

static status turn_camera(const train_view *v, const float turn[3][3])
{
    picture p;
    status s = copy_picture(v, &p);
    if (s != OK) return s;
    const camera eye = {.width = v->size, .height = v->size, .fov = CAMERA_FOV};
    for (int y = 0; y < v->size; y++)
        for (int x = 0; x < v->size; x++)
            turn_pixel(v, &p, &eye, turn, x, y);
    free(p.memory);
    if (v->sh) {
        float sh[9][3];
        memcpy(sh, v->sh, sizeof sh);
        sh_turn(sh, turn);
        memcpy(v->sh, sh, sizeof sh);
    }
    return OK;
}

status train_move(const train_view *v, const train_motion *m)
{
    size_t pixels = (size_t)v->size * (size_t)v->size;
    float falloff = 1 / (m->distance * m->distance);
    status s = m->turned && !is_cut_off(v) ? turn_camera(v, m->turn) : OK;
    for (size_t i = 0; i < pixels; i++)
        v->depth[i] *= m->distance;
    for (size_t i = 0; i < 3 * pixels; i++) {
        v->direct[i] *= falloff;
        v->indirect[i] *= falloff;
    }
    return s;
}
