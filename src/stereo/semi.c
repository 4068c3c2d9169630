/* Light directions known, intensities not (D. Cho, Y. Matsushita, Y.-W. Tai, I. S. Kweon, Semi-calibrated photometric
 * stereo, ECCV 2016 and PAMI 2018).
 *
 * The matrix of values is diag(e) L B. Its column space U (rank three) is that of diag(e) L, so that
 * diag(1/e) U = L Q for some 3×3 Q: linear in 1/e and Q together, and solved by their one null vector. Shadows and
 * highlights bend U; from there intensities and surface alternate, each by robust weights. The mean intensity is 1. */
#include <lapacke.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "stereo/pixel_fit.h"
#include "stereo/samples.h"

enum { SAMPLE = 600, ITERATIONS = 20 };

/* Intensities further apart than this are a failure of the rank constraint, not lamps. */
static const double most_apart = 100;

static void normalize(double *e, int count)
{
    double mean = 0;
    for (int k = 0; k < count; k++)
        mean += e[k] / count;
    for (int k = 0; k < count; k++)
        e[k] /= mean;
}

/* e by the rank constraint, or all 1 where it does not hold. */
static status from_rank(const pst_problem *p, const pst_samples *m, double *e)
{
    int n = m->lights, columns = n + 9;
    for (int k = 0; k < n; k++)
        e[k] = 1;
    if (n < 5) return OK;
    double *basis = calloc((size_t)n * 3 + (size_t)columns * (size_t)(columns + 1), sizeof *basis);
    if (!basis) return fail(ERROR_MEMORY, "no memory for %d lights", n);
    double *normal = basis + 3 * n, *eigenvalue = normal + columns * columns;
    size_t lit;
    status s = pst_samples_basis(m, basis, &lit);
    for (int k = 0; s == OK && k < n; k++) {
        const vec3 d = p->light[k].direction;
        for (int j = 0; j < 3; j++) {
            double row[4] = {basis[3 * k + j], -(double)d.x, -(double)d.y, -(double)d.z};
            int at[4] = {k, n + j, n + 3 + j, n + 6 + j};
            for (int a = 0; a < 4; a++)
                for (int b = 0; b < 4; b++)
                    normal[at[a] * columns + at[b]] += row[a] * row[b];
        }
    }
    if (s == OK && LAPACKE_dsyev(LAPACK_ROW_MAJOR, 'V', 'U', columns, normal, columns, eigenvalue) == 0) {
        double low = HUGE_VAL, high = 0, sign = normal[0] < 0 ? -1 : 1;
        for (int k = 0; k < n; k++) {
            double inverse = sign * normal[k * columns];
            low = fmin(low, inverse);
            high = fmax(high, inverse);
        }
        if (low > 0 && high < most_apart * low)
            for (int k = 0; k < n; k++)
                e[k] = 1 / (sign * normal[k * columns]);
    }
    free(basis);
    normalize(e, n);
    return s;
}

/* Each light's intensity given the surface, in one channel of the pictures (-1: grey). */
static void from_surface(const pst_problem *p, const pst_samples *m, int channel, double *e)
{
    const pst_capture *c = p->capture;
    for (int k = 0; k < m->lights; k++) {
        double up = 0, down = 0;
        for (size_t i = 0; i < m->count; i++) {
            double w = m->weight[i * m->padded + (size_t)k], fit = vec3_dot(m->b[i], p->light[k].direction);
            double v = m->value[i * m->padded + (size_t)k] * (channel < 0 ? e[k] : 1);
            if (channel >= 0) v = c->picture[k][(size_t)m->pixel[i] * (size_t)c->channels + (size_t)channel] / 65535.0;
            up += w * v * fit;
            down += w * fit * fit;
        }
        e[k] = up > 1e-6 * down && down > 0 ? up / down : 1e-6;
    }
    normalize(e, m->lights);
}

static void scale_values(pst_samples *m, const float *raw, const double *e)
{
    for (size_t i = 0; i < m->count; i++)
        for (int k = 0; k < m->lights; k++)
            m->value[i * m->padded + (size_t)k] = raw[i * m->padded + (size_t)k] / (float)e[k];
}

static status alternate(const pst_problem *p, pst_samples *m, double *e)
{
    size_t padded = m->padded, floats = m->count * padded;
    float *direction = calloc(3 * padded + floats, sizeof *direction);
    if (!direction) return fail(ERROR_MEMORY, "no memory for %d lights", m->lights);
    float *x = direction, *y = x + padded, *z = y + padded, *raw = z + padded;
    memcpy(raw, m->value, floats * sizeof *raw);
    for (int k = 0; k < m->lights; k++) {
        x[k] = p->light[k].direction.x;
        y[k] = p->light[k].direction.y;
        z[k] = p->light[k].direction.z;
    }
    int iterations = p->iterations > 0 ? p->iterations : ITERATIONS;
    for (int k = 0; k < iterations; k++) {
        scale_values(m, raw, e);
        pst_samples_fit(m, x, y, z);
        from_surface(p, m, -1, e);
    }
    free(direction);
    return OK;
}

status pst_solve_semi(const pst_problem *p, pst_surface *out)
{
    int count = p->capture->count, channels = p->capture->channels;
    pst_samples m = {0};
    double *e = calloc((size_t)count, sizeof *e);
    out->light = malloc((size_t)count * sizeof *out->light);
    status s = e && out->light ? OK : fail(ERROR_MEMORY, "no memory for %d lights", count);
    if (s == OK) s = pst_samples_new(p, SAMPLE, &m);
    if (s == OK) s = from_rank(p, &m, e);
    if (s == OK) s = alternate(p, &m, e);
    for (int k = 0; s == OK && k < count; k++) {
        out->light[k] = p->light[k];
        for (int ch = 0; ch < 3; ch++)
            out->light[k].intensity[ch] = (float)e[k];
    }
    for (int ch = 0; s == OK && channels == 3 && ch < 3; ch++) {
        from_surface(p, &m, ch, e);
        for (int k = 0; k < count; k++)
            out->light[k].intensity[ch] = (float)e[k];
    }
    free(e);
    pst_samples_free(&m);
    pst_problem known = *p;
    known.light = out->light;
    return s == OK ? pst_solve_robust(&known, out) : s;
}
