/* SPDX-License-Identifier: MIT */
#include "stereo/integrate/surface.h"

#include <stdlib.h>
#include <string.h>

#include "stereo/integrate/integrate.h"

static const char *const method_names[] = {"auto", "ls", "robust", "near", "semi", "uncalibrated"};
enum { METHOD_COUNT = sizeof method_names / sizeof *method_names };

int pst_method_from_name(const char *name)
{
    for (int i = 0; i < METHOD_COUNT; i++)
        if (!strcmp(name, method_names[i])) return i;
    return -1;
}

const char *pst_method_name(pst_method m)
{
    return (int)m >= 0 && (int)m < (int)METHOD_COUNT ? method_names[m] : "unknown";
}

status pst_surface_integrate(const pst_capture *c, bool integrate, bool preserve_edges, const watch *shown,
                             pst_surface *s)
{
    if (s->depth.data && !integrate) return OK;
    pst_integration how = {.preserve_edges = preserve_edges, .watch = shown};
    watch_tell(shown, "integrating", 0);
    if (s->depth.data) {
        how.prior = &s->depth;
        how.prior_weight = PST_KEEP_DEPTH;
    }
    img depth = {0};
    status result = pst_integrate(&s->normal, &c->mask, &c->camera, &how, &depth);
    if (result != OK) return result;
    img_free(&s->depth);
    s->depth = depth;
    return OK;
}

void pst_surface_free(pst_surface *s)
{
    img_free(&s->normal);
    img_free(&s->albedo);
    img_free(&s->depth);
    img_free(&s->residual);
    free(s->light);
    *s = (pst_surface){0};
}
