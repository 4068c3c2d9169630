/* SPDX-License-Identifier: MIT */
#include "estimate/light/horizon.h"

#include <stdbool.h>
#include <stdlib.h>

#include "base/number.h"
#include "base/parallel.h"
#include "optics/camera.h"

/* Largest number of points per side, as light from all around varies slowly; bits per word; azimuths per quarter. */
enum { MOST_SIDE = 256, BITS = 32, QUARTER = HORIZON_AZIMUTHS / 4 };
/* Distance behind the map in pixels from which on a point is hidden; step of a march as a share of the distance, at
 * least one pixel; and uncertainty of an angle. They were tuned like those of shadow.c (docs/notes/environments.md). */
static const float MARGIN = 1, STRIDE = 0.06f, BORDER = 0.06f;
/* Depth where there is no surface. */
static const float NOTHING = 1e4f;

/* ---- directions about a line of sight ---- */

typedef struct frame {
    vec3 view, right, up;
} frame;

static frame frame_of(vec3 ray)
{
    vec3 view = vec3_scale(ray, -1);
    /* lines of sight are within 75 degrees of the axis, so that none is parallel to x */
    vec3 right = vec3_normalize(vec3_fma(vec3_make(1, 0, 0), -view.x, view));
    return (frame){view, right, vec3_cross(view, right)};
}

/* Returns the direction of a half plane. They are numbered around a square instead of a circle, so that no angle is
 * needed to find one. */
static vec3 across_of(const frame *f, int azimuth)
{
    static const float sign_x[] = {1, -1, -1, 1}, sign_y[] = {1, 1, -1, -1};
    int quarter = azimuth / QUARTER;
    float t = (float)(azimuth % QUARTER) / QUARTER, x = quarter % 2 ? t : 1 - t;
    return vec3_fma(vec3_scale(f->right, sign_x[quarter] * x), sign_y[quarter] * (1 - x), f->up);
}

static float azimuth_of(float x, float y)
{
    float sum = fabsf(x) + fabsf(y), t = sum > 0 ? y / sum : 0;
    float turn = x < 0 ? 2 - t : t < 0 ? 4 + t : t;
    return turn * QUARTER;
}

/* ---- making ---- */

typedef struct making {
    const shadow_occluder *occluder;
    camera eye;
    img depth; /* depth, NOTHING outside the surface */
    horizon *out;
} making;

/* Points of one row that are marched from, each along one line through the picture. */
typedef struct marches {
    int count, column[MOST_SIDE];
    float px[MOST_SIDE], py[MOST_SIDE], pz[MOST_SIDE], vx[MOST_SIDE], vy[MOST_SIDE], vz[MOST_SIDE];
    float x[MOST_SIDE], y[MOST_SIDE], dx[MOST_SIDE], dy[MOST_SIDE]; /* pixel centres at whole coordinates */
    float most[MOST_SIDE];
    uint32_t closed[MOST_SIDE];
} marches;

/* Sets the line of a march: a straight line in space along `across` is a straight line in the picture. */
static void aim(marches *m, int i, vec3 across)
{
    float dx = across.z * m->px[i] - across.x * m->pz[i], dy = across.y * m->pz[i] - across.z * m->py[i];
    float unit = 1 / sqrtf(dx * dx + dy * dy + 1e-30f);
    m->dx[i] = unit * dx;
    m->dy[i] = unit * dy;
    m->most[i] = -1;
    m->closed[i] = 0;
}

/* Returns the bits whose centres lie between two cosines. A shift by 32 would be undefined and is done in two. */
static inline uint32_t bits_between(float low, float high)
{
    int first = (int)(0.5f * BITS * (low + 1) + 0.5f), end = (int)(0.5f * BITS * (high + 1) + 0.5f);
    uint32_t all = ~(uint32_t)0, from = all << (first >> 1) << (first - (first >> 1));
    uint32_t to = all << (end >> 1) << (end - (end >> 1));
    return from & ~to;
}

static inline float cosine_to(vec3 to, vec3 view)
{
    float cosine = vec3_dot(to, view) / sqrtf(vec3_dot(to, to) + 1e-20f);
    cosine = cosine > -1 ? cosine : -1;
    return cosine < 1 ? cosine : 1;
}

/* Marks what is hidden by the surface this many pixels further. */
static void meet(const making *m, float way, marches *r)
{
    const float *depth = m->depth.data;
    const int width = m->depth.width, height = m->depth.height;
    const float size = camera_pixel_size(&m->eye), middle_x = 0.5f * (float)(width - 1);
    const float middle_y = 0.5f * (float)(height - 1);
#pragma omp simd
    for (int i = 0; i < r->count; i++) {
        float x = rintf(r->x[i] + way * r->dx[i]), y = rintf(r->y[i] + way * r->dy[i]);
        bool inside = x >= 0 && y >= 0 && x < (float)width && y < (float)height;
        float d = depth[inside ? (int)y * width + (int)x : 0];
        float front = d * (1 + MARGIN * size), back = front + SHADOW_THICKNESS;
        vec3 ray = {(x - middle_x) * size, (middle_y - y) * size, -1};
        vec3 p = {r->px[i], r->py[i], r->pz[i]}, view = {r->vx[i], r->vy[i], r->vz[i]};
        float high = cosine_to(vec3_sub(vec3_scale(ray, front), p), view);
        float low = cosine_to(vec3_sub(vec3_scale(ray, back), p), view);
        bool met = inside && d < NOTHING;
        r->most[i] = met && high > r->most[i] ? high : r->most[i];
        r->closed[i] |= met ? bits_between(low < high ? low : high, high) : 0;
    }
}

/* Tells whether a point is on or next to the surface: larger pictures interpolate between such points. */
static bool near_surface(const making *m, float x, float y, float step)
{
    for (int k = 0; k < 9; k++) {
        int column = k % 3 - 1, line = k / 3 - 1;
        int at_x = (int)floorf(x + step * (float)column + 0.5f), at_y = (int)floorf(y + step * (float)line + 0.5f);
        if (at_x < 0 || at_y < 0 || at_x >= m->depth.width || at_y >= m->depth.height) continue;
        if (*img_at(&m->depth, at_x, at_y) < NOTHING) return true;
    }
    return false;
}

static float depth_at(const img *depth, float x, float y)
{
    int left = (int)x, top = (int)y;
    int right = left + 1 < depth->width ? 1 : 0, down = top + 1 < depth->height ? depth->width : 0;
    const float *d = img_at(depth, left, top);
    float u = x - (float)left, v = y - (float)top;
    return (1 - v) * ((1 - u) * d[0] + u * d[right]) + v * ((1 - u) * d[down] + u * d[down + right]);
}

static void begin_row(const making *m, int row, marches *r)
{
    int width = m->out->cosine.width;
    float step = (float)m->depth.width / (float)width, y = ((float)row + 0.5f) * step - 0.5f;
    r->count = 0;
    for (int i = 0; i < width; i++) {
        float x = ((float)i + 0.5f) * step - 0.5f;
        if (!near_surface(m, x, y, step)) continue;
        vec3 p = camera_point(&m->eye, x + 0.5f, y + 0.5f, depth_at(&m->occluder->depth, x, y));
        vec3 view = vec3_scale(vec3_normalize(p), -1);
        int at = r->count++;
        r->column[at] = i;
        r->x[at] = x;
        r->y[at] = y;
        r->px[at] = p.x;
        r->py[at] = p.y;
        r->pz[at] = p.z;
        r->vx[at] = view.x;
        r->vy[at] = view.y;
        r->vz[at] = view.z;
    }
}

static void make_row(void *context, size_t row)
{
    const making *m = context;
    const img *cosine = &m->out->cosine;
    marches r;
    begin_row(m, (int)row, &r);
    float farthest = (float)(m->depth.width + m->depth.height);
    for (int k = 0; k < HORIZON_AZIMUTHS && r.count > 0; k++) {
        for (int i = 0; i < r.count; i++) {
            frame f = frame_of(vec3_make(-r.vx[i], -r.vy[i], -r.vz[i]));
            aim(&r, i, across_of(&f, k));
        }
        float way = 1;
        while (way < farthest) {
            meet(m, way, &r);
            way += fmaxf(1, STRIDE * way);
        }
        for (int i = 0; i < r.count; i++) {
            size_t at = (row * (size_t)cosine->width + (size_t)r.column[i]) * HORIZON_AZIMUTHS + (size_t)k;
            cosine->data[at] = r.most[i];
            m->out->closed[at] = r.closed[i] | bits_between(r.most[i], 1);
        }
    }
}

/* Copies the occluder's depth, with NOTHING outside the surface. */
static status cut_out(const shadow_occluder *c, img *out)
{
    status s = img_copy(out, &c->depth);
    size_t count = s == OK ? (size_t)out->width * (size_t)out->height : 0;
    for (size_t i = 0; i < count; i++)
        if (c->mask.data[i] < 0.5f) out->data[i] = NOTHING;
    return s;
}

status horizon_new(const shadow_occluder *occluder, horizon *out)
{
    int side = occluder->depth.width < MOST_SIDE ? occluder->depth.width : MOST_SIDE;
    making m = {occluder, camera_through(occluder->lens, occluder->depth.width, occluder->depth.height), {0}, out};
    *out = (horizon){.lens = occluder->lens};
    status s = img_new(&out->cosine, side, side, HORIZON_AZIMUTHS);
    size_t count = (size_t)side * (size_t)side * HORIZON_AZIMUTHS;
    for (size_t i = 0; s == OK && i < count; i++)
        out->cosine.data[i] = -1;
    if (s == OK && count > 0) out->closed = calloc(count, sizeof *out->closed);
    if (s == OK && !out->closed) s = fail(MERLIN_NO_MEMORY, "no memory for horizons of %d x %d points", side, side);
    if (s == OK) s = cut_out(occluder, &m.depth);
    if (s == OK) parallel_for((size_t)side, make_row, &m);
    img_free(&m.depth);
    if (s != OK) horizon_free(out);
    return s;
}

void horizon_free(horizon *h)
{
    img_free(&h->cosine);
    free(h->closed);
    h->closed = NULL;
}

/* ---- use ---- */

void horizon_at(const horizon *h, float x, float y, horizon_view *out)
{
    int width = h->cosine.width, height = h->cosine.height;
    const camera eye = camera_through(h->lens, width, height);
    frame f = frame_of(camera_ray(&eye, x * (float)width, y * (float)height));
    out->view = f.view;
    out->right = f.right;
    out->up = f.up;
    float u = fminf(fmaxf(x * (float)width - 0.5f, 0), (float)(width - 1));
    float v = fminf(fmaxf(y * (float)height - 0.5f, 0), (float)(height - 1));
    int left = (int)u, top = (int)v;
    u -= (float)left;
    v -= (float)top;
    const float *cosine[4];
    for (int k = 0; k < 4; k++) {
        int column = left + k % 2 < width ? left + k % 2 : left, row = top + k / 2 < height ? top + k / 2 : top;
        size_t at = ((size_t)row * (size_t)width + (size_t)column) * HORIZON_AZIMUTHS;
        cosine[k] = h->cosine.data + at;
        out->closed[k] = h->closed + at;
        out->weight[k] = (k % 2 ? u : 1 - u) * (k / 2 ? v : 1 - v);
    }
    for (int k = 0; k < HORIZON_AZIMUTHS; k++)
        out->cosine[k] = out->weight[0] * cosine[0][k] + out->weight[1] * cosine[1][k] + out->weight[2] * cosine[2][k] +
                         out->weight[3] * cosine[3][k];
}

/* Returns the openness of the surface beyond its horizon, interpolated between two bits. */
static float open_behind(const horizon_view *at, int azimuth, float cosine)
{
    float place = fminf(fmaxf(0.5f * BITS * (cosine + 1) - 0.5f, 0), BITS - 1.001f), sum = 0;
    int bit = (int)place;
    float between = place - (float)bit;
    for (int k = 0; k < 4; k++) {
        uint32_t open = ~at->closed[k][azimuth];
        if (open && at->weight[k] > 0)
            sum +=
                at->weight[k] * ((1 - between) * (float)(open >> bit & 1) + between * (float)(open >> (bit + 1) & 1));
    }
    return sum;
}

float horizon_sees(const horizon_view *at, vec3 direction, float solid_angle)
{
    float x = vec3_dot(direction, at->right), y = vec3_dot(direction, at->up), z = vec3_dot(direction, at->view);
    float azimuth = azimuth_of(x, y), between = azimuth - floorf(azimuth);
    int below = (int)azimuth % HORIZON_AZIMUTHS, above = (below + 1) % HORIZON_AZIMUTHS;
    float edge = at->cosine[below] + between * (at->cosine[above] - at->cosine[below]);
    /* converts a width in angles to one in cosines */
    float width = sqrtf((BORDER * BORDER + solid_angle) * (x * x + y * y)) + 1e-6f;
    float seen = clamp((z - edge) / width + 0.5f, 0, 1);
    if (seen >= 1) return 1;
    float behind = open_behind(at, below, z) * (1 - between) + open_behind(at, above, z) * between;
    return seen + (1 - seen) * behind;
}
