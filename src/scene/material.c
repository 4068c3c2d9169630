#include "scene/material.h"

#include "scene/noise.h"
#include "scene/number.h"

static vec3 mixed_colour(const paint *p, float t)
{
    if (p->colours == 1) return p->colour[0];
    float x = t * (float)(p->colours - 1);
    int i = x < 1 || p->colours == 2 ? 0 : 1;
    return vec3_lerp(p->colour[i], p->colour[i + 1], x - (float)i);
}

static vec3 painted(const paint *p, vec3 reference, vec3 facing, float *roughness)
{
    bool varied = p->colours > 1 || p->spread != 0;
    float t = varied ? pattern_value(&p->mix, reference, facing) : 0.5f;
    *roughness = p->roughness + p->spread * (t - 0.5f);
    if (!p->photographed.texture) return mixed_colour(p, t);
    if (p->photographed.texture->roughness.data) *roughness = texture_roughness(&p->photographed, reference, facing);
    return texture_albedo(&p->photographed, reference, facing);
}

void material_eval(const scn_material *material, vec3 reference, vec3 facing, uint8_t part, vec3 *albedo,
                   real *roughness)
{
    uint32_t bit = 1u << (part % 32);
    vec3 a = {0, 0, 0};
    float rough = 0, through = 1;
    /* from the top, so that what is covered is never looked at */
    for (int i = material->layers - 1; i >= 0 && through > 0; i--) {
        const layer *l = &material->layer[i];
        if (!(l->parts & bit)) continue;
        float share = l->opacity * (l->everywhere ? 1 : pattern_value(&l->mask, reference, facing));
        if (share <= 0) continue;
        float gloss;
        a = vec3_fma(a, through * share, painted(&l->paint, reference, facing, &gloss));
        rough += through * share * gloss;
        through *= 1 - share;
    }
    if (material->smudged)
        rough += material->smudge_amount * (pattern_value(&material->smudge, reference, facing) - 0.5f);
    *albedo = vec3_make(min_of(1, max_of(0, a.x)), min_of(1, max_of(0, a.y)), min_of(1, max_of(0, a.z)));
    *roughness = min_of(1, max_of(0.1f, rough));
}

/* The relief of the ground that shows: the last layer without a mask. */
static void add_photographed_slope(const scn_material *material, vec3 reference, vec3 facing, uint32_t bit,
                                   const vec3 tangent[2], float d[2])
{
    if (!material->embossed) return;
    const texture_place *place = NULL;
    for (int i = 0; i < material->layers; i++) {
        const layer *l = &material->layer[i];
        if (l->everywhere && (l->parts & bit)) place = &l->paint.photographed;
    }
    if (!place || !place->texture || !place->texture->slope.data) return;
    vec3 gradient = texture_gradient(place, reference, facing);
    for (int k = 0; k < 2; k++)
        d[k] += vec3_dot(gradient, tangent[k]);
}

void material_slope(const scn_material *material, vec3 reference, vec3 facing, uint8_t part, const vec3 tangent[2],
                    float d[2])
{
    uint32_t bit = 1u << (part % 32);
    d[0] = d[1] = 0;
    add_photographed_slope(material, reference, facing, bit, tangent, d);
    for (int i = 0; i < material->bumps; i++) {
        const bump *b = &material->bump[i];
        if (!(b->parts & bit)) continue;
        float here = pattern_value(&b->pattern, reference, facing);
        for (int k = 0; k < 2; k++) {
            float there = pattern_value(&b->pattern, vec3_fma(reference, b->step, tangent[k]), facing);
            d[k] += b->height * (there - here) / b->step;
        }
    }
}
