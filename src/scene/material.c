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

void material_eval(const scn_material *material, vec3 reference, vec3 facing, uint8_t part, vec3 *albedo,
                   real *roughness)
{
    uint32_t bit = 1u << (part % 32);
    vec3 a = {0, 0, 0};
    float rough = 0;
    for (int i = 0; i < material->layers; i++) {
        const layer *l = &material->layer[i];
        if (!(l->parts & bit)) continue;
        float share = l->opacity * (l->everywhere ? 1 : pattern_value(&l->mask, reference, facing));
        if (share <= 0) continue;
        bool varied = l->paint.colours > 1 || l->paint.spread != 0;
        float t = varied ? pattern_value(&l->paint.mix, reference, facing) : 0.5f;
        a = vec3_lerp(a, mixed_colour(&l->paint, t), share);
        rough += (l->paint.roughness + l->paint.spread * (t - 0.5f) - rough) * share;
    }
    if (material->smudged)
        rough += material->smudge_amount * (pattern_value(&material->smudge, reference, facing) - 0.5f);
    *albedo = vec3_make(min_of(1, max_of(0, a.x)), min_of(1, max_of(0, a.y)), min_of(1, max_of(0, a.z)));
    *roughness = min_of(1, max_of(0.1f, rough));
}

void material_slope(const scn_material *material, vec3 reference, vec3 facing, uint8_t part, const vec3 tangent[2],
                    float d[2])
{
    uint32_t bit = 1u << (part % 32);
    d[0] = d[1] = 0;
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
