/* SPDX-License-Identifier: MIT */
/* A surface whose normals and depth were found elsewhere, by a network: what is left to measure is the albedo, as that
 * of a surface without gloss, in whose light highlights and cast shadows count as outliers (lobe_fit.h), and how far
 * the pictures are from that. */
#include <stdlib.h>

#include "stereo/fit/field_fit.h"
#include "stereo/methods/solve_parts.h"

status pst_solve_given(const pst_problem *p, merlin_surface *out)
{
    static const pst_lobe matte = {.width = 0.1f, .shadow = PST_SHADOW_COST};
    pst_shading *shading = calloc(p->pixel_count, sizeof *shading);
    if (!shading) return fail(MERLIN_NO_MEMORY, "no memory to fit %zu pixels", p->pixel_count);
    out->by_network = 1;
    status s = img_copy(&out->depth, p->expected->depth);
    const pst_field f = {.problem = p,
                         .pixel = p->pixel,
                         .count = p->pixel_count,
                         .depth = &out->depth,
                         .scale = 1,
                         .lobe = &matte,
                         .shading = shading};
    if (s == OK) s = pst_field_given(&f, p->expected->normal);
    if (s == OK) s = pst_field_store(&f, out);
    free(shading);
    return s;
}
