/* SPDX-License-Identifier: MIT */
/* merlin/mesh: the visible surface of an object as triangles, for Blender, browsers and your own programs.
 *
 *     merlin_mesh mesh;
 *     if (merlin_mesh_from_maps(&maps, NULL, &mesh) || merlin_mesh_write(&mesh, "cup.glb", NULL))
 *         fprintf(stderr, "%s\n", merlin_error());
 *     merlin_mesh_free(&mesh);
 *
 * It is only the front, as a camera does not see the back. There are no triangles across a jump in depth. */
#ifndef MERLIN_MESH_H
#define MERLIN_MESH_H

#include <merlin/files.h>
#include <merlin/image.h>
#include <merlin/maps.h>
#include <merlin/stereo.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

/* Arrays of vertices and triangles. In a mesh that you fill in yourself, fields marked as for colour or for the normal
 * map may be missing (NULL, no data, 0). */
typedef struct merlin_mesh {
    size_t vertex_count, triangle_count;
    float *positions; /* 3 per vertex, in camera space: x right, y up, -z away from the camera; in depth's unit, or in
                       * pixels of a camera that is far away */
    float *normals;   /* 3 per vertex, unit, by the maps */
    float *uvs;       /* 2 per vertex, of textures: (0, 0) is their upper left corner, (1, 1) the lower right one */
    float *colors;    /* 3 per vertex: albedo, linear, [0, 1]. For colour */
    uint32_t *triangles;    /* 3 indices of vertices per triangle, counter-clockwise as seen by the camera */
    int width, height;      /* size of the maps whose pixels are the vertices. For the normal map, as the next two: */
    uint32_t *pixels;       /* 1 per vertex: row * width + column in these maps */
    float *face_normals;    /* 3 per vertex, unit: the area-weighted mean of the adjacent triangles' normals; NULL: the
                             * same as normals */
    merlin_image albedo;    /* texture: 3 channels, linear, [0, 1], of any size. For colour */
    merlin_image roughness; /* texture: 1 channel, of any size; no data: 1 everywhere */
    double scale; /* scale of the positions in the scene of a GLB or USD, as viewers take a unit for a metre; 0: 1. For
                   * positions in pixels it makes the whole picture one unit large */
    int matte;    /* 1: without gloss, as a captured surface, whose gloss was not measured */
} merlin_mesh;

/* Options; all zeros are the defaults. */
typedef struct merlin_mesh_params {
    int side;         /* vertices a side of the square around the object; 0: 512, beyond which shape has no detail */
    int texture_side; /* side of the textures in pixels; 0: 2048. Neither side exceeds the square's in the photograph */
} merlin_mesh_params;

/* Makes a mesh of a photograph's maps: in camera space, with the object near (0, 0, -1), and albedo and roughness as
 * textures. params NULL: the defaults. */
merlin_status merlin_mesh_from_maps(const merlin_maps *maps, const merlin_mesh_params *params, merlin_mesh *out);
/* Makes a mesh of a captured surface: a vertex for each pixel of its mask, albedo scaled to a brightest of 0.9. */
merlin_status merlin_mesh_from_surface(const merlin_surface *surface, merlin_mesh *out);
void merlin_mesh_free(merlin_mesh *mesh);

/* Returns MERLIN_WRONG_USE unless a mesh can be written under this name, which ends in .ply, .obj, .glb or .usda, so
 * that one can check before long work. */
merlin_status merlin_mesh_check_name(const char *path);
/* Lists the files of which a mesh of this name consists, whether or not they exist: itself and, of an .obj or .usda,
 * its material and textures; those that merlin_mesh_write makes of this mesh, or, for NULL, of any. MERLIN_WRONG_USE
 * for other names. Give it to merlin_files_free. */
merlin_status merlin_mesh_files(const merlin_mesh *mesh, const char *path, merlin_files *out);
/* Writes a mesh in the format of the path's ending: .ply (binary) with colours of vertices, .obj with NAME.mtl and, if
 * it has albedo, NAME.png, .glb with albedo, roughness and normals as textures, or .usda (a preview surface) with the
 * same as NAME.png, NAME_roughness.png and NAME_normal.png beside it. After a failure no file is left incomplete.
 * MERLIN_CANNOT_WRITE if one of these lies there without the mesh, as it belongs to something else.
 * written (may be NULL) gets their paths. A GLB has at most 4 GiB. */
merlin_status merlin_mesh_write(const merlin_mesh *mesh, const char *path, merlin_files *written);

#ifdef __cplusplus
}
#endif

#endif
