/* SPDX-License-Identifier: MIT */
/* merlin_mesh_from_maps: what a photograph shows of its object, as a mesh. */
#include "base/api_needs.h"
#include "base/number.h"
#include "estimate/relight/maps_surface.h"
#include "estimate/surface/fill.h"
#include "mesh/surface/surface_mesh.h"

/* The network's shape has 256 points a side; the photograph adds none to it, but colour in more detail. */
enum { SHAPE_SIDE = 512, TEXTURE_SIDE = 2048, LEAST_SIDE = 2, MOST_SIDE = 8192 };

static status take_side(const char *what, int asked, int usual, int most, int *side)
{
    if (asked != 0 && (asked < LEAST_SIDE || asked > MOST_SIDE))
        return fail(MERLIN_WRONG_USE, "%s of a mesh is 0 (the usual one) or from %d to %d, not %d", what, LEAST_SIDE,
                    MOST_SIDE, asked);
    *side = min_int(asked ? asked : usual, most);
    return OK;
}

static status make(const merlin_maps *maps, int side, int texture_side, merlin_mesh *out)
{
    surface shape = {0};
    img texture = {0};
    status s = maps_surface(maps, side, &shape);
    if (s == OK) s = maps_albedo(maps, texture_side, &texture);
    /* or a texture seen small would mix the zeros beside the object, a mirror, into its outline */
    if (s == OK) s = fill_outside(&shape.roughness, &shape.mask);
    const mesh_source source = {.depth = &shape.depth,
                                .mask = &shape.mask,
                                .normal = &shape.normal,
                                .albedo = &shape.albedo,
                                .texture = &texture,
                                .roughness = &shape.roughness,
                                .camera = pinhole_of(side, side, surface_lens(&shape).fov),
                                .slant = surface_lens(&shape).slant};
    if (s == OK) s = surface_mesh_new(&source, out);
    out->matte = maps->captured;
    surface_free(&shape);
    img_free(&texture);
    return s;
}

merlin_status merlin_mesh_from_maps(const merlin_maps *maps, const merlin_mesh_params *params, merlin_mesh *out)
{
    static const merlin_mesh_params usual = {0};
    int side = 0, texture_side = 0;
    if (out) *out = (merlin_mesh){0};
    status s = api_needs(__func__, maps && out);
    if (s == OK) s = maps_check(maps);
    if (!params) params = &usual;
    if (s == OK) s = take_side("the side", params->side, SHAPE_SIDE, maps->crop.side, &side);
    if (s == OK) s = take_side("the texture_side", params->texture_side, TEXTURE_SIDE, maps->crop.side, &texture_side);
    return s == OK ? make(maps, side, texture_side, out) : s;
}
