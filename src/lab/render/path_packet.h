/* SPDX-License-Identifier: MIT */
/* The first step of many paths at once: arithmetic is done in vector registers, then the rays are traced together. Most
 * paths end there, as most of an object's surface sees no other surface.
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

/* The surface points seen in one pixel, at which paths start in turn. */
typedef struct path_points {
    const scene_surface *at;
    const vec3 *view; /* unit, from each point to the eye */
    int count;
    uint32_t index; /* number of the pixel's first path in the sequence */
} path_points;

typedef struct path_packet {
    int count;                                      /* lanes in use */
    int pixel[TRACE_PACKET];                        /* pixel of the path */
    uint32_t index[TRACE_PACKET];                   /* number of the path in its sequence */
    lanes albedo, normal, geometric_normal, toward; /* toward: to the viewer */
    float roughness[TRACE_PACKET];
    ray_packet rays; /* leaving the surfaces */
    lanes throughput;
    float pdf[TRACE_PACKET];
} path_packet;

/* Begins with path number `first` of the paths of `count` pixels, `paths` each, and the ones after it. */
void path_packet_begin(path_packet *b, const path_points *pixels, int count, int paths, int first);

/* Samples directions from the BRDF; rays.valid tells which paths continue, throughput is f cosθ / pdf. */
void path_packet_scatter(path_packet *b, const sequence *q, bool diffuse_only);

/* Evaluates given directions (in rays, with their density in light_pdf): throughput is f cosθ over the sum of both
 * densities. */
void path_packet_reflect(path_packet *b, const float *light_pdf, bool diffuse_only);

#endif
