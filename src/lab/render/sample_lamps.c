/* SPDX-License-Identifier: MIT */
#include "lab/render/sample_lamps.h"

#include "optics/light.h"

/* Distances of lamps, in units of the camera's, and the distance that stands for infinity: parallax and falloff over an
 * object are then invisible, and floats still hold its direction. */
static const float NEAREST = 0.4f, FARTHEST = 3, INFINITE = 300;
/* Cosine of 110 degrees; factor by which a lamp stays outside the object. */
static const float BEHIND = -0.34202014f, CLEAR = 1.25f;
static const float SMALLEST_DISC = 0.02f, LARGEST_DISC = 0.2f; /* radius as a share of the distance */

static float radius_of(const scene_object *object)
{
    float most = 0;
    for (uint32_t i = 0; i < object->vertex_count; i++) {
        float far = vec3_length(vec3_sub(object->position[i], object_middle));
        most = far > most ? far : most;
    }
    return most;
}

/* Returns a direction from the object's middle: half of the time uniform over all that are allowed, else with the usual
 * preference for directions near the camera. */
static vec3 draw_direction(rng *r)
{
    bool usual = rng_uniform(r) < 0.5f;
    float u = rng_uniform(r), angle = 2 * PI * rng_uniform(r);
    float cosine = usual ? cosf(1.3f * u) : 1 + (BEHIND - 1) * u;
    float sine = sqrtf(1 - cosine * cosine);
    return vec3_make(sine * cosf(angle), sine * sinf(angle), cosine);
}

void sample_lamp_draw(rng *r, const scene_object *object, sample_lamp *out)
{
    vec3 toward = draw_direction(r);
    bool distant = rng_uniform(r) < 0.25f;
    float far = NEAREST * powf(FARTHEST / NEAREST, rng_uniform(r)), clear = CLEAR * radius_of(object);
    bool disc = rng_uniform(r) < 0.5f;
    float size = rng_range(r, SMALLEST_DISC, LARGEST_DISC);
    far = far > clear ? far : clear;
    out->distant = distant;
    out->at = distant ? toward : vec3_fma(object_middle, far, toward);
    out->radius = disc ? size * (distant ? 1 : far) : 0;
}

void sample_lamp_draw_at(rng *r, float angle, sample_lamp *out)
{
    float turn = 2 * PI * rng_uniform(r), sine = sinf(angle * DEGREE);
    vec3 toward = vec3_make(sine * cosf(turn), sine * sinf(turn), cosf(angle * DEGREE));
    out->at = vec3_add(object_middle, toward);
}

point_light sample_lamp_light(const sample_lamp *of)
{
    vec3 way = of->distant ? vec3_scale(of->at, INFINITE) : vec3_sub(of->at, object_middle);
    float far = vec3_length(way), radius = of->radius * (of->distant ? INFINITE : 1);
    vec3 aside = fabsf(way.y) < 0.9f * far ? vec3_make(0, 1, 0) : vec3_make(1, 0, 0);
    vec3 right = vec3_normalize(vec3_cross(aside, way)), up = vec3_normalize(vec3_cross(way, right));
    return (point_light){.position = vec3_add(object_middle, way),
                         .power = LIGHT_POWER * far * far,
                         .across = {vec3_scale(right, radius), vec3_scale(up, radius)}};
}
