#include "stereo/integrate.h"
#include "stereo/solve.h"

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
