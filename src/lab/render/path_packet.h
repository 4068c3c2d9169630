/* SPDX-License-Identifier: MIT */
/* The first step of many paths at once: what is arithmetic alone is done for all of them in vector registers, then
 * their rays are traced together. Most paths end there, for most of an object's surface sees no other.
 *
 *     path_packet b;
 *     path_packet_begin(&b, pixels, count, paths, first);
 *     path_packet_scatter(&b, sequence, diffuse_only);
 *     trace_packet(scene, &b.rays, hits);
 *     for (int i = 0; i < b.count; i++) if (hits[i].distance >= 0) ... b.throughput ...
 */
#ifndef MERLIN_LAB_RENDER_PATH_PACKET_H
#define MERLIN_LAB_RENDER_PATH_PACKET_H

#include "lab/render/sequence.h"
#include "lab/render/trace.h"

/* The points of a surface that one pixel shows: paths start at them in turn. */
typedef struct path_points {
    const scene_surface *at;
    const vec3 *view; /* unit, from each point to the eye */
    int count;
    uint32_t index; /* of the pixel's first path in the sequence */
} path_points;

typedef struct path_packet {
    int count;                                      /* lanes in use */
    int pixel[TRACE_PACKET];                        /* that the path is for */
    uint32_t index[TRACE_PACKET];                   /* of the path in its sequence */
    lanes albedo, normal, geometric_normal, toward; /* toward: the viewer */
    float roughness[TRACE_PACKET];
    ray_packet rays; /* leave the surfaces */
    lanes throughput;
    float pdf[TRACE_PACKET];
} path_packet;

/* Of the paths of `count` pixels, so many each, `first` and the ones behind it. */
void path_packet_begin(path_packet *b, const path_points *pixels, int count, int paths, int first);

/* Draws directions from the BRDF; rays.valid tells which paths go on, throughput is f cosθ / pdf. */
void path_packet_scatter(path_packet *b, const sequence *q, bool diffuse_only);

/* The same for directions that are given (in rays, with their density in light_pdf): throughput is f cosθ over the sum
 * of both densities. */
void path_packet_reflect(path_packet *b, const float *light_pdf, bool diffuse_only);

#endif
