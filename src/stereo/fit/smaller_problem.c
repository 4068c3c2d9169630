/* SPDX-License-Identifier: MIT */
#include "stereo/fit/smaller_problem.h"

#include <math.h>
#include <stdlib.h>

#include "stereo/capture/shrink.h"

/* Shrinks what is expected. */
static status shrink_expected(const pst_problem *p, pst_blocks blocks, smaller_problem *out)
{
    const img *mask = &p->capture->mask;
    if (!p->expected) return OK;
    out->expected = *p->expected;
    out->problem.expected = &out->expected;
    status s = pst_shrink_map(p->expected->normal, mask, blocks, &out->normal);
    for (size_t i = 0; s == OK && i < img_value_count(&out->normal); i += 3)
        vec3_put(vec3_normalize(vec3_of(out->normal.data + i)), out->normal.data + i);
    out->expected.normal = &out->normal;
    if (s != OK || !p->expected->depth) return s;
    out->expected.depth = &out->depth;
    return pst_shrink_map(p->expected->depth, mask, blocks, &out->depth);
}

status smaller_problem_new(const pst_problem *p, int pixels, smaller_problem *out)
{
    const int factor = (int)sqrt((double)p->pixel_count / pixels);
    *out = (smaller_problem){.problem = *p, .factor = factor > 1 ? factor : 1};
    if (out->factor == 1) return OK;
    const pst_blocks blocks = pst_blocks_of(p->capture, factor);
    out->problem.pixel = NULL;
    status s = pst_shrink(p->capture, blocks, p->saturation, &out->capture);
    out->problem.capture = &out->capture;
    if (s == OK) s = pst_list_pixels(&out->capture, &out->problem);
    return s == OK ? shrink_expected(p, blocks, out) : s;
}

void smaller_problem_free(smaller_problem *s)
{
    if (s->factor == 1) return;
    free(s->problem.pixel);
    pst_capture_free(&s->capture);
    img_free(&s->normal);
    img_free(&s->depth);
}
