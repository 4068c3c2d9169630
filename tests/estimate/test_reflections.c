/* SPDX-License-Identifier: MIT */
/* Interpolated reflections against the lobe sampled at every pixel. */
#include "estimate/light/reflections.h"

#include <math.h>

#include "estimate/light/lobe_sampler.h"
#include "optics/camera.h"
#include "surroundings.h"

/* last, as cmocka defines a macro named fail */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

enum { SIZE = 150, PIXELS = SIZE * SIZE };

/* A sphere that fills most of the frame, rougher to the right; its outline is no multiple of any square. bumps: how far
 * normals are off at every other pixel. */
static surface ball(float least, float most, float bumps)
{
    surface s;
    assert_int_equal(surface_new(SIZE, SIZE, &s), OK);
    for (int i = 0; i < PIXELS; i++) {
        float x = ((float)(i % SIZE) + 0.5f) / SIZE * 2 - 1, y = 1 - ((float)(i / SIZE) + 0.5f) / SIZE * 2;
        x /= 0.93f;
        y /= 0.93f;
        if (x * x + y * y > 0.98f) continue;
        float off = (i % SIZE + i / SIZE) % 2 ? bumps : 0;
        vec3_put(vec3_normalize(vec3_make(x + off, y, sqrtf(1 - x * x - y * y))), s.normal.data + 3 * i);
        s.roughness.data[i] = least + (most - least) * (float)(i % SIZE) / SIZE;
        s.depth.data[i] = 1;
        s.mask.data[i] = x > -0.9f ? 1 : 0.5f;
    }
    return s;
}

/* A sky, and a lamp of three degrees as strong as all of it. */
static vec3 lamp_and_sky(vec3 d)
{
    static const vec3 place = {0.48f, 0.6f, 0.64f};
    float glow = vec3_dot(d, place) > 0.99966f ? 2500 : 0;
    return vec3_make(1 + glow + 0.5f * d.x, 0.8f + glow + 0.3f * d.y, 0.6f + glow + 0.3f * d.y * d.z);
}

static void sample_every_pixel(const surface *s, const env_map *env, const horizon *hidden, img *image)
{
    lobe_sampler l;
    lobe_over(env, hidden, &l);
    camera eye = {.width = SIZE, .height = SIZE, .fov = CAMERA_FOV};
    assert_int_equal(img_new(image, SIZE, SIZE, 3), OK);
    for (int i = 0; i < PIXELS; i++) {
        if (!(s->mask.data[i] > 0)) continue;
        float x = (float)(i % SIZE) + 0.5f, y = (float)(i / SIZE) + 0.5f;
        lobe_point p = {vec3_of(s->normal.data + 3 * i), vec3_scale(camera_ray(&eye, x, y), -1), s->roughness.data[i],
                        x / SIZE, y / SIZE};
        vec3_put(vec3_scale(lobe_reflection(&l, &p), s->mask.data[i]), image->data + 3 * i);
    }
}

typedef struct difference {
    double largest, rms; /* of the brightest value; of the mean */
} difference;

static difference compare(const img *a, const img *truth)
{
    double squares = 0, sum = 0, largest = 0, brightest = 0;
    size_t count = 0;
    for (int i = 0; i < 3 * PIXELS; i++) {
        double off = (double)(a->data[i] - truth->data[i]), value = (double)truth->data[i];
        squares += off * off;
        sum += value;
        count += value > 0;
        largest = fmax(largest, fabs(off));
        brightest = fmax(brightest, value);
    }
    return (difference){largest / brightest, sqrt(squares / (double)count) / (sum / (double)count)};
}

static difference error_of(surface *s, const horizon *hidden)
{
    env_map e;
    img fast = {0}, plain = {0};
    assert_int_equal(surroundings(lamp_and_sky, 512, &e), OK);
    assert_int_equal(img_new(&fast, SIZE, SIZE, 3), OK);
    surface_add_reflections(s, &e, hidden, &fast);
    sample_every_pixel(s, &e, hidden, &plain);
    difference out = compare(&fast, &plain);
    print_message("largest error %.2e of the brightest, root mean square %.2e of the mean\n", out.largest, out.rms);
    env_map_free(&e);
    img_free(&fast);
    img_free(&plain);
    surface_free(s);
    return out;
}

static void interpolated_reflections_are_those_of_every_pixel(void **state)
{
    (void)state;
    surface s = ball(0.25f, 0.9f, 0);
    difference d = error_of(&s, NULL);
    assert_true(d.rms > 0);    /* or nothing was interpolated */
    assert_true(d.rms < 0.02); /* what the middle of a square may be off by */
    /* at the lamp 64 samples are off by a tenth themselves (lobe.h), in a pattern that is finer than squares */
    assert_true(d.largest < 0.1);
}

/* A wall beside the line of sight to the right half hides what is there. */
static void interpolated_reflections_know_the_horizon(void **state)
{
    (void)state;
    surface s = ball(0.5f, 0.9f, 0);
    for (int i = 0; i < PIXELS; i++)
        s.depth.data[i] = i % SIZE > SIZE / 2 ? 0.7f : 1;
    shadow_occluder occluder;
    horizon h;
    assert_int_equal(shadow_occluder_new(&s.depth, &s.normal, &s.mask, (camera_lens){.fov = CAMERA_FOV}, &occluder),
                     OK);
    assert_int_equal(horizon_new(&occluder, &h), OK);
    difference d = error_of(&s, &h);
    assert_true(d.rms > 0 && d.rms < 0.02);
    assert_true(d.largest < 0.15); /* as above, and the foot of the wall: the horizon turns between two of its points */
    horizon_free(&h);
    shadow_occluder_free(&occluder);
}

static void relief_finer_than_a_square_is_not_interpolated(void **state)
{
    (void)state;
    surface s = ball(0.25f, 0.4f, 0.1f);
    difference d = error_of(&s, NULL);
    assert_true(d.largest < 1e-5); /* rounding */
}

static void mirrors_are_not_interpolated_over_a_turning_surface(void **state)
{
    (void)state;
    surface s = ball(0.03f, 0.05f, 0);
    difference d = error_of(&s, NULL);
    assert_true(d.rms < 1e-3); /* the map resolves a hundredth of a radian, and normals turn by as much a pixel */
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(interpolated_reflections_are_those_of_every_pixel),
        cmocka_unit_test(interpolated_reflections_know_the_horizon),
        cmocka_unit_test(relief_finer_than_a_square_is_not_interpolated),
        cmocka_unit_test(mirrors_are_not_interpolated_over_a_turning_surface),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
