/* Distant lights of unknown direction.
 *
 * 1. The matrix of values is factored into lights and surface by its singular vectors, highlights cut off; the factors
 *    are then refitted by robust weights, because shadows and highlights are not of rank three. An unknown 3×3 matrix
 *    is left between the factors.
 * 2. Prior: most lights are equally strong or, where that cannot be or the other is so far more exactly, most of the
 *    surface has one albedo. It leaves a rotation or reflection (unit_quadric.h).
 * 3. Normals of a surface are integrable (A. Yuille, D. Snow, Shape and albedo from multiple images using
 *    integrability, CVPR 1997): that fixes the rotation, searched for among those that leave the lights' mean on the
 *    camera's side, but for a sign, convex or concave. Noise bends it: on photographs it is 20 to 40 degrees off. So
 *    the worse the best rotation is, the more counts a second prior: the object is like a balloon of its outline. That
 *    tells the sign, too.
 * 4. With the lights found, their strengths among them, the robust solver does the rest. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "stereo/field_fit.h"
#include "stereo/pixel_fit.h"
#include "stereo/samples.h"
#include "stereo/uncalibrated_parts.h"
#include "stereo/unit_quadric.h"

enum { SAMPLE = 1500, REFITS = 30, PASSES = 5, GRID = 12, FEWEST = 100 };

/* Lights whose strengths differ by more are not meant to be equal, nor are those that do so this many times more than
 * the surface's albedos: noise alone has albedos differ three times more, one albedo under lights that differ, half as
 * much or less. */
static const double uneven = 0.07, plainly = 2;
/* Cosine between the lights' mean and the camera's axis, at least: lights from the side do not show an object. */
#define FRONTAL 0.8
/* What a surface costs that is nothing like the balloon, in costs of the most integrable one. */
static const double balloon_weight = 20;

typedef struct lights3 {
    int count;
    float *x, *y, *z; /* padded */
} lights3;

/* A surface up to a 3×3 matrix, and where its pixels are. */
typedef struct pseudo {
    const pst_problem *problem;
    const img *balloon;
    vec3 *b;       /* a pixel of the problem */
    int32_t *slot; /* picture position to that, -1 outside the mask */
} pseudo;

/* row-major m times v */
static vec3 transform(const double m[9], vec3 v)
{
    return vec3_make((float)(m[0] * v.x + m[1] * v.y + m[2] * v.z), (float)(m[3] * v.x + m[4] * v.y + m[5] * v.z),
                     (float)(m[6] * v.x + m[7] * v.y + m[8] * v.z));
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
            pst_add_outer3(a, vec3_scale(b, w), b);
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
    if (!(scale > 0) || !isfinite(scale)) return false;
    vec3 by_y = vec3_scale(vec3_cross(b, dy), 1 / scale), by_x = vec3_scale(vec3_cross(b, dx), -1 / scale);
    memcpy(row, &(double[6]){by_y.x, by_y.y, by_y.z, by_x.x, by_x.y, by_x.z}, 6 * sizeof *row);
    return true;
}

static double row_length(const double row[6])
{
    double square = 0;
    for (int j = 0; j < 6; j++)
        square += row[j] * row[j];
    return sqrt(square);
}

static status too_thin(void)
{
    return fail(ERROR_INPUT, "the mask is too thin to solve without known lights");
}

/* The equations' 6×6 quadratic form by iteratively reweighted least squares (Cauchy's loss: the equation fails across
 * depth jumps, and where the surface turns most), for the minors (A3 × A1, A3 × A2) of the last pass. */
static status integrability_form(const pseudo *f, const double minor[6], double *scale, double form[36])
{
    const pst_problem *p = f->problem;
    double row[6], absolute = 0, lengths = 0, length;
    size_t count = 0;
    memset(form, 0, 36 * sizeof *form);
    for (size_t i = 0; i < p->pixel_count; i++) {
        if (!integrability_row(f, p->pixel[i], row)) continue;
        lengths += row_length(row);
        count++;
    }
    if (count < FEWEST) return too_thin();
    length = fmax(lengths / (double)count, 1e-12);
    for (size_t i = 0; i < p->pixel_count; i++) {
        if (!integrability_row(f, p->pixel[i], row)) continue;
        double r = 0;
        for (int j = 0; j < 6; j++)
            r += row[j] * minor[j];
        double steep = row_length(row) / length, w = 1 / ((1 + r * r / (*scale * *scale)) * (1 + steep * steep));
        for (int j = 0; j < 36; j++)
            form[j] += w * row[j / 6] * row[j % 6];
        absolute += fabs(r);
    }
    *scale = fmax(absolute / (double)count, 1e-12);
    return OK;
}

/* Rotation matrix of a rotation vector times a, row-major. */
static void turned(const double turn[3], const double a[9], double out[9])
{
    double angle = sqrt(turn[0] * turn[0] + turn[1] * turn[1] + turn[2] * turn[2]), s = sin(angle), c = cos(angle);
    double u[3] = {1, 0, 0}, r[9];
    for (int j = 0; angle > 1e-12 && j < 3; j++)
        u[j] = turn[j] / angle;
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++)
            r[3 * i + j] = u[i] * u[j] * (1 - c) + (i == j ? c : 0);
    r[1] -= s * u[2];
    r[3] += s * u[2];
    r[2] += s * u[1];
    r[6] -= s * u[1];
    r[5] -= s * u[0];
    r[7] += s * u[0];
    for (int i = 0; i < 9; i++)
        out[i] = r[i / 3 * 3] * a[i % 3] + r[i / 3 * 3 + 1] * a[3 + i % 3] + r[i / 3 * 3 + 2] * a[6 + i % 3];
}

/* A rotation's minors: A3 × A1 = A2, A3 × A2 = −A1. */
static void minors_of(const double a[9], double minor[6])
{
    for (int j = 0; j < 3; j++) {
        minor[j] = a[3 + j];
        minor[3 + j] = -a[j];
    }
}

static double form_at(const double form[36], const double a[9])
{
    double minor[6], sum = 0;
    minors_of(a, minor);
    for (int j = 0; j < 36; j++)
        sum += form[j] * minor[j / 6] * minor[j % 6];
    return sum;
}

/* What rotations cost. */
typedef struct rotation_cost {
    double form[36];   /* integrability's */
    double balloon[9]; /* mean of the balloon's unit normals times the surface's, transposed */
    double pull;       /* of the balloon */
} rotation_cost;

/* How much a is like the balloon to the side and toward the camera; below 0: its mirror image is. */
static void liken(const rotation_cost *c, const double a[9], double *aside, double *toward)
{
    *aside = *toward = 0;
    for (int j = 0; j < 6; j++)
        *aside += a[j] * c->balloon[j];
    for (int j = 6; j < 9; j++)
        *toward += a[j] * c->balloon[j];
}

/* Whichever of its four mirror images is most like the balloon. */
static double cost_at(const rotation_cost *c, const double a[9])
{
    double aside, toward;
    liken(c, a, &aside, &toward);
    return form_at(c->form, a) + c->pull * (1 - fabs(aside) - fabs(toward));
}

/* To that image. */
static void mirror(const rotation_cost *c, double a[9])
{
    double aside, toward;
    liken(c, a, &aside, &toward);
    for (int j = 0; j < 9; j++)
        a[j] *= (j < 6 ? aside : toward) < 0 ? -1 : 1;
}

/* Downhill from a by turns about the axes that are halved when none helps. */
static void descend(const rotation_cost *c, double reach, double a[9])
{
    double best = cost_at(c, a), trial[9];
    while (reach > 1e-4) {
        bool better = false;
        for (int k = 0; k < 6; k++) {
            double turn[3] = {0};
            turn[k / 2] = k % 2 ? reach : -reach;
            turned(turn, a, trial);
            double value = cost_at(c, trial);
            if (!(value < best)) continue;
            best = value;
            better = true;
            memcpy(a, trial, sizeof trial);
        }
        if (!better) reach /= 2;
    }
}

static vec3 mean_light(const lights3 *l)
{
    vec3 sum = {0, 0, 0};
    for (int k = 0; k < l->count; k++)
        sum = vec3_add(sum, vec3_make(l->x[k], l->y[k], l->z[k]));
    return vec3_normalize(sum);
}

static void compare_with_balloon(const pseudo *f, double products[9])
{
    const pst_problem *p = f->problem;
    for (size_t i = 0; i < p->pixel_count; i++) {
        vec3 b = f->b[i];
        double length = (double)vec3_length(b);
        if (!(length > 0) || !isfinite(length)) continue;
        const float *n = f->balloon->data + 3 * (size_t)p->pixel[i];
        const double unit[3] = {b.x / length, b.y / length, b.z / length};
        for (int j = 0; j < 9; j++)
            products[j] += (double)n[j / 3] * unit[j % 3] / (double)p->pixel_count;
    }
}

/* Of grid point k, counted along three turns. */
static void grid_rotation(int k, double out[9])
{
    static const double identity[9] = {1, 0, 0, 0, 1, 0, 0, 0, 1};
    const double step = 6.283185307 / GRID;
    const int index[3] = {k % GRID, k / GRID % GRID, k / GRID / GRID};
    const double about_z[3] = {0, 0, step * index[0]}, about_x[3] = {step * index[1], 0, 0};
    const double last[3] = {0, 0, step * index[2]};
    double once[9], tilted[9];
    turned(about_z, identity, once);
    turned(about_x, once, tilted);
    turned(last, tilted, out);
}

/* Whether it leaves the lights' mean on the camera's side. */
static bool is_frontal(const double a[9], vec3 mean)
{
    return fabs((double)transform(a, mean).z) >= FRONTAL;
}

/* The best of those that are frontal, downhill from every point of a grid: a ball's cap is almost as integrable if it
 * is turned into a saddle, and what is between the two is less than what the grid's own points are off. */
static status search(const rotation_cost *c, vec3 mean, double a[9])
{
    double best = HUGE_VAL;
    for (int k = 0; k < GRID * GRID * GRID; k++) {
        double from[9], trial[9];
        grid_rotation(k, from);
        if (!is_frontal(from, mean)) continue;
        memcpy(trial, from, sizeof trial);
        descend(c, 0.3, trial);
        const double *found = is_frontal(trial, mean) ? trial : from;
        double value = cost_at(c, found);
        if (!(value < best)) continue;
        best = value;
        memcpy(a, found, sizeof trial);
    }
    return best < HUGE_VAL ? OK : fail(ERROR_INPUT, "the pictures do not tell where the lights are");
}

static double trace(const double form[36])
{
    double sum = 0;
    for (int j = 0; j < 6; j++)
        sum += form[7 * j];
    return sum;
}

/* Of the rotations near one of these minors; share: the pull, in traces of the form. */
static status weigh(const pseudo *f, const double minor[6], double share, double *scale, rotation_cost *c)
{
    status s = integrability_form(f, minor, scale, c->form);
    c->pull = share * trace(c->form);
    return s;
}

/* The best rotation. */
static status rotate_by(const pseudo *f, vec3 mean, double share, rotation_cost *c, double a[9])
{
    double minor[6] = {0}, scale = HUGE_VAL;
    status s = weigh(f, minor, share, &scale, c);
    if (s == OK) s = search(c, mean, a);
    for (int pass = 0; s == OK && pass < PASSES; pass++) {
        descend(c, pass == 0 ? 0.3 : 0.05, a);
        minors_of(a, minor);
        s = weigh(f, minor, share, &scale, c);
    }
    return s;
}

/* The share of the surface that faces the other way than the whole. */
static double share_away(const pseudo *f, const double a[9])
{
    size_t count = f->problem->pixel_count, away = 0;
    double sum = 0;
    for (size_t i = 0; i < count; i++) {
        double z = (double)transform(a, f->b[i]).z;
        sum += z / fmax((double)vec3_length(f->b[i]), 1e-12);
        away += z < 0;
    }
    return (double)(sum < 0 ? count - away : away) / (double)count;
}

/* By integrability alone, which says how far it can be trusted; then with the balloon. */
static status rotate(const pseudo *f, const lights3 *l, double a[9], bool *by_outline)
{
    rotation_cost c = {.pull = 0};
    vec3 mean = mean_light(l);
    status s = rotate_by(f, mean, 0, &c, a);
    if (s != OK) return s;
    *by_outline = share_away(f, a) > PST_MOST_AWAY;
    double least = form_at(c.form, a) / fmax(trace(c.form), 1e-300);
    compare_with_balloon(f, c.balloon);
    s = rotate_by(f, mean, balloon_weight * least, &c, a);
    if (s == OK) mirror(&c, a);
    return s;
}

static void transform_lights(const double m[9], lights3 *l)
{
    for (int k = 0; k < l->count; k++) {
        vec3 v = transform(m, vec3_make(l->x[k], l->y[k], l->z[k]));
        l->x[k] = v.x;
        l->y[k] = v.y;
        l->z[k] = v.z;
    }
}

/* Lights become equally strong or, if they cannot or the surface is plainly of one albedo, that does; up to a
 * rotation. */
static status straighten(pseudo *f, lights3 *l)
{
    unit_quadric strength, albedo;
    size_t n = f->problem->pixel_count;
    vec3 *light = malloc((size_t)l->count * sizeof *light);
    if (!light) return fail(ERROR_MEMORY, "no memory for %d lights", l->count);
    for (int k = 0; k < l->count; k++)
        light[k] = vec3_make(l->x[k], l->y[k], l->z[k]);
    status s = unit_quadric_fit(light, (size_t)l->count, &strength);
    free(light);
    if (s != OK) return s;
    double albedos = unit_quadric_fit(f->b, n, &albedo) == OK ? albedo.spread : HUGE_VAL;
    bool by_albedo = strength.spread > fmin(uneven, plainly * albedos);
    if (by_albedo && albedos > strength.spread)
        return fail(ERROR_INPUT,
                    "the lights are not equally strong, nor is the surface of one albedo: where the lights "
                    "are cannot be told; state their intensities in light_intensities.txt");
    transform_lights(by_albedo ? albedo.dual : strength.make, l);
    for (size_t i = 0; i < n; i++)
        f->b[i] = transform(by_albedo ? albedo.make : strength.dual, f->b[i]);
    return OK;
}

/* The pseudo lights become directions. */
static status resolve(pseudo *f, lights3 *l, bool *by_outline)
{
    double a[9];
    status s = straighten(f, l);
    if (s == OK) s = rotate(f, l, a, by_outline);
    if (s == OK) transform_lights(a, l);
    return s;
}

/* The surface under the pseudo lights, at every pixel. */
static status pseudo_surface(const pst_problem *p, const lights3 *l, pseudo *f)
{
    pst_field field = {.problem = p, .pixel = p->pixel, .count = p->pixel_count};
    f->problem = p;
    f->b = field.b = malloc(p->pixel_count * sizeof *f->b);
    f->slot = pst_field_slots(&field);
    pst_light *light = malloc((size_t)l->count * sizeof *light);
    status s = f->b && f->slot && light ? OK : fail(ERROR_MEMORY, "no memory for %zu pixels", p->pixel_count);
    if (s == OK) {
        for (int k = 0; k < l->count; k++) {
            light[k] = p->light[k];
            light[k].direction = vec3_make(l->x[k], l->y[k], l->z[k]);
        }
        pst_problem under = *p;
        under.light = light;
        field.problem = &under;
        double cost;
        s = pst_field_fit(&field, &cost);
    }
    free(light);
    return s;
}

static status name_lights(const pst_problem *p, const lights3 *l, pst_light *light)
{
    double mean = 0;
    for (int k = 0; k < l->count; k++)
        mean += vec3_length(vec3_make(l->x[k], l->y[k], l->z[k])) / l->count;
    for (int k = 0; k < l->count; k++) {
        vec3 v = vec3_make(l->x[k], l->y[k], l->z[k]);
        light[k] = p->light[k];
        light[k].direction = vec3_normalize(v);
        for (int ch = 0; ch < 3; ch++)
            light[k].intensity[ch] *= fmaxf(vec3_length(v) / (float)mean, 1e-6f);
    }
    return pst_check_directions(light, l->count);
}

status pst_find_distant_lights(const pst_problem *p, const img *balloon, pst_light *light, bool *by_outline)
{
    if (p->pixel_count < FEWEST) return too_thin();
    int count = p->capture->count;
    size_t padded = (size_t)pst_padded(count);
    pseudo f = {.balloon = balloon};
    lights3 l = {.count = count, .x = calloc(3 * padded, sizeof(float))};
    if (!l.x) return fail(ERROR_MEMORY, "no memory for %d lights", count);
    l.y = l.x + padded;
    l.z = l.y + padded;
    status s = factor(p, &l);
    if (s == OK) s = pseudo_surface(p, &l, &f);
    if (s == OK) s = resolve(&f, &l, by_outline);
    if (s == OK) s = name_lights(p, &l, light);
    free(l.x);
    free(f.b);
    free(f.slot);
    return s;
}
