/* Highlights, cast shadows and light from elsewhere told from Lambert's law, under distant lights: a lobe a pixel
 * (lobe_fit.h), what pixels share from a sample (lobe_choice.h), and neighbours' results as further starts. */
#include <stdlib.h>

#include "stereo/lobe_choice.h"

enum { SAMPLE = 128, SWEEPS = 2 };

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
    double cost;
    s = pst_field_fit(&f, &cost);
    if (s == OK) s = pst_field_spread(&f, SWEEPS);
    if (s == OK) s = pst_field_store(&f, out);
    free(f.shading);
    return s;
}
