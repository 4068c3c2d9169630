/* SPDX-License-Identifier: MIT */
/* merlin_maps_from_surface: a captured surface as maps that can be relit. */
#include "base/api_needs.h"
#include "estimate/files/maps_files.h"
#include "merlin/surface.h"
#include "stereo/integrate/stereo_surface.h"
#include "surfaces/surface_albedo.h"

merlin_status merlin_maps_from_surface(const merlin_surface *surface, merlin_maps *out)
{
    if (out) *out = (merlin_maps){0};
    status s = api_needs(__func__, surface && out);
    if (s == OK) s = pst_surface_check(surface);
    if (s != OK) return s;
    const int width = surface->mask.width, height = surface->mask.height;
    maps_begin_captured(out);
    s = surface_albedo(surface, &out->albedo);
    if (s == OK) s = img_copy(&out->normal, &surface->normal);
    if (s == OK) s = img_copy(&out->depth, &surface->depth);
    if (s == OK) s = img_copy(&out->mask, &surface->mask);
    if (s == OK && surface->spread.data) s = img_copy(&out->spread, &surface->spread);
    if (s == OK) s = img_new(&out->roughness, width, height, 1);
    if (s == OK) s = img_new(&out->photo, width, height, 3);
    if (s == OK) s = maps_place_captured(out, surface->camera.focal);
    if (s != OK) merlin_maps_free(out);
    return s;
}
