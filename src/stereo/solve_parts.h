/* What the solvers of solve.h share: each takes a checked problem and fills an allocated surface.
 *
 *     static status run(const pst_problem *p, pst_surface *out) { return pst_solve_ls(p, out); }
 *
 * A problem is the capture with every choice of the options made. */
#ifndef MERLIN_STEREO_SOLVE_PARTS_H
#define MERLIN_STEREO_SOLVE_PARTS_H

#include "stereo/solve.h"

typedef struct pst_problem {
    const pst_capture *capture; /* of at most PST_MAX_LIGHTS pictures, but for ls */
    const pst_light *light;     /* count; intensities above 0. The capture's own unless a solver found better */
    uint32_t *pixel; /* indices of the mask's pixels, rows from the top; NULL for ls, which streams them all */
    size_t pixel_count;
    float shadow, saturation; /* shares of full scale: usable is shadow < value < saturation */
    int iterations;           /* 0: the solver's own */
} pst_problem;

/* Directions are unit already. Fewer than 3 lights, or all in a plane through the origin, are refused. */
status pst_check_directions(const pst_light *light, int count);

/* Sets pixel (malloc'ed, NULL on failure) and pixel_count, from a mask of the pictures' size. */
status pst_list_pixels(const pst_capture *c, pst_problem *p);

status pst_solve_ls(const pst_problem *p, pst_surface *out);
status pst_solve_robust(const pst_problem *p, pst_surface *out);
status pst_solve_near(const pst_problem *p, pst_surface *out);
status pst_solve_semi(const pst_problem *p, pst_surface *out);
status pst_solve_uncalibrated(const pst_problem *p, pst_surface *out);

/* Symmetric 3×3 (xx, xy, xz, yy, yz, zz) times x = b, lightly damped so that a singular matrix gives the short
 * solution instead of infinity. */
static inline vec3 pst_solve3(const float m[6], vec3 b)
{
    float damping = 1e-6f * (m[0] + m[3] + m[5]) + 1e-30f;
    float xx = m[0] + damping, xy = m[1], xz = m[2], yy = m[3] + damping, yz = m[4], zz = m[5] + damping;
    float c0 = yy * zz - yz * yz, c1 = xz * yz - xy * zz, c2 = xy * yz - xz * yy;
    float determinant = xx * c0 + xy * c1 + xz * c2;
    float inverse = 1 / (determinant > 1e-37f ? determinant : 1e-37f);
    return (vec3){(c0 * b.x + c1 * b.y + c2 * b.z) * inverse,
                  (c1 * b.x + (xx * zz - xz * xz) * b.y + (xy * xz - xx * yz) * b.z) * inverse,
                  (c2 * b.x + (xy * xz - xx * yz) * b.y + (xx * yy - xy * xy) * b.z) * inverse};
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
