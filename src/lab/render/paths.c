/* SPDX-License-Identifier: MIT */
#include "lab/render/paths.h"

#include <string.h>

#include "base/number.h"
#include "optics/brdf.h"
#include "optics/led.h"

static const vec3 black = {0, 0, 0};

/* Returns the BRDF and the density of scatter at l. */
static vec3 reflect_density(const trace_scene *scene, const scene_surface *at, vec3 l, vec3 view, real *pdf)
{
    if (!scene->diffuse_only) return brdf_eval_pdf(at->albedo, at->roughness, at->normal, l, view, pdf);
    *pdf = clamp(vec3_dot(at->normal, l), 0, 1) / PI;
    return vec3_scale(at->albedo, 1 / PI);
}

/* Tells whether both normals face l: the shading normal for the BRDF, the geometric one so that no light passes through
 * the surface. */
static bool faces(const scene_surface *at, vec3 l)
{
    return vec3_dot(at->normal, l) > 0 && vec3_dot(at->geometric_normal, l) > 0;
}

/* Samples the next direction and multiplies throughput by f cosθ / pdf; returns false if the path ends. */
static bool scatter(const trace_scene *scene, const scene_surface *at, vec3 view, path_start start, real choice,
                    vec3 *l, real *pdf, vec3 *throughput)
{
    if (scene->diffuse_only)
        *l = brdf_sample_cosine(at->normal, start.u1, start.u2);
    else
        *l = brdf_sample(at->albedo, at->roughness, at->normal, view, start.u1, start.u2, choice);
    if (!faces(at, *l)) return false;
    vec3 f = reflect_density(scene, at, *l, view, pdf);
    if (*pdf < (real)1e-6) return false;
    *throughput = vec3_mul(*throughput, vec3_scale(f, vec3_dot(at->normal, *l) / *pdf));
    return true;
}

static vec3 clamp_path(vec3 c)
{
    return vec3_make(c.x < PATH_CLAMP ? c.x : PATH_CLAMP, c.y < PATH_CLAMP ? c.y : PATH_CLAMP,
                     c.z < PATH_CLAMP ? c.z : PATH_CLAMP);
}

static path_start random_start(rng *r)
{
    real a = rng_uniform(r), b = rng_uniform(r);
    return (path_start){a, b};
}

/* ---- direct light of a point light
 * ----------------------------------------------------------------------------------- */

/* Inputs of shading, one point a lane; lanes beyond count repeat the first. */
typedef struct shaded {
    lanes position, normal, albedo, view, light;
    float roughness[LANES];
} shaded;

/* Points of a disc that are tested for shadows: one a quarter, so that a half hidden lamp gives about half its light.
 */
enum { PARTS = 4 };

static int parts_of(const point_light *light)
{
    return vec3_length(light->across[0]) > 0 ? PARTS : 1;
}

/* Returns 32 pseudo-random bits of a position: neighbours test other points of a lamp, and a position always the same
 * ones. */
static uint32_t scramble(vec3 place)
{
    uint32_t bits[3], h = 0x9e3779b9u;
    const float at[3] = {(float)place.x, (float)place.y, (float)place.z};
    memcpy(bits, at, sizeof bits);
    for (int i = 0; i < 3; i++) {
        h = (h ^ bits[i]) * 0x85ebca6bu;
        h = (h ^ h >> 13) * 0xc2b2ae35u;
        h ^= h >> 16;
    }
    return h;
}

/* Returns the point of a part of a lamp that is tested: uniform over a quarter of the disc. */
static vec3 place_of_part(const point_light *light, int part, vec3 seen_from)
{
    if (parts_of(light) == 1) return light->position;
    uint32_t bits = scramble(seen_from);
    real u1 = ((real)(part & 1) + (real)(bits & 0xffff) / 0x10000) / 2;
    real u2 = ((real)(part >> 1) + (real)(bits >> 16) / 0x10000) / 2;
    real radius = sqrt(u1), angle = 2 * PI * u2;
    vec3 place = vec3_fma(light->position, radius * cos(angle), light->across[0]);
    return vec3_fma(place, radius * sin(angle), light->across[1]);
}

static void gather(const scene_surface *at, const vec3 *view, int count, const point_light *light, int part,
                   shaded *out)
{
    for (int i = 0; i < LANES; i++) {
        int from = i < count ? i : 0;
        lanes_put(&out->position, i, at[from].position);
        lanes_put(&out->normal, i, at[from].normal);
        lanes_put(&out->albedo, i, at[from].albedo);
        lanes_put(&out->view, i, view[from]);
        lanes_put(&out->light, i, place_of_part(light, part, at[from].position));
        out->roughness[i] = at[from].roughness;
    }
}

ALWAYS_INLINE void shade_lanes(const shaded *s, real power, bool diffuse_only, lanes *out)
{
#pragma omp simd
    for (int i = 0; i < LANES; i++) {
        vec3 n = lanes_at(&s->normal, i), albedo = lanes_at(&s->albedo, i);
        vec3 to_light = vec3_sub(lanes_at(&s->light, i), lanes_at(&s->position, i));
        real distance2 = vec3_dot(to_light, to_light);
        vec3 l = vec3_scale(to_light, 1 / sqrt(distance2));
        real cosine = vec3_dot(n, l);
        vec3 f =
            diffuse_only ? vec3_scale(albedo, 1 / PI) : brdf_eval(albedo, s->roughness[i], n, l, lanes_at(&s->view, i));
        bool lit = (cosine > 0) & (distance2 >= (real)1e-6);
        real strength = power * cosine / distance2;
        lanes_put(out, i, vec3_make(lit ? f.x * strength : 0, lit ? f.y * strength : 0, lit ? f.z * strength : 0));
    }
}

/* Dims the light of an LED on points beside its axis: a loop of its own, as a power does not vectorize. */
static void dim_beside_axis(const point_light *light, const shaded *s, int count, lanes *lit)
{
    for (int i = 0; i < count; i++) {
        vec3 l = vec3_normalize(vec3_sub(lanes_at(&s->light, i), lanes_at(&s->position, i)));
        lanes_put(lit, i, vec3_scale(lanes_at(lit, i), led_share(light->axis, light->lobe, l)));
    }
}

/* Computes the light of one part of a lamp on up to LANES points, without shadows. */
static void shade_part(const trace_scene *scene, const scene_surface *at, const vec3 *view, int count,
                       const point_light *light, int part, shaded *s, lanes *lit)
{
    real power = light->power / (real)parts_of(light);
    gather(at, view, count, light, part, s);
    if (scene->diffuse_only)
        shade_lanes(s, power, true, lit);
    else
        shade_lanes(s, power, false, lit);
    if (light->lobe > 0) dim_beside_axis(light, s, count, lit);
}

/* Sets the light to zero for points in shadow. */
static void cast_shadows(trace_scene *scene, const scene_surface *at, int count, const shaded *s, lanes *lit)
{
    ray_packet rays;
    float far[LANES];
    for (int i = 0; i < LANES; i++) {
        int from = i < count ? i : 0;
        vec3 origin = trace_leave(&at[from]), to_light = vec3_sub(lanes_at(&s->light, from), origin),
             radiance = lanes_at(lit, from);
        far[i] = vec3_length(to_light);
        vec3 l = vec3_scale(to_light, 1 / far[i]);
        rays.x[i] = origin.x;
        rays.y[i] = origin.y;
        rays.z[i] = origin.z;
        rays.dx[i] = l.x;
        rays.dy[i] = l.y;
        rays.dz[i] = l.z;
        rays.valid[i] = i < count && radiance.x + radiance.y + radiance.z > 0 && faces(&at[from], to_light) ? -1 : 0;
    }
    trace_packet_free(scene, &rays, far);
    for (int i = 0; i < count; i++)
        if (!rays.valid[i]) lanes_put(lit, i, black);
}

/* Adds the lanes to sum; the first part sets it. */
static void add_part(const lanes *lit, int count, int part, vec3 *sum)
{
    for (int i = 0; i < count; i++)
        sum[i] = part == 0 ? lanes_at(lit, i) : vec3_add(sum[i], lanes_at(lit, i));
}

/* Computes direct light with and without shadows; either of radiance and unshadowed may be NULL. */
static void light_points(trace_scene *scene, const scene_surface *at, const vec3 *view, int count,
                         const point_light *light, vec3 *radiance, vec3 *unshadowed)
{
    shaded s;
    lanes lit;
    for (int done = 0; done < count; done += LANES) {
        int abreast = count - done < LANES ? count - done : LANES;
        for (int part = 0; part < parts_of(light); part++) {
            shade_part(scene, at + done, view + done, abreast, light, part, &s, &lit);
            if (unshadowed) add_part(&lit, abreast, part, unshadowed + done);
            if (!radiance) continue;
            cast_shadows(scene, at + done, abreast, &s, &lit);
            add_part(&lit, abreast, part, radiance + done);
        }
    }
}

void point_light_unshadowed(trace_scene *scene, const scene_surface *at, const vec3 *view, int count,
                            const point_light *light, vec3 *radiance)
{
    light_points(scene, at, view, count, light, NULL, radiance);
}

void point_light_direct(trace_scene *scene, const scene_surface *at, const vec3 *view, int count,
                        const point_light *light, vec3 *radiance)
{
    light_points(scene, at, view, count, light, radiance, NULL);
}

void point_light_both(trace_scene *scene, const scene_surface *at, const vec3 *view, int count,
                      const point_light *light, vec3 *radiance, vec3 *unshadowed)
{
    light_points(scene, at, view, count, light, radiance, unshadowed);
}

/* ---- paths that hit another surface
 * ---------------------------------------------------------------------------------- */

/* Number of paths begun before those that hit a surface are continued together. */
enum { WAVE = 16 * TRACE_PACKET };

typedef struct arrivals {
    int count;
    int pixel[WAVE];
    uint32_t index[WAVE]; /* number of the path in its sequence */
    vec3 throughput[WAVE], view[WAVE];
    trace_hit hit[WAVE];
    scene_surface at[WAVE];
    vec3 direct[WAVE]; /* a point light's light */
} arrivals;

static void arrive(arrivals *a, const path_packet *b, int lane, const trace_hit *hit)
{
    int k = a->count++;
    a->pixel[k] = b->pixel[lane];
    a->index[k] = b->index[lane];
    a->throughput[k] = lanes_at(&b->throughput, lane);
    a->view[k] = vec3_make(-b->rays.dx[lane], -b->rays.dy[lane], -b->rays.dz[lane]);
    a->hit[k] = *hit;
}

/* Adds bounces 2 and 3 of arrival k. */
static void follow_point_light(trace_scene *scene, const arrivals *a, int k, const point_light *light,
                               const path_source *source, vec3 bounce[2])
{
    vec3 throughput = a->throughput[k], l, back, third;
    const scene_surface *from = &a->at[k];
    scene_surface to;
    real pdf;
    bounce[0] = vec3_add(bounce[0], clamp_path(vec3_mul(throughput, a->direct[k])));
    path_start start = sequence_at(source->sequence, SEQUENCE_SECOND, a->index[k]);
    real choice = sequence_at(source->sequence, SEQUENCE_CHOICE, a->index[k]).u2;
    if (!scatter(scene, from, a->view[k], start, choice, &l, &pdf, &throughput)) return;
    if (!trace_surface(scene, trace_leave(from), l, &to)) return;
    back = vec3_scale(l, -1);
    point_light_direct(scene, &to, &back, 1, light, &third);
    bounce[1] = vec3_add(bounce[1], clamp_path(vec3_mul(throughput, third)));
}

void point_light_paths(trace_scene *scene, const path_points *pixels, int count, const point_light *light,
                       const path_source *source, int paths, vec3 (*bounce)[2])
{
    path_packet b;
    trace_hit hits[TRACE_PACKET];
    arrivals a;
    for (int i = 0; i < count; i++)
        bounce[i][0] = bounce[i][1] = black;
    for (int done = 0; done < count * paths;) {
        a.count = 0;
        for (int end = done + WAVE; done < end && done < count * paths; done += TRACE_PACKET) {
            path_packet_begin(&b, pixels, count, paths, done);
            path_packet_scatter(&b, source->sequence, scene->diffuse_only);
            trace_packet(scene, &b.rays, hits);
            for (int i = 0; i < b.count; i++)
                if (hits[i].distance >= 0) arrive(&a, &b, i, &hits[i]);
        }
        trace_surfaces_at(scene, a.hit, a.view, a.count, a.at);
        point_light_direct(scene, a.at, a.view, a.count, light, a.direct);
        for (int k = 0; k < a.count; k++)
            follow_point_light(scene, &a, k, light, source, bounce[a.pixel[k]]);
    }
}

/* ---- the environment ------------------------------------------------------------------------------------------- */

/* Returns the environment's light on one surface, by a direction sampled from the map. */
static vec3 environment_direct(trace_scene *scene, const scene_surface *at, vec3 view, const environment *env,
                               path_start u)
{
    float u1[LANES] = {u.u1}, u2[LANES] = {u.u2};
    environment_rays drawn;
    environment_sample(env, u1, u2, 1, &drawn);
    vec3 l = lanes_at(&drawn.direction, 0);
    if (!faces(at, l)) return black;
    real pdf;
    vec3 f = reflect_density(scene, at, l, view, &pdf);
    vec3 share = vec3_scale(f, vec3_dot(at->normal, l) / (drawn.pdf[0] + pdf));
    vec3 result = vec3_mul(share, lanes_at(&drawn.radiance, 0));
    if (result.x + result.y + result.z <= 0) return black;
    return trace_occluded(scene, trace_leave(at), l, 1e4f) ? black : result;
}

/* Returns the map's light along a direction that was sampled from the BRDF with this density. */
static vec3 environment_seen(const environment *env, vec3 l, real pdf)
{
    real light_pdf;
    vec3 radiance = environment_look(env, l, &light_pdf);
    return vec3_scale(radiance, pdf / (pdf + light_pdf));
}

/* Returns the light along arrival k: from the map, at up to two more surfaces. */
static vec3 follow_environment(trace_scene *scene, const arrivals *a, int k, const environment *env, rng *r)
{
    enum { MORE_SURFACES = 2 };
    vec3 sum = black, throughput = a->throughput[k], v = a->view[k], l;
    scene_surface from = a->at[k], to;
    for (int left = MORE_SURFACES; left > 0; left--) {
        real pdf;
        vec3 direct = vec3_mul(throughput, environment_direct(scene, &from, v, env, random_start(r)));
        sum = vec3_add(sum, clamp_path(direct));
        path_start start = random_start(r);
        if (!scatter(scene, &from, v, start, rng_uniform(r), &l, &pdf, &throughput)) break;
        if (!trace_surface(scene, trace_leave(&from), l, &to)) {
            sum = vec3_add(sum, clamp_path(vec3_mul(throughput, environment_seen(env, l, pdf))));
            break;
        }
        v = vec3_scale(l, -1);
        from = to;
    }
    return sum;
}

static void add(vec3 *radiance, const path_packet *b, int lane, vec3 light)
{
    vec3 *sum = &radiance[b->pixel[lane]];
    *sum = vec3_add(*sum, vec3_mul(lanes_at(&b->throughput, lane), light));
}

/* Adds the map's light at the first surfaces, by directions sampled from the map. */
static void first_environment_direct(trace_scene *scene, path_packet *b, const environment *env, const sequence *q,
                                     vec3 *radiance)
{
    float u1[LANES], u2[LANES];
    environment_rays drawn;
#pragma omp simd
    for (int i = 0; i < LANES; i++) {
        path_start u = sequence_at(q, SEQUENCE_LIGHT, b->index[i]);
        u1[i] = u.u1;
        u2[i] = u.u2;
    }
    environment_sample(env, u1, u2, LANES, &drawn);
    memcpy(b->rays.dx, drawn.direction.x, sizeof b->rays.dx);
    memcpy(b->rays.dy, drawn.direction.y, sizeof b->rays.dy);
    memcpy(b->rays.dz, drawn.direction.z, sizeof b->rays.dz);
    path_packet_reflect(b, drawn.pdf, scene->diffuse_only);
    trace_packet_free(scene, &b->rays, NULL);
    for (int i = 0; i < b->count; i++)
        if (b->rays.valid[i]) add(radiance, b, i, lanes_at(&drawn.radiance, i));
}

/* Adds the map's light along BRDF samples at the first surfaces; paths that hit another surface become arrivals. */
static void begin_environment_paths(trace_scene *scene, path_packet *b, const environment *env, const sequence *q,
                                    vec3 *radiance, arrivals *a)
{
    trace_hit hits[TRACE_PACKET];
    first_environment_direct(scene, b, env, q, radiance);
    path_packet_scatter(b, q, scene->diffuse_only);
    trace_packet(scene, &b->rays, hits);
    for (int i = 0; i < b->count; i++) {
        vec3 l = vec3_make(b->rays.dx[i], b->rays.dy[i], b->rays.dz[i]);
        if (hits[i].distance >= 0)
            arrive(a, b, i, &hits[i]);
        else if (b->rays.valid[i])
            add(radiance, b, i, environment_seen(env, l, b->pdf[i]));
    }
}

void environment_paths(trace_scene *scene, const path_points *pixels, int count, const environment *env,
                       const path_source *source, int paths, vec3 *radiance)
{
    path_packet b;
    arrivals a;
    for (int i = 0; i < count; i++)
        radiance[i] = black;
    for (int done = 0; done < count * paths;) {
        a.count = 0;
        for (int end = done + WAVE; done < end && done < count * paths; done += TRACE_PACKET) {
            path_packet_begin(&b, pixels, count, paths, done);
            begin_environment_paths(scene, &b, env, source->sequence, radiance, &a);
        }
        trace_surfaces_at(scene, a.hit, a.view, a.count, a.at);
        for (int k = 0; k < a.count; k++) {
            vec3 *sum = &radiance[a.pixel[k]];
            *sum = vec3_add(*sum, follow_environment(scene, &a, k, env, source->random));
        }
    }
}
