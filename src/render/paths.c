#include "render/paths.h"

#include "optics/brdf.h"

static const vec3 white = {1, 1, 1}, black = {0, 0, 0};

static vec3 reflect(const trace_scene *scene, const scn_surface *at, vec3 l, vec3 view)
{
    if (scene->diffuse_only) return vec3_scale(at->albedo, 1 / BRDF_PI);
    return brdf_eval(at->albedo, at->roughness, at->normal, l, view);
}

static real density(const trace_scene *scene, const scn_surface *at, vec3 l, vec3 view)
{
    if (scene->diffuse_only) return brdf_clamp(vec3_dot(at->normal, l), 0, 1) / BRDF_PI;
    return brdf_pdf(at->albedo, at->roughness, at->normal, l, view);
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
    *pdf = density(scene, at, *l, view);
    if (*pdf < (real)1e-6) return false;
    vec3 f = reflect(scene, at, *l, view);
    *throughput = vec3_mul(*throughput, vec3_scale(f, vec3_dot(at->normal, *l) / *pdf));
    return true;
}

static vec3 clamp_path(vec3 c)
{
    return vec3_make(c.x < PATH_CLAMP ? c.x : PATH_CLAMP, c.y < PATH_CLAMP ? c.y : PATH_CLAMP,
                     c.z < PATH_CLAMP ? c.z : PATH_CLAMP);
}

path_start path_start_at(int i, int count, real shift1, real shift2)
{
    uint32_t bits = (uint32_t)i;
    bits = ((bits >> 1) & 0x55555555u) | ((bits & 0x55555555u) << 1);
    bits = ((bits >> 2) & 0x33333333u) | ((bits & 0x33333333u) << 2);
    bits = ((bits >> 4) & 0x0f0f0f0fu) | ((bits & 0x0f0f0f0fu) << 4);
    bits = __builtin_bswap32(bits);
    real a = ((real)i + shift1) / (real)count, b = (real)(bits >> 8) * (real)0x1p-24 + shift2;
    /* below 1 even after rounding: the samplers divide by what is left of 1 */
    return (path_start){brdf_clamp(a, 0, (real)0.9999999), b >= 1 ? b - 1 : b};
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

void point_light_path(trace_scene *scene, const scn_surface *at, vec3 view, const point_light *light, path_start start,
                      rng *r, vec3 bounce[2])
{
    bounce[0] = bounce[1] = black;
    vec3 throughput = white, v = view, l;
    scn_surface from = *at, to;
    for (int b = 0; b < 2; b++) {
        real pdf;
        if (b > 0) start = random_start(r);
        if (!scatter(scene, &from, v, start, rng_uniform(r), &l, &pdf, &throughput)) return;
        if (!trace_surface(scene, trace_leave(&from), l, &to)) return;
        v = vec3_scale(l, -1);
        bounce[b] = clamp_path(vec3_mul(throughput, point_light_direct(scene, &to, v, light)));
        from = to;
    }
}

/* The environment's light at one surface, by a direction drawn from the map. */
static vec3 environment_direct(trace_scene *scene, const scn_surface *at, vec3 view, const environment *env, rng *r)
{
    real u1 = rng_uniform(r), u2 = rng_uniform(r), light_pdf;
    vec3 l, radiance = environment_sample(env, u1, u2, &l, &light_pdf);
    if (!faces(at, l)) return black;
    real weight = 1 / (light_pdf + density(scene, at, l, view));
    vec3 f = vec3_scale(reflect(scene, at, l, view), vec3_dot(at->normal, l) * weight);
    vec3 result = vec3_mul(f, radiance);
    if (result.x + result.y + result.z <= 0) return black;
    return trace_occluded(scene, trace_leave(at), l, 1e4f) ? black : result;
}

vec3 environment_path(trace_scene *scene, const scn_surface *at, vec3 view, const environment *env, path_start start,
                      rng *r)
{
    enum { SURFACES = 3 };
    vec3 sum = black, throughput = white, v = view, l;
    scn_surface from = *at, to;
    for (int b = 0; b < SURFACES; b++) {
        real pdf;
        vec3 direct = vec3_mul(throughput, environment_direct(scene, &from, v, env, r));
        sum = vec3_add(sum, clamp_path(direct));
        if (b > 0) start = random_start(r);
        if (!scatter(scene, &from, v, start, rng_uniform(r), &l, &pdf, &throughput)) break;
        if (!trace_surface(scene, trace_leave(&from), l, &to)) {
            real weight = pdf / (pdf + environment_pdf(env, l));
            vec3 seen = vec3_scale(vec3_mul(throughput, environment_radiance(env, l)), weight);
            sum = vec3_add(sum, clamp_path(seen));
            break;
        }
        v = vec3_scale(l, -1);
        from = to;
    }
    return sum;
}
