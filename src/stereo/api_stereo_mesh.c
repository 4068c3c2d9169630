/* SPDX-License-Identifier: MIT */
/* merlin_mesh_from_surface: a captured surface as a mesh. */
#include "base/api_needs.h"
#include "mesh/surface/surface_mesh.h"
#include "stereo/fit/albedo_scale.h"
#include "stereo/integrate/stereo_surface.h"

merlin_status merlin_mesh_from_surface(const merlin_surface *surface, merlin_mesh *out)
{
    if (out) *out = (merlin_mesh){0};
    status s = api_needs(__func__, surface && out);
    if (s == OK) s = pst_surface_check(surface);
    if (s != OK) return s;
    img albedo = {0};
    float scale;
    s = img_copy(&albedo, &surface->albedo);
    if (s == OK) s = pst_scale_albedo(&albedo, &surface->mask, &scale);
    const mesh_source source = {.depth = &surface->depth,
                                .mask = &surface->mask,
                                .normal = &surface->normal,
                                .albedo = &albedo,
                                .camera = surface->camera};
    if (s == OK) s = surface_mesh_new(&source, out);
    out->matte = 1;
    img_free(&albedo);
    return s;
}
