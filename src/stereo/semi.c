/* Light directions known, intensities not (D. Cho, Y. Matsushita, Y.-W. Tai, I. S. Kweon, Semi-calibrated photometric
 * stereo, ECCV 2016 and PAMI 2018).
 *
 * The matrix of values is diag(e) L B. Its column space U (rank three) is that of diag(e) L, so that
 * diag(1/e) U = L Q for some 3×3 Q: linear in 1/e and Q together, and solved by their one null vector. Shadows and
 * highlights bend U; so that and equal intensities are two starts, from which intensities and a sample's surface, its
 * highlights included (lobe_fit.h), alternate. The start that ends with the lower loss counts. The mean intensity is 1.
 * On a surface whose normals hardly differ, intensities and albedo explain each other: equal ones are kept unless
 * others explain the pictures much better. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "stereo/lapack.h"
#include "stereo/lobe_choice.h"
#include "stereo/samples.h"

enum { SAMPLE = 240, ITERATIONS = 12, TRIAL_ROUNDS = 4 };

/* Intensities further apart than this are a failure of the rank constraint, not lamps. */
static const double most_apart = 100;
/* Of the loss before: what a terminator, and what intensities must bring it down to. */
static const double worth_terminator = 0.9, worth_intensities = 0.8;
static const float likely_terminator = 0.1f;
/* Of the albedo: a pixel less bright says little of its light. */
static const float well_lit = 0.25f;

/* The sample under intensities that change. */
typedef struct semi_job {
    pst_problem problem;
    pst_light *light; /* the problem's */
    pst_field field;
    pst_lobe lobe;
    float *weight, *model, *value, *usable; /* count × padded */
    float *ratio;                           /* count */
    size_t padded;
    double cost;
    bool equal; /* what was found */
} semi_job;

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
    if (s == OK && lapack_eigen(normal, columns, true, eigenvalue)) {
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

static void set_intensities(semi_job *job, const double *e)
{
    for (int k = 0; k < job->problem.capture->count; k++)
        for (int ch = 0; ch < 3; ch++)
            job->light[k].intensity[ch] = (float)e[k];
}

static int ascending(const void *a, const void *b)
{
    float x = *(const float *)a, y = *(const float *)b;
    return (x > y) - (x < y);
}

/* The middle of most of the ratios: their median, then reweighted (Geman & McClure) about it. */
static double typical(float *ratio, size_t count)
{
    static const double width = 0.1;
    if (count == 0) return 1;
    qsort(ratio, count, sizeof *ratio, ascending);
    double middle = fmax((double)ratio[count / 2], 1e-6);
    for (int round = 0; round < 5; round++) {
        double sum = 0, weights = 0;
        for (size_t i = 0; i < count; i++) {
            double r = ((double)ratio[i] / middle - 1) / width, w = 1 / ((1 + r * r) * (1 + r * r));
            sum += w * (double)ratio[i];
            weights += w;
        }
        middle = fmax(sum / weights, 1e-6);
    }
    return middle;
}

/* Each light's intensity given the surface, in one channel of the pictures (-1: grey): what most of the pixels that it
 * should light have in proportion. */
static void from_surface(const semi_job *job, int channel, double *e)
{
    const pst_capture *c = job->problem.capture;
    for (int k = 0; k < c->count; k++) {
        size_t lit = 0;
        for (size_t i = 0; i < job->field.count; i++) {
            size_t at = i * job->padded + (size_t)k;
            float v = job->value[at] * job->light[k].intensity[0];
            if (channel >= 0)
                v = (float)c->picture[k][(size_t)job->field.pixel[i] * (size_t)c->channels + (size_t)channel] / 65535;
            if (job->usable[at] > 0 && job->model[at] > well_lit * job->field.shading[i].albedo)
                job->ratio[lit++] = v / job->model[at];
        }
        e[k] = typical(job->ratio, lit);
    }
    normalize(e, c->count);
}

/* The surface from the intensities, then the intensities from the surface. */
static status improve(semi_job *job, bool choose, double *e)
{
    set_intensities(job, e);
    status s = choose ? pst_lobe_choose(&job->field, &job->lobe) : OK;
    if (s == OK) s = pst_field_fit(&job->field, &job->cost);
    if (s == OK) s = pst_field_model(&job->field, job->weight, job->model);
    if (s != OK) return s;
    pst_gather(&job->problem, job->field.pixel, job->field.count, job->value, job->usable, job->padded);
    from_surface(job, -1, e);
    return OK;
}

/* The lobe is chosen anew as the intensities come right. */
static status improve_often(semi_job *job, int from, int to, double *e)
{
    status s = OK;
    for (int k = from; s == OK && k < to; k++)
        s = improve(job, k % 3 == 0, e);
    return s;
}

/* From both starts; e becomes the better's. *equal: the loss of equal intensities as they are. */
static status start(semi_job *job, double *e, double *other, double *equal)
{
    size_t bytes = (size_t)job->problem.capture->count * sizeof *e;
    status s = improve_often(job, 0, TRIAL_ROUNDS, e);
    double cost = job->cost;
    if (s == OK) s = improve(job, true, other);
    *equal = job->cost;
    if (s == OK) s = improve_often(job, 1, TRIAL_ROUNDS, other);
    if (s != OK || job->cost >= cost) return s;
    memcpy(e, other, bytes);
    return OK;
}

/* A terminator that is left out goes into the intensities, and no longer shows: it is tried together with them. */
static status try_terminator(semi_job *job, double *e, double *other)
{
    size_t bytes = (size_t)job->problem.capture->count * sizeof *e;
    memcpy(other, e, bytes);
    status s = improve(job, true, other);
    double cost = job->cost;
    if (s != OK || job->lobe.terminator > 0 || job->problem.capture->count < PST_MANY_LIGHTS) return s;
    memcpy(other, e, bytes);
    job->lobe.terminator = likely_terminator;
    for (int k = 0; s == OK && k < TRIAL_ROUNDS; k++)
        s = improve(job, false, other);
    if (s == OK && job->cost < worth_terminator * cost) memcpy(e, other, bytes);
    return s;
}

/* Equal intensities are what most captures have: they are given up only for what costs much less. */
static status settle(semi_job *job, int rounds, double *e)
{
    int count = job->problem.capture->count;
    double *other = malloc((size_t)count * sizeof *other), equal = 0;
    if (!other) return fail(ERROR_MEMORY, "no memory for %d lights", count);
    for (int k = 0; k < count; k++)
        other[k] = 1;
    status s = start(job, e, other, &equal);
    if (s == OK) s = try_terminator(job, e, other);
    if (s == OK) s = improve_often(job, 0, rounds, e);
    job->equal = s == OK && job->cost >= worth_intensities * equal;
    for (int k = 0; k < count && job->equal; k++)
        e[k] = 1;
    free(other);
    return s;
}

static status job_new(const pst_problem *p, pst_light *light, semi_job *job)
{
    uint32_t *pixel;
    size_t n;
    *job = (semi_job){.problem = *p, .light = light, .padded = (size_t)pst_padded(p->capture->count)};
    job->problem.light = light;
    status s = pst_field_sample(p, SAMPLE, &pixel, &n);
    if (s != OK) return s;
    job->field = (pst_field){.problem = &job->problem, .pixel = pixel, .count = n, .lobe = &job->lobe};
    job->field.shading = calloc(n, sizeof *job->field.shading);
    job->weight = malloc((4 * job->padded + 1) * n * sizeof *job->weight);
    if (!job->field.shading || !job->weight) return fail(ERROR_MEMORY, "no memory for a sample of %zu pixels", n);
    job->model = job->weight + n * job->padded;
    job->value = job->model + n * job->padded;
    job->usable = job->value + n * job->padded;
    job->ratio = job->usable + n * job->padded;
    return OK;
}

static void job_free(semi_job *job)
{
    free((uint32_t *)job->field.pixel);
    free(job->field.shading);
    free(job->weight);
}

static status find_intensities(const pst_problem *p, semi_job *job, double *e)
{
    pst_samples m = {0};
    status s = pst_samples_new(p, SAMPLE, &m);
    if (s == OK) s = from_rank(p, &m, e);
    pst_samples_free(&m);
    return s == OK ? settle(job, p->iterations > 0 ? p->iterations : ITERATIONS, e) : s;
}

status pst_solve_semi(const pst_problem *p, pst_surface *out)
{
    int count = p->capture->count;
    semi_job job = {0};
    double *e = calloc((size_t)count, sizeof *e);
    out->light = malloc((size_t)count * sizeof *out->light);
    status s = e && out->light ? OK : fail(ERROR_MEMORY, "no memory for %d lights", count);
    if (s == OK) {
        memcpy(out->light, p->light, (size_t)count * sizeof *out->light);
        s = job_new(p, out->light, &job);
    }
    if (s == OK) s = find_intensities(p, &job, e);
    if (s == OK) set_intensities(&job, e);
    for (int ch = 0; s == OK && !job.equal && p->capture->channels == 3 && ch < 3; ch++) {
        from_surface(&job, ch, e);
        for (int k = 0; k < count; k++)
            out->light[k].intensity[ch] = (float)e[k];
    }
    free(e);
    job_free(&job);
    pst_problem known = *p;
    known.light = out->light;
    return s == OK ? pst_solve_robust(&known, out) : s;
}
