/* SPDX-License-Identifier: MIT */
/* Photometric stereo under distant lights that is robust to highlights, cast shadows and indirect light: a lobe per
 * pixel (lobe_fit.h), common properties from a sample (lobe_choice.h), and neighbours' results as further starts;
 * pixels that most neighbours contradict get the neighbours' result if it explains the pictures about as well. */
#include <math.h>
#include <stdlib.h>

#include "stereo/fit/lobe_choice.h"
#include "stereo/methods/solve_parts.h"

enum { SAMPLE = 128, SWEEPS = 2 };

/* Returns the cost from which on a pixel is searched longer: that of many outliers, and many more than usual for this
 * object. */
static float search_limit(const pst_field *f, double cost)
{
    float many = 0.16f * (float)f->problem->capture->count, usual = (float)(cost / (double)f->count);
    return fmaxf(many, 2 * usual);
}

static status fit_all(const pst_field *f, merlin_surface *out)
{
    double cost;
    status s = pst_field_fit(f, &cost);
    if (s == OK) s = pst_field_try_second(f);
    if (s == OK) s = pst_field_search(f, search_limit(f, cost));
    if (s == OK) s = pst_field_spread(f, SWEEPS);
    if (s == OK) s = pst_field_replace_outliers(f, SWEEPS);
    return s == OK ? pst_field_store(f, out) : s;
}

status pst_solve_robust(const pst_problem *p, merlin_surface *out)
{
    pst_lobe lobe, second;
    uint32_t *pixel;
    pst_field sample = {.problem = p};
    bool two = false;
    status s = pst_field_sample(p, SAMPLE, &pixel, &sample.count);
    sample.pixel = pixel;
    if (s == OK) s = pst_lobe_choose(&sample, &lobe);
    if (s == OK) s = pst_lobe_choose_second(&sample, &lobe, &second, &two);
    free(pixel);
    if (s != OK) return s;
    pst_field f = {.problem = p, .pixel = p->pixel, .count = p->pixel_count, .lobe = &lobe};
    if (two) f.second = &second;
    f.shading = calloc(f.count, sizeof *f.shading);
    s = f.shading ? fit_all(&f, out) : fail(MERLIN_NO_MEMORY, "no memory to fit %zu pixels", f.count);
    free(f.shading);
    return s;
}
