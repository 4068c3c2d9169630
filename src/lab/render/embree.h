/* SPDX-License-Identifier: MIT */
/* One interface to Embree 3 and 4, which name their headers and a query's settings differently. Internal to
 * src/lab/render.
 *
 *     embree_intersect16(valid, scene, &packet, EMBREE_COHERENT);
 */
#ifndef MERLIN_LAB_RENDER_EMBREE_H
#define MERLIN_LAB_RENDER_EMBREE_H

#if MERLIN_EMBREE == 3
#include <embree3/rtcore.h>

#define EMBREE_INCOHERENT RTC_INTERSECT_CONTEXT_FLAG_INCOHERENT
#define EMBREE_COHERENT RTC_INTERSECT_CONTEXT_FLAG_COHERENT
typedef enum RTCIntersectContextFlags embree_flags;
typedef struct RTCIntersectContext embree_context;

static inline embree_context embree_settings(embree_flags flags)
{
    embree_context context;
    rtcInitIntersectContext(&context);
    context.flags = flags;
    return context;
}

static inline void embree_intersect16(const int *valid, RTCScene scene, struct RTCRayHit16 *rays, embree_flags flags)
{
    embree_context context = embree_settings(flags);
    rtcIntersect16(valid, scene, &context, rays);
}

static inline void embree_occluded16(const int *valid, RTCScene scene, struct RTCRay16 *rays)
{
    embree_context context = embree_settings(EMBREE_INCOHERENT);
    rtcOccluded16(valid, scene, &context, rays);
}

static inline void embree_intersect1(RTCScene scene, struct RTCRayHit *ray)
{
    embree_context context = embree_settings(EMBREE_INCOHERENT);
    rtcIntersect1(scene, &context, ray);
}

static inline void embree_occluded1(RTCScene scene, struct RTCRay *ray)
{
    embree_context context = embree_settings(EMBREE_INCOHERENT);
    rtcOccluded1(scene, &context, ray);
}

#else
#include <embree4/rtcore.h>

#define EMBREE_INCOHERENT RTC_RAY_QUERY_FLAG_INCOHERENT
#define EMBREE_COHERENT RTC_RAY_QUERY_FLAG_COHERENT
typedef enum RTCRayQueryFlags embree_flags;

static inline void embree_intersect16(const int *valid, RTCScene scene, struct RTCRayHit16 *rays, embree_flags flags)
{
    struct RTCIntersectArguments arguments;
    rtcInitIntersectArguments(&arguments);
    arguments.flags = flags;
    rtcIntersect16(valid, scene, rays, &arguments);
}

static inline void embree_occluded16(const int *valid, RTCScene scene, struct RTCRay16 *rays)
{
    rtcOccluded16(valid, scene, rays, NULL);
}

static inline void embree_intersect1(RTCScene scene, struct RTCRayHit *ray)
{
    rtcIntersect1(scene, ray, NULL);
}

static inline void embree_occluded1(RTCScene scene, struct RTCRay *ray)
{
    rtcOccluded1(scene, ray, NULL);
}
#endif

#endif
