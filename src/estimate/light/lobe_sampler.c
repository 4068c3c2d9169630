/* SPDX-License-Identifier: MIT */
#include "estimate/light/lobe_sampler.h"

#include <math.h>

#include "base/number.h"
#include "optics/brdf.h"

/* Solid angle that a sample averages, in units of the one that it stands for: with overlapping neighbours no pattern
 * appears where a lamp lies between two. */
#define OVERLAP 2.0f

/* Sets up Hammersley points: equal steps in one coordinate, bit-reversed numbers in the other. */
void lobe_over(const env_map *env, const horizon *hidden, lobe_sampler *out)
{
    out->env = env;
    out->hidden = hidden;
    for (unsigned i = 0; i < LOBE_SAMPLES; i++) {
        float turn = 0, half = 0.5f;
        for (unsigned bits = i; bits; bits >>= 1, half *= 0.5f)
            turn += bits & 1 ? half : 0;
        float phi = 2 * PI * (turn + 0.5f / LOBE_SAMPLES);
        out->places[i] = (lobe_place){((float)i + 0.5f) / LOBE_SAMPLES, cosf(phi), sinf(phi)};
    }
}

/* Returns one half vector's contribution: radiance times f (n·l), divided by its probability density D (n·h) / (4 v·h).
 */
static vec3 sample(const lobe_sampler *s, const lobe_point *p, const horizon_view *edge, const lobe_place *at,
                   float alpha2, float k)
{
    const vec3 black = {0, 0, 0};
    float cosine2 = (1 - at->u) / (1 + (alpha2 - 1) * at->u), sine = sqrtf(fmaxf(0, 1 - cosine2));
    float n_h = sqrtf(cosine2);
    vec3 h = brdf_to_world(vec3_make(sine * at->cosine, sine * at->sine, n_h), p->normal);
    float v_h = vec3_dot(p->view, h);
    vec3 l = vec3_fma(vec3_scale(p->view, -1), 2 * v_h, h);
    float n_l = vec3_dot(p->normal, l), n_v = clamp(vec3_dot(p->normal, p->view), 0, 1);
    if (v_h <= 0 || n_l <= 0) return black;
    float density = brdf_distribution(alpha2, n_h) * n_h / (4 * v_h);
    float weight = brdf_fresnel(fminf(v_h, 1)) * brdf_visibility(k, fminf(n_l, 1), n_v) * 4 * n_l * v_h / n_h;
    if (s->hidden) weight *= horizon_sees(edge, l, 1 / (LOBE_SAMPLES * density));
    return vec3_scale(env_map_lookup(s->env, l, OVERLAP / (LOBE_SAMPLES * density)), weight / LOBE_SAMPLES);
}

vec3 lobe_reflection(const lobe_sampler *s, const lobe_point *p)
{
    vec3 sum = {0, 0, 0};
    float alpha2 = brdf_alpha2(p->roughness), k = brdf_k(p->roughness);
    horizon_view edge = {0};
    if (s->hidden) horizon_at(s->hidden, p->x, p->y, &edge);
    for (int i = 0; i < LOBE_SAMPLES; i++)
        sum = vec3_add(sum, sample(s, p, &edge, &s->places[i], alpha2, k));
    return sum;
}
