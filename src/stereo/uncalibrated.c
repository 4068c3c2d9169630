/* Distant lights of unknown direction.
 *
 * 1. The matrix of values is factored into lights and surface by its singular vectors (H. Hayakawa, Photometric stereo
 *    under a light source with arbitrary motion, JOSA A 11(11), 1994), which leaves an unknown 3×3 matrix between them;
 *    the factors are then refitted by robust weights, because shadows and highlights are not of rank three.
 * 2. Normals of a surface are integrable: what is left is the generalized bas-relief ambiguity (A. Yuille, D. Snow,
 *    Shape and albedo from multiple images using integrability, CVPR 1997; Belhumeur et al. 1999).
 * 3. Prior: all lights are equally strong. It fixes the bas-relief ambiguity but for a sign, convex or concave; the
 *    object is taken to be convex: near its outline it faces outward.
 * 4. With the lights found, the robust solver does the rest. */
#include <lapacke.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "stereo/field_fit.h"
#include "stereo/pixel_fit.h"
#include "stereo/samples.h"

enum { SAMPLE = 1500, REFITS = 8, PASSES = 4, NEWTON_STEPS = 30 };

typedef struct lights3 {
    int count;
    float *x, *y, *z; /* padded */
} lights3;

/* A surface up to a 3×3 matrix, and where its pixels are. */
typedef struct pseudo {
    const pst_problem *problem;
    vec3 *b;       /* a pixel of the problem */
    int32_t *slot; /* picture position to that, -1 outside the mask */
} pseudo;

/* row-major m times v */
static vec3 transform(const double m[9], vec3 v)
{
    return vec3_make((float)(m[0] * v.x + m[1] * v.y + m[2] * v.z), (float)(m[3] * v.x + m[4] * v.y + m[5] * v.z),
                     (float)(m[6] * v.x + m[7] * v.y + m[8] * v.z));
}

static vec3 cross(const double a[3], const double b[3], double out[3])
{
    out[0] = a[1] * b[2] - a[2] * b[1];
    out[1] = a[2] * b[0] - a[0] * b[2];
    out[2] = a[0] * b[1] - a[1] * b[0];
    return vec3_make((float)out[0], (float)out[1], (float)out[2]);
}

/* Each light from the surface, by the surface's weights. */
static void refit_lights(const pst_samples *m, lights3 *l)
{
    for (int k = 0; k < l->count; k++) {
        float a[6] = {0};
        vec3 right = {0, 0, 0};
        for (size_t i = 0; i < m->count; i++) {
            /* of equal weight whatever the albedo */
            vec3 b = m->b[i];
            float w = m->weight[i * m->padded + (size_t)k] / fmaxf(vec3_dot(b, b), 1e-12f);
            a[0] += w * b.x * b.x;
            a[1] += w * b.x * b.y;
            a[2] += w * b.x * b.z;
            a[3] += w * b.y * b.y;
            a[4] += w * b.y * b.z;
            a[5] += w * b.z * b.z;
            right = vec3_fma(right, w * m->value[i * m->padded + (size_t)k], b);
        }
        vec3 found = pst_solve3(a, right);
        l->x[k] = found.x;
        l->y[k] = found.y;
        l->z[k] = found.z;
    }
}

static status factor(const pst_problem *p, lights3 *l)
{
    pst_samples m;
    status s = pst_samples_new(p, SAMPLE, &m);
    if (s != OK) return s;
    double *basis = calloc((size_t)l->count * 3, sizeof *basis), mean[3] = {0};
    size_t lit = 0;
    s = basis ? pst_samples_basis(&m, basis, &lit) : fail(ERROR_MEMORY, "no memory for %d lights", l->count);
    for (int k = 0; s == OK && k < 3 * l->count; k++)
        mean[k % 3] += basis[k] * basis[k] / l->count;
    for (int k = 0; s == OK && k < l->count; k++) {
        /* white: the robust fit's widths are shares of |b|, which must mean the same in all directions */
        l->x[k] = (float)(basis[3 * k] / sqrt(3 * mean[0]));
        l->y[k] = (float)(basis[3 * k + 1] / sqrt(3 * mean[1]));
        l->z[k] = (float)(basis[3 * k + 2] / sqrt(3 * mean[2]));
    }
    for (int k = 0; s == OK && k < REFITS; k++) {
        pst_samples_fit(&m, l->x, l->y, l->z);
        refit_lights(&m, l);
    }
    free(basis);
    pst_samples_free(&m);
    return s;
}

/* One pixel's equation: b3 ∂y b1 − b1 ∂y b3 = b3 ∂x b2 − b2 ∂x b3 for b = A b', linear in the six minors of A. */
static bool integrability_row(const pseudo *f, size_t at, double row[6])
{
    int width = f->problem->capture->width, height = f->problem->capture->height;
    int x = (int)(at % (size_t)width), y = (int)(at / (size_t)width);
    if (x < 1 || y < 1 || x + 1 >= width || y + 1 >= height) return false;
    const int32_t *slot = f->slot + at;
    if (slot[-1] < 0 || slot[1] < 0 || slot[-width] < 0 || slot[width] < 0) return false;
    vec3 b = f->b[slot[0]], dx = vec3_sub(f->b[slot[1]], f->b[slot[-1]]);
    vec3 dy = vec3_sub(f->b[slot[-width]], f->b[slot[width]]);
    float scale = vec3_dot(b, b);
    if (!(scale > 0)) return false;
    vec3 by_y = vec3_scale(vec3_cross(b, dy), 1 / scale), by_x = vec3_scale(vec3_cross(b, dx), -1 / scale);
    memcpy(row, &(double[6]){by_y.x, by_y.y, by_y.z, by_x.x, by_x.y, by_x.z}, 6 * sizeof *row);
    return true;
}

/* The minors (A3 × A1, A3 × A2) by iteratively reweighted least squares (Cauchy's loss): the equation fails across
 * depth jumps. */
static status minors(const pseudo *f, double minor[6])
{
    const pst_problem *p = f->problem;
    double scale = HUGE_VAL, row[6];
    memset(minor, 0, 6 * sizeof *minor);
    for (int pass = 0; pass < PASSES; pass++) {
        double a[36] = {0}, eigenvalue[6], absolute = 0;
        size_t count = 0;
        for (size_t i = 0; i < p->pixel_count; i++) {
            if (!integrability_row(f, p->pixel[i], row)) continue;
            double r = 0;
            for (int j = 0; j < 6; j++)
                r += row[j] * minor[j];
            double w = 1 / (1 + r * r / (scale * scale));
            for (int j = 0; j < 36; j++)
                a[j] += w * row[j / 6] * row[j % 6];
            count++;
        }
        if (count < 100) return fail(ERROR_INPUT, "the mask is too thin to solve without known lights");
        if (LAPACKE_dsyev(LAPACK_ROW_MAJOR, 'V', 'U', 6, a, 6, eigenvalue) != 0 || !(eigenvalue[1] > 0))
            return fail(ERROR_INPUT, "the surface is too flat to solve without known lights");
        for (int j = 0; j < 6; j++)
            minor[j] = a[6 * j];
        for (size_t i = 0; i < p->pixel_count; i++) {
            if (!integrability_row(f, p->pixel[i], row)) continue;
            double r = 0;
            for (int j = 0; j < 6; j++)
                r += row[j] * minor[j];
            absolute += fabs(r);
        }
        scale = fmax(absolute / (double)count, 1e-12);
    }
    return OK;
}

/* A, up to a bas-relief transformation, from c = A3 × A1 and d = A3 × A2: A3 is normal to both. */
static status matrix_of(const double minor[6], double a[9])
{
    double unit[3], length;
    cross(minor, minor + 3, unit);
    length = sqrt(unit[0] * unit[0] + unit[1] * unit[1] + unit[2] * unit[2]);
    if (!(length > 1e-12)) return fail(ERROR_INPUT, "the surface is too flat to solve without known lights");
    for (int j = 0; j < 3; j++)
        a[6 + j] = unit[j] / length;
    cross(minor, a + 6, a);
    cross(minor + 3, a + 6, a + 3);
    return OK;
}

static double strength(const double g[3], vec3 l)
{
    double z = g[0] * l.x + g[1] * l.y + g[2] * l.z;
    return log((double)l.x * l.x + (double)l.y * l.y + z * z + 1e-30);
}

/* Spread of the lights' strengths under the bas-relief transformation of last row g. */
static double spread(const double g[3], const lights3 *l, double *mean)
{
    double sum = 0, square = 0;
    for (int k = 0; k < l->count; k++) {
        double v = strength(g, vec3_make(l->x[k], l->y[k], l->z[k]));
        sum += v;
        square += v * v;
    }
    *mean = sum / l->count;
    return square / l->count - *mean * *mean;
}

/* x² + y² + (g·l)² = k is lᵀ Q l = 1 with Q = (diag(1, 1, 0) + g gᵀ) / k, linear in the six numbers of Q; flat relief
 * where no g of that form exists. */
static status linear_relief(const lights3 *l, double g[3])
{
    int n = l->count;
    double *a = calloc((size_t)n * 7, sizeof *a);
    if (!a) return fail(ERROR_MEMORY, "no memory for %d lights", n);
    double *q = a + 6 * n; /* the right-hand side first, xx xy xz yy yz zz then */
    for (int k = 0; k < n; k++) {
        double x = l->x[k], y = l->y[k], z = l->z[k];
        memcpy(a + 6 * k, &(double[6]){x * x, 2 * x * y, 2 * x * z, y * y, 2 * y * z, z * z}, 6 * sizeof *a);
        q[k] = 1;
    }
    memcpy(g, &(double[3]){0, 0, 1}, 3 * sizeof *g);
    lapack_int info = LAPACKE_dgels(LAPACK_ROW_MAJOR, 'N', n, 6, 1, a, 6, q, 1);
    if (info == 0 && q[5] > 0) {
        double inverse = (q[0] - q[2] * q[2] / q[5] + q[3] - q[4] * q[4] / q[5]) / 2;
        if (inverse > 0) {
            g[2] = sqrt(q[5] / inverse);
            g[0] = q[2] / q[5] * g[2];
            g[1] = q[4] / q[5] * g[2];
        }
    }
    free(a);
    return OK;
}

/* Gauss-Newton on the logarithms of the strengths, each step halved until it helps. */
static void refine_relief(const lights3 *l, double g[3])
{
    double mean, best = spread(g, l, &mean);
    for (int step = 0; step < NEWTON_STEPS; step++) {
        float a[6] = {0};
        vec3 right = {0, 0, 0};
        for (int k = 0; k < l->count; k++) {
            vec3 v = vec3_make(l->x[k], l->y[k], l->z[k]);
            double z = g[0] * v.x + g[1] * v.y + g[2] * v.z, log_strength = strength(g, v);
            vec3 slope = vec3_scale(v, (float)(2 * z / exp(log_strength)));
            a[0] += slope.x * slope.x;
            a[1] += slope.x * slope.y;
            a[2] += slope.x * slope.z;
            a[3] += slope.y * slope.y;
            a[4] += slope.y * slope.z;
            a[5] += slope.z * slope.z;
            right = vec3_fma(right, (float)(mean - log_strength), slope);
        }
        vec3 move = pst_solve3(a, right);
        bool better = false;
        for (double share = 1; !better && share > 0.01; share /= 2) {
            double trial[3] = {g[0] + share * move.x, g[1] + share * move.y, g[2] + share * move.z}, trial_mean;
            double value = spread(trial, l, &trial_mean);
            better = value < best;
            if (!better) continue;
            best = value;
            mean = trial_mean;
            memcpy(g, trial, sizeof trial);
        }
        if (!better) return;
    }
}

/* Positive if the surface faces outward on the whole, seen from the mask's middle. */
static double outwardness(const pseudo *f, const double surface[9], double *toward)
{
    const pst_problem *p = f->problem;
    size_t width = (size_t)p->capture->width;
    double cx = 0, cy = 0, sum = 0;
    for (size_t i = 0; i < p->pixel_count; i++) {
        size_t column = p->pixel[i] % width, row = p->pixel[i] / width;
        cx += (double)column / (double)p->pixel_count;
        cy += (double)row / (double)p->pixel_count;
    }
    *toward = 0;
    for (size_t i = 0; i < p->pixel_count; i++) {
        vec3 n = vec3_normalize(transform(surface, f->b[i]));
        size_t column = p->pixel[i] % width, row = p->pixel[i] / width;
        sum += n.x * ((double)column - cx) - n.y * ((double)row - cy);
        *toward += n.z;
    }
    return sum;
}

/* The pseudo lights become directions: l = G A^-T l', b = G^-T A b'. */
static status resolve(const pseudo *f, lights3 *l)
{
    double minor[6], a[9] = {0}, g[3], cofactor[9], toward;
    status s = minors(f, minor);
    if (s == OK) s = matrix_of(minor, a);
    if (s != OK) return s;
    cross(a + 3, a + 6, cofactor);
    cross(a + 6, a, cofactor + 3);
    cross(a, a + 3, cofactor + 6);
    double determinant = a[0] * cofactor[0] + a[1] * cofactor[1] + a[2] * cofactor[2];
    for (int j = 0; j < 9; j++)
        cofactor[j] /= determinant;
    for (int k = 0; k < l->count; k++) {
        vec3 v = transform(cofactor, vec3_make(l->x[k], l->y[k], l->z[k]));
        l->x[k] = v.x;
        l->y[k] = v.y;
        l->z[k] = v.z;
    }
    s = linear_relief(l, g);
    if (s != OK) return s;
    refine_relief(l, g);
    if (!(fabs(g[2]) > 1e-6)) return fail(ERROR_INPUT, "the bas-relief ambiguity cannot be resolved from these lights");
    double surface[9];
    for (int j = 0; j < 3; j++) {
        surface[6 + j] = a[6 + j] / g[2];
        surface[j] = a[j] - g[0] * surface[6 + j];
        surface[3 + j] = a[3 + j] - g[1] * surface[6 + j];
    }
    double outward = outwardness(f, surface, &toward);
    float z_sign = toward < 0 ? -1 : 1, xy_sign = outward < 0 ? -1 : 1;
    for (int k = 0; k < l->count; k++) {
        vec3 v = vec3_make(l->x[k], l->y[k], l->z[k]);
        l->z[k] = z_sign * (float)(g[0] * v.x + g[1] * v.y + g[2] * v.z);
        l->x[k] = xy_sign * v.x;
        l->y[k] = xy_sign * v.y;
    }
    return OK;
}

/* The surface under the pseudo lights, at every pixel. */
static status pseudo_surface(const pst_problem *p, const lights3 *l, pseudo *f)
{
    size_t size = (size_t)p->capture->width * (size_t)p->capture->height;
    f->problem = p;
    f->b = malloc(p->pixel_count * sizeof *f->b);
    f->slot = malloc(size * sizeof *f->slot);
    pst_light *light = malloc((size_t)l->count * sizeof *light);
    status s = f->b && f->slot && light ? OK : fail(ERROR_MEMORY, "no memory for %zu pixels", p->pixel_count);
    if (s == OK) {
        memset(f->slot, 0xff, size * sizeof *f->slot);
        for (size_t i = 0; i < p->pixel_count; i++)
            f->slot[p->pixel[i]] = (int32_t)i;
        for (int k = 0; k < l->count; k++) {
            light[k] = p->light[k];
            light[k].direction = vec3_make(l->x[k], l->y[k], l->z[k]);
        }
        pst_problem under = *p;
        under.light = light;
        double cost;
        s = pst_field_fit(&(pst_field){.problem = &under, .pixel = p->pixel, .count = p->pixel_count, .b = f->b},
                          &cost);
    }
    free(light);
    return s;
}

static status name_lights(const pst_problem *p, const lights3 *l, pst_surface *out)
{
    double mean = 0;
    out->light = malloc((size_t)l->count * sizeof *out->light);
    if (!out->light) return fail(ERROR_MEMORY, "no memory for %d lights", l->count);
    for (int k = 0; k < l->count; k++)
        mean += vec3_length(vec3_make(l->x[k], l->y[k], l->z[k])) / l->count;
    for (int k = 0; k < l->count; k++) {
        vec3 v = vec3_make(l->x[k], l->y[k], l->z[k]);
        out->light[k] = p->light[k];
        out->light[k].direction = vec3_normalize(v);
        for (int ch = 0; ch < 3; ch++)
            out->light[k].intensity[ch] *= fmaxf(vec3_length(v) / (float)mean, 1e-6f);
    }
    return pst_check_directions(out->light, l->count);
}

status pst_solve_uncalibrated(const pst_problem *p, pst_surface *out)
{
    int count = p->capture->count;
    if (count < 7) return fail(ERROR_INPUT, "unknown lights need 7 or more pictures, not %d", count);
    size_t padded = (size_t)pst_padded(count);
    pseudo f = {0};
    lights3 l = {.count = count, .x = calloc(3 * padded, sizeof(float))};
    if (!l.x) return fail(ERROR_MEMORY, "no memory for %d lights", count);
    l.y = l.x + padded;
    l.z = l.y + padded;
    status s = factor(p, &l);
    if (s == OK) s = pseudo_surface(p, &l, &f);
    if (s == OK) s = resolve(&f, &l);
    if (s == OK) s = name_lights(p, &l, out);
    free(l.x);
    free(f.b);
    free(f.slot);
    pst_problem found = *p;
    found.light = out->light;
    return s == OK ? pst_solve_robust(&found, out) : s;
}
