/* SPDX-License-Identifier: MIT */
/* Functions shared by several classes of shapes: rotations, ellipsoids, bending. */
#include "lab/scene/shape/shape.h"
#include "lab/scene/shape/mesh_displace.h"

#include "base/number.h"
#include "lab/scene/shape/mesh_solids.h"

mat3 random_rotation(rng *r)
{
    float u = rng_uniform(r), a = 2 * PI * rng_uniform(r), b = 2 * PI * rng_uniform(r);
    float x = sqrtf(1 - u) * sinf(a), y = sqrtf(1 - u) * cosf(a), z = sqrtf(u) * sinf(b), w = sqrtf(u) * cosf(b);
    return (mat3){{{1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)},
                   {2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)},
                   {2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)}}};
}

vec3 random_direction(rng *r)
{
    float z = rng_range(r, -1, 1), a = 2 * PI * rng_uniform(r), s = sqrtf(max_of(0, 1 - z * z));
    return vec3_make(s * cosf(a), s * sinf(a), z);
}

vec3 random_between(rng *r, float low, float high)
{
    float x = rng_range(r, low, high), y = rng_range(r, low, high), z = rng_range(r, low, high);
    return vec3_make(x, y, z);
}

void random_dents(rng *r, triangle_mesh *mesh, uint32_t first, float amount, float low, float high)
{
    float frequency = rng_range(r, low, high);
    int octaves = 1 + rng_below(r, 3);
    mesh_displace(mesh, first, amount, frequency, octaves, rng_u32(r));
}

mat3 mat3_product(const mat3 *a, const mat3 *b)
{
    mat3 m;
    for (int i = 0; i < 3; i++)
        m.row[i] = mat3_apply_transposed(b, a->row[i]);
    return m;
}

mat3 rotation_xyz(float x, float y, float z)
{
    mat3 rx = {{{1, 0, 0}, {0, cosf(x), -sinf(x)}, {0, sinf(x), cosf(x)}}};
    mat3 ry = {{{cosf(y), 0, sinf(y)}, {0, 1, 0}, {-sinf(y), 0, cosf(y)}}};
    mat3 rz = {{{cosf(z), -sinf(z), 0}, {sinf(z), cosf(z), 0}, {0, 0, 1}}};
    mat3 yx = mat3_product(&ry, &rx);
    return mat3_product(&rz, &yx);
}

static vec3 map_ellipsoid(const void *context, vec3 cube)
{
    const vec3 *radii = context;
    /* the tangent spreads the squares evenly over the sphere */
    vec3 d = vec3_make(tanf(0.7853982f * cube.x), tanf(0.7853982f * cube.y), tanf(0.7853982f * cube.z));
    return vec3_mul(vec3_normalize(d), *radii);
}

void add_ellipsoid(triangle_mesh *mesh, int n, vec3 radii, uint8_t part)
{
    mesh_add_cube_grid(mesh, n, part, map_ellipsoid, &radii);
}

void bend_and_twist(rng *r, triangle_mesh *mesh, uint32_t first)
{
    float twist = rng_uniform(r) < 0.4f ? rng_normal(r) * 0.7f : 0,
          bend = rng_uniform(r) < 0.5f ? rng_normal(r) * 0.5f : 0;
    float taper = rng_uniform(r) < 0.4f ? rng_range(r, -0.35f, 0.35f) : 0;
    for (uint32_t i = first; i < mesh->vertex_count; i++) {
        vec3 p = mesh->position[i];
        float scale = max_of(0.3f, 1 - taper * p.y), a = twist * p.y;
        p = vec3_make(scale * (p.x * cosf(a) - p.z * sinf(a)), p.y, scale * (p.x * sinf(a) + p.z * cosf(a)));
        if (fabsf(bend) > 1e-3f) {
            /* the y axis becomes an arc of this curvature; beyond 0.8 it would fold onto itself */
            float k = clamp(bend, -0.8f, 0.8f), angle = k * p.y, radius = 1 / k - p.x;
            p = vec3_make(1 / k - radius * cosf(angle), radius * sinf(angle), p.z);
        }
        mesh->position[i] = p;
    }
}
