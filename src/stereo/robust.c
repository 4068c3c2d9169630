/* Highlights and cast shadows as outliers of Lambert's law (pixel_fit.h), under distant lights.
 *
 * One number is shared by the object: the cosine τ at which its surface turns dark. Lambert's law has τ = 0; pictures
 * whose black level was taken too high, and renderers that move the shadow terminator to hide the facets of a mesh,
 * have τ > 0; ambient and interreflected light has τ < 0. Left out, it turns every normal by degrees. It is the τ of
 * the least robust loss over a sample of pixels, and stays 0 unless it earns its place. */
#include <stdlib.h>

#include "stereo/field_fit.h"

enum { SAMPLE = 128 };

/* A τ that explains less than this share of the loss is taken for a chance of the sample. */
static const double worth = 0.1;

static status least_cost(const pst_field *sample, float *terminator)
{
    double best = 0, plain = 0, cost;
    pst_field f = *sample;
    float centre = 0;
    status s = pst_field_fit(&f, &plain);
    best = plain;
    for (int k = -2; s == OK && k <= 4; k++) {
        f.terminator = 0.05f * (float)k;
        s = pst_field_fit(&f, &cost);
        if (s == OK && cost < best) {
            best = cost;
            centre = f.terminator;
        }
    }
    for (float step = 0.025f; s == OK && step > 0.002f; step /= 2) {
        float around = centre;
        for (int side = -1; s == OK && side <= 1; side += 2) {
            f.terminator = around + step * (float)side;
            s = pst_field_fit(&f, &cost);
            if (s != OK || cost >= best) continue;
            best = cost;
            centre = f.terminator;
        }
    }
    *terminator = best < (1 - worth) * plain ? centre : 0;
    return s;
}

status pst_solve_robust(const pst_problem *p, pst_surface *out)
{
    pst_field sample = {.problem = p}, whole = {.problem = p, .pixel = p->pixel, .count = p->pixel_count, .out = out};
    uint32_t *pixel;
    double cost;
    status s = pst_field_sample(p, SAMPLE, &pixel, &sample.count);
    if (s != OK) return s;
    sample.pixel = pixel;
    /* with few lights τ would be read from the highlights */
    if (p->capture->count >= 12) s = least_cost(&sample, &whole.terminator);
    free(pixel);
    return s == OK ? pst_field_fit(&whole, &cost) : s;
}
