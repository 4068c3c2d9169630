/* SPDX-License-Identifier: MIT */
/* Superellipsoids (Barr 1981) and rounded convex polyhedra, bent, twisted and dented. */
#include "base/number.h"
#include "lab/scene/shape/mesh_solids.h"
#include "lab/scene/shape/shape.h"

enum { PLANES = 24 };

typedef struct radial {
    vec3 axes;
    float exponent_side, exponent_height; /* 2: ellipsoid; large: box; 1: octahedron */
    int planes;
    vec3 plane[PLANES]; /* outward direction divided by distance */
    float sharpness;
} radial;

static float superellipsoid_radius(const radial *s, vec3 d)
{
    float side = powf(fabsf(d.x / s->axes.x), s->exponent_side) + powf(fabsf(d.z / s->axes.z), s->exponent_side);
    float all = powf(side, s->exponent_height / s->exponent_side) + powf(fabsf(d.y / s->axes.y), s->exponent_height);
    return powf(all, -1 / s->exponent_height);
}

/* Returns the polyhedron's radius; a p-norm of the distances to the planes rounds its edges. */
static float polyhedron_radius(const radial *s, vec3 d)
{
    float sum = 0;
    for (int i = 0; i < s->planes; i++)
        sum += powf(max_of(0, vec3_dot(s->plane[i], d)), s->sharpness);
    return powf(sum, -1 / s->sharpness);
}

static vec3 map_radial(const void *context, vec3 cube)
{
    const radial *s = context;
    vec3 d = vec3_normalize(vec3_make(tanf(0.7853982f * cube.x), tanf(0.7853982f * cube.y), tanf(0.7853982f * cube.z)));
    return vec3_scale(d, s->planes ? polyhedron_radius(s, d) : superellipsoid_radius(s, d));
}

static radial random_superellipsoid(rng *r)
{
    radial s = {.axes = {rng_range(r, 0.45f, 1), rng_range(r, 0.45f, 1), rng_range(r, 0.45f, 1)}};
    s.exponent_side = 0.8f * powf(12, rng_uniform(r));
    s.exponent_height = 0.8f * powf(12, rng_uniform(r));
    return s;
}

static radial random_polyhedron(rng *r)
{
    radial s = {.planes = 6 + rng_below(r, PLANES - 11), .sharpness = 6 * powf(10, rng_uniform(r))};
    for (int i = 0; i < s.planes; i++) {
        s.plane[i] = random_direction(r);
        s.plane[i] = vec3_scale(s.plane[i], 1 / rng_range(r, 0.6f, 1));
    }
    for (int k = 0; k < 6 && s.planes <= PLANES - 1; k++) { /* a cage, so that the body is closed */
        float sign = k % 2 ? -1 : 1, far = rng_range(r, 0.7f, 1.1f);
        s.plane[s.planes++] =
            vec3_make(k / 2 == 0 ? sign / far : 0, k / 2 == 1 ? sign / far : 0, k / 2 == 2 ? sign / far : 0);
    }
    return s;
}

void shape_superquadric(rng *r, triangle_mesh *mesh, shape_traits *traits)
{
    bool polyhedron = rng_uniform(r) < 0.4f;
    radial s = polyhedron ? random_polyhedron(r) : random_superellipsoid(r);
    mesh_add_cube_grid(mesh, 46, 0, map_radial, &s);
    if (rng_uniform(r) < 0.4f) bend_and_twist(r, mesh, 0);
    float u = rng_uniform(r);
    if (rng_uniform(r) < 0.55f) random_dents(r, mesh, 0, 0.2f * u * u, 0.8f, 4);
    *traits =
        (shape_traits){.name = "superquadric", .upright = rng_uniform(r) < 0.5f, .crease_cosine = 0.6f, .parts = 1};
}
