/* SPDX-License-Identifier: MIT */
#include "stereo/uncalibrated/integrable.h"

#include <math.h>
#include <string.h>

#include "image/resize.h"

enum { PASSES = 5, GRID = 12 };

/* Least cosine between the lights' mean and the camera's axis, as lights from the side do not show an object. */
#define FRONTAL 0.8
/* Weight of the difference from the inflated outline, in units of the most integrable surface's cost
 * (docs/notes/unknown_lights.md states its effect, and how the constants below were measured). */
static const double inflated_weight = 30;
/* Radius of averaging as a share of an object's width (the square root of its pixels), and in pixels at least. Rendered
 * objects of 64 pixels with noise of 1 % have errors of 20 degrees without it and 14 with it, without noise 7 in both
 * cases; twice the radius is no better. */
static const double averaged = 1.0 / 96;
enum { LEAST_AVERAGED = 2 };
/* Limit of the cost at the best rotation as a share of the integrability form's trace: above it rendered objects had
 * errors of 20 to 46 degrees, below 0.05 nearly all had less than 15. */
static const double not_integrable = 0.08;
/* Limit of the correlation of the normals' sideways components with those of the inflated outline, below which the sign
 * is random: bumps on a plane have 0.02, objects 0.5 to 1. */
static const double unlike = 0.4;

/* Limit in degrees of the difference between the rotations without and with the inflated outline: of 69 rendered and
 * real captures with errors below 10 degrees two had more or had another warning, of 19 with 15 or more four had
 * neither. */
static const double far_apart = 22;

/* Computes one pixel's equation: b3 ∂y b1 − b1 ∂y b3 = b3 ∂x b2 − b2 ∂x b3 for b = A b', linear in the six minors of A.
 */
static bool integrability_row(const pst_pseudo *f, size_t at, double row[6])
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

status pst_too_thin(void)
{
    return fail(MERLIN_BAD_INPUT, "the mask is too thin to solve without known lights");
}

/* Computes the equations' 6×6 quadratic form by iteratively reweighted least squares (Cauchy's loss, as the equation
 * fails across depth jumps, and where the surface curves most), with the minors (A3 × A1, A3 × A2) of the previous
 * pass. */
static status integrability_form(const pst_pseudo *f, const double minor[6], double *scale, double form[36])
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
    if (count < PST_FEWEST_PIXELS) return pst_too_thin();
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
    /* without minors there are no residuals yet, and all equations have equal weight */
    if (absolute > 0) *scale = fmax(absolute / (double)count, 1e-12);
    return OK;
}

/* Multiplies the rotation matrix of a rotation vector by a, row-major. */
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

/* Computes a rotation's minors: A3 × A1 = A2, A3 × A2 = −A1. */
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

/* Terms of a rotation's cost. */
typedef struct rotation_cost {
    double form[36];    /* integrability form */
    double inflated[9]; /* mean of the inflated outline's unit normals times the surface's, transposed */
    double pull;        /* weight of the inflated outline */
} rotation_cost;

/* Measures the similarity of a to the inflated outline, sideways and toward the camera; below 0: its mirror image is
 * more similar. */
static void measure_likeness(const rotation_cost *c, const double a[9], double *aside, double *toward)
{
    *aside = *toward = 0;
    for (int j = 0; j < 6; j++)
        *aside += a[j] * c->inflated[j];
    for (int j = 6; j < 9; j++)
        *toward += a[j] * c->inflated[j];
}

/* Returns the cost of the one of its four mirror images that is most similar to the inflated outline. */
static double cost_at(const rotation_cost *c, const double a[9])
{
    double aside, toward;
    measure_likeness(c, a, &aside, &toward);
    return form_at(c->form, a) + c->pull * (1 - fabs(aside) - fabs(toward));
}

/* Replaces a by that image. */
static void mirror(const rotation_cost *c, double a[9])
{
    double aside, toward;
    measure_likeness(c, a, &aside, &toward);
    for (int j = 0; j < 9; j++)
        a[j] *= (j < 6 ? aside : toward) < 0 ? -1 : 1;
}

/* Descends from a by rotations about the axes, which are halved when none helps. */
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

static void compare_with_inflated(const pst_pseudo *f, double products[9])
{
    const pst_problem *p = f->problem;
    for (size_t i = 0; i < p->pixel_count; i++) {
        vec3 b = f->b[i];
        double length = (double)vec3_length(b);
        if (!(length > 0) || !isfinite(length)) continue;
        const float *n = f->inflated->data + 3 * (size_t)p->pixel[i];
        const double unit[3] = {b.x / length, b.y / length, b.z / length};
        for (int j = 0; j < 9; j++)
            products[j] += (double)n[j / 3] * unit[j % 3] / (double)p->pixel_count;
    }
}

/* Computes grid point k, counted along three rotations. */
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

/* Tells whether a rotation leaves the lights' mean on the camera's side. */
static bool is_frontal(const double a[9], vec3 mean)
{
    return fabs((double)pst_transform(a, mean).z) >= FRONTAL;
}

/* Finds the best frontal rotation, descending from every point of a grid: a ball's cap is almost as integrable if it is
 * turned into a saddle, and the difference between the two is less than the error of the grid's points. */
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
    return best < HUGE_VAL ? OK : fail(MERLIN_BAD_INPUT, "the pictures do not tell where the lights are");
}

static double trace(const double form[36])
{
    double sum = 0;
    for (int j = 0; j < 6; j++)
        sum += form[7 * j];
    return sum;
}

/* Sets up the cost of rotations near one with these minors; share: weight of the inflated outline, in traces of the
 * form. */
static status weigh(const pst_pseudo *f, const double minor[6], double share, double *scale, rotation_cost *c)
{
    status s = integrability_form(f, minor, scale, c->form);
    c->pull = share * trace(c->form);
    return s;
}

/* Finds the best rotation. */
static status rotate_by(const pst_pseudo *f, vec3 mean, double share, rotation_cost *c, double a[9])
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

/* Returns the share of the surface that faces away while the whole faces the camera. */
static double share_away(const pst_pseudo *f, const double a[9])
{
    size_t count = f->problem->pixel_count, away = 0;
    double sum = 0;
    for (size_t i = 0; i < count; i++) {
        double z = (double)pst_transform(a, f->b[i]).z;
        sum += z / fmax((double)vec3_length(f->b[i]), 1e-12);
        away += z < 0;
    }
    return (double)(sum < 0 ? count - away : away) / (double)count;
}

/* Returns the correlation of the sideways components of the surface's normals with the inflated outline's, 1 for equal
 * ones. */
static double sideways_correlation(const pst_pseudo *f, const double a[9])
{
    const pst_problem *p = f->problem;
    double both = 0, surface = 0, inflated = 0;
    for (size_t i = 0; i < p->pixel_count; i++) {
        vec3 n = vec3_normalize(pst_transform(a, f->b[i]));
        const float *m = f->inflated->data + 3 * (size_t)p->pixel[i];
        if (!isfinite(n.x)) continue;
        both += (double)(n.x * m[0] + n.y * m[1]);
        surface += (double)(n.x * n.x + n.y * n.y);
        inflated += (double)(m[0] * m[0] + m[1] * m[1]);
    }
    return both / fmax(sqrt(surface * inflated), 1e-300);
}

/* Returns the angle between two rotations in degrees; between a reflection and a rotation 180. */
static double degrees_between(const double a[9], const double b[9])
{
    double trace_of_both = 0;
    for (int j = 0; j < 9; j++)
        trace_of_both += a[j] * b[j];
    return acos(fmax(-1, fmin(1, (trace_of_both - 1) / 2))) * 57.29577951;
}

/* Finds the rotation by integrability alone, which shows how reliable it is; then with the inflated outline. */
static status rotate(const pst_pseudo *f, vec3 mean, pst_rotation *out)
{
    rotation_cost c = {.pull = 0};
    status s = rotate_by(f, mean, 0, &c, out->at);
    if (s != OK) return s;
    bool faces_away = share_away(f, out->at) > PST_MOST_AWAY;
    double least = form_at(c.form, out->at) / fmax(trace(c.form), 1e-300);
    compare_with_inflated(f, c.inflated);
    double alone[9];
    memcpy(alone, out->at, sizeof alone);
    mirror(&c, alone);
    s = rotate_by(f, mean, inflated_weight * least, &c, out->at);
    if (s != OK) return s;
    mirror(&c, out->at);
    out->unsure = faces_away || least > not_integrable || degrees_between(alone, out->at) > far_apart ||
                  sideways_correlation(f, out->at) < unlike;
    return OK;
}

static float *place(const img *sums, const pst_bounds *r, const pst_problem *p, size_t i)
{
    size_t width = (size_t)p->capture->width;
    return img_at(sums, (int)(p->pixel[i] % width) - r->left, (int)(p->pixel[i] / width) - r->top);
}

status pst_average_surface(const pst_pseudo *f)
{
    const pst_problem *p = f->problem;
    const pst_bounds r = pst_bounds_of(p);
    int radius = (int)(averaged * sqrt((double)p->pixel_count) + 0.5);
    if (radius < LEAST_AVERAGED) radius = LEAST_AVERAGED;
    img sums;
    status s = img_new(&sums, r.right - r.left + 1, r.bottom - r.top + 1, 4);
    if (s != OK) return s;
    for (size_t i = 0; i < p->pixel_count; i++) {
        vec3 b = f->b[i];
        if (isfinite(vec3_dot(b, b))) memcpy(place(&sums, &r, p, i), &(float[4]){b.x, b.y, b.z, 1}, 4 * sizeof(float));
    }
    /* two boxes of half the width make a tent */
    s = img_box_sums(&sums, radius / 2);
    if (s == OK) s = img_box_sums(&sums, radius - radius / 2);
    for (size_t i = 0; i < p->pixel_count && s == OK; i++) {
        const float *sum = place(&sums, &r, p, i);
        f->b[i] = vec3_scale(vec3_of(sum), sum[3] > 0 ? 1 / sum[3] : 0);
    }
    img_free(&sums);
    return s;
}

status pst_find_rotation(const pst_pseudo *f, vec3 mean_light, pst_rotation *out)
{
    status s = pst_average_surface(f);
    return s == OK ? rotate(f, mean_light, out) : s;
}
