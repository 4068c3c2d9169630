#include "render/paths.h"

#include "optics/brdf.h"

static const vec3 white = {1, 1, 1}, black = {0, 0, 0};

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

/* Whether a path goes on, about as likely as its throughput is high, which is then raised to make up for the others
 * (Russian roulette; Arvo & Kirk 1990). */
static bool survives(vec3 *throughput, real choice)
{
    const real least = (real)0.2;
    real share = brdf_clamp(fmax(throughput->x, fmax(throughput->y, throughput->z)), least, 1);
    if (choice >= share) return false;
    *throughput = vec3_scale(*throughput, 1 / share);
    return true;
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

void point_light_path(trace_scene *scene, const scn_surface *at, vec3 view, const point_light *light,
                      const path_source *source, vec3 bounce[2])
{
    bounce[0] = bounce[1] = black;
    vec3 throughput = white, v = view, l;
    path_start choice = sequence_at(source->sequence, SEQUENCE_CHOICE, source->index);
    scn_surface from = *at, to;
    for (int b = 0; b < 2; b++) {
        real pdf;
        if (b > 0 && !survives(&throughput, rng_uniform(source->random))) return;
        path_start start = sequence_at(source->sequence, b ? SEQUENCE_SECOND : SEQUENCE_DIRECTION, source->index);
        if (!scatter(scene, &from, v, start, b ? choice.u2 : choice.u1, &l, &pdf, &throughput)) return;
        if (!trace_surface(scene, trace_leave(&from), l, &to)) return;
        v = vec3_scale(l, -1);
        bounce[b] = clamp_path(vec3_mul(throughput, point_light_direct(scene, &to, v, light)));
        from = to;
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

vec3 environment_path(trace_scene *scene, const scn_surface *at, vec3 view, const environment *env,
                      const path_source *source)
{
    enum { SURFACES = 3 };
    vec3 sum = black, throughput = white, v = view, l;
    scn_surface from = *at, to;
    path_start to_light = sequence_at(source->sequence, SEQUENCE_LIGHT, source->index);
    path_start start = sequence_at(source->sequence, SEQUENCE_DIRECTION, source->index);
    real choice = sequence_at(source->sequence, SEQUENCE_CHOICE, source->index).u1;
    for (int b = 0; b < SURFACES; b++) {
        real pdf;
        if (b > 0) {
            if (!survives(&throughput, rng_uniform(source->random))) break;
            to_light = random_start(source->random);
            start = random_start(source->random);
            choice = rng_uniform(source->random);
        }
        vec3 direct = vec3_mul(throughput, environment_direct(scene, &from, v, env, to_light));
        sum = vec3_add(sum, clamp_path(direct));
        if (!scatter(scene, &from, v, start, choice, &l, &pdf, &throughput)) break;
        if (!trace_surface(scene, trace_leave(&from), l, &to)) {
            real light_pdf;
            vec3 radiance = environment_look(env, l, &light_pdf);
            vec3 seen = vec3_scale(vec3_mul(throughput, radiance), pdf / (pdf + light_pdf));
            sum = vec3_add(sum, clamp_path(seen));
            break;
        }
        v = vec3_scale(l, -1);
        from = to;
    }
    return sum;
}
