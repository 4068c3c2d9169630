/* SPDX-License-Identifier: MIT */
#include "cli/photo_mesh.h"

#include "base/file.h"
#include "base/number.h"
#include "estimate/relight/maps_surface.h"
#include "estimate/surface/fill.h"
#include "mesh/write/mesh_write.h"

/* The network's shape has 256 points a side; the photograph adds none to it, but colour in more detail. */
enum { SHAPE_SIDE = 512, TEXTURE_SIDE = 2048 };

status photo_mesh_write(const merlin_maps *maps, const char *path)
{
    surface shape = {0};
    img texture = {0};
    int side = min_int(maps->crop.side, SHAPE_SIDE);
    status s = maps_surface(maps, side, &shape);
    if (s == OK) s = maps_albedo(maps, min_int(maps->crop.side, TEXTURE_SIDE), &texture);
    /* or a texture seen small would mix the zeros beside the object, a mirror, into its outline */
    if (s == OK) s = fill_outside(&shape.roughness, &shape.mask);
    bool by_vertex = file_ends_in(path, ".ply");
    mesh_source source = {&shape.depth,
                          &shape.mask,
                          &shape.normal,
                          by_vertex ? &shape.albedo : &texture,
                          &shape.roughness,
                          pinhole_of(side, side, surface_lens(&shape).fov),
                          surface_lens(&shape).slant};
    if (s == OK) s = mesh_write(path, &source);
    surface_free(&shape);
    img_free(&texture);
    return s;
}
