/* SPDX-License-Identifier: MIT */
/* Finds the ball's outline: edges with their directions vote for circles by random sampling (Fischler & Bolles 1981),
 * where two edges and their normals define a circle; the circle with edges all around is chosen and refined by least
 * squares. */
#include <stdlib.h>
#include <string.h>

#include "base/real.h"
#include "base/rng.h"
#include "stereo/calibrate/calibrate_parts.h"

enum { MOST_EDGES = 4000, LEAST_EDGES = 24, TRIES = 8000, BINS = 72, REFINEMENTS = 12 };

static const float LEAST_RADIUS = 8;    /* pixels: below, normals are too inaccurate for calibration */
static const float NEAR_CIRCLE = 1.5f;  /* pixels */
static const float ALONG_RADIUS = 0.9f; /* cosine between an edge's normal and the radius */
static const float LEAST_SEEN = 0.3f;   /* share of the outline */
static const float PLAINLY_SEEN = 0.8f; /* the same for a circle that is only the second best */

typedef struct edge {
    float x, y, nx, ny, strength;
} edge;

typedef struct edges {
    edge *at;
    size_t count;
} edges;

static float sample(const img *p, int x, int y)
{
    return *img_at(p, x, y);
}

static void gradient(const img *p, int x, int y, float *gx, float *gy)
{
    *gx = sample(p, x + 1, y - 1) + 2 * sample(p, x + 1, y) + sample(p, x + 1, y + 1) - sample(p, x - 1, y - 1) -
          2 * sample(p, x - 1, y) - sample(p, x - 1, y + 1);
    *gy = sample(p, x - 1, y + 1) + 2 * sample(p, x, y + 1) + sample(p, x + 1, y + 1) - sample(p, x - 1, y - 1) -
          2 * sample(p, x, y - 1) - sample(p, x + 1, y - 1);
}

static int stronger_first(const void *a, const void *b)
{
    float x = ((const edge *)a)->strength, y = ((const edge *)b)->strength;
    return (x < y) - (x > y);
}

/* Tells whether a pixel is an edge: whether strength, the gradient's magnitude, is largest there across the edge. */
static bool is_ridge(const img *strength, int x, int y, float nx, float ny)
{
    int dx = (int)lroundf(nx), dy = (int)lroundf(ny);
    float here = sample(strength, x, y);
    return here > 0 && here >= sample(strength, x + dx, y + dy) && here > sample(strength, x - dx, y - dy);
}

static void collect(const img *picture, const img *strength, size_t most, edges *out)
{
    for (int y = 2; y < picture->height - 2; y++)
        for (int x = 2; x < picture->width - 2; x++) {
            float gx, gy, g = sample(strength, x, y);
            gradient(picture, x, y, &gx, &gy);
            if (!(g > 1e-6f) || !is_ridge(strength, x, y, gx / g, gy / g)) continue;
            out->at[out->count++] = (edge){(float)x + 0.5f, (float)y + 0.5f, gx / g, gy / g, g};
        }
    qsort(out->at, out->count, sizeof *out->at, stronger_first);
    if (out->count > most) out->count = most;
}

static status find_edges(const img *picture, size_t most, edges *out)
{
    img strength;
    status s = img_new(&strength, picture->width, picture->height, 1);
    if (s != OK) return s;
    *out = (edges){malloc((size_t)picture->width * (size_t)picture->height * sizeof *out->at), 0};
    if (!out->at) {
        img_free(&strength);
        return fail(MERLIN_NO_MEMORY, "no memory for edges");
    }
    for (int y = 1; y < picture->height - 1; y++)
        for (int x = 1; x < picture->width - 1; x++) {
            float gx, gy;
            gradient(picture, x, y, &gx, &gy);
            *img_at(&strength, x, y) = hypotf(gx, gy);
        }
    collect(picture, &strength, most, out);
    img_free(&strength);
    return OK;
}

/* Computes the circle around the intersection of two edges' normals, if that is equally far from both. */
static bool circle_through(const edge *a, const edge *b, merlin_circle *out)
{
    float det = a->ny * b->nx - a->nx * b->ny, dx = b->x - a->x, dy = b->y - a->y;
    if (fabsf(det) < 0.2f) return false;
    float t = (dy * b->nx - dx * b->ny) / det;
    *out = (merlin_circle){a->x + t * a->nx, a->y + t * a->ny, fabsf(t)};
    float other = hypotf(out->x - b->x, out->y - b->y);
    if (fabsf(other - out->radius) > 2 + 0.03f * out->radius) return false;
    out->radius = 0.5f * (out->radius + other);
    return true;
}

static bool is_near(const edge *e, const merlin_circle *c, float width, float *distance, float *cosine)
{
    float dx = e->x - c->x, dy = e->y - c->y, d = hypotf(dx, dy);
    *distance = d - c->radius;
    *cosine = d > 0 ? (dx * e->nx + dy * e->ny) / d : 0;
    return fabsf(*distance) < width && fabsf(*cosine) > ALONG_RADIUS;
}

/* Returns the share of the outline where an edge lies on the circle; edges of the less frequent polarity (bright inside
 * or outside) count half. */
static float share_seen(const edges *e, const merlin_circle *c)
{
    unsigned char seen[2][BINS] = {{0}};
    for (size_t i = 0; i < e->count; i++) {
        float distance, cosine;
        if (!is_near(&e->at[i], c, NEAR_CIRCLE, &distance, &cosine)) continue;
        float turn = (atan2f(e->at[i].y - c->y, e->at[i].x - c->x) + PI) / (2 * PI);
        seen[cosine > 0][(int)(turn * BINS) % BINS] = 1;
    }
    int sum[2] = {0};
    for (int i = 0; i < BINS; i++) {
        sum[0] += seen[0][i];
        sum[1] += seen[1][i];
    }
    int more = sum[0] > sum[1] ? sum[0] : sum[1], less = sum[0] + sum[1] - more;
    return ((float)more + 0.5f * (float)less) / BINS;
}

/* Makes a Gauss-Newton step on the distance to the circle; the 3 × 3 system is solved by Cramer's rule. */
static void refine_once(const edges *e, float width, merlin_circle *c)
{
    double m[6] = {0}, v[3] = {0};
    for (size_t i = 0; i < e->count; i++) {
        float distance, cosine;
        if (!is_near(&e->at[i], c, width, &distance, &cosine)) continue;
        double dx = e->at[i].x - c->x, dy = e->at[i].y - c->y, d = hypot(dx, dy), ux = dx / d, uy = dy / d;
        m[0] += ux * ux, m[1] += ux * uy, m[2] += ux, m[3] += uy * uy, m[4] += uy, m[5] += 1;
        v[0] += ux * distance, v[1] += uy * distance, v[2] += distance;
    }
    double a = m[3] * m[5] - m[4] * m[4], b = m[2] * m[4] - m[1] * m[5], k = m[1] * m[4] - m[2] * m[3];
    double det = m[0] * a + m[1] * b + m[2] * k;
    if (fabs(det) < 1e-9) return;
    double p = m[0] * m[5] - m[2] * m[2], q = m[1] * m[2] - m[0] * m[4], r = m[0] * m[3] - m[1] * m[1];
    c->x += (float)((a * v[0] + b * v[1] + k * v[2]) / det);
    c->y += (float)((b * v[0] + p * v[1] + q * v[2]) / det);
    c->radius += (float)((k * v[0] + q * v[1] + r * v[2]) / det);
}

static void refine(const edges *e, merlin_circle *c)
{
    for (int i = 0; i < REFINEMENTS; i++)
        refine_once(e, i < REFINEMENTS / 2 ? 2 * NEAR_CIRCLE : NEAR_CIRCLE, c);
}

static float sample_circles(const edges *e, const img *picture, merlin_circle *best)
{
    float most = 0, largest = (float)(picture->width > picture->height ? picture->width : picture->height);
    rng r = rng_at(1, 0, 0);
    for (int i = 0; i < TRIES; i++) {
        const edge *a = &e->at[rng_below(&r, (int)e->count)], *b = &e->at[rng_below(&r, (int)e->count)];
        merlin_circle c;
        if (!circle_through(a, b, &c) || c.radius < LEAST_RADIUS || c.radius > 0.75f * largest || c.x < 0 || c.y < 0 ||
            c.x > (float)picture->width || c.y > (float)picture->height)
            continue;
        float seen = share_seen(e, &c);
        if (seen <= most) continue;
        most = seen;
        *best = c;
    }
    return most;
}

/* Removes the edges of another ball and its surroundings. */
static void keep_beside(edges *e, const merlin_circle *other)
{
    static const float ABOUT = 1.1f; /* radii */
    size_t kept = 0;
    for (size_t i = 0; i < e->count; i++)
        if (hypotf(e->at[i].x - other->x, e->at[i].y - other->y) > ABOUT * other->radius) e->at[kept++] = e->at[i];
    e->count = kept < MOST_EDGES ? kept : MOST_EDGES;
}

status ball_find(const img *picture, const merlin_circle *beside, merlin_circle *circle, bool *found)
{
    *found = false;
    edges e;
    status s = find_edges(picture, beside ? SIZE_MAX : MOST_EDGES, &e);
    if (s != OK) return s;
    if (beside) keep_beside(&e, beside);
    if (e.count > 8 && sample_circles(&e, picture, circle) > 0.5f * LEAST_SEEN) {
        refine(&e, circle);
        *found = share_seen(&e, circle) >= (beside ? PLAINLY_SEEN : LEAST_SEEN);
    }
    free(e.at);
    return OK;
}

status ball_share_seen(const img *picture, const merlin_circle *circle, float *share)
{
    edges e;
    status s = find_edges(picture, MOST_EDGES, &e);
    if (s != OK) return s;
    *share = share_seen(&e, circle);
    free(e.at);
    return OK;
}

/* Keeps only edges near the circle, so that stronger ones elsewhere take no room. */
static void keep_near(edges *e, const merlin_circle *c)
{
    size_t kept = 0;
    for (size_t i = 0; i < e->count; i++) {
        float distance, cosine;
        if (is_near(&e->at[i], c, 2 * NEAR_CIRCLE, &distance, &cosine)) e->at[kept++] = e->at[i];
    }
    e->count = kept;
}

status ball_refine(const img *picture, merlin_circle *circle)
{
    edges e;
    status s = find_edges(picture, SIZE_MAX, &e);
    if (s != OK) return s;
    merlin_circle found = *circle;
    keep_near(&e, circle);
    refine(&e, &found);
    float moved = hypotf(found.x - circle->x, found.y - circle->y) + fabsf(found.radius - circle->radius);
    if (e.count >= LEAST_EDGES && moved < 4 * NEAR_CIRCLE) *circle = found;
    free(e.at);
    return OK;
}

static bool orthographic_point(const merlin_circle *c, float x, float y, vec3 *normal, vec3 *to_camera)
{
    float u = (x - c->x) / c->radius, v = (c->y - y) / c->radius, rest = 1 - u * u - v * v;
    if (!(rest > 0)) return false;
    *normal = vec3_make(u, v, sqrtf(rest));
    *to_camera = vec3_make(0, 0, 1);
    return true;
}

static vec3 pixel_ray(const pinhole *k, float x, float y)
{
    return vec3_normalize(vec3_make((x - k->x) / k->focal, (k->y - y) / k->focal, -1));
}

/* A camera in the same place that looks along another axis. */
typedef struct turn {
    const pinhole *camera;
    vec3 right, up, back;
} turn;

static turn turn_to(const pinhole *camera, vec3 axis)
{
    vec3 back = vec3_scale(axis, -1), right = vec3_normalize(vec3_cross(vec3_make(0, 1, 0), back));
    return (turn){camera, right, vec3_cross(back, right), back};
}

static vec3 turn_back(const turn *t, vec3 v)
{
    return vec3_fma(vec3_fma(vec3_scale(t->back, v.z), v.y, t->up), v.x, t->right);
}

static void turned_point(const turn *t, float *x, float *y)
{
    vec3 ray = pixel_ray(t->camera, *x, *y);
    float scale = t->camera->focal / -vec3_dot(ray, t->back);
    *x = t->camera->x + scale * vec3_dot(ray, t->right);
    *y = t->camera->y - scale * vec3_dot(ray, t->up);
}

static edge turned_edge(const turn *t, const edge *from)
{
    edge e = *from;
    float x = e.x + e.nx, y = e.y + e.ny;
    turned_point(t, &e.x, &e.y);
    turned_point(t, &x, &y);
    float length = hypotf(x - e.x, y - e.y);
    e.nx = (x - e.x) / length;
    e.ny = (y - e.y) / length;
    return e;
}

/* Finds the ball's centre. Away from the optical axis the outline is an ellipse, whose centre is not the ball's; a
 * camera turned toward the ball sees a circle. */
static vec3 center_of(const edges *e, edges *turned, const pinhole *camera, const merlin_circle *circle)
{
    enum { ROUNDS = 4 };
    vec3 axis = pixel_ray(camera, circle->x, circle->y);
    float radius = -axis.z * circle->radius;
    for (int i = 0; i < ROUNDS; i++) {
        turn t = turn_to(camera, axis);
        for (turned->count = 0; turned->count < e->count; turned->count++)
            turned->at[turned->count] = turned_edge(&t, &e->at[turned->count]);
        merlin_circle seen = {camera->x, camera->y, radius};
        refine(turned, &seen);
        axis = turn_back(&t, pixel_ray(camera, seen.x, seen.y));
        radius = seen.radius;
    }
    return vec3_scale(axis, hypotf(camera->focal, radius) / radius);
}

status ball_center(const img *picture, const pinhole *camera, const merlin_circle *circle, vec3 *center)
{
    edges e;
    status s = find_edges(picture, MOST_EDGES, &e);
    if (s != OK) return s;
    edges turned = {malloc(MOST_EDGES * sizeof *turned.at), 0};
    if (turned.at)
        *center = center_of(&e, &turned, camera, circle);
    else
        s = fail(MERLIN_NO_MEMORY, "no memory for edges");
    free(turned.at);
    free(e.at);
    return s;
}

bool ball_point(const ball_view *view, float x, float y, vec3 *normal, vec3 *to_camera)
{
    const merlin_circle *c = &view->circle;
    if (!(view->camera.focal > 0)) return orthographic_point(c, x, y, normal, to_camera);
    vec3 center = view->center, ray = pixel_ray(&view->camera, x, y);
    float along = vec3_dot(center, ray), rest = along * along - vec3_dot(center, center) + 1;
    if (!(rest > 0)) return false;
    *normal = vec3_normalize(vec3_sub(vec3_scale(ray, along - sqrtf(rest)), center));
    *to_camera = vec3_scale(ray, -1);
    return true;
}
