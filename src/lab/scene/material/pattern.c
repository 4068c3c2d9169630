/* SPDX-License-Identifier: MIT */
#include "lab/scene/material/pattern.h"

#include "base/number.h"
#include "lab/scene/shape/glyph.h"
#include "lab/scene/shape/noise.h"
#include "lab/scene/shape/shape.h"

static float wave(float x)
{
    return 0.5f + 0.5f * sinf(2 * PI * x);
}

/* Returns lines of text in the coordinate plane that the surface faces most. */
static float letters(const pattern *p, vec3 q, vec3 facing)
{
    float ax = fabsf(facing.x), ay = fabsf(facing.y), az = fabsf(facing.z);
    if (az >= ax && az >= ay) return glyph_ink(q.x, q.y, 0.1f, p->seed);
    if (ax >= ay) return glyph_ink(q.z, q.y, 0.1f, p->seed + 1);
    return glyph_ink(q.x, q.z, 0.1f, p->seed + 2);
}

static void patches(const pattern *p, const lanes *q, float out[LANES])
{
    bool boxes = p->sharpness > 2.5f;
    for (int i = 0; i < LANES; i++)
        out[i] = 1e9f;
    for (int k = 0; k < p->centres; k++) {
        vec3 centre = p->centre[k];
#pragma omp simd
        for (int i = 0; i < LANES; i++) {
            vec3 d = vec3_sub(lanes_at(q, i), centre);
            float box = max_of(fabsf(d.x), max_of(fabsf(d.y), fabsf(d.z))), round = vec3_length(d);
            out[i] = min_of(out[i], boxes ? box : round);
        }
    }
    for (int i = 0; i < LANES; i++)
        out[i] = max_of(0, 1 - 0.5f * out[i]);
}

/* Computes thin lines in three families of directions. */
static void scratches(const pattern *p, const lanes *at, float out[LANES])
{
    lanes q = *at, s;
    float line[LANES], where[LANES];
    for (int i = 0; i < LANES; i++)
        out[i] = 0;
    for (uint32_t k = 0; k < 3; k++) {
#pragma omp simd
        for (int i = 0; i < LANES; i++)
            lanes_put(&s, i, vec3_make(0.25f * q.x[i] + 0.1f * q.z[i], 6 * q.y[i] + 1.5f * q.x[i], 0.25f * q.z[i]));
        noise_gradients(&s, p->seed + k, line);
        noise_gradients(&q, p->seed + 7 + k, where);
#pragma omp simd
        for (int i = 0; i < LANES; i++) {
            float ink = (1 - min_of(1, fabsf(line[i]) * 6)) * smooth_step(0, 0.3f, where[i]);
            out[i] = max_of(out[i], ink);
            lanes_put(&q, i, vec3_make(q.y[i], q.z[i] + 0.7f * q.x[i], q.x[i]));
        }
    }
}

/* Computes patterns made of noise, for all lanes at once; returns false for other kinds. */
static bool noise_values(const pattern *p, const lanes *q, float out[LANES])
{
    switch (p->kind) {
    case PATTERN_FBM:
        noise_fbms(q, p->octaves, p->seed, out);
        for (int i = 0; i < LANES; i++)
            out[i] = 0.5f + 0.8f * out[i];
        return true;
    case PATTERN_TURBULENCE:
        noise_turbulences(q, p->octaves, p->seed, out);
        for (int i = 0; i < LANES; i++)
            out[i] = 2 * out[i];
        return true;
    case PATTERN_MARBLE:
        noise_fbms(q, p->octaves, p->seed, out);
        for (int i = 0; i < LANES; i++)
            out[i] = 1 - min_of(1, 2.5f * fabsf(out[i]));
        return true;
    case PATTERN_SCRATCHES:
        scratches(p, q, out);
        return true;
    case PATTERN_PATCHES:
        patches(p, q, out);
        return true;
    default:
        return false;
    }
}

static bool is_cellular(pattern_kind kind)
{
    return kind == PATTERN_CELLS || kind == PATTERN_CELL_EDGES || kind == PATTERN_CELL_VALUES || kind == PATTERN_SPOTS;
}

static void cellular_values(const pattern *p, const lanes *q, float out[LANES])
{
    noise_cells c;
    noise_cellulars(q, p->seed, &c);
    for (int i = 0; i < LANES; i++)
        out[i] = p->kind == PATTERN_CELLS        ? c.first[i]
                 : p->kind == PATTERN_CELL_EDGES ? 2 * (c.second[i] - c.first[i])
                 : p->kind == PATTERN_SPOTS      ? 1 - c.first[i]
                                                 : noise_unit(c.id[i] * 0x9e3779b9u);
}

/* Returns patterns that need a few points each, or functions without a vector form. */
static float plain_value(const pattern *p, vec3 q, vec3 facing)
{
    switch (p->kind) {
    case PATTERN_STRIPES:
        return wave(q.x);
    case PATTERN_RINGS:
        return wave(hypotf(q.x, q.z) + 0.15f * q.y);
    case PATTERN_CHECKS:
        return 0.5f + 0.5f * sinf(PI * q.x) * sinf(PI * q.y) * sinf(PI * (q.z + 0.5f));
    case PATTERN_LETTERS:
        return letters(p, q, facing);
    case PATTERN_BANDS:
        return noise_unit(noise_hash((int)floorf(q.y + 0.6f * sinf(1.7f * q.y)), 0, 0, p->seed));
    default:
        return 0.5f + 0.5f * q.y;
    }
}

void pattern_values(const pattern *p, const lanes *reference, const lanes *facing, lane_set wanted, float out[LANES])
{
    lanes q, bend;
#pragma omp simd
    for (int i = 0; i < LANES; i++) {
        vec3 at = lanes_at(reference, i);
        at.x = p->mirrored ? fabsf(at.x) : at.x;
        lanes_put(&q, i, vec3_add(mat3_apply(&p->frame, at), p->offset));
    }
    if (p->warp > 0) {
        noise_vectors(&q, p->seed + 101, &bend);
#pragma omp simd
        for (int i = 0; i < LANES; i++)
            lanes_put(&q, i, vec3_fma(lanes_at(&q, i), p->warp, lanes_at(&bend, i)));
    }
    if (is_cellular(p->kind))
        cellular_values(p, &q, out);
    else if (!noise_values(p, &q, out))
        for (int i = 0; i < LANES; i++)
            out[i] = lane_in(wanted, i) ? plain_value(p, lanes_at(&q, i), lanes_at(facing, i)) : 0;
#pragma omp simd
    for (int i = 0; i < LANES; i++)
        out[i] = smooth_step(p->low, p->high, out[i]);
}

static void choose_centres(rng *r, pattern *p, const triangle_mesh *mesh)
{
    p->centres = 1 + rng_below(r, PATTERN_CENTRES);
    p->offset = (vec3){0, 0, 0};
    for (int i = 0; i < p->centres; i++) {
        /* half of the time on something that protrudes, such as an eye, if the mesh has such a part */
        uint32_t triangle = (uint32_t)rng_below(r, (int)mesh->triangle_count);
        int tries = rng_uniform(r) < 0.5f ? 24 : 0;
        while (tries-- > 0 && mesh->part[triangle] == 0)
            triangle = (uint32_t)rng_below(r, (int)mesh->triangle_count);
        vec3 at = mesh->reference[mesh->triangle[triangle][0]];
        if (p->mirrored) at.x = fabsf(at.x);
        p->centre[i] = mat3_apply(&p->frame, at);
    }
}

pattern pattern_random(rng *r, pattern_kind kind, float frequency, const triangle_mesh *mesh, bool mirrored)
{
    pattern p = {.kind = kind, .mirrored = mirrored, .low = 0, .high = 1, .seed = rng_u32(r)};
    p.octaves = 1 + rng_below(r, 4);
    p.sharpness = rng_uniform(r) < 0.7f ? 2 : 4;
    bool aligned = kind == PATTERN_LETTERS || kind == PATTERN_BANDS || kind == PATTERN_GRADIENT;
    bool turned = rng_uniform(r) < (aligned ? 0.25f : 0.6f);
    p.frame = turned ? random_rotation(r) : (mat3){{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
    bool stretched = rng_uniform(r) < 0.3f;
    for (int k = 0; k < 3; k++) {
        float stretch = stretched ? powf(3, rng_range(r, -1, 1)) : 1;
        p.frame.row[k] = vec3_scale(p.frame.row[k], frequency * stretch);
    }
    p.offset = random_between(r, -50, 50);
    if (kind == PATTERN_GRADIENT) p.offset = vec3_make(0, rng_normal(r) * 0.3f, 0);
    if (kind == PATTERN_RINGS) p.offset = random_between(r, -frequency, frequency);
    bool regular = kind == PATTERN_LETTERS || kind == PATTERN_CHECKS;
    float warped = rng_uniform(r);
    if (!regular && warped < 0.4f) p.warp = 0.6f * rng_uniform(r);
    if (kind == PATTERN_PATCHES) choose_centres(r, &p, mesh);
    return p;
}

void pattern_threshold(pattern *p, float share, float width)
{
    float at;
    switch (p->kind) {
    case PATTERN_CELL_EDGES: /* lines: the second region is between them */
        at = 0.05f + 0.4f * (1 - share);
        break;
    case PATTERN_MARBLE:
    case PATTERN_SCRATCHES:
        at = 0.9f - 0.6f * share;
        break;
    case PATTERN_SPOTS:
        at = 0.85f - 0.4f * share;
        break;
    case PATTERN_LETTERS:
        at = 0.5f;
        break;
    case PATTERN_CELLS:
        at = 0.9f - 0.7f * share;
        break;
    default:
        at = 0.75f - 0.5f * share;
    }
    p->low = at - 0.5f * width;
    p->high = at + 0.5f * width;
}
