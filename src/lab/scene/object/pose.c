/* SPDX-License-Identifier: MIT */
#include "lab/scene/object/pose.h"

#include <stdlib.h>
#include <string.h>

#include "base/number.h"

enum { RASTER = 64, ATTEMPTS = 4, STEPS = 9 };

static const float NEAREST = 0.42f, FRAME = 1.9f; /* least depth; largest side, in a frame 2 wide */

/* Transform from object space to camera space: stretch (rotation p) + offset. */
typedef struct pose {
    mat3 rotation;
    vec3 stretch, offset;
} pose;

typedef struct silhouette {
    float coverage; /* share of the frame */
    float low_x, high_x, low_y, high_y, nearest;
} silhouette;

static vec3 pose_apply(const pose *at, vec3 p)
{
    return vec3_add(vec3_mul(at->stretch, mat3_apply(&at->rotation, p)), at->offset);
}

/* Marks the pixels whose centres are inside the triangle, in either winding. */
static void mark_triangle(uint8_t *mask, const float a[2], const float b[2], const float c[2])
{
    float low_x = min_of(a[0], min_of(b[0], c[0])), high_x = max_of(a[0], max_of(b[0], c[0]));
    float low_y = min_of(a[1], min_of(b[1], c[1])), high_y = max_of(a[1], max_of(b[1], c[1]));
    if (!(low_x < RASTER && high_x > 0 && low_y < RASTER && high_y > 0)) return;
    int x0 = (int)max_of(0, ceilf(low_x - 0.5f)), x1 = (int)min_of(RASTER - 1, floorf(high_x - 0.5f));
    int y0 = (int)max_of(0, ceilf(low_y - 0.5f)), y1 = (int)min_of(RASTER - 1, floorf(high_y - 0.5f));
    for (int y = y0; y <= y1; y++) {
        for (int x = x0; x <= x1; x++) {
            float px = (float)x + 0.5f, py = (float)y + 0.5f;
            float u = (b[0] - a[0]) * (py - a[1]) - (b[1] - a[1]) * (px - a[0]);
            float v = (c[0] - b[0]) * (py - b[1]) - (c[1] - b[1]) * (px - b[0]);
            float w = (a[0] - c[0]) * (py - c[1]) - (a[1] - c[1]) * (px - c[0]);
            if ((u >= 0 && v >= 0 && w >= 0) || (u <= 0 && v <= 0 && w <= 0)) mask[y * RASTER + x] = 1;
        }
    }
}

/* Measures the silhouette. screen: room for two floats a vertex. */
static silhouette measure(const triangle_mesh *mesh, const pose *at, float tangent, float (*screen)[2])
{
    float low_x = 1e9f, high_x = -1e9f, low_y = 1e9f, high_y = -1e9f, nearest = 1e9f;
    const pose to = *at;
#pragma omp simd reduction(min : low_x, low_y, nearest) reduction(max : high_x, high_y)
    for (uint32_t i = 0; i < mesh->vertex_count; i++) {
        vec3 p = pose_apply(&to, mesh->position[i]);
        float depth = max_of(0.05f, -p.z), x = p.x / (depth * tangent), y = p.y / (depth * tangent);
        nearest = min_of(nearest, -p.z);
        low_x = min_of(low_x, x);
        high_x = max_of(high_x, x);
        low_y = min_of(low_y, y);
        high_y = max_of(high_y, y);
        screen[i][0] = (x + 1) * (0.5f * RASTER);
        screen[i][1] = (y + 1) * (0.5f * RASTER);
    }
    silhouette s = {0, low_x, high_x, low_y, high_y, nearest};
    uint8_t mask[RASTER * RASTER] = {0};
    for (uint32_t i = 0; i < mesh->triangle_count; i++) {
        const uint32_t *t = mesh->triangle[i];
        mark_triangle(mask, screen[t[0]], screen[t[1]], screen[t[2]]);
    }
    int covered = 0;
    for (int i = 0; i < RASTER * RASTER; i++)
        covered += mask[i];
    s.coverage = (float)covered / (RASTER * RASTER);
    return s;
}

static mat3 choose_rotation(rng *r, const shape_traits *traits)
{
    if (traits->frontal && rng_uniform(r) < 0.9f) {
        float x = rng_normal(r) * 0.4f, y = rng_normal(r) * 0.4f;
        return rotation_xyz(x, y, 2 * PI * rng_uniform(r));
    }
    if (traits->upright && rng_uniform(r) < 0.75f) {
        float yaw = traits->mirrored ? rng_normal(r) * 0.9f : 2 * PI * rng_uniform(r);
        float pitch = rng_range(r, -0.2f, 0.8f), roll = rng_normal(r) * 0.12f;
        mat3 turn = rotation_xyz(0, yaw, 0), tilt = rotation_xyz(pitch, 0, roll);
        return mat3_product(&tilt, &turn);
    }
    return random_rotation(r);
}

/* Takes one step of the search: scales toward the target coverage within the frame, then centres. aim: desired position
 * of the bounding box's middle, as a share of the room left in the frame. */
static void improve(pose *at, const silhouette *s, float target, float tangent, const float aim[2])
{
    float width = s->high_x - s->low_x, height = s->high_y - s->low_y;
    float grow = sqrtf(target / max_of(s->coverage, 0.01f)), limit = FRAME / max_of(width, height);
    if (grow > limit) {
        float reached = s->coverage * limit * limit;
        grow = limit;
        if (reached < 0.28f) { /* too thin for any size: widen its narrow side */
            float widen =
                min_of(1.4f, min_of(0.3f / max_of(reached, 0.02f), max_of(width, height) / min_of(width, height)));
            if (width < height)
                at->stretch.x *= widen;
            else
                at->stretch.y *= widen;
        }
    }
    grow = clamp(grow, 0.3f, 3);
    at->stretch = vec3_scale(at->stretch, grow);
    float depth = (1 - s->nearest) * grow;
    if (depth > 1 - NEAREST) at->stretch.z *= 0.97f * (1 - NEAREST) / depth;
    float room_x = max_of(0, 0.5f * (FRAME - width * grow)), room_y = max_of(0, 0.5f * (FRAME - height * grow));
    /* the object grows about its own middle, so that the box's offset from there grows, too */
    float mean_x = 0.5f * (s->low_x + s->high_x), mean_y = 0.5f * (s->low_y + s->high_y);
    at->offset.x += (aim[0] * room_x - mean_x) * tangent;
    at->offset.y += (aim[1] * room_y - mean_y) * tangent;
}

static bool in_frame(const silhouette *s)
{
    return s->low_x > -0.985f && s->high_x < 0.985f && s->low_y > -0.985f && s->high_y < 0.985f;
}

/* Returns how far a result is from the requirements; 0 is perfect. */
static float badness(const silhouette *s, float target)
{
    float bad = fabsf(s->coverage - target) * 0.1f;
    if (s->coverage < 0.25f) bad += 1 + 4 * (0.25f - s->coverage);
    if (s->coverage > 0.75f) bad += 1 + 4 * (s->coverage - 0.75f);
    return bad + !in_frame(s) + 2 * (s->nearest < 0.4f);
}

static pose search(rng *r, const triangle_mesh *mesh, const shape_traits *traits, float tangent, float (*screen)[2])
{
    pose best = {0};
    float least = 1e9f;
    for (int attempt = 0; attempt < ATTEMPTS && least >= 0.3f; attempt++) {
        float target = rng_range(r, 0.28f, 0.72f), aim[2] = {rng_range(r, -0.7f, 0.7f), rng_range(r, -0.7f, 0.7f)};
        pose at = {choose_rotation(r, traits), {0.45f, 0.45f, 0.45f}, {0, 0, -1}};
        for (int step = 0; step < STEPS; step++) {
            silhouette s = measure(mesh, &at, tangent, screen);
            float bad = badness(&s, target);
            if (bad < least) {
                best = at;
                least = bad;
            }
            if (bad < 0.003f) break;
            improve(&at, &s, target, tangent, aim);
        }
    }
    return best;
}

static void push_to_edge(rng *r, pose *at, const silhouette *s, float tangent)
{
    float cut = rng_range(r, 0, 0.2f), *side = rng_uniform(r) < 0.5f ? &at->offset.x : &at->offset.y;
    float low = side == &at->offset.x ? s->low_x : s->low_y, high = side == &at->offset.x ? s->high_x : s->high_y;
    *side += (rng_uniform(r) < 0.5f ? 1 + cut - high : -1 - cut - low) * tangent;
}

void pose_object(rng *r, triangle_mesh *mesh, const shape_traits *traits, float fov)
{
    float tangent = tanf(0.5f * fov * DEGREE), (*screen)[2] = malloc(mesh->vertex_count * sizeof *screen);
    if (!screen) {
        mesh->failed = true;
        return;
    }
    pose at = search(r, mesh, traits, tangent, screen);
    if (rng_uniform(r) < 0.05f) {
        silhouette s = measure(mesh, &at, tangent, screen);
        push_to_edge(r, &at, &s, tangent);
    }
    free(screen);
    for (uint32_t i = 0; i < mesh->vertex_count; i++) {
        mesh->position[i] = pose_apply(&at, mesh->position[i]);
        if (!mesh->normal) continue;
        vec3 n = mat3_apply(&at.rotation, mesh->normal[i]), s = at.stretch;
        mesh->normal[i] = vec3_normalize(vec3_make(n.x / s.x, n.y / s.y, n.z / s.z));
    }
}
