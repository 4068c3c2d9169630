/* SPDX-License-Identifier: MIT */
#include "mesh/surface/surface_mesh.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/number.h"

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
    merlin_mesh *mesh;
    const uint32_t *vertex; /* per pixel, UINT32_MAX outside */
} builder;

/* Adds a triangle of three pixels if all are on the object and no side crosses a discontinuity. */
static void add_triangle(builder *b, size_t p, size_t q, size_t r)
{
    const uint32_t *v = b->vertex;
    if (v[p] == UINT32_MAX || v[q] == UINT32_MAX || v[r] == UINT32_MAX) return;
    if (!joined(b->from, p, q) || !joined(b->from, q, r) || !joined(b->from, r, p)) return;
    uint32_t *to = b->mesh->triangles + 3 * b->mesh->triangle_count++;
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

static vec3 corner(const merlin_mesh *m, uint32_t v)
{
    return vec3_of(m->positions + 3 * (size_t)v);
}

/* Sums the triangles' normals, weighted by area. */
static void add_normals(merlin_mesh *m)
{
    for (size_t t = 0; t < m->triangle_count; t++) {
        const uint32_t *i = m->triangles + 3 * t;
        vec3 a = corner(m, i[0]), n = vec3_cross(vec3_sub(corner(m, i[1]), a), vec3_sub(corner(m, i[2]), a));
        for (int k = 0; k < 3; k++) {
            float *to = m->normals + 3 * (size_t)i[k];
            to[0] += n.x;
            to[1] += n.y;
            to[2] += n.z;
        }
    }
    for (size_t v = 0; v < m->vertex_count; v++) {
        float *to = m->normals + 3 * v;
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
    merlin_mesh *m = b->mesh;
    size_t width = (size_t)from->depth->width, height = (size_t)from->depth->height;
    uint32_t next = 0;
    for (size_t p = 0; p < width * height; p++) {
        vertex[p] = UINT32_MAX;
        if (!inside(from, p)) continue;
        place(from, p, m->positions + 3 * (size_t)next, m->uvs + 2 * (size_t)next);
        m->pixels[next] = (uint32_t)p;
        vertex[p] = next++;
    }
    for (size_t y = 0; y + 1 < height; y++)
        for (size_t x = 0; x + 1 < width; x++)
            add_square(b, y * width + x);
    add_normals(m);
}

/* ---- what the maps say of the vertices ---- */

/* Gives vertices the normal map's normals, where it has some, and keeps the triangles' beside them. */
static void take_normals(const img *map, merlin_mesh *m)
{
    memcpy(m->face_normals, m->normals, 3 * m->vertex_count * sizeof *m->normals);
    for (size_t v = 0; v < m->vertex_count; v++) {
        vec3 mapped = vec3_normalize(vec3_of(map->data + 3 * (size_t)m->pixels[v]));
        if (vec3_dot(mapped, mapped) > (real)0.5) vec3_put(mapped, m->normals + 3 * v);
    }
}

static void take_colors(const img *albedo, merlin_mesh *m)
{
    const size_t channels = (size_t)albedo->channels;
    for (size_t v = 0; v < m->vertex_count; v++)
        for (size_t c = 0; c < 3; c++)
            m->colors[3 * v + c] = clamp(albedo->data[m->pixels[v] * channels + (channels == 3 ? c : 0)], 0, 1);
}

/* Copies albedo as 3 channels in [0, 1]: a single channel is repeated. */
static status take_texture(const img *albedo, img *out)
{
    status s = img_new(out, albedo->width, albedo->height, 3);
    if (s != OK) return s;
    size_t count = (size_t)albedo->width * (size_t)albedo->height, channels = (size_t)albedo->channels;
    for (size_t i = 0; i < 3 * count; i++) {
        float x = albedo->data[i / 3 * channels + (channels == 3 ? i % 3 : 0)];
        if (x > 0) out->data[i] = x < 1 ? x : 1;
    }
    return OK;
}

static status take_maps(const mesh_source *from, merlin_mesh *m)
{
    if (from->normal) take_normals(from->normal, m);
    if (from->albedo) take_colors(from->albedo, m);
    const img *texture = from->texture ? from->texture : from->albedo;
    status s = texture ? take_texture(texture, &m->albedo) : OK;
    return s == OK && from->roughness ? img_copy(&m->roughness, from->roughness) : s;
}

/* ---- all of it ---- */

/* A map may be missing. */
static status check_size(const mesh_source *from, const img *map)
{
    if (!map || (map->width == from->depth->width && map->height == from->depth->height)) return OK;
    return fail(MERLIN_WRONG_USE, "the maps of a mesh differ in size: %d × %d and %d × %d", from->depth->width,
                from->depth->height, map->width, map->height);
}

static status check(const mesh_source *from)
{
    status s = check_size(from, from->mask);
    if (s == OK) s = check_size(from, from->normal);
    if (s == OK) s = check_size(from, from->albedo);
    if (s != OK) return s;
    if (!(from->camera.focal >= 0))
        return fail(MERLIN_WRONG_USE, "a camera's focal length is 0 (far away) or above, in pixels, not %g",
                    (double)from->camera.focal);
    return OK;
}

static bool allocate(const mesh_source *from, merlin_mesh *m)
{
    const size_t n = m->vertex_count;
    m->positions = calloc(3 * n, sizeof *m->positions);
    m->normals = calloc(3 * n, sizeof *m->normals);
    m->uvs = malloc(2 * n * sizeof *m->uvs);
    m->pixels = calloc(n, sizeof *m->pixels);
    /* a vertex is a corner of at most four squares, and each has at most a triangle per two corners */
    m->triangles = calloc(6 * n, sizeof *m->triangles);
    if (from->normal) m->face_normals = malloc(3 * n * sizeof *m->face_normals);
    if (from->albedo) m->colors = malloc(3 * n * sizeof *m->colors);
    return m->positions && m->normals && m->uvs && m->pixels && m->triangles && (m->face_normals || !from->normal) &&
           (m->colors || !from->albedo);
}

status surface_mesh_new(const mesh_source *from, merlin_mesh *out)
{
    *out = (merlin_mesh){0};
    status s = check(from);
    if (s != OK) return s;
    const int width = from->depth->width, height = from->depth->height;
    size_t pixels = (size_t)width * (size_t)height;
    *out = (merlin_mesh){.width = width, .height = height, .scale = 1};
    if (!pinhole_is_near(&from->camera)) out->scale = 1.0 / (width > height ? width : height);
    for (size_t p = 0; p < pixels; p++)
        out->vertex_count += inside(from, p);
    if (pixels == 0 || out->vertex_count == 0) {
        *out = (merlin_mesh){0};
        return fail(MERLIN_BAD_INPUT, "the mask is empty: there is no mesh to write");
    }
    uint32_t *vertex = calloc(pixels, sizeof *vertex);
    if (vertex && allocate(from, out)) {
        build(&(builder){from, out, vertex}, vertex);
        s = take_maps(from, out);
    } else {
        s = fail(MERLIN_NO_MEMORY, "no memory for a mesh of %zu vertices", out->vertex_count);
    }
    free(vertex);
    if (s != OK) merlin_mesh_free(out);
    return s;
}

void merlin_mesh_free(merlin_mesh *mesh)
{
    if (!mesh) return;
    free(mesh->positions);
    free(mesh->normals);
    free(mesh->uvs);
    free(mesh->colors);
    free(mesh->triangles);
    free(mesh->pixels);
    free(mesh->face_normals);
    img_free(&mesh->albedo);
    img_free(&mesh->roughness);
    *mesh = (merlin_mesh){0};
}
