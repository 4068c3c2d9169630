/* SPDX-License-Identifier: MIT */
#include "stereo/integrate/stereo_surface.h"

#include <stdlib.h>
#include <string.h>

#include "stereo/integrate/integrate.h"

static const char *const method_names[] = {"auto", "ls", "robust", "near", "semi", "uncalibrated", "nfps"};
enum { METHOD_COUNT = sizeof method_names / sizeof *method_names };

int pst_method_from_name(const char *name)
{
    for (int i = 0; i < METHOD_COUNT; i++)
        if (!strcmp(name, method_names[i])) return i;
    return -1;
}

const char *merlin_stereo_method_name(merlin_stereo_method method)
{
    return (int)method >= 0 && (int)method < (int)METHOD_COUNT ? method_names[method] : "unknown";
}

status pst_surface_check(const merlin_surface *s)
{
    const merlin_image *maps[] = {&s->normal, &s->depth, &s->mask};
    const int channels[] = {3, 1, 1};
    bool sound = s->albedo.data && (s->albedo.channels == 1 || s->albedo.channels == 3);
    for (int i = 0; i < 3; i++)
        sound &= maps[i]->data && maps[i]->channels == channels[i] && maps[i]->width == s->albedo.width &&
                 maps[i]->height == s->albedo.height;
    return sound ? OK : fail(MERLIN_WRONG_USE, "this surface is empty or incomplete");
}

status pst_surface_integrate(const merlin_stereo_params *params, merlin_surface *s)
{
    if (s->depth.data && !params->integrate) return OK;
    const watch shown = {params->progress, params->progress_context, params->stop};
    pst_integration how = {.preserve_edges = params->keep_edges != 0, .watch = &shown};
    watch_tell(&shown, "integrating", 0);
    if (s->depth.data) {
        how.prior = &s->depth;
        how.prior_weight = PST_KEEP_DEPTH;
    }
    img depth = {0};
    status result = pst_integrate(&s->normal, &s->mask, &s->camera, &how, &depth);
    if (result != OK) return result;
    img_free(&s->depth);
    s->depth = depth;
    return OK;
}

void merlin_surface_free(merlin_surface *surface)
{
    if (!surface) return;
    img_free(&surface->normal);
    img_free(&surface->albedo);
    img_free(&surface->depth);
    img_free(&surface->residual);
    img_free(&surface->spread);
    img_free(&surface->mask);
    free(surface->lights);
    for (int i = 0; surface->picture_names && i < surface->picture_count; i++)
        free(surface->picture_names[i]);
    free(surface->picture_names);
    skipped_free(&surface->skipped);
    *surface = (merlin_surface){0};
}
