/* SPDX-License-Identifier: MIT */
#include "lab/render/trace.h"

#include <float.h>
#include <stdlib.h>
#include <string.h>

#include "base/threads.h"
#include "lab/render/embree.h"

struct trace_device {
    RTCDevice device;
};

/* Returns the scene as Embree's type, a pointer to an opaque struct that trace.h names without Embree's header. */
static RTCScene bvh_of(const trace_scene *scene)
{
    return (RTCScene)(void *)scene->bvh;
}

static status device_fail(RTCDevice device, const char *what)
{
    static const char *const words[] = {"no error",          "unknown error", "invalid argument",
                                        "invalid operation", "out of memory", "unsupported processor",
                                        "cancelled"};
    enum RTCError error = rtcGetDeviceError(device);
    const char *word = (unsigned)error < 7 ? words[error] : "unknown error";
    return fail(error == RTC_ERROR_OUT_OF_MEMORY ? MERLIN_NO_MEMORY : MERLIN_DEVICE_FAILED, "Embree cannot %s: %s",
                what, word);
}

status trace_device_new(trace_device **out)
{
    *out = NULL;
    /* TBB, which Embree uses, ends the program if it gets none */
    if (!threads_are_left(1)) return fail(MERLIN_NO_MEMORY, "no thread for the ray tracer");
    *out = calloc(1, sizeof **out);
    if (!*out) return fail(MERLIN_NO_MEMORY, "out of memory for the ray tracer");
    /* samples are rendered in parallel, so that each hierarchy is built by the thread that needs it */
    (*out)->device = rtcNewDevice("threads=1,user_threads=1");
    if ((*out)->device) return OK;
    free(*out);
    *out = NULL;
    return device_fail(NULL, "start");
}

void trace_device_free(trace_device *device)
{
    if (!device) return;
    rtcReleaseDevice(device->device);
    free(device);
}

static status attach_triangles(RTCDevice device, RTCScene bvh, const scene_object *object, enum RTCBuildQuality quality)
{
    RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE);
    if (!geometry) return device_fail(device, "make a geometry");
    float *vertices = rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, 3 * sizeof(float),
                                              object->vertex_count);
    uint32_t *triangles = rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3,
                                                  3 * sizeof(uint32_t), object->triangle_count);
    if (!vertices || !triangles) {
        rtcReleaseGeometry(geometry);
        return device_fail(device, "hold the triangles");
    }
    for (uint32_t i = 0; i < object->vertex_count; i++) {
        vertices[3 * i] = (float)object->position[i].x;
        vertices[3 * i + 1] = (float)object->position[i].y;
        vertices[3 * i + 2] = (float)object->position[i].z;
    }
    memcpy(triangles, object->triangle, (size_t)object->triangle_count * sizeof *object->triangle);
    rtcSetGeometryBuildQuality(geometry, quality);
    rtcCommitGeometry(geometry);
    rtcAttachGeometry(bvh, geometry);
    rtcReleaseGeometry(geometry);
    return OK;
}

/* Rays per triangle below which the quick build pays. Measured: it saves 0.18 µs a triangle and costs some 15 ns a ray.
 */
static const double few_rays = 12;

status trace_scene_new(trace_device *device, const scene_object *object, trace_surface_function *surface, double rays,
                       trace_scene *out)
{
    *out = (trace_scene){.object = object, .surface = surface};
    if (object->triangle_count == 0) return fail(MERLIN_BAD_INPUT, "the object has no triangles");
    RTCScene bvh = rtcNewScene(device->device);
    if (!bvh) return device_fail(device->device, "make a scene");
    bool quick = rays < few_rays * (double)object->triangle_count;
    enum RTCBuildQuality quality = quick ? RTC_BUILD_QUALITY_LOW : RTC_BUILD_QUALITY_MEDIUM;
    rtcSetSceneFlags(bvh, RTC_SCENE_FLAG_ROBUST);
    rtcSetSceneBuildQuality(bvh, quality);
    status s = attach_triangles(device->device, bvh, object, quality);
    if (s == OK) {
        rtcCommitScene(bvh);
        if (rtcGetDeviceError(device->device) != RTC_ERROR_NONE)
            s = fail(MERLIN_DEVICE_FAILED, "Embree cannot build its tree");
    }
    if (s != OK) {
        rtcReleaseScene(bvh);
        return s;
    }
    out->bvh = (trace_bvh *)(void *)bvh;
    return OK;
}

void trace_scene_free(trace_scene *scene)
{
    if (scene->bvh) rtcReleaseScene(bvh_of(scene));
    scene->bvh = NULL;
}

void trace_camera_rays(trace_scene *scene, const vec3 *directions, int count, trace_hit *hits)
{
    struct RTCRayHit16 packet;
    _Alignas(64) int valid[TRACE_PACKET];
    memset(&packet, 0, sizeof packet);
    for (int i = 0; i < TRACE_PACKET; i++) {
        vec3 d = directions[i < count ? i : 0];
        valid[i] = i < count ? -1 : 0;
        packet.ray.dir_x[i] = d.x;
        packet.ray.dir_y[i] = d.y;
        packet.ray.dir_z[i] = d.z;
        packet.ray.tfar[i] = FLT_MAX;
        packet.ray.mask[i] = 0xffffffffu;
        packet.hit.geomID[i] = RTC_INVALID_GEOMETRY_ID;
    }
    embree_intersect16(valid, bvh_of(scene), &packet, EMBREE_COHERENT);
    scene->rays += (uint64_t)count;
    for (int i = 0; i < count; i++) {
        bool met = packet.hit.geomID[i] != RTC_INVALID_GEOMETRY_ID;
        hits[i].at = (scene_place){packet.hit.primID[i], packet.hit.u[i], packet.hit.v[i]};
        hits[i].distance = met ? packet.ray.tfar[i] : -1.0f;
    }
}

/* Counts the rays, and copies them to Embree's aligned structure. */
static void fill_rays(trace_scene *scene, const ray_packet *from, struct RTCRay16 *to, int valid[TRACE_PACKET])
{
    int count = 0;
    for (int i = 0; i < TRACE_PACKET; i++)
        count -= valid[i] = from->valid[i];
    scene->rays += (uint64_t)count;
    for (int i = 0; i < TRACE_PACKET; i++) {
        to->org_x[i] = from->x[i];
        to->org_y[i] = from->y[i];
        to->org_z[i] = from->z[i];
        to->tnear[i] = to->time[i] = 0;
        to->dir_x[i] = from->dx[i];
        to->dir_y[i] = from->dy[i];
        to->dir_z[i] = from->dz[i];
        to->tfar[i] = FLT_MAX;
        to->mask[i] = 0xffffffffu;
        to->id[i] = to->flags[i] = 0;
    }
}

void trace_packet(trace_scene *scene, const ray_packet *rays, trace_hit hits[TRACE_PACKET])
{
    struct RTCRayHit16 packet;
    _Alignas(64) int valid[TRACE_PACKET];
    fill_rays(scene, rays, &packet.ray, valid);
    memset(packet.hit.geomID, 0xff, sizeof packet.hit.geomID); /* RTC_INVALID_GEOMETRY_ID */
    embree_intersect16(valid, bvh_of(scene), &packet, EMBREE_INCOHERENT);
    for (int i = 0; i < TRACE_PACKET; i++) {
        bool met = rays->valid[i] && packet.hit.geomID[i] != RTC_INVALID_GEOMETRY_ID;
        hits[i].at = (scene_place){packet.hit.primID[i], packet.hit.u[i], packet.hit.v[i]};
        hits[i].distance = met ? packet.ray.tfar[i] : -1.0f;
    }
}

void trace_packet_free(trace_scene *scene, ray_packet *rays, const float *far)
{
    struct RTCRay16 packet;
    _Alignas(64) int valid[TRACE_PACKET];
    fill_rays(scene, rays, &packet, valid);
    if (far) memcpy(packet.tfar, far, sizeof packet.tfar);
    embree_occluded16(valid, bvh_of(scene), &packet);
    for (int i = 0; i < TRACE_PACKET; i++)
        if (packet.tfar[i] < 0) rays->valid[i] = 0;
}

/* Moves n toward the unit vector d until n·d is at least `least`. */
static vec3 bend_toward(vec3 n, vec3 d, real least)
{
    real c = vec3_dot(n, d);
    return c < least ? vec3_normalize(vec3_fma(n, least - c, d)) : n;
}

static void face(scene_surface *s, vec3 view)
{
    if (vec3_dot(s->geometric_normal, view) < 0) {
        s->geometric_normal = vec3_scale(s->geometric_normal, -1);
        s->normal = vec3_scale(s->normal, -1);
    }
    s->normal = bend_toward(s->normal, view, (real)0.03);
}

void trace_surfaces_at(const trace_scene *scene, const trace_hit *hits, const vec3 *view, int count, scene_surface *out)
{
    scene_place places[TRACE_PACKET];
    for (int done = 0; done < count; done += TRACE_PACKET) {
        int abreast = count - done < TRACE_PACKET ? count - done : TRACE_PACKET;
        for (int i = 0; i < abreast; i++)
            places[i] = hits[done + i].at;
        scene->surface(scene->object, places, abreast, out + done);
    }
    for (int i = 0; i < count; i++)
        face(&out[i], view[i]);
}

static struct RTCRay make_ray(vec3 origin, vec3 direction, float distance)
{
    return (struct RTCRay){.org_x = origin.x,
                           .org_y = origin.y,
                           .org_z = origin.z,
                           .dir_x = direction.x,
                           .dir_y = direction.y,
                           .dir_z = direction.z,
                           .tfar = distance,
                           .mask = 0xffffffffu};
}

bool trace_surface(trace_scene *scene, vec3 origin, vec3 direction, scene_surface *out)
{
    struct RTCRayHit ray = {.ray = make_ray(origin, direction, FLT_MAX)};
    ray.hit.geomID = RTC_INVALID_GEOMETRY_ID;
    embree_intersect1(bvh_of(scene), &ray);
    scene->rays++;
    if (ray.hit.geomID == RTC_INVALID_GEOMETRY_ID) return false;
    trace_hit hit = {{ray.hit.primID, ray.hit.u, ray.hit.v}, ray.ray.tfar};
    vec3 view = vec3_scale(direction, -1);
    trace_surfaces_at(scene, &hit, &view, 1, out);
    return true;
}

bool trace_occluded(trace_scene *scene, vec3 origin, vec3 direction, float distance)
{
    struct RTCRay ray = make_ray(origin, direction, distance);
    embree_occluded1(bvh_of(scene), &ray);
    scene->rays++;
    return ray.tfar < 0;
}
