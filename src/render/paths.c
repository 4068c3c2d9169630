#include "render/paths.h"

#include "optics/brdf.h"
#include "render/bundle.h"

static const vec3 black = {0, 0, 0};

static vec3 reflect(const trace_scene *scene, const scn_surface *at, vec3 l, vec3 view)
{
    if (scene->diffuse_only) return vec3_scale(at->albedo, 1 / BRDF_PI);
    return brdf_eval(at->albedo, at->roughness, at->normal, l, view);
}

/* The same with the density of scatter at l. */
static vec3 reflect_density(const trace_scene *scene, const scn_surface *at, vec3 l, vec3 view, real *pdf)
{
    if (!scene->diffuse_only) return brdf_eval_pdf(at->albedo, at->roughness, at->normal, l, view, pdf);
    *pdf = brdf_clamp(vec3_dot(at->normal, l), 0, 1) / BRDF_PI;
    return vec3_scale(at->albedo, 1 / BRDF_PI);
}

/* Both normals must face l: the shading normal for the BRDF, the true one lest light pass through the surface. */
static bool faces(const scn_surface *at, vec3 l)
{
    return vec3_dot(at->normal, l) > 0 && vec3_dot(at->geometric_normal, l) > 0;
}

/* Draws the next direction and multiplies throughput by f cosθ / pdf; false if the path ends. */
static bool scatter(const trace_scene *scene, const scn_surface *at, vec3 view, path_start start, real choice, vec3 *l,
                    real *pdf, vec3 *throughput)
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

vec3 point_light_unshadowed(const trace_scene *scene, const scn_surface *at, vec3 view, const point_light *light)
{
    vec3 to_light = vec3_sub(light->position, at->position);
    real distance2 = vec3_dot(to_light, to_light);
    if (distance2 < (real)1e-6) return black;
    vec3 l = vec3_scale(to_light, 1 / sqrt(distance2));
    real cosine = vec3_dot(at->normal, l);
    if (cosine <= 0) return black;
    return vec3_scale(reflect(scene, at, l, view), light->power * cosine / distance2);
}

vec3 point_light_direct(trace_scene *scene, const scn_surface *at, vec3 view, const point_light *light)
{
    vec3 origin = trace_leave(at), to_light = vec3_sub(light->position, origin);
    if (!faces(at, to_light)) return black;
    vec3 radiance = point_light_unshadowed(scene, at, view, light);
    if (radiance.x + radiance.y + radiance.z <= 0) return black;
    real distance = vec3_length(to_light);
    return trace_occluded(scene, origin, vec3_scale(to_light, 1 / distance), distance) ? black : radiance;
}

/* Bounce 2 of a path that has met `hit`, and bounce 3. */
static void follow_point_light(trace_scene *scene, const bundle *b, int lane, const trace_hit *hit,
                               const point_light *light, const path_source *source, vec3 bounce[2])
{
    vec3 throughput = lanes_at(&b->throughput, lane), l;
    vec3 v = vec3_make(-b->rays.dx[lane], -b->rays.dy[lane], -b->rays.dz[lane]);
    scn_surface from, to;
    real pdf;
    trace_surface_at(scene, hit, v, &from);
    bounce[0] = vec3_add(bounce[0], clamp_path(vec3_mul(throughput, point_light_direct(scene, &from, v, light))));
    path_start start = sequence_at(source->sequence, SEQUENCE_SECOND, b->index[lane]);
    real choice = sequence_at(source->sequence, SEQUENCE_CHOICE, b->index[lane]).u2;
    if (!scatter(scene, &from, v, start, choice, &l, &pdf, &throughput)) return;
    if (!trace_surface(scene, trace_leave(&from), l, &to)) return;
    v = vec3_scale(l, -1);
    bounce[1] = vec3_add(bounce[1], clamp_path(vec3_mul(throughput, point_light_direct(scene, &to, v, light))));
}

void point_light_paths(trace_scene *scene, const path_points *points, const point_light *light,
                       const path_source *source, int count, vec3 bounce[2])
{
    bundle b;
    trace_hit hits[TRACE_PACKET];
    bounce[0] = bounce[1] = black;
    for (int done = 0; done < count; done += TRACE_PACKET) {
        int abreast = count - done < TRACE_PACKET ? count - done : TRACE_PACKET;
        bundle_begin(&b, source->index + (uint32_t)done, points->at, points->view, points->count, abreast);
        bundle_scatter(&b, source->sequence, scene->diffuse_only);
        trace_packet(scene, &b.rays, hits);
        for (int i = 0; i < abreast; i++)
            if (hits[i].distance >= 0) follow_point_light(scene, &b, i, &hits[i], light, source, bounce);
    }
}

/* The environment's light at one surface, by a direction drawn from the map. */
static vec3 environment_direct(trace_scene *scene, const scn_surface *at, vec3 view, const environment *env,
                               path_start u)
{
    real light_pdf;
    vec3 l, radiance = environment_sample(env, u.u1, u.u2, &l, &light_pdf);
    if (!faces(at, l)) return black;
    real pdf;
    vec3 f = reflect_density(scene, at, l, view, &pdf);
    vec3 result = vec3_mul(vec3_scale(f, vec3_dot(at->normal, l) / (light_pdf + pdf)), radiance);
    if (result.x + result.y + result.z <= 0) return black;
    return trace_occluded(scene, trace_leave(at), l, 1e4f) ? black : result;
}

/* The map's light along a direction that was drawn from the BRDF with this density. */
static vec3 environment_seen(const environment *env, vec3 l, real pdf)
{
    real light_pdf;
    vec3 radiance = environment_look(env, l, &light_pdf);
    return vec3_scale(radiance, pdf / (pdf + light_pdf));
}

/* The light that a path brings once it has met `hit`: from the map at up to two more surfaces. */
static vec3 follow_environment(trace_scene *scene, const bundle *b, int lane, const trace_hit *hit,
                               const environment *env, rng *r)
{
    enum { MORE_SURFACES = 2 };
    vec3 sum = black, throughput = lanes_at(&b->throughput, lane), l;
    vec3 v = vec3_make(-b->rays.dx[lane], -b->rays.dy[lane], -b->rays.dz[lane]);
    scn_surface from, to;
    trace_surface_at(scene, hit, v, &from);
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

/* The map's light at the first surfaces, by directions drawn from the map. */
static vec3 first_environment_direct(trace_scene *scene, bundle *b, const environment *env, const sequence *q)
{
    lanes radiance = {0};
    float light_pdf[TRACE_PACKET] = {0};
    vec3 sum = black;
    for (int i = 0; i < b->count; i++) {
        path_start u = sequence_at(q, SEQUENCE_LIGHT, b->index[i]);
        vec3 l;
        lanes_put(&radiance, i, environment_sample(env, u.u1, u.u2, &l, &light_pdf[i]));
        b->rays.dx[i] = l.x;
        b->rays.dy[i] = l.y;
        b->rays.dz[i] = l.z;
    }
    bundle_reflect(b, light_pdf, scene->diffuse_only);
    trace_packet_free(scene, &b->rays);
    for (int i = 0; i < b->count; i++)
        if (b->rays.valid[i])
            sum = vec3_add(sum, clamp_path(vec3_mul(lanes_at(&b->throughput, i), lanes_at(&radiance, i))));
    return sum;
}

vec3 environment_paths(trace_scene *scene, const path_points *points, const environment *env, const path_source *source,
                       int count)
{
    bundle b;
    trace_hit hits[TRACE_PACKET];
    vec3 sum = black;
    for (int done = 0; done < count; done += TRACE_PACKET) {
        int abreast = count - done < TRACE_PACKET ? count - done : TRACE_PACKET;
        bundle_begin(&b, source->index + (uint32_t)done, points->at, points->view, points->count, abreast);
        for (int i = abreast; i < TRACE_PACKET; i++)
            b.rays.dx[i] = b.rays.dy[i] = b.rays.dz[i] = 1;
        sum = vec3_add(sum, first_environment_direct(scene, &b, env, source->sequence));
        bundle_scatter(&b, source->sequence, scene->diffuse_only);
        trace_packet(scene, &b.rays, hits);
        for (int i = 0; i < abreast; i++) {
            vec3 l = vec3_make(b.rays.dx[i], b.rays.dy[i], b.rays.dz[i]), brought = black;
            if (hits[i].distance >= 0)
                brought = follow_environment(scene, &b, i, &hits[i], env, source->random);
            else if (b.rays.valid[i])
                brought = clamp_path(vec3_mul(lanes_at(&b.throughput, i), environment_seen(env, l, b.pdf[i])));
            sum = vec3_add(sum, brought);
        }
    }
    return sum;
}
