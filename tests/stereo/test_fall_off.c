/* SPDX-License-Identifier: MIT */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include "base/status.h"

#include <cmocka.h> /* last, as cmocka defines a macro named fail */

#include <math.h>

#include "stereo/fit/fall_off.h"

enum { LIGHTS = 32 };
static const pst_lobe matte = {.width = 0.04f, .shadow = PST_SHADOW_COST, .masking = 0.28f};

/* What the lights of a ring about the camera, the radius wide, bring to a point on the camera's axis. */
typedef struct ring {
    float x[LIGHTS], y[LIGHTS], z[LIGHTS], power[LIGHTS];
} ring;

static ring ring_seen_from(float depth, float radius)
{
    ring r;
    for (int k = 0; k < LIGHTS; k++) {
        float phi = 6.2831853f * (float)k / LIGHTS, wide = radius * (k % 2 ? 0.5f : 1);
        vec3 to = vec3_make(wide * cosf(phi), wide * sinf(phi), depth);
        float square = vec3_dot(to, to), inverse = 1 / sqrtf(square);
        r.x[k] = to.x * inverse;
        r.y[k] = to.y * inverse;
        r.z[k] = to.z * inverse;
        r.power[k] = 1 / square;
    }
    return r;
}

static void seen_at(const ring *r, const float *radiance, float *value, pst_lobe_data *out)
{
    static float usable[LIGHTS];
    for (int k = 0; k < LIGHTS; k++) {
        usable[k] = 1;
        value[k] = radiance[k] / r->power[k];
    }
    pst_observations o = {LIGHTS, r->x, r->y, r->z, value, usable, 0};
    pst_lobe_prepare(&o, vec3_make(0, 0, 1), matte.shadow, out);
}

/* A matte, tilted pixel at depth 1 under the ring, thought to be at another depth. */
static pst_fall_off found_from(float thought, float radius)
{
    const vec3 normal = vec3_normalize(vec3_make(0.3f, -0.2f, 1));
    const ring truth = ring_seen_from(1, radius), there = ring_seen_from(thought, radius),
               behind = ring_seen_from(thought * expf(PST_DEEPER), radius);
    float radiance[LIGHTS], value[2][LIGHTS];
    for (int k = 0; k < LIGHTS; k++)
        radiance[k] = 0.5f * truth.power[k] * (normal.x * truth.x[k] + normal.y * truth.y[k] + normal.z * truth.z[k]);
    pst_lobe_data here, deeper;
    seen_at(&there, radiance, value[0], &here);
    seen_at(&behind, radiance, value[1], &deeper);
    pst_shading fit = pst_lobe_fit(&here, &matte);
    return pst_fall_off_of(&here, &deeper, &matte, &fit);
}

/* One Gauss-Newton step from 5 % off: what is left is of second order. */
static void the_lights_fall_off_tells_the_depth(void **state)
{
    (void)state;
    for (int k = -1; k <= 1; k++) {
        float thought = 1 + 0.05f * (float)k;
        pst_fall_off found = found_from(thought, 0.6f);
        print_message("thought to be at %.2f: off by %.4f, found %.4f\n", (double)thought, (double)-logf(thought),
                      (double)found.offset);
        assert_true(found.trust > 0);
        assert_true(fabsf(found.offset + logf(thought)) < 0.01f);
    }
}

/* From afar one depth looks like another. */
static void narrow_rings_are_trusted_less(void **state)
{
    (void)state;
    assert_true(found_from(1, 0.15f).trust < 0.1f * found_from(1, 0.6f).trust);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_lights_fall_off_tells_the_depth),
        cmocka_unit_test(narrow_rings_are_trusted_less),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
