/* The first step of many paths at once: what is arithmetic alone is done for all of them in vector registers, then
 * their rays are traced together. Most paths end there, for most of an object's surface sees no other.
 *
 *     bundle b;
 *     bundle_begin(&b, &source, at, view, points, count);
 *     bundle_scatter(&b, diffuse_only);
 *     trace_packet(scene, &b.rays, hits);
 *     for (int i = 0; i < b.count; i++) if (hits[i].distance >= 0) ... b.throughput ...
 */
#ifndef MERLIN_RENDER_BUNDLE_H
#define MERLIN_RENDER_BUNDLE_H

#include "render/sequence.h"
#include "render/trace.h"

/* Vectors, one a lane. */
typedef struct lanes {
    float x[TRACE_PACKET], y[TRACE_PACKET], z[TRACE_PACKET];
} lanes;

typedef struct bundle {
    int count; /* lanes in use */
    const scn_surface *at[TRACE_PACKET];
    const vec3 *view[TRACE_PACKET];
    uint32_t index[TRACE_PACKET];                   /* of the path in its sequence */
    lanes albedo, normal, geometric_normal, toward; /* toward: the viewer */
    float roughness[TRACE_PACKET];
    ray_packet rays; /* leave the surfaces */
    lanes throughput;
    float pdf[TRACE_PACKET];
} bundle;

/* Paths `first` and on of a sequence start at the points in turn. */
void bundle_begin(bundle *b, uint32_t first, const scn_surface *at, const vec3 *view, int points, int count);

/* Draws directions from the BRDF; rays.valid tells which paths go on, throughput is f cosθ / pdf. */
void bundle_scatter(bundle *b, const sequence *q, bool diffuse_only);

/* The same for directions that are given (in rays, with their density in light_pdf): throughput is f cosθ over the sum
 * of both densities. */
void bundle_reflect(bundle *b, const float *light_pdf, bool diffuse_only);

static inline vec3 lanes_at(const lanes *l, int i)
{
    return vec3_make(l->x[i], l->y[i], l->z[i]);
}

static inline void lanes_put(lanes *l, int i, vec3 v)
{
    l->x[i] = v.x;
    l->y[i] = v.y;
    l->z[i] = v.z;
}

#endif
