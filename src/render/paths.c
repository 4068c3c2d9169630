#include "render/paths.h"

#include "optics/brdf.h"

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

/* ---- paths that meet another surface --------------------------------------------------------------------------- */

/* How many paths are begun before those of them that arrived somewhere go on together. */
enum { WAVE = 16 * TRACE_PACKET };

typedef struct arrivals {
    int count;
    int pixel[WAVE];
    uint32_t index[WAVE]; /* of the path in its sequence */
    vec3 throughput[WAVE], view[WAVE];
    trace_hit hit[WAVE];
    scn_surface at[WAVE];
} arrivals;

static void arrive(arrivals *a, const bundle *b, int lane, const trace_hit *hit)
{
    int k = a->count++;
    a->pixel[k] = b->pixel[lane];
    a->index[k] = b->index[lane];
    a->throughput[k] = lanes_at(&b->throughput, lane);
    a->view[k] = vec3_make(-b->rays.dx[lane], -b->rays.dy[lane], -b->rays.dz[lane]);
    a->hit[k] = *hit;
}

/* Bounce 2 of arrival k, and bounce 3. */
static void follow_point_light(trace_scene *scene, const arrivals *a, int k, const point_light *light,
                               const path_source *source, vec3 bounce[2])
{
    vec3 throughput = a->throughput[k], l;
    const scn_surface *from = &a->at[k];
    scn_surface to;
    real pdf;
    vec3 second = point_light_direct(scene, from, a->view[k], light);
    bounce[0] = vec3_add(bounce[0], clamp_path(vec3_mul(throughput, second)));
    path_start start = sequence_at(source->sequence, SEQUENCE_SECOND, a->index[k]);
    real choice = sequence_at(source->sequence, SEQUENCE_CHOICE, a->index[k]).u2;
    if (!scatter(scene, from, a->view[k], start, choice, &l, &pdf, &throughput)) return;
    if (!trace_surface(scene, trace_leave(from), l, &to)) return;
    vec3 third = point_light_direct(scene, &to, vec3_scale(l, -1), light);
    bounce[1] = vec3_add(bounce[1], clamp_path(vec3_mul(throughput, third)));
}

void point_light_paths(trace_scene *scene, const path_points *pixels, int count, const point_light *light,
                       const path_source *source, int paths, vec3 (*bounce)[2])
{
    bundle b;
    trace_hit hits[TRACE_PACKET];
    arrivals a;
    for (int i = 0; i < count; i++)
        bounce[i][0] = bounce[i][1] = black;
    for (int done = 0; done < count * paths;) {
        a.count = 0;
        for (int end = done + WAVE; done < end && done < count * paths; done += TRACE_PACKET) {
            bundle_begin(&b, pixels, count, paths, done);
            bundle_scatter(&b, source->sequence, scene->diffuse_only);
            trace_packet(scene, &b.rays, hits);
            for (int i = 0; i < b.count; i++)
                if (hits[i].distance >= 0) arrive(&a, &b, i, &hits[i]);
        }
        trace_surfaces_at(scene, a.hit, a.view, a.count, a.at);
        for (int k = 0; k < a.count; k++)
            follow_point_light(scene, &a, k, light, source, bounce[a.pixel[k]]);
    }
}

/* ---- the environment ------------------------------------------------------------------------------------------- */

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

/* The light that arrival k brings: from the map at up to two more surfaces. */
static vec3 follow_environment(trace_scene *scene, const arrivals *a, int k, const environment *env, rng *r)
{
    enum { MORE_SURFACES = 2 };
    vec3 sum = black, throughput = a->throughput[k], v = a->view[k], l;
    scn_surface from = a->at[k], to;
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

static void add(vec3 *radiance, const bundle *b, int lane, vec3 light)
{
    vec3 *sum = &radiance[b->pixel[lane]];
    *sum = vec3_add(*sum, clamp_path(vec3_mul(lanes_at(&b->throughput, lane), light)));
}

/* The map's light at the first surfaces, by directions drawn from the map. */
static void first_environment_direct(trace_scene *scene, bundle *b, const environment *env, const sequence *q,
                                     vec3 *radiance)
{
    lanes light;
    float light_pdf[TRACE_PACKET];
    for (int i = 0; i < TRACE_PACKET; i++) {
        path_start u = sequence_at(q, SEQUENCE_LIGHT, b->index[i]);
        vec3 l;
        lanes_put(&light, i, environment_sample(env, u.u1, u.u2, &l, &light_pdf[i]));
        b->rays.dx[i] = l.x;
        b->rays.dy[i] = l.y;
        b->rays.dz[i] = l.z;
    }
    bundle_reflect(b, light_pdf, scene->diffuse_only);
    trace_packet_free(scene, &b->rays);
    for (int i = 0; i < b->count; i++)
        if (b->rays.valid[i]) add(radiance, b, i, lanes_at(&light, i));
}

/* What the first surfaces get from the map; paths that meet another surface arrive there. */
static void begin_environment_paths(trace_scene *scene, bundle *b, const environment *env, const sequence *q,
                                    vec3 *radiance, arrivals *a)
{
    trace_hit hits[TRACE_PACKET];
    first_environment_direct(scene, b, env, q, radiance);
    bundle_scatter(b, q, scene->diffuse_only);
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
    bundle b;
    arrivals a;
    for (int i = 0; i < count; i++)
        radiance[i] = black;
    for (int done = 0; done < count * paths;) {
        a.count = 0;
        for (int end = done + WAVE; done < end && done < count * paths; done += TRACE_PACKET) {
            bundle_begin(&b, pixels, count, paths, done);
            begin_environment_paths(scene, &b, env, source->sequence, radiance, &a);
        }
        trace_surfaces_at(scene, a.hit, a.view, a.count, a.at);
        for (int k = 0; k < a.count; k++) {
            vec3 *sum = &radiance[a.pixel[k]];
            *sum = vec3_add(*sum, follow_environment(scene, &a, k, env, source->random));
        }
    }
}
