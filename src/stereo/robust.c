/* Highlights, cast shadows and light from elsewhere told from Lambert's law, under distant lights: a lobe a pixel
 * (lobe_fit.h), what pixels share from a sample (lobe_choice.h), and neighbours' results as further starts. */
#include <stdlib.h>
#include <string.h>

#include "stereo/lobe_choice.h"

enum { SAMPLE = 128, SWEEPS = 2 };

static status fit_all(const pst_field *f, pst_surface *out)
{
    const pst_capture *c = f->problem->capture;
    size_t size = (size_t)c->width * (size_t)c->height, moved = 1;
    double cost;
    int32_t *slot = malloc(size * sizeof *slot);
    if (!slot) return fail(ERROR_MEMORY, "no memory for %zu pixels", size);
    memset(slot, 0xff, size * sizeof *slot);
    for (size_t i = 0; i < f->count; i++)
        slot[f->pixel[i]] = (int32_t)i;
    status s = pst_field_fit(f, &cost);
    for (int k = 0; s == OK && k < SWEEPS && moved > 0; k++)
        s = pst_field_spread(f, slot, &moved);
    free(slot);
    return s == OK ? pst_field_store(f, out) : s;
}

status pst_solve_robust(const pst_problem *p, pst_surface *out)
{
    pst_lobe lobe;
    uint32_t *pixel;
    size_t count;
    status s = pst_field_sample(p, SAMPLE, &pixel, &count);
    if (s == OK) s = pst_lobe_choose(&(pst_field){.problem = p, .pixel = pixel, .count = count}, &lobe);
    free(pixel);
    if (s != OK) return s;
    pst_field f = {.problem = p, .pixel = p->pixel, .count = p->pixel_count, .lobe = &lobe};
    f.shading = calloc(f.count, sizeof *f.shading);
    if (!f.shading) return fail(ERROR_MEMORY, "no memory to fit %zu pixels", f.count);
    s = fit_all(&f, out);
    free(f.shading);
    return s;
}
