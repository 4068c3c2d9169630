/* SPDX-License-Identifier: MIT */
#include "lab/scene/material/material.h"

#include "base/number.h"
#include "lab/scene/shape/noise.h"

static lane_set on_parts(const material_points *at, uint32_t parts)
{
    lane_set set = 0;
    for (int i = 0; i < LANES; i++)
        set |= ((parts >> (at->part[i] % 32)) & 1) << i;
    return set & at->wanted;
}

static void mix_colours(const material_paint *p, const float t[LANES], lanes *out)
{
    const vec3 *c = p->colour;
    int steps = p->colours - 1;
#pragma omp simd
    for (int i = 0; i < LANES; i++) {
        float x = t[i] * (float)steps;
        vec3 low = vec3_lerp(c[0], c[1], x), high = vec3_lerp(c[1], c[2], x - 1);
        bool first = x < 1 || steps == 1;
        lanes_put(out, i, vec3_make(first ? low.x : high.x, first ? low.y : high.y, first ? low.z : high.z));
    }
}

static void look_at_photograph(const texture_place *place, const material_points *at, lane_set wanted, lanes *albedo,
                               float roughness[LANES])
{
    for (int i = 0; i < LANES; i++) {
        if (!lane_in(wanted, i)) continue;
        vec3 reference = lanes_at(&at->reference, i), facing = lanes_at(&at->facing, i);
        lanes_put(albedo, i, texture_albedo(place, reference, facing));
        if (place->texture->roughness.data) roughness[i] = texture_roughness(place, reference, facing);
    }
}

static void paint_lanes(const material_paint *p, const material_points *at, lane_set wanted, lanes *albedo,
                        float roughness[LANES])
{
    float t[LANES];
    if (p->colours > 1 || p->spread != 0)
        pattern_values(&p->mix, &at->reference, &at->facing, wanted, t);
    else
        for (int i = 0; i < LANES; i++)
            t[i] = 0.5f;
    for (int i = 0; i < LANES; i++)
        roughness[i] = p->roughness + p->spread * (t[i] - 0.5f);
    if (p->colours > 1)
        mix_colours(p, t, albedo);
    else
        for (int i = 0; i < LANES; i++)
            lanes_put(albedo, i, p->colour[0]);
    if (p->photographed.texture) look_at_photograph(&p->photographed, at, wanted, albedo, roughness);
}

/* Computes how much of each point a layer covers; returns the points where it covers any. */
static lane_set cover(const material_layer *l, const material_points *at, lane_set open, float share[LANES])
{
    lane_set covered = 0;
    if (l->everywhere)
        for (int i = 0; i < LANES; i++)
            share[i] = 1;
    else
        pattern_values(&l->mask, &at->reference, &at->facing, open, share);
    for (int i = 0; i < LANES; i++) {
        share[i] = lane_in(open, i) ? l->opacity * share[i] : 0;
        covered |= (uint32_t)(share[i] > 0) << i;
    }
    return covered;
}

/* The blend of the layers so far, and how much of those below is still visible. */
typedef struct coat {
    lanes albedo;
    float roughness[LANES], through[LANES];
} coat;

static lane_set lay_under(coat *c, const material_layer *l, const material_points *at, lane_set open)
{
    lanes colour;
    float gloss[LANES], share[LANES];
    lane_set covered = cover(l, at, open & on_parts(at, l->parts), share);
    if (!covered) return open;
    paint_lanes(&l->paint, at, covered, &colour, gloss);
    lane_set left = 0;
    for (int i = 0; i < LANES; i++) {
        float weight = c->through[i] * share[i];
        lanes_put(&c->albedo, i, vec3_fma(lanes_at(&c->albedo, i), weight, lanes_at(&colour, i)));
        c->roughness[i] += weight * gloss[i];
        c->through[i] *= 1 - share[i];
        left |= (uint32_t)(c->through[i] > 0) << i;
    }
    return open & left;
}

void material_eval(const scene_material *material, const material_points *at, lanes *albedo, float roughness[LANES])
{
    coat c = {.roughness = {0}};
    float smudge[LANES];
    for (int i = 0; i < LANES; i++)
        c.through[i] = 1;
    /* from the top, so that covered layers are not evaluated */
    lane_set open = at->wanted;
    for (int k = material->layers - 1; k >= 0 && open; k--)
        open = lay_under(&c, &material->layer[k], at, open);
    if (material->smudged) pattern_values(&material->smudge, &at->reference, &at->facing, at->wanted, smudge);
#pragma omp simd
    for (int i = 0; i < LANES; i++) {
        vec3 a = lanes_at(&c.albedo, i);
        float rough = c.roughness[i];
        if (material->smudged) rough += material->smudge_amount * (smudge[i] - 0.5f);
        lanes_put(albedo, i, vec3_make(clamp(a.x, 0, 1), clamp(a.y, 0, 1), clamp(a.z, 0, 1)));
        roughness[i] = clamp(rough, 0.1f, 1);
    }
}

/* Adds the normal detail of the visible base: the last layer without a mask. */
static void add_photographed_slope(const scene_material *material, const material_points *at, int lane,
                                   const lanes tangent[2], float d[2][LANES])
{
    uint32_t bit = 1u << (at->part[lane] % 32);
    const texture_place *place = NULL;
    for (int i = 0; i < material->layers; i++) {
        const material_layer *l = &material->layer[i];
        if (l->everywhere && (l->parts & bit)) place = &l->paint.photographed;
    }
    if (!place || !place->texture || !place->texture->slope.data) return;
    vec3 gradient = texture_gradient(place, lanes_at(&at->reference, lane), lanes_at(&at->facing, lane));
    for (int k = 0; k < 2; k++)
        d[k][lane] += vec3_dot(gradient, lanes_at(&tangent[k], lane));
}

static void add_bump(const material_bump *b, const material_points *at, lane_set wanted, const lanes tangent[2],
                     float d[2][LANES])
{
    float here[LANES], there[LANES];
    lanes moved;
    pattern_values(&b->pattern, &at->reference, &at->facing, wanted, here);
    for (int k = 0; k < 2; k++) {
#pragma omp simd
        for (int i = 0; i < LANES; i++)
            lanes_put(&moved, i, vec3_fma(lanes_at(&at->reference, i), b->step, lanes_at(&tangent[k], i)));
        pattern_values(&b->pattern, &moved, &at->facing, wanted, there);
        for (int i = 0; i < LANES; i++)
            d[k][i] += lane_in(wanted, i) ? b->height * (there[i] - here[i]) / b->step : 0;
    }
}

void material_slope(const scene_material *material, const material_points *at, const lanes tangent[2],
                    float d[2][LANES])
{
    for (int k = 0; k < 2; k++)
        for (int i = 0; i < LANES; i++)
            d[k][i] = 0;
    for (int i = 0; i < LANES && material->embossed; i++)
        if (lane_in(at->wanted, i)) add_photographed_slope(material, at, i, tangent, d);
    for (int k = 0; k < material->bumps; k++) {
        lane_set wanted = on_parts(at, material->bump[k].parts);
        if (wanted) add_bump(&material->bump[k], at, wanted, tangent, d);
    }
}
