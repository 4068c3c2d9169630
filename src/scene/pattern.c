#include "scene/pattern.h"

#include "scene/glyph.h"
#include "scene/noise.h"
#include "scene/number.h"
#include "scene/shape.h"

static float wave(float x)
{
    return 0.5f + 0.5f * sinf(6.2831853f * x);
}

/* Lines of text on the plane the surface faces most. */
static float letters(const pattern *p, vec3 q, vec3 facing)
{
    float ax = fabsf(facing.x), ay = fabsf(facing.y), az = fabsf(facing.z);
    if (az >= ax && az >= ay) return glyph_ink(q.x, q.y, 0.1f, p->seed);
    if (ax >= ay) return glyph_ink(q.z, q.y, 0.1f, p->seed + 1);
    return glyph_ink(q.x, q.z, 0.1f, p->seed + 2);
}

static float patches(const pattern *p, vec3 q)
{
    float nearest = 1e9f;
    for (int i = 0; i < p->centres; i++) {
        vec3 d = vec3_sub(q, p->centre[i]);
        float e;
        if (p->sharpness > 2.5f)
            e = max_of(fabsf(d.x), max_of(fabsf(d.y), fabsf(d.z)));
        else
            e = vec3_length(d);
        nearest = min_of(nearest, e);
    }
    return max_of(0, 1 - 0.5f * nearest);
}

/* Thin lines in three families of directions. */
static float scratches(const pattern *p, vec3 q)
{
    float best = 0;
    for (int i = 0; i < 3; i++) {
        vec3 s = vec3_make(0.25f * q.x + 0.1f * q.z, 6 * q.y + 1.5f * q.x, 0.25f * q.z);
        float line = noise_gradient(s, p->seed + (uint32_t)i), where = noise_gradient(q, p->seed + 7 + (uint32_t)i);
        best = max_of(best, (1 - min_of(1, fabsf(line) * 6)) * smooth_step(0, 0.3f, where));
        q = vec3_make(q.y, q.z + 0.7f * q.x, q.x);
    }
    return best;
}

static float raw_value(const pattern *p, vec3 q, vec3 facing)
{
    switch (p->kind) {
    case PATTERN_FBM:
        return 0.5f + 0.8f * noise_fbm(q, p->octaves, p->seed);
    case PATTERN_TURBULENCE:
        return 2 * noise_turbulence(q, p->octaves, p->seed);
    case PATTERN_CELLS:
        return noise_cellular(q, p->seed).first;
    case PATTERN_CELL_EDGES: {
        noise_cell c = noise_cellular(q, p->seed);
        return 2 * (c.second - c.first);
    }
    case PATTERN_CELL_VALUES:
        return noise_unit(noise_cellular(q, p->seed).id * 0x9e3779b9u);
    case PATTERN_STRIPES:
        return wave(q.x);
    case PATTERN_RINGS:
        return wave(hypotf(q.x, q.z) + 0.15f * q.y);
    case PATTERN_MARBLE:
        return 1 - min_of(1, 2.5f * fabsf(noise_fbm(q, p->octaves, p->seed)));
    case PATTERN_SPOTS:
        return 1 - noise_cellular(q, p->seed).first;
    case PATTERN_CHECKS:
        return 0.5f + 0.5f * sinf(3.1415927f * q.x) * sinf(3.1415927f * q.y) * sinf(3.1415927f * (q.z + 0.5f));
    case PATTERN_SCRATCHES:
        return scratches(p, q);
    case PATTERN_LETTERS:
        return letters(p, q, facing);
    case PATTERN_BANDS:
        return noise_unit(noise_hash((int)floorf(q.y + 0.6f * sinf(1.7f * q.y)), 0, 0, p->seed));
    case PATTERN_PATCHES:
        return patches(p, q);
    default:
        return 0.5f + 0.5f * q.y;
    }
}

float pattern_value(const pattern *p, vec3 reference, vec3 facing)
{
    if (p->mirrored) reference.x = fabsf(reference.x);
    vec3 q = vec3_add(mat3_apply(&p->frame, reference), p->offset);
    if (p->warp > 0) q = vec3_fma(q, p->warp, noise_vector(q, p->seed + 101));
    return smooth_step(p->low, p->high, raw_value(p, q, facing));
}

static void choose_centres(rng *r, pattern *p, const scn_mesh *mesh)
{
    p->centres = 1 + rng_below(r, PATTERN_CENTRES);
    p->offset = (vec3){0, 0, 0};
    for (int i = 0; i < p->centres; i++) {
        /* half of the time on something that sticks out, such as an eye, if the mesh has such a part */
        uint32_t triangle = (uint32_t)rng_below(r, (int)mesh->triangle_count);
        int tries = rng_uniform(r) < 0.5f ? 24 : 0;
        while (tries-- > 0 && mesh->part[triangle] == 0)
            triangle = (uint32_t)rng_below(r, (int)mesh->triangle_count);
        vec3 at = mesh->reference[mesh->triangle[triangle][0]];
        if (p->mirrored) at.x = fabsf(at.x);
        p->centre[i] = mat3_apply(&p->frame, at);
    }
}

pattern pattern_random(rng *r, pattern_kind kind, float frequency, const scn_mesh *mesh, bool mirrored)
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
    case PATTERN_CELL_EDGES: /* lines: the second region is what lies between them */
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
