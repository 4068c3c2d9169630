/* SPDX-License-Identifier: MIT */
/* Surfaces of revolution: open vessels with a wall, lathed solids, fruit, rings; some fluted, some with a handle. */
#include "base/number.h"
#include "lab/scene/shape/mesh_solids.h"
#include "lab/scene/shape/shape.h"

enum { KNOTS = 8 };

/* Interpolates `count` equally spaced knots at t in [0, 1] (Catmull-Rom). */
static float spline(const float *knot, int count, float t)
{
    float x = t * (float)(count - 1);
    int i = (int)x;
    if (i > count - 2) i = count - 2;
    float u = x - (float)i;
    float a = knot[i > 0 ? i - 1 : 0], b = knot[i], c = knot[i + 1], d = knot[i + 2 < count ? i + 2 : count - 1];
    return b + 0.5f * u * (c - a + u * (2 * a - 5 * b + 4 * c - d + u * (3 * (b - c) + d - a)));
}

typedef struct outline {
    float knot[KNOTS];
    int knots;
    float half_height;
} outline;

static float outline_radius(const outline *o, float t)
{
    return max_of(0.07f, spline(o->knot, o->knots, t));
}

static outline random_outline(rng *r)
{
    outline o = {.knots = 3 + rng_below(r, KNOTS - 2), .half_height = rng_range(r, 0.35f, 1.2f)};
    float radius = rng_range(r, 0.3f, 0.7f);
    for (int i = 0; i < o.knots; i++) {
        o.knot[i] = radius;
        radius = clamp(radius + rng_normal(r) * 0.22f, 0.12f, 0.95f);
    }
    return o;
}

static void add_side(lathe_profile *p, const outline *o, int steps)
{
    for (int i = 0; i <= steps; i++) {
        float t = (float)i / (float)steps;
        lathe_profile_add(p, outline_radius(o, t), o->half_height * (2 * t - 1));
    }
}

static void add_bottom(lathe_profile *p, const outline *o)
{
    float r0 = outline_radius(o, 0), h = o->half_height;
    float centre[2] = {0, -h - 0.03f}, edge[2] = {r0, -h - 0.03f}, side[2] = {r0, -h};
    lathe_profile_add(p, 0, -h - 0.03f);
    lathe_profile_add(p, 0.5f * r0, -h - 0.03f);
    lathe_profile_add_corner(p, centre, edge, side, 0.03f, 4);
}

static void vessel(rng *r, lathe_profile *p, outline *o)
{
    float wall = rng_range(r, 0.025f, 0.09f), floor = rng_range(r, 0.03f, 0.12f);
    int steps = 56;
    if (rng_uniform(r) < 0.35f) o->knot[o->knots - 1] = min_of(1.1f, o->knot[o->knots - 1] + rng_range(r, 0, 0.4f));
    add_bottom(p, o);
    add_side(p, o, steps);
    float rim = outline_radius(o, 1), h = o->half_height;
    for (int i = 1; i < 6; i++) { /* half-round rim */
        float a = PI * (float)i / 6;
        lathe_profile_add(p, rim - 0.5f * wall * (1 - cosf(a)), h + 0.5f * wall * sinf(a));
    }
    for (int i = steps; i >= 0; i--) {
        float t = (float)i / (float)steps, y = h * (2 * t - 1);
        if (y > -h + floor) lathe_profile_add(p, max_of(0.02f, outline_radius(o, t) - wall), y);
    }
    lathe_profile_add(p, 0.5f * p->radius[p->count - 1], -h + floor);
    lathe_profile_add(p, 0, -h + floor);
}

static void lathed_solid(rng *r, lathe_profile *p, outline *o)
{
    add_bottom(p, o);
    add_side(p, o, 90);
    float rim = outline_radius(o, 1), h = o->half_height,
          dome = rng_uniform(r) < 0.5f ? 0.02f : rng_range(r, 0.1f, 0.6f);
    for (int i = 1; i <= 14; i++) {
        float a = 1.5707963f * (float)i / 14;
        lathe_profile_add(p, i == 14 ? 0 : rim * cosf(a), h + dome * rim * sinf(a));
    }
}

/* Makes a ball or egg with dimpled or pointed ends: fruit, pebbles, eggs. */
static void fruit(rng *r, lathe_profile *p)
{
    float tall = rng_range(r, 0.75f, 1.5f), egg = rng_range(r, -0.25f, 0.25f);
    float top = rng_normal(r) * 0.12f, bottom = rng_normal(r) * 0.12f, width = rng_range(r, 0.15f, 0.45f);
    for (int i = 0; i <= 110; i++) {
        float a = PI * ((float)i / 110 - 0.5f), s = sinf(a), c = i % 110 ? cosf(a) : 0;
        float nub = s > 0 ? top * expf(-c * c / (width * width)) : -bottom * expf(-c * c / (width * width));
        lathe_profile_add(p, 0.7f * c * (1 + egg * s), 0.7f * tall * s + nub);
    }
}

static void ring(rng *r, lathe_profile *p)
{
    float major = 0.7f, minor = rng_range(r, 0.12f, 0.42f), tall = rng_range(r, 0.5f, 1.8f),
          e = rng_range(r, 0.35f, 1.2f);
    p->closed = true;
    for (int i = 0; i < 72; i++) {
        float a = 2 * PI * (float)i / 72 - 1.5707963f, c = cosf(a), s = sinf(a);
        lathe_profile_add(p, major + minor * copysignf(powf(fabsf(c), e), c),
                          minor * tall * copysignf(powf(fabsf(s), e), s));
    }
}

/* Adds flutes: the radius varies around the axis, possibly twisting with height. */
static void flute(rng *r, triangle_mesh *mesh)
{
    int count = 3 + rng_below(r, 22);
    float depth = rng_range(r, 0.01f, 0.35f / (float)(count < 6 ? 6 : count)) * 2, twist = rng_normal(r) * 2;
    for (uint32_t i = 0; i < mesh->vertex_count; i++) {
        vec3 *q = &mesh->position[i];
        float wave = 1 + depth * cosf((float)count * (atan2f(q->z, q->x) + twist * q->y));
        q->x *= wave;
        q->z *= wave;
    }
}

static void handle(rng *r, triangle_mesh *mesh, const outline *o, uint8_t part)
{
    enum { COUNT = 36 };
    vec3 path[COUNT];
    float radius[COUNT], low = rng_range(r, 0.1f, 0.35f), high = rng_range(r, 0.65f, 0.95f), h = o->half_height;
    float out = rng_range(r, 0.2f, 0.5f), thick = rng_range(r, 0.035f, 0.08f);
    for (int i = 0; i < COUNT; i++) {
        float t = (float)i / (COUNT - 1), u = low + (high - low) * t;
        float bow = powf(max_of(0, sinf(PI * t)), 0.6f) * out;
        path[i] = vec3_make(outline_radius(o, u) - 0.02f + bow, h * (2 * u - 1), 0);
        radius[i] = thick;
    }
    mesh_add_tube(mesh, path, radius, COUNT, 20, rng_range(r, 0.8f, 2), part);
}

void shape_revolution(rng *r, triangle_mesh *mesh, shape_traits *traits)
{
    outline o = random_outline(r);
    lathe_profile p = {0};
    float kind = rng_uniform(r);
    bool sided = kind < 0.65f;
    if (kind < 0.4f)
        vessel(r, &p, &o);
    else if (sided)
        lathed_solid(r, &p, &o);
    else if (kind < 0.88f)
        fruit(r, &p);
    else
        ring(r, &p);
    mesh_add_lathe(mesh, &p, 112, 0);
    if (rng_uniform(r) < 0.22f) flute(r, mesh);
    *traits = (shape_traits){.name = "revolution", .upright = true, .crease_cosine = 0.7f, .parts = 1};
    if (sided && rng_uniform(r) < 0.3f) handle(r, mesh, &o, (uint8_t)traits->parts++);
    if (rng_uniform(r) < (sided ? 0.15f : 0.5f)) bend_and_twist(r, mesh, 0);
    if (rng_uniform(r) < (sided ? 0.3f : 0.6f)) {
        float amount = rng_range(r, 0.005f, 0.07f);
        random_dents(r, mesh, 0, amount, 1, 4);
    }
}
