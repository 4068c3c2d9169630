/* What the solvers of solve.h share: each takes a checked problem and fills an allocated surface.
 *
 *     static status run(const pst_problem *p, pst_surface *out) { return pst_solve_ls(p, out); }
 *
 * A problem is the capture with every choice of the options made. */
#ifndef MERLIN_STEREO_SOLVE_PARTS_H
#define MERLIN_STEREO_SOLVE_PARTS_H

#include <pthread.h>
#include <stdatomic.h>

#include "stereo/solve.h"

/* Counts the fits that a solver has done, by all threads. */
typedef struct pst_effort {
    const watch *watch;
    pthread_t owner; /* the thread that began */
    atomic_size_t done;
    size_t expected;
} pst_effort;

/* Called by any thread; the owner tells. */
void pst_effort_add(pst_effort *e, size_t fits);

typedef struct pst_problem {
    const pst_capture *capture; /* of at most PST_MAX_LIGHTS pictures, but for ls */
    const pst_light *light;     /* count; intensities above 0. The capture's own unless a solver found better */
    uint32_t *pixel; /* indices of the mask's pixels, rows from the top; NULL for ls, which streams them all */
    size_t pixel_count;
    float shadow, saturation; /* shares of full scale: usable is shadow < value < saturation */
    int iterations;           /* 0: the solver's own */
    pst_effort *effort;       /* may be NULL */
} pst_problem;

/* Directions are unit already. Fewer than 3 lights, or all in a plane through the origin, are refused. */
status pst_check_directions(const pst_light *light, int count);

/* Sets pixel (malloc'ed, NULL on failure) and pixel_count, from a mask of the pictures' size. */
status pst_list_pixels(const pst_capture *c, pst_problem *p);

/* The rectangle that the pixels fill, all four inside it; of one pixel at least. */
typedef struct pst_bounds {
    int left, right, top, bottom;
} pst_bounds;
pst_bounds pst_bounds_of(const pst_problem *p);

status pst_solve_ls(const pst_problem *p, pst_surface *out);
status pst_solve_robust(const pst_problem *p, pst_surface *out);
status pst_solve_near(const pst_problem *p, pst_surface *out);
status pst_solve_semi(const pst_problem *p, pst_surface *out);
status pst_solve_uncalibrated(const pst_problem *p, pst_surface *out);

/* A symmetric 3×3 matrix (xx, xy, xz, yy, yz, zz) as L D Lᵀ, lightly damped so that a singular one gives the short
 * solution instead of infinity. By pivots, none of them less than the damping: a determinant would be lost in rounding
 * where one light alone made the matrix. */
typedef struct pst_factors {
    float yx, zx, zy; /* of L, below its diagonal of 1 */
    float x, y, z;    /* one over D */
} pst_factors;

static inline pst_factors pst_factor3(float xx, float xy, float xz, float yy, float yz, float zz)
{
    float damping = 1e-6f * (xx + yy + zz) + 1e-30f;
    pst_factors f = {.x = 1 / (xx + damping)};
    f.yx = xy * f.x;
    f.zx = xz * f.x;
    float rest = yz - f.zx * xy, second = yy - f.yx * xy;
    f.y = 1 / ((second > 0 ? second : 0) + damping);
    f.zy = rest * f.y;
    float third = zz - f.zx * xz - f.zy * rest;
    f.z = 1 / ((third > 0 ? third : 0) + damping);
    return f;
}

/* x of L D Lᵀ x = b. */
static inline vec3 pst_solve_factored(pst_factors f, vec3 b)
{
    float y = b.y - f.yx * b.x, z = (b.z - f.zx * b.x - f.zy * y) * f.z;
    y = y * f.y - f.zy * z;
    return (vec3){b.x * f.x - f.yx * y - f.zx * z, y, z};
}

static inline vec3 pst_solve3(const float m[6], vec3 b)
{
    return pst_solve_factored(pst_factor3(m[0], m[1], m[2], m[3], m[4], m[5]), b);
}

/* Adds a vᵀ, a multiple of v, to a symmetric matrix of that order. */
static inline void pst_add_outer3(float m[6], vec3 a, vec3 v)
{
    m[0] += a.x * v.x;
    m[1] += a.x * v.y;
    m[2] += a.x * v.z;
    m[3] += a.y * v.y;
    m[4] += a.y * v.z;
    m[5] += a.z * v.z;
}

/* Unit and facing the camera; (0, 0, 1) for what has no direction. */
static inline vec3 pst_facing(vec3 n)
{
    float length = vec3_length(n);
    if (!(length > 1e-20f) || !(length < 1e20f)) return vec3_make(0, 0, 1);
    n = vec3_scale(n, 1 / length);
    if (n.z < 1e-3f) n = vec3_normalize(vec3_make(n.x, n.y, 1e-3f));
    return n;
}

#endif
