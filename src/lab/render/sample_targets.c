/* SPDX-License-Identifier: MIT */
#include "lab/render/sample_targets.h"

#include "optics/light.h"

/* LEDs stand in a disc of this radius and depth about the camera, turned from its axis by up to 30 degrees, of which
 * this is the cosine, and have lobes of exponents up to this. */
static const float DISC = 0.75f, DEEP = 0.15f, MOST_TURNED = 0.8660254f, LARGEST_LOBE = 2;

void sample_target_draw(rng *r, sample_target *out)
{
    float u1 = rng_uniform(r), u2 = rng_uniform(r);
    out->light = frontal_light(u1, u2);
}

void sample_target_draw_led(rng *r, sample_target *out)
{
    float radius = DISC * sqrtf(rng_uniform(r)), angle = 2 * PI * rng_uniform(r), deep = rng_range(r, -DEEP, DEEP);
    float cosine = 1 - (1 - MOST_TURNED) * rng_uniform(r), sine = sqrtf(1 - cosine * cosine);
    float turn = 2 * PI * rng_uniform(r);
    out->light = vec3_make(radius * cosf(angle), radius * sinf(angle), deep);
    out->axis = vec3_normalize(vec3_make(sine * cosf(turn), sine * sinf(turn), -cosine));
    out->lobe = rng_range(r, 0, LARGEST_LOBE);
}

point_light sample_target_light(const sample_target *of)
{
    return (point_light){.position = of->light, .power = LIGHT_POWER, .axis = of->axis, .lobe = of->lobe};
}
