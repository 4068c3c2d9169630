#include "estimate/relight_env.h"

#include <math.h>

#include "base/parallel.h"
#include "optics/ambient.h"
#include "optics/camera.h"

enum { SAMPLES = 64 };
/* What a sample averages over, in parts of the solid angle that it stands for: neighbours that overlap leave no pattern
 * where a lamp falls between them. */
#define OVERLAP 2.0f

/* Where a sample lies on the disc: its radius is a matter of the roughness. */
typedef struct sample_place {
    float u, cosine, sine;
} sample_place;

typedef struct pixel {
    vec3 albedo, normal, view;
    float roughness;
} pixel;

typedef struct job job;
struct job {
    const surface *s;
    camera eye;
    const float (*sh)[3];
    const env_map *env;
    sample_place places[SAMPLES];
    vec3 (*shade)(const job *j, const pixel *p);
    img *image;
};

static vec3 at3(const img *image, size_t i)
{
    return vec3_of(image->data + 3 * i);
}

static void add_rows(void *context, size_t begin, size_t end)
{
    const job *j = context;
    const surface *s = j->s;
    size_t width = (size_t)s->mask.width;
    for (size_t i = begin * width; i < end * width; i++) {
        float coverage = s->mask.data[i];
        if (!(coverage > 0)) continue;
        size_t x = i % width, y = i / width;
        vec3 ray = camera_ray(&j->eye, (float)x + 0.5f, (float)y + 0.5f);
        pixel p = {at3(&s->albedo, i), at3(&s->normal, i), vec3_scale(ray, -1), s->roughness.data[i]};
        vec3 radiance = j->shade(j, &p);
        float *out = j->image->data + 3 * i;
        out[0] += coverage * radiance.x;
        out[1] += coverage * radiance.y;
        out[2] += coverage * radiance.z;
    }
}

static void add(job *j)
{
    j->eye = (camera){j->s->mask.width, j->s->mask.height, SURFACE_FOV};
    parallel_blocks((size_t)j->s->mask.height, add_rows, j);
}

/* ---- by coefficients ---- */

static vec3 shade_ambient(const job *j, const pixel *p)
{
    vec3 e = sh_irradiance(j->sh, p->normal);
    return vec3_scale(vec3_mul(p->albedo, vec3_make(fmaxf(e.x, 0), fmaxf(e.y, 0), fmaxf(e.z, 0))), 1 / BRDF_PI);
}

void surface_add_ambient(const surface *s, const float sh[9][3], img *image)
{
    add(&(job){.s = s, .sh = sh, .shade = shade_ambient, .image = image});
}

static vec3 shade_highlights(const job *j, const pixel *p)
{
    return ambient_specular(j->sh, p->roughness, p->normal, p->view);
}

void surface_add_ambient_highlights(const surface *s, const float sh[9][3], img *image)
{
    add(&(job){.s = s, .sh = sh, .shade = shade_highlights, .image = image});
}

/* ---- by the map ---- */

/* Hammersley points: even steps one way, bits of the number reversed the other way. */
static void place_samples(sample_place places[SAMPLES])
{
    for (unsigned i = 0; i < SAMPLES; i++) {
        float turn = 0, half = 0.5f;
        for (unsigned bits = i; bits; bits >>= 1, half *= 0.5f)
            turn += bits & 1 ? half : 0;
        float phi = 2 * BRDF_PI * (turn + 0.5f / SAMPLES);
        places[i] = (sample_place){((float)i + 0.5f) / SAMPLES, cosf(phi), sinf(phi)};
    }
}

/* One half vector's share: radiance times f (n·l) over the density of drawing it, D (n·h) / (4 v·h). */
static vec3 sample_lobe(const job *j, const pixel *p, const sample_place *at, float alpha2, float k)
{
    const vec3 black = {0, 0, 0};
    float cosine2 = (1 - at->u) / (1 + (alpha2 - 1) * at->u), sine = sqrtf(fmaxf(0, 1 - cosine2));
    float n_h = sqrtf(cosine2);
    vec3 h = brdf_to_world(vec3_make(sine * at->cosine, sine * at->sine, n_h), p->normal);
    float v_h = vec3_dot(p->view, h);
    vec3 l = vec3_fma(vec3_scale(p->view, -1), 2 * v_h, h);
    float n_l = vec3_dot(p->normal, l), n_v = brdf_clamp(vec3_dot(p->normal, p->view), 0, 1);
    if (v_h <= 0 || n_l <= 0) return black;
    float density = brdf_distribution(alpha2, n_h) * n_h / (4 * v_h);
    float weight = brdf_fresnel(fminf(v_h, 1)) * brdf_visibility(k, fminf(n_l, 1), n_v) * 4 * n_l * v_h / n_h;
    return vec3_scale(env_map_lookup(j->env, l, OVERLAP / (SAMPLES * density)), weight / SAMPLES);
}

static vec3 shade_reflections(const job *j, const pixel *p)
{
    vec3 sum = {0, 0, 0};
    float alpha2 = brdf_alpha2(p->roughness), k = brdf_k(p->roughness);
    for (int i = 0; i < SAMPLES; i++)
        sum = vec3_add(sum, sample_lobe(j, p, &j->places[i], alpha2, k));
    return sum;
}

void surface_add_reflections(const surface *s, const env_map *env, img *image)
{
    job j = {.s = s, .env = env, .shade = shade_reflections, .image = image};
    place_samples(j.places);
    add(&j);
}
