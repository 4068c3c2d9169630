/* SPDX-License-Identifier: MIT */
#include "mesh/write/surface_mesh.h"

#include <math.h>
#include <stdlib.h>

/* Largest difference in depth, in pixel sizes, of neighbours that are joined (a slope of 84 degrees). */
static const float JUMP = 10;

static bool inside(const mesh_source *from, size_t pixel)
{
    float depth = from->depth->data[pixel];
    return from->mask->data[pixel * (size_t)from->mask->channels] > 0.5f && isfinite(depth);
}

static float pixel_size(const mesh_source *from, float depth)
{
    return pinhole_is_near(&from->camera) ? fabsf(depth) / from->camera.focal : 1;
}

/* Returns the point so many pixels to the right of the principal point and above it. */
static vec3 point_at(const mesh_source *from, float right, float up, float depth)
{
    const float size = pixel_size(from, depth);
    if (from->slant.right == 0 && from->slant.up == 0) return vec3_make(right * size, up * size, -depth);
    const camera_plane plane = camera_plane_of(from->slant);
    return vec3_scale(camera_on_plane(&plane, right / from->camera.focal, up / from->camera.focal), depth);
}

static void place(const mesh_source *from, size_t pixel, float *position, float *texture)
{
    int width = from->depth->width, height = from->depth->height;
    size_t column = pixel % (size_t)width, row = pixel / (size_t)width;
    float x = (float)column + 0.5f, y = (float)row + 0.5f;
    const pinhole *c = &from->camera;
    const float right = x - (pinhole_is_near(c) ? c->x : (float)width / 2),
                up = (pinhole_is_near(c) ? c->y : (float)height / 2) - y;
    vec3_put(point_at(from, right, up, from->depth->data[pixel]), position);
    texture[0] = x / (float)width;
    texture[1] = y / (float)height;
}

static bool joined(const mesh_source *from, size_t a, size_t b)
{
    float first = from->depth->data[a], second = from->depth->data[b];
    return fabsf(first - second) <= JUMP * pixel_size(from, first < second ? first : second);
}

typedef struct builder {
    const mesh_source *from;
    surface_mesh *mesh;
    const uint32_t *vertex; /* per pixel, UINT32_MAX outside */
} builder;

/* Adds a triangle of three pixels if all are on the object and no side crosses a discontinuity. */
static void add_triangle(builder *b, size_t p, size_t q, size_t r)
{
    const uint32_t *v = b->vertex;
    if (v[p] == UINT32_MAX || v[q] == UINT32_MAX || v[r] == UINT32_MAX) return;
    if (!joined(b->from, p, q) || !joined(b->from, q, r) || !joined(b->from, r, p)) return;
    uint32_t *to = b->mesh->index + 3 * b->mesh->triangles++;
    to[0] = v[p];
    to[1] = v[q];
    to[2] = v[r];
}

/* Adds the triangles of four pixels, split along the flatter diagonal; with one corner outside the mask there is one
 * triangle. */
static void add_square(builder *b, size_t top_left)
{
    size_t width = (size_t)b->from->depth->width;
    size_t tl = top_left, tr = tl + 1, bl = tl + width, br = bl + 1;
    const float *d = b->from->depth->data;
    bool falling = fabsf(d[tl] - d[br]) <= fabsf(d[tr] - d[bl]);
    if (b->vertex[tr] == UINT32_MAX || b->vertex[bl] == UINT32_MAX) falling = true;
    if (b->vertex[tl] == UINT32_MAX || b->vertex[br] == UINT32_MAX) falling = false;
    if (falling) {
        add_triangle(b, tl, bl, br);
        add_triangle(b, tl, br, tr);
    } else {
        add_triangle(b, tl, bl, tr);
        add_triangle(b, tr, bl, br);
    }
}

static vec3 corner(const surface_mesh *m, uint32_t v)
{
    return vec3_of(m->position + 3 * (size_t)v);
}

/* Sums the triangles' normals, weighted by area. */
static void add_normals(surface_mesh *m)
{
    for (size_t t = 0; t < m->triangles; t++) {
        const uint32_t *i = m->index + 3 * t;
        vec3 a = corner(m, i[0]), n = vec3_cross(vec3_sub(corner(m, i[1]), a), vec3_sub(corner(m, i[2]), a));
        for (int k = 0; k < 3; k++) {
            float *to = m->normal + 3 * i[k];
            to[0] += n.x;
            to[1] += n.y;
            to[2] += n.z;
        }
    }
    for (size_t v = 0; v < m->vertices; v++) {
        float *to = m->normal + 3 * v;
        vec3 n = vec3_normalize(vec3_of(to));
        bool alone = !(vec3_dot(n, n) > 0);
        to[0] = alone ? 0 : n.x;
        to[1] = alone ? 0 : n.y;
        to[2] = alone ? 1 : n.z;
    }
}

static void build(builder *b, uint32_t *vertex)
{
    const mesh_source *from = b->from;
    surface_mesh *m = b->mesh;
    size_t width = (size_t)from->depth->width, height = (size_t)from->depth->height;
    uint32_t next = 0;
    for (size_t p = 0; p < width * height; p++) {
        vertex[p] = UINT32_MAX;
        if (!inside(from, p)) continue;
        place(from, p, m->position + 3 * (size_t)next, m->texture + 2 * (size_t)next);
        m->pixel[next] = (int)p;
        vertex[p] = next++;
    }
    for (size_t y = 0; y + 1 < height; y++)
        for (size_t x = 0; x + 1 < width; x++)
            add_square(b, y * width + x);
    add_normals(m);
}

status surface_mesh_check_size(const mesh_source *from, const img *map)
{
    if (!map || (map->width == from->depth->width && map->height == from->depth->height)) return OK;
    return fail(MERLIN_WRONG_USE, "the maps of a mesh differ in size: %d × %d and %d × %d", from->depth->width,
                from->depth->height, map->width, map->height);
}

static status check(const mesh_source *from)
{
    status s = surface_mesh_check_size(from, from->mask);
    if (s == OK) s = surface_mesh_check_size(from, from->normal);
    if (s != OK) return s;
    if (!(from->camera.focal >= 0))
        return fail(MERLIN_WRONG_USE, "a camera's focal length is 0 (far away) or above, in pixels, not %g",
                    (double)from->camera.focal);
    return OK;
}

status surface_mesh_new(const mesh_source *from, surface_mesh *out)
{
    *out = (surface_mesh){0};
    status s = check(from);
    if (s != OK) return s;
    size_t pixels = (size_t)from->depth->width * (size_t)from->depth->height;
    for (size_t p = 0; p < pixels; p++)
        out->vertices += inside(from, p);
    size_t n = out->vertices;
    if (pixels == 0 || n == 0) return fail(MERLIN_BAD_INPUT, "the mask is empty: there is no mesh to write");
    uint32_t *vertex = calloc(pixels, sizeof *vertex);
    out->position = calloc(3 * n, sizeof *out->position);
    out->normal = calloc(3 * n, sizeof *out->normal);
    out->texture = malloc(2 * n * sizeof *out->texture);
    out->pixel = malloc(n * sizeof *out->pixel);
    /* a vertex is a corner of at most four squares, and each has at most a triangle per two corners */
    out->index = calloc(6 * n, sizeof *out->index);
    if (vertex && out->position && out->normal && out->texture && out->pixel && out->index)
        build(&(builder){from, out, vertex}, vertex);
    else
        s = fail(MERLIN_NO_MEMORY, "no memory for a mesh of %zu vertices", n);
    free(vertex);
    if (s != OK) surface_mesh_free(out);
    return s;
}

void surface_mesh_free(surface_mesh *m)
{
    free(m->position);
    free(m->normal);
    free(m->texture);
    free(m->pixel);
    free(m->index);
    *m = (surface_mesh){0};
}

vec3 surface_mesh_normal(const surface_mesh *m, const mesh_source *from, size_t vertex)
{
    const float *own = m->normal + 3 * vertex;
    vec3 geometric = vec3_of(own);
    if (!from->normal) return geometric;
    const float *n = from->normal->data + 3 * (size_t)m->pixel[vertex];
    vec3 mapped = vec3_normalize(vec3_of(n));
    return vec3_dot(mapped, mapped) > (real)0.5 ? mapped : geometric;
}

status mesh_albedo(const img *albedo, img *out)
{
    status s = img_new(out, albedo->width, albedo->height, 3);
    if (s != OK) return s;
    size_t count = (size_t)albedo->width * (size_t)albedo->height, channels = (size_t)albedo->channels;
    for (size_t i = 0; i < 3 * count; i++) {
        float x = albedo->data[i / 3 * channels + (channels == 3 ? i % 3 : 0)];
        out->data[i] = x > 0 ? (x < 1 ? x : 1) : 0;
    }
    return OK;
}
