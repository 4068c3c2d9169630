/* SPDX-License-Identifier: MIT */
/* The inputs of the network of near lights as numbers. */
#include <math.h>
#include <string.h>

#include "base/rng.h"
#include "model/nfps.h"
#include "nfps/nfps_inputs.h"

/* last, as cmocka defines a macro named fail */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

enum { SIDE = 8, PIXELS = SIDE * SIDE, PICTURES = 5 };

static void near(vec3 a, vec3 b, double tolerance)
{
    assert_true((double)vec3_length(vec3_sub(a, b)) <= tolerance);
}

static void a_turn_takes_the_view_to_the_front_and_back(void **state)
{
    (void)state;
    rng r = rng_at(1, 2, 3);
    for (int i = 0; i < 100; i++) {
        const vec3 view = vec3_normalize(vec3_make(rng_normal(&r), rng_normal(&r), fabsf(rng_normal(&r)) + 0.2f));
        const vec3 v = vec3_make(rng_normal(&r), rng_normal(&r), rng_normal(&r));
        near(nfps_turn(view, view), vec3_make(0, 0, 1), 1e-6);
        near(nfps_turn_back(view, nfps_turn(view, v)), v, 1e-5);
        assert_true(fabsf(vec3_dot(nfps_turn(view, v), vec3_make(0, 0, 1)) - vec3_dot(v, view)) < 1e-5f);
    }
}

static void a_light_falls_off_with_distance_and_lobe(void **state)
{
    (void)state;
    float strength;
    const nfps_light point = {.at = {0, 0, 0}}, led = {.at = {0, 0, 0}, .axis = {0, 0, -1}, .lobe = 2};
    near(nfps_light_at(&point, vec3_make(0, 0, -2), &strength), vec3_make(0, 0, 1), 1e-6);
    assert_true(fabsf(strength - 0.25f) < 1e-6f);
    nfps_light_at(&led, vec3_make(2, 0, -2), &strength);
    assert_true(fabsf(strength - 0.5f / 8) < 1e-6f); /* cos² of 45 degrees over the squared distance */
    const nfps_light sun = {.at = {0, 0.6f, 0.8f}, .distant = true};
    near(nfps_light_at(&sun, vec3_make(2, 0, -2), &strength), vec3_make(0, 0.6f, 0.8f), 1e-6);
    assert_true(strength == 1);
}

/* A matte plane seen through a lens of 60 degrees, lit by five lights. */
typedef struct plane {
    float mask[PIXELS], point[3 * PIXELS], view[3 * PIXELS], images[3 * PICTURES * PIXELS];
    float work[PICTURES * PIXELS], picture[NFPS_PICTURE * PICTURES * PIXELS], light[NFPS_LIGHT * PICTURES * PIXELS];
    float matte[NFPS_MATTE * PIXELS];
    nfps_light lights[PICTURES];
    nfps_scene scene;
} plane;

static void encode(plane *p)
{
    nfps_encode(&p->scene, p->images, p->work, &(nfps_arrays){p->picture, p->light, p->matte});
}

static void plane_of(plane *p, float albedo_right)
{
    static const vec3 places[PICTURES] = {
        {0, 0, 0}, {0.5f, 0, -0.1f}, {0, -0.6f, 0.1f}, {-0.4f, 0.3f, 0}, {0.2f, 0.7f, 0}};
    for (int i = 0; i < PIXELS; i++) {
        const float x = ((float)(i % SIDE) + 0.5f) / SIDE - 0.5f, y = 0.5f - ((float)(i / SIDE) + 0.5f) / SIDE;
        const vec3 ray = vec3_make(1.1547f * x, 1.1547f * y, -1);
        p->mask[i] = i % SIDE > 0;
        vec3_put(ray, p->point + 3 * i);
        vec3_put(vec3_scale(vec3_normalize(ray), -1), p->view + 3 * i);
        for (int k = 0; k < PICTURES; k++) {
            float strength;
            p->lights[k] = (nfps_light){.at = places[k]};
            const vec3 l = nfps_light_at(&p->lights[k], ray, &strength);
            for (int c = 0; c < 3; c++)
                p->images[3 * (k * PIXELS + i) + c] = (x > 0 ? albedo_right : 0.4f) * strength * l.z;
        }
    }
    p->scene = (nfps_scene){PIXELS, PICTURES, p->mask, p->point, p->view, p->lights, false};
    encode(p);
}

static void inputs_are_light_without_fall_off(void **state)
{
    (void)state;
    static plane p;
    plane_of(&p, 0.4f);
    /* all channels squared are proportional to the cosine, the same factor everywhere */
    float factor = 0;
    for (int k = 0; k < PICTURES; k++)
        for (int i = 0; i < PIXELS; i++) {
            const float *picture = p.picture + NFPS_PICTURE * (k * PIXELS + i);
            const float *light = p.light + NFPS_LIGHT * (k * PIXELS + i);
            if (!(p.mask[i] > 0.5f)) {
                for (int c = 0; c < NFPS_PICTURE; c++)
                    assert_true(picture[c] == 0);
                for (int c = 0; c < NFPS_LIGHT; c++)
                    assert_true(light[c] == 0);
                continue;
            }
            const vec3 l = nfps_turn_back(vec3_of(p.view + 3 * i), vec3_of(light));
            if (factor == 0) factor = picture[0] * picture[0] / l.z;
            assert_true(fabsf(picture[0] * picture[0] - factor * l.z) < 1e-4f * factor);
            assert_true(light[4] == 0);
        }
}

static void a_pixels_share_does_without_its_albedo(void **state)
{
    (void)state;
    static plane same, other;
    plane_of(&same, 0.4f);
    plane_of(&other, 0.8f);
    for (int i = 0; i < PICTURES * PIXELS; i++) /* DARK's share differs a little with the mean */
        assert_true(fabsf(same.picture[NFPS_PICTURE * i + 3] - other.picture[NFPS_PICTURE * i + 3]) < 0.03f);
}

/* The plane's normal, turned, at every pixel, though one of its pictures has a shadow and another a highlight. */
static void a_matte_surface_is_found_among_shadows_and_highlights(void **state)
{
    (void)state;
    static plane p;
    plane_of(&p, 0.8f);
    for (int i = 0; i < PIXELS; i++)
        for (int c = 0; c < 3; c++)
            p.images[3 * ((i % 2 ? 1 : 2) * PIXELS + i) + c] *= i % 2 ? 0.0f : 3.0f;
    encode(&p);
    for (int i = 0; i < PIXELS; i++) {
        const float *matte = p.matte + NFPS_MATTE * i;
        const vec3 expected = nfps_turn(vec3_of(p.view + 3 * i), vec3_make(0, 0, 1));
        near(vec3_of(matte), p.mask[i] > 0.5f ? expected : (vec3){0}, 0.01);
        assert_true(p.mask[i] > 0.5f ? matte[3] > 0.01f && matte[3] < 0.25f : matte[3] == 0);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_turn_takes_the_view_to_the_front_and_back),
        cmocka_unit_test(a_light_falls_off_with_distance_and_lobe),
        cmocka_unit_test(inputs_are_light_without_fall_off),
        cmocka_unit_test(a_pixels_share_does_without_its_albedo),
        cmocka_unit_test(a_matte_surface_is_found_among_shadows_and_highlights),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
