/* SPDX-License-Identifier: MIT */
#include "stereo/methods/solution_cost.h"

#include <stdlib.h>

#include "stereo/fit/field_fit.h"
#include "stereo/methods/solve_parts.h"

/* SAMPLE: number of pixels; FREE: least number of pictures whose highlights are fitted, as of fewer those explain any
 * shading. */
enum { SAMPLE = 1024, FREE = 12 };

static const pst_lobe glossy = {.masking = 0.28f, .tail = 2, .width = 0.04f, .shadow = PST_SHADOW_COST},
                      matte = {.masking = 1, .width = 0.16f, .shadow = PST_SHADOW_COST};

static status fit(const pst_problem *p, const merlin_surface *found, double *cost)
{
    uint32_t *pixel;
    pst_field f = {.problem = p, .scale = 1, .lobe = p->capture->count >= FREE ? &glossy : &matte};
    if (p->capture->lighting == MERLIN_NEAR_LIGHTS) f.depth = &found->depth;
    status s = pst_field_sample(p, SAMPLE, &pixel, &f.count);
    if (s != OK) return s;
    f.pixel = pixel;
    f.shading = calloc(f.count, sizeof *f.shading);
    s = f.shading ? pst_field_fit(&f, cost) : fail(MERLIN_NO_MEMORY, "no memory to fit %zu pixels", f.count);
    *cost /= (double)f.count;
    free(f.shading);
    free(pixel);
    return s;
}

status pst_solution_cost(const merlin_capture *c, const merlin_surface *found, double *cost)
{
    *cost = 0;
    merlin_light *light = calloc((size_t)c->count, sizeof *light);
    pst_problem p = {.capture = c, .light = light, .saturation = PST_SATURATED};
    status s =
        light ? pst_list_lights(c, found->method, light) : fail(MERLIN_NO_MEMORY, "no memory for %d lights", c->count);
    if (s == OK) s = pst_list_pixels(c, &p);
    if (s == OK) s = fit(&p, found, cost);
    free(p.pixel);
    free(light);
    return s;
}
