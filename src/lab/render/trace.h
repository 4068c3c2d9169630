/* SPDX-License-Identifier: MIT */
/* Traces rays against one object, by Embree.
 *
 *     trace_device *device;
 *     status s = trace_device_new(&device);
 *     trace_scene scene;
 *     s = trace_scene_new(device, &object, scene_surfaces_eval, 1e6, &scene);
 *     scene_surface hit;
 *     if (trace_surface(&scene, origin, direction, &hit)) ...
 *     trace_scene_free(&scene);
 *     trace_device_free(device);
 *
 * A scene is used by one thread at a time; scenes of one device may be used in parallel. */
#ifndef MERLIN_LAB_RENDER_TRACE_H
#define MERLIN_LAB_RENDER_TRACE_H

#include <stdbool.h>
#include <stdint.h>

#include "base/lanes.h"
#include "lab/scene/scene.h"

typedef struct trace_device trace_device;
typedef struct trace_bvh trace_bvh;

/* Evaluates the surface at hits: scene_surfaces_eval for real objects, simpler functions in tests with closed forms. */
typedef void trace_surface_function(const scene_object *object, const scene_place *places, int count,
                                    scene_surface *out);

typedef struct trace_scene {
    const scene_object *object; /* borrowed */
    trace_surface_function *surface;
    trace_bvh *bvh;
    bool diffuse_only; /* omits the specular lobe, for tests against closed forms */
    uint64_t rays;     /* number traced so far */
} trace_scene;

status trace_device_new(trace_device **out);
void trace_device_free(trace_device *device);

/* Builds the hierarchy over the object's triangles. The object must outlive the scene. rays: expected number of rays;
 * with few, a better hierarchy does not repay its time. The results are the same. */
status trace_scene_new(trace_device *device, const scene_object *object, trace_surface_function *surface, double rays,
                       trace_scene *out);
void trace_scene_free(trace_scene *scene);

/* Where a ray hit the object; distance below 0 if it did not. */
typedef struct trace_hit {
    scene_place at;
    float distance;
} trace_hit;

enum { TRACE_PACKET = LANES };
/* Traces up to TRACE_PACKET rays from the origin at once. */
void trace_camera_rays(trace_scene *scene, const vec3 *directions, int count, trace_hit *hits);

/* Arbitrary rays: origins and unit directions; valid: -1 for those to be traced, else 0. */
typedef struct ray_packet {
    float x[TRACE_PACKET], y[TRACE_PACKET], z[TRACE_PACKET];
    float dx[TRACE_PACKET], dy[TRACE_PACKET], dz[TRACE_PACKET];
    int valid[TRACE_PACKET];
} ray_packet;

/* Finds the first hit of each valid ray. */
void trace_packet(trace_scene *scene, const ray_packet *rays, trace_hit hits[TRACE_PACKET]);
/* Clears valid for rays that hit anything within these distances; NULL: at any distance. */
void trace_packet_free(trace_scene *scene, ray_packet *rays, const float *far);

/* Evaluates the surfaces at hits, each seen along -view (view: unit, from the surface to the eye): both normals are
 * turned to the viewer's side, and the shading normal is bent until the viewer sees it at least at grazing angle. */
void trace_surfaces_at(const trace_scene *scene, const trace_hit *hits, const vec3 *view, int count,
                       scene_surface *out);

/* Finds the first surface along a unit direction, ready for shading as above; returns false if there is none. */
bool trace_surface(trace_scene *scene, vec3 origin, vec3 direction, scene_surface *out);
/* Tells whether anything lies between the origin and distance. */
bool trace_occluded(trace_scene *scene, vec3 origin, vec3 direction, float distance);

/* Returns the origin of rays that leave a surface, slightly above it, so that they do not hit it again. */
static inline vec3 trace_leave(const scene_surface *s)
{
    return vec3_fma(s->position, (real)2e-5, s->geometric_normal);
}

#endif
