/* SPDX-License-Identifier: MIT */
/* merlin/mesh: the visible surface of an object as triangles, for Blender, browsers and programs of your own.
 *
 *     merlin_mesh mesh;
 *     if (merlin_mesh_from_maps(&maps, NULL, &mesh) || merlin_mesh_write(&mesh, "cup.glb", NULL))
 *         fprintf(stderr, "%s\n", merlin_error());
 *     merlin_mesh_free(&mesh);
 *
 * It is the front alone: a camera sees nothing of the back. Triangles across a jump in depth are left out. */
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

/* Arrays of vertices and triangles, one after the other. Of a mesh that you fill in yourself, what is said to be for
 * colour or for the normal map may be missing (NULL, no data, 0). */
typedef struct merlin_mesh {
    size_t vertex_count, triangle_count;
    float *positions;    /* 3 a vertex, in camera space: x right, y up, -z away from the camera; in depth's unit, or in
                          * pixels of a camera that is far away */
    float *normals;      /* 3 a vertex, unit: the maps' */
    float *uvs;          /* 2 a vertex, of textures: (0, 0) is their upper left corner, (1, 1) the lower right one */
    float *colors;       /* 3 a vertex: albedo, linear, [0, 1]. For colour */
    uint32_t *triangles; /* 3 numbers of vertices a triangle, counter-clockwise as the camera sees it */
    int width, height;   /* of the maps that a vertex is a pixel of. For the normal map, as the next two: */
    uint32_t *pixels;    /* 1 a vertex: row * width + column in these maps */
    float *face_normals; /* 3 a vertex, unit: the mean of the triangles' around it, by area; NULL: as normals, as if
                          * there were no other ones */
    merlin_image albedo; /* texture: 3 channels, linear, [0, 1], of any size. For colour */
    merlin_image roughness; /* texture: 1 channel, of any size; no data: 1 everywhere */
    double scale; /* with which a GLB's scene shows positions, as viewers take a unit for a metre; 0: 1. Positions in
                   * pixels make the whole picture one unit large */
} merlin_mesh;

/* All zeros is the usual case. */
typedef struct merlin_mesh_params {
    int side; /* of the square around the object, in vertices; 0: 512, to which a network's shape adds nothing */
    int texture_side; /* of the textures, in pixels; 0: 2048. Neither is larger than the square in the photograph */
} merlin_mesh_params;

/* Makes a photograph's: in camera space, the object about (0, 0, -1), its textures albedo and roughness. params NULL:
 * the usual case. */
merlin_status merlin_mesh_from_maps(const merlin_maps *maps, const merlin_mesh_params *params, merlin_mesh *out);
/* Makes a captured surface's, a vertex for each pixel of its mask, albedo scaled so that its brightest are 0.9. */
merlin_status merlin_mesh_from_surface(const merlin_surface *surface, merlin_mesh *out);
void merlin_mesh_free(merlin_mesh *mesh);

/* Returns MERLIN_WRONG_USE unless a mesh can be written under this name, which ends in .ply, .obj or .glb: asked before
 * long work. */
merlin_status merlin_mesh_check_name(const char *path);
/* Writes a mesh, by the path's ending: .ply (binary) with normals and colours of vertices, .obj with NAME.mtl and, if
 * it has albedo, NAME.png, or .glb with albedo, roughness and normals as textures. All of them or, after a failure,
 * none that is half written. written (may be NULL) gets their paths. A GLB holds at most 4 GiB. */
merlin_status merlin_mesh_write(const merlin_mesh *mesh, const char *path, merlin_files *written);

#ifdef __cplusplus
}
#endif

#endif
