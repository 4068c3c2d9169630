/* SPDX-License-Identifier: MIT */
#include "lab/render/path_packet.h"

#include "base/number.h"
#include "optics/brdf.h"

/* A loop with a condition in it does not vectorize either: the loops below are compiled twice, once for each value of
 * diffuse_only. */

/* Fills all lanes, so that loops need no remainder; lanes beyond count repeat the first, and are never traced. */
void path_packet_begin(path_packet *b, const path_points *pixels, int count, int paths, int first)
{
    int left = count * paths - first;
    b->count = left < TRACE_PACKET ? left : TRACE_PACKET;
    for (int i = 0; i < TRACE_PACKET; i++) {
        int path = first + (i < left ? i : 0);
        const path_points *p = &pixels[path / paths];
        uint32_t index = p->index + (uint32_t)(path % paths), point = index % (uint32_t)p->count;
        const scene_surface *s = p->at + point;
        b->pixel[i] = path / paths;
        b->index[i] = index;
        vec3 origin = trace_leave(s);
        b->rays.x[i] = origin.x;
        b->rays.y[i] = origin.y;
        b->rays.z[i] = origin.z;
        lanes_put(&b->albedo, i, s->albedo);
        lanes_put(&b->normal, i, s->normal);
        lanes_put(&b->geometric_normal, i, s->geometric_normal);
        lanes_put(&b->toward, i, p->view[point]);
        b->roughness[i] = s->roughness;
    }
}

/* Returns the BRDF and sets the density of its own directions. */
ALWAYS_INLINE vec3 evaluate(const path_packet *b, int i, vec3 l, bool diffuse_only, real *pdf)
{
    vec3 albedo = lanes_at(&b->albedo, i), n = lanes_at(&b->normal, i);
    if (!diffuse_only) return brdf_eval_pdf(albedo, b->roughness[i], n, l, lanes_at(&b->toward, i), pdf);
    *pdf = clamp(vec3_dot(n, l), 0, 1) / PI;
    return vec3_scale(albedo, 1 / PI);
}

/* Decides which paths continue: both normals must face l, the shading normal for the BRDF, the geometric one so that no
 * light passes through the surface. It is a loop of its own, as comparisons inside the other keep it from vectorizing.
 */
static void decide(path_packet *b)
{
    int count = b->count;
#pragma omp simd
    for (int i = 0; i < TRACE_PACKET; i++) {
        vec3 l = vec3_make(b->rays.dx[i], b->rays.dy[i], b->rays.dz[i]);
        real cosine = vec3_dot(lanes_at(&b->normal, i), l), above = vec3_dot(lanes_at(&b->geometric_normal, i), l);
        b->rays.valid[i] = -((cosine > 0) & (above > 0) & (b->pdf[i] >= (real)1e-6) & (i < count));
        lanes_put(&b->throughput, i, vec3_scale(lanes_at(&b->throughput, i), cosine / b->pdf[i]));
    }
}

ALWAYS_INLINE void scatter_lanes(path_packet *b, const sequence *q, bool diffuse_only)
{
#pragma omp simd
    for (int i = 0; i < TRACE_PACKET; i++) {
        path_start start = sequence_at(q, SEQUENCE_DIRECTION, b->index[i]);
        real choice = sequence_at(q, SEQUENCE_CHOICE, b->index[i]).u1, pdf;
        vec3 albedo = lanes_at(&b->albedo, i), n = lanes_at(&b->normal, i), v = lanes_at(&b->toward, i);
        vec3 l = diffuse_only ? brdf_sample_cosine(n, start.u1, start.u2)
                              : brdf_sample(albedo, b->roughness[i], n, v, start.u1, start.u2, choice);
        vec3 f = evaluate(b, i, l, diffuse_only, &pdf);
        b->rays.dx[i] = l.x;
        b->rays.dy[i] = l.y;
        b->rays.dz[i] = l.z;
        b->pdf[i] = pdf;
        lanes_put(&b->throughput, i, f);
    }
}

void path_packet_scatter(path_packet *b, const sequence *q, bool diffuse_only)
{
    if (diffuse_only)
        scatter_lanes(b, q, true);
    else
        scatter_lanes(b, q, false);
    decide(b);
}

ALWAYS_INLINE void reflect_lanes(path_packet *b, const float *light_pdf, bool diffuse_only)
{
#pragma omp simd
    for (int i = 0; i < TRACE_PACKET; i++) {
        real pdf;
        vec3 l = vec3_make(b->rays.dx[i], b->rays.dy[i], b->rays.dz[i]);
        vec3 f = evaluate(b, i, l, diffuse_only, &pdf);
        b->pdf[i] = pdf + light_pdf[i];
        lanes_put(&b->throughput, i, f);
    }
}

void path_packet_reflect(path_packet *b, const float *light_pdf, bool diffuse_only)
{
    if (diffuse_only)
        reflect_lanes(b, light_pdf, true);
    else
        reflect_lanes(b, light_pdf, false);
    decide(b);
}
