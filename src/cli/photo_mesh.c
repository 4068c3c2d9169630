#include "cli/photo_mesh.h"

#include <math.h>
#include <stdlib.h>

#include "base/file.h"
#include "estimate/api.h"
#include "image/resize.h"
#include "stereo/mesh_write.h"

/* The network's shape has 256 points a side; the photograph adds none to it, but colour. */
enum { SHAPE_SIDE = 512, TEXTURE_SIDE = 2048 };

static int least(int a, int b)
{
    return a < b ? a : b;
}

/* Albedo in more detail than the shape has. */
static status take_texture(const merlin_maps *maps, img *out)
{
    img albedo = img_of(&maps->albedo), mask = img_of(&maps->mask), part = {0}, part_mask = {0}, cover = {0};
    int side = least(maps->crop.side, TEXTURE_SIDE);
    status s = crop_take(&albedo, crop_of(maps), &mask, &part);
    if (s == OK) s = crop_take(&mask, crop_of(maps), &mask, &part_mask);
    if (s == OK) s = img_resize(&part_mask, side, side, &cover);
    if (s == OK) s = surface_resize_image(&part, &part_mask, &cover, out);
    img_free(&part);
    img_free(&part_mask);
    img_free(&cover);
    return s;
}

status photo_mesh_write(const merlin_maps *maps, const char *folder)
{
    surface shape = {0};
    img texture = {0};
    char *path = file_join(folder, "mesh.glb");
    int side = least(maps->crop.side, SHAPE_SIDE);
    status s = path ? maps_surface(maps, side, &shape) : fail(ERROR_MEMORY, "no memory for a file name");
    if (s == OK) s = take_texture(maps, &texture);
    float middle = 0.5f * (float)side, tangent = tanf(0.5f * SURFACE_FOV * 0.017453293f);
    pst_mesh_source source = {&shape.depth,
                              &shape.mask,
                              &shape.normal,
                              &texture,
                              {.perspective = true, .focal = middle / tangent, .center_x = middle, .center_y = middle}};
    if (s == OK) s = pst_mesh_write(path, &source);
    free(path);
    surface_free(&shape);
    img_free(&texture);
    return s;
}
