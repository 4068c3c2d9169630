/* SPDX-License-Identifier: MIT */
/* Samples for the network of near lights, of a matte ball whose light is known in closed form. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "lab/train/samples/nfps_sample.h"
#include "model/nfps.h"
#include "nfps/nfps_inputs.h"

/* last, as cmocka defines a macro named fail */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

enum { SAMPLE = 64, SIDE = SAMPLE / 2, LAMPS = 6, PICTURES = 4 };
static const float radius = 0.4f;

typedef struct ball {
    train_view view;
    float normal[3 * SAMPLE * SAMPLE], depth[SAMPLE * SAMPLE], mask[SAMPLE * SAMPLE];
    float lamps[LAMPS * SAMPLE * SAMPLE * TRAIN_LAMP_VALUES];
} ball;

static void light_pixel(ball *b, size_t i, vec3 at, vec3 normal)
{
    for (size_t k = 0; k < LAMPS; k++) {
        const vec3 way = vec3_sub(b->view.lamp[k].at, at);
        const float squared = vec3_dot(way, way);
        const float light = fmaxf(vec3_dot(normal, way), 0) / (squared * sqrtf(squared));
        for (size_t c = 0; c < 3; c++)
            b->lamps[(k * SAMPLE * SAMPLE + i) * TRAIN_LAMP_VALUES + c] = light;
    }
}

static void ball_of(ball *b)
{
    memset(b, 0, sizeof *b);
    b->view = (train_view){.size = SAMPLE,
                           .normal = b->normal,
                           .depth = b->depth,
                           .mask = b->mask,
                           .lamps = b->lamps,
                           .lamp_count = LAMPS,
                           .lens = {SAMPLE, SAMPLE, 60, {0, 0}}};
    for (int k = 0; k < LAMPS; k++)
        b->view.lamp[k].at = vec3_make(0.5f * cosf((float)k), 0.5f * sinf((float)k), 0.1f * (float)(k % 2));
    for (int i = 0; i < SAMPLE * SAMPLE; i++) {
        const vec3 ray = camera_ray(&b->view.lens, (float)(i % SAMPLE) + 0.5f, (float)(i / SAMPLE) + 0.5f);
        const float inside = ray.z * ray.z - 1 + radius * radius;
        if (inside < 0.2f * radius * radius) continue;
        const vec3 at = vec3_scale(ray, -ray.z - sqrtf(inside));
        const vec3 normal = vec3_scale(vec3_make(at.x, at.y, at.z + 1), 1 / radius);
        b->mask[i] = 1;
        b->depth[i] = -at.z;
        vec3_put(normal, b->normal + 3 * i);
        light_pixel(b, (size_t)i, at, normal);
    }
}

typedef struct inputs {
    float picture[PICTURES * SIDE * SIDE * NFPS_PICTURE], light[PICTURES * SIDE * SIDE * NFPS_LIGHT];
    float matte[SIDE * SIDE * NFPS_MATTE];
    float mask[SIDE * SIDE], normal[3 * SIDE * SIDE], normal_true[3 * SIDE * SIDE], loss_mask[SIDE * SIDE];
} inputs;

static nfps_stage_place place_in(inputs *in, bool refines)
{
    return (nfps_stage_place){
        {in->picture, in->light, in->matte}, in->mask, refines ? in->normal : NULL, in->normal_true, in->loss_mask};
}

static status fill(const ball *b, uint64_t index, inputs *first, inputs *refining)
{
    rng r = rng_at(1, index, 2);
    const nfps_place place = {SIDE, PICTURES, place_in(first, false), place_in(refining, true)};
    return nfps_sample_fill(&b->view, &r, &place);
}

/* Returns the correlation of the encoded light, squared, with the cosine that truth and the told light have. */
static double agreement(const inputs *in, int size)
{
    double xx = 0, yy = 0, xy = 0;
    for (int k = 0; k < PICTURES; k++)
        for (int i = 0; i < size * size; i++) {
            if (!(in->loss_mask[i] > 0)) continue;
            const int at = k * size * size + i;
            const double x = (double)in->picture[NFPS_PICTURE * at] * (double)in->picture[NFPS_PICTURE * at];
            const double y =
                fmax((double)vec3_dot(vec3_of(in->light + NFPS_LIGHT * at), vec3_of(in->normal_true + 3 * i)), 0);
            xx += x * x;
            yy += y * y;
            xy += x * y;
        }
    return xy / sqrt(xx * yy);
}

/* With known lights and a depth that is nearly right, what the network sees is the cosine: saturation, noise and the
 * errors of depth leave at least 0.95 in the worst of presentations. */
static void pictures_lights_and_truth_agree(void **state)
{
    (void)state;
    static ball b;
    static inputs first, refining;
    ball_of(&b);
    int known = 0, parts = 0;
    for (uint64_t i = 0; i < 40; i++) {
        assert_int_equal(fill(&b, i, &first, &refining), OK);
        if (first.light[NFPS_LIGHT * (SIDE / 4 * SIDE / 2 + SIDE / 4) + 4] > 0) continue; /* estimated */
        known++;
        parts += refining.mask[0] > 0 || refining.mask[SIDE - 1] > 0 || refining.mask[SIDE / 2] > 0;
        assert_true(agreement(&refining, SIDE) > 0.95);
        assert_true(agreement(&first, SIDE / 2) > 0.9); /* of a plane's depth */
    }
    assert_in_range(known, 20, 36);
    assert_true(parts > 0);
}

static void normals_before_are_wrong_but_of_the_same_surface(void **state)
{
    (void)state;
    static ball b;
    static inputs first, refining;
    ball_of(&b);
    double sum = 0, count = 0;
    for (uint64_t n = 0; n < 40; n++) {
        assert_int_equal(fill(&b, n, &first, &refining), OK);
        for (int i = 0; i < SIDE * SIDE; i++) {
            if (!(refining.mask[i] > 0)) continue;
            const vec3 was = vec3_of(refining.normal + 3 * i), is = vec3_of(refining.normal_true + 3 * i);
            assert_true(fabsf(vec3_length(was) - 1) < 1e-3f && fabsf(vec3_length(is) - 1) < 1e-3f);
            assert_true(was.z > 0.04f); /* it faces the eye */
            sum += acos(fmin((double)vec3_dot(was, is), 1)) * 57.29578;
            count++;
        }
    }
    assert_true(sum / count > 5 && sum / count < 25);
}

static void a_presentation_is_the_same_again(void **state)
{
    (void)state;
    static ball b;
    static inputs first, refining, first_again, again;
    ball_of(&b);
    assert_int_equal(fill(&b, 7, &first, &refining), OK);
    assert_int_equal(fill(&b, 7, &first_again, &again), OK);
    assert_memory_equal(&first, &first_again, sizeof first);
    assert_memory_equal(&refining, &again, sizeof again);
    b.view.lamp_count = PICTURES - 1;
    assert_int_equal(fill(&b, 7, &first, &refining), MERLIN_BAD_INPUT);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(pictures_lights_and_truth_agree),
        cmocka_unit_test(normals_before_are_wrong_but_of_the_same_surface),
        cmocka_unit_test(a_presentation_is_the_same_again),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
