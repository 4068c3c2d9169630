/* SPDX-License-Identifier: MIT */
/* Unions of 1 to 9 cubes, ellipsoids and cylinders, each deformed by a random smooth height field (Xu et al. 2018); one
 * in ten assembled as a toy on wheels. */
#include "base/number.h"
#include "lab/scene/shape/mesh_solids.h"
#include "lab/scene/shape/shape.h"

typedef struct rounded_box {
    vec3 half;
    float round;
} rounded_box;

/* Maps the cube grid to a rounded box; the outer quarter of each side becomes the rounded edge. */
static vec3 map_rounded_box(const void *context, vec3 cube)
{
    const rounded_box *box = context;
    const real half[3] = {box->half.x, box->half.y, box->half.z}, at[3] = {cube.x, cube.y, cube.z};
    float inner[3], direction[3], length = 0;
    for (int k = 0; k < 3; k++) {
        float flat = min_of(1, fabsf(at[k]) / 0.75f), edge = max_of(0, (fabsf(at[k]) - 0.75f) / 0.25f);
        inner[k] = flat * (half[k] - box->round);
        direction[k] = tanf(0.7853982f * edge);
        length += direction[k] * direction[k];
    }
    real p[3];
    for (int k = 0; k < 3; k++)
        p[k] = copysignf(inner[k] + box->round * direction[k] / sqrtf(length), at[k]);
    return vec3_of(p);
}

static void add_box(rng *r, triangle_mesh *mesh, int n, uint8_t part)
{
    rounded_box box = {{rng_range(r, 0.45f, 1), rng_range(r, 0.45f, 1), rng_range(r, 0.45f, 1)}, 0};
    float smallest = min_of(box.half.x, min_of(box.half.y, box.half.z)), u = rng_uniform(r);
    box.round = smallest * (0.01f + 0.8f * u * u * u);
    mesh_add_cube_grid(mesh, n, part, map_rounded_box, &box);
}

static void add_cylinder(rng *r, triangle_mesh *mesh, int n, uint8_t part)
{
    float h = rng_range(r, 0.5f, 1.1f), bottom = rng_range(r, 0.35f, 0.9f), u = rng_uniform(r);
    float top = rng_uniform(r) < 0.6f ? bottom : bottom * rng_range(r, 0.1f, 1);
    float round = 0.02f + 0.35f * u * u;
    float points[4][2] = {{0, -h}, {bottom, -h}, {top, h}, {0, h}};
    lathe_profile p = {0};
    int flat = n / 2;
    for (int i = 0; i < flat; i++)
        lathe_profile_add(&p, bottom * 0.5f * (float)i / (float)flat, -h);
    lathe_profile_add_corner(&p, points[0], points[1], points[2], round, 5);
    for (int i = 1; i < n; i++) {
        float t = 0.5f * round / h + (1 - round / h) * (float)i / (float)n;
        lathe_profile_add(&p, bottom + (top - bottom) * t, -h + 2 * h * t);
    }
    lathe_profile_add_corner(&p, points[1], points[2], points[3], round, 5);
    for (int i = flat - 1; i >= 0; i--)
        lathe_profile_add(&p, top * 0.5f * (float)i / (float)flat, h);
    mesh_add_lathe(mesh, &p, 4 * n, part);
}

static void add_primitive(rng *r, triangle_mesh *mesh, int n, uint8_t part)
{
    switch (rng_below(r, 3)) {
    case 0:
        add_box(r, mesh, n, part);
        break;
    case 1: {
        vec3 radii = {rng_range(r, 0.45f, 1), rng_range(r, 0.45f, 1), rng_range(r, 0.45f, 1)};
        add_ellipsoid(mesh, n, radii, part);
        break;
    }
    default:
        add_cylinder(r, mesh, n, part);
    }
}

static void place_box(triangle_mesh *mesh, vec3 half, float round, vec3 at, uint8_t part)
{
    rounded_box box = {half, round * min_of(half.x, min_of(half.y, half.z))};
    uint32_t first = mesh->vertex_count;
    mat3 one = {{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
    mesh_add_cube_grid(mesh, 22, part, map_rounded_box, &box);
    mesh_transform(mesh, first, &one, at, true);
}

/* Adds a disc in the xy plane, its edge rounded and its face slightly concave. */
static void place_wheel(triangle_mesh *mesh, float radius, float width, vec3 at, uint8_t part)
{
    float hub = 0.6f * radius, points[4][2] = {{hub, -width}, {radius, -width}, {radius, width}, {hub, width}};
    lathe_profile p = {0};
    lathe_profile_add(&p, 0, -0.8f * width);
    lathe_profile_add(&p, 0.9f * hub, -0.8f * width);
    lathe_profile_add_corner(&p, points[0], points[1], points[2], 0.5f * width, 5);
    lathe_profile_add_corner(&p, points[1], points[2], points[3], 0.5f * width, 5);
    lathe_profile_add(&p, 0.9f * hub, 0.8f * width);
    lathe_profile_add(&p, 0, 0.8f * width);
    uint32_t first = mesh->vertex_count;
    mat3 on_its_side = {{{1, 0, 0}, {0, 0, -1}, {0, 1, 0}}};
    mesh_add_lathe(mesh, &p, 48, part);
    mesh_transform(mesh, first, &on_its_side, at, true);
}

/* Makes a toy car, engine or cart along x: a body, perhaps a cabin and a bonnet, four or six wheels (part 2). */
static void vehicle(rng *r, triangle_mesh *mesh, shape_traits *traits)
{
    float length = rng_range(r, 0.7f, 1), height = rng_range(r, 0.15f, 0.35f), width = rng_range(r, 0.3f, 0.5f);
    float round = rng_range(r, 0.05f, 0.9f), wheel = rng_range(r, 0.14f, 0.26f), thick = rng_range(r, 0.04f, 0.1f);
    place_box(mesh, vec3_make(length, height, width), round, vec3_make(0, 0, 0), 0);
    float cabin = rng_range(r, 0.25f, 0.6f) * length, up = rng_range(r, 0.12f, 0.3f), along = rng_range(r, -0.4f, 0.2f);
    if (rng_uniform(r) < 0.85f)
        place_box(mesh, vec3_make(cabin, up, 0.88f * width), round, vec3_make(along * length, height + 0.7f * up, 0),
                  1);
    if (rng_uniform(r) < 0.4f)
        place_box(mesh, vec3_make(0.4f * length, 0.1f, 0.7f * width), round, vec3_make(0.6f * length, height, 0), 3);
    int axles = rng_uniform(r) < 0.8f ? 2 : 3;
    for (int i = 0; i < 2 * axles; i++) {
        int axle = i / 2;
        float x = length * (1.3f * (float)axle / (float)(axles - 1) - 0.65f), side = i % 2 ? -1 : 1;
        place_wheel(mesh, wheel, thick, vec3_make(x, -0.85f * height, side * width), 2);
    }
    float dents = rng_uniform(r) < 0.4f ? rng_range(r, 0.01f, 0.06f) : 0;
    random_dents(r, mesh, 0, dents, 1, 2);
    *traits = (shape_traits){.name = "union", .upright = true, .crease_cosine = 0.75f, .parts = 4};
}

void shape_union(rng *r, triangle_mesh *mesh, shape_traits *traits)
{
    if (rng_uniform(r) < 0.1f) {
        vehicle(r, mesh, traits);
        return;
    }
    int count = 1 + rng_below(r, 9), n = (int)sqrtf(26000.0f / (12.0f * (float)count));
    n = n < 16 ? 16 : n > 42 ? 42 : n;
    vec3 place = {0, 0, 0};
    bool regular = rng_uniform(r) < 0.3f; /* axis-aligned, as manufactured objects are */
    for (int i = 0; i < count; i++) {
        uint32_t first = mesh->vertex_count;
        add_primitive(r, mesh, n, (uint8_t)i);
        if (rng_uniform(r) < 0.3f) bend_and_twist(r, mesh, first);
        float u = rng_uniform(r), amount = rng_uniform(r) < 0.2f ? 0 : 0.3f * u * u;
        random_dents(r, mesh, first, amount, 0.8f, 2.5f);
        float size = i == 0 ? 1 : rng_range(r, 0.3f, 0.85f);
        mat3 m = random_rotation(r);
        if (regular) m = (mat3){{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
        for (int k = 0; k < 3; k++)
            m.row[k] = vec3_scale(m.row[k], size);
        /* each one begins at or near the surface of those before, so that all are connected */
        float far = rng_range(r, 0.35f, 0.44f + 0.44f * size);
        vec3 away = vec3_fma(place, far, random_direction(r));
        if (i > 0) mesh_transform(mesh, first, &m, away, true);
        if (i > 0 && rng_uniform(r) < 0.3f) place = vec3_scale(away, 0.7f);
    }
    *traits = (shape_traits){.name = "union", .upright = regular, .crease_cosine = 0.75f, .parts = count};
}
