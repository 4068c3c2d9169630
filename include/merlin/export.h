/* SPDX-License-Identifier: MIT */
/* merlin/export: maps for other programs: game engines, 3-D programs, milling machines and printers.
 *
 *     const merlin_export_params unreal = {.maps = MERLIN_EXPORT_ALBEDO | MERLIN_EXPORT_NORMAL | MERLIN_EXPORT_ORM,
 *                                          .normal_down = 1};
 *     if (merlin_maps_read("cup.merlin", &maps) || merlin_maps_export(&maps, &unreal, "cup.unreal", NULL, NULL))
 *         fprintf(stderr, "%s\n", merlin_error());
 *
 * All maps show the square around the object. Outside the object textures continue smoothly, so that they have no dark
 * edge at small sizes, and heights, which are on the photograph's grid and so in perspective, are 0; alpha.png shows
 * where the object is. export.json contains the numbers that programs need. */
#ifndef MERLIN_EXPORT_H
#define MERLIN_EXPORT_H

#include <merlin/files.h>
#include <merlin/maps.h>

#ifdef __cplusplus
extern "C" {
#endif

/* Files to write: a sum of these. */
typedef enum merlin_export_map {
    MERLIN_EXPORT_ALBEDO = 1 << 0,     /* albedo.png: 8 bits, sRGB */
    MERLIN_EXPORT_NORMAL = 1 << 1,     /* normal.png: 16 bits, (n + 1) / 2, in the camera's space, which is the tangent
                                        * space of a plane that faces it */
    MERLIN_EXPORT_ROUGHNESS = 1 << 2,  /* roughness.png: 8 bits, linear, for GGX: the square root of its alpha */
    MERLIN_EXPORT_SMOOTHNESS = 1 << 3, /* smoothness.png: 1 - roughness */
    MERLIN_EXPORT_OCCLUSION = 1 << 4,  /* ao.png: 8 bits, linear: merlin_maps_occlusion */
    MERLIN_EXPORT_ORM = 1 << 5,        /* orm.png: occlusion, roughness and metalness (0) as red, green and blue */
    MERLIN_EXPORT_HEIGHT = 1 << 6,     /* height.png: 16 bits, linear: the lowest point 0, the highest 1 */
    MERLIN_EXPORT_HEIGHT_FLOAT = 1 << 7, /* height.exr: 32-bit float, in widths of the square, above the lowest point */
    MERLIN_EXPORT_ALPHA = 1 << 8,        /* alpha.png: 8 bits, linear: coverage of a pixel by the object */
    MERLIN_EXPORT_MATERIALX = 1 << 9, /* material.mtlx: albedo, normals, roughness, and the files that it refers to */
    MERLIN_EXPORT_ALL = (1 << 10) - 1,
} merlin_export_map;

enum { MERLIN_EXPORT_SIDE = 2048, MERLIN_EXPORT_LEAST_SIDE = 64, MERLIN_EXPORT_MOST_SIDE = 8192 };

/* Options; all zeros are the defaults. */
typedef struct merlin_export_params {
    unsigned maps;   /* merlin_export_map's bits; 0: albedo, normal, roughness, occlusion, height and alpha */
    int normal_down; /* 1: green in normal.png is larger where the surface faces downwards (DirectX, Unreal); 0: upwards
                      * (OpenGL, Unity, Blender, MaterialX) */
    int side;        /* pixels a side, within the two bounds; 0: the square's size in the photograph, at most
                      * MERLIN_EXPORT_SIDE */
    int (*stop)(void); /* called between the files; a nonzero result ends the work with MERLIN_STOPPED; may be NULL */
    merlin_progress progress; /* called with "exporting"; may be NULL */
    void *progress_context;
} merlin_export_params;

/* Numbers of export.json. */
typedef struct merlin_export_facts {
    int side;     /* side of all pictures in pixels */
    float relief; /* height difference between the lowest and the highest point in widths of the square: the scale of a
                   * displacement by height.png on a plane of width 1 */
    float width;  /* width of the square at the object's mean distance, in the maps' unit, in which a photograph's or
                   * captured object is about 1 from the camera */
} merlin_export_facts;

/* Writes the files into a folder, which is created if necessary: all of them or, after a failure, none. params NULL:
 * the defaults. facts and written (the files' paths) may be NULL. MERLIN_WRONG_USE for an impossible sum or side, and
 * for MERLIN_EXPORT_MATERIALX with normal_down, which MaterialX cannot express; MERLIN_EXPORT_ALL leaves it out then.
 * MERLIN_CANNOT_WRITE if the folder has files of these names that no export wrote. */
merlin_status merlin_maps_export(const merlin_maps *maps, const merlin_export_params *params, const char *folder,
                                 merlin_export_facts *facts, merlin_files *written);

/* Computes ambient occlusion: the cosine-weighted share of the directions around a point's normal that the object
 * leaves open (Miller 1994). out: side x side pixels, 1 channel in [0, 1], 1 outside the object. */
merlin_status merlin_maps_occlusion(const merlin_maps *maps, int side, merlin_image *out);

#ifdef __cplusplus
}
#endif

#endif
