/* SPDX-License-Identifier: MIT */
/* Surfaces under environments whose reflection is known in closed form or by quadrature. */
#include <math.h>

#include "estimate/light/relight_env.h"
#include "optics/brdf.h"
#include "optics/camera.h"
#include "optics/latlong.h"
#include "optics/sh.h"
#include "surroundings.h"

/* last, as cmocka defines a macro named fail */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

enum { SIZE = 24, PIXELS = SIZE * SIZE };

static vec3 view_of(int i)
{
    camera c = {.width = SIZE, .height = SIZE, .fov = 60};
    return vec3_scale(camera_ray(&c, (float)(i % SIZE) + 0.5f, (float)(i / SIZE) + 0.5f), -1);
}

static vec3 normal_of(const surface *s, int i)
{
    const float *n = s->normal.data + 3 * i;
    return vec3_make(n[0], n[1], n[2]);
}

/* Normals up to 60 degrees off the view, all roughnesses from `least`, one corner outside the mask. */
static surface wall(float least)
{
    surface s;
    assert_int_equal(surface_new(SIZE, SIZE, &s), OK);
    for (int i = 0; i < PIXELS; i++) {
        float tilt = 1.05f * (float)(i / SIZE) / SIZE, around = 2.4f * (float)i;
        vec3 n = vec3_make(sinf(tilt) * cosf(around), sinf(tilt) * sinf(around), cosf(tilt));
        vec3 from_axis = brdf_to_world(n, view_of(i));
        s.normal.data[3 * i] = from_axis.x;
        s.normal.data[3 * i + 1] = from_axis.y;
        s.normal.data[3 * i + 2] = from_axis.z;
        for (int c = 0; c < 3; c++)
            s.albedo.data[3 * i + c] = 0.2f + 0.3f * (float)c;
        s.roughness.data[i] = least + (1 - least) * (float)(i % SIZE) / SIZE;
        s.depth.data[i] = 1;
        s.mask.data[i] = i ? 1 : 0;
    }
    return s;
}

static env_map map_of(vec3 (*radiance)(vec3))
{
    env_map e;
    assert_int_equal(surroundings(radiance, 512, &e), OK);
    return e;
}

static img picture(void)
{
    img image = {0};
    assert_int_equal(img_new(&image, SIZE, SIZE, 3), OK);
    return image;
}

static vec3 white(vec3 d)
{
    (void)d;
    return vec3_make(1, 1, 1);
}

/* The lobe's share of a furnace's light: quadrature over the hemisphere, cosθ to the fourth power's steps so that sharp
 * lobes about the mirror direction are not needed: the surface's least roughness is 0.2. */
static float share_of_lobe(float roughness, vec3 n, vec3 v)
{
    enum { STEPS = 160 };
    double sum = 0;
    for (int i = 0; i < STEPS * STEPS; i++) {
        float u1 = ((float)(i / STEPS) + 0.5f) / STEPS, u2 = ((float)(i % STEPS) + 0.5f) / STEPS;
        vec3 l = brdf_sample_cosine(n, u1, u2); /* density cosθ/π */
        sum += (double)(brdf_specular(roughness, n, l, v) * PI);
    }
    return (float)(sum / (STEPS * STEPS));
}

static void white_furnace_gives_the_brdfs_directional_albedo(void **state)
{
    (void)state;
    surface s = wall(0.2f);
    env_map e = map_of(white);
    img image = picture();
    surface_add_ambient(&s, (const float(*)[3])e.sh, &image);
    surface_add_reflections(&s, &e, NULL, &image);
    float worst = 0;
    for (int i = 1; i < PIXELS; i += 7) {
        float share = share_of_lobe(s.roughness.data[i], normal_of(&s, i), view_of(i));
        for (int c = 0; c < 3; c++)
            worst = fmaxf(worst, fabsf(image.data[3 * i + c] - s.albedo.data[3 * i + c] - share));
    }
    print_message("largest error %.4f\n", (double)worst);
    assert_true(worst < 0.003f); /* shares are 0.02 to 0.07; 64 samples and the quadrature of sharp lobes */
    for (int c = 0; c < 3; c++)
        assert_true(image.data[c] == 0); /* outside the mask */
    surface_free(&s);
    env_map_free(&e);
    img_free(&image);
}

static const vec3 spot = {0.48f, 0.6f, 0.64f};

/* Three degrees wide. */
static vec3 small_bright_spot(vec3 d)
{
    return vec3_dot(d, spot) > 0.99966f ? vec3_make(1000, 1000, 1000) : vec3_make(0, 0, 0);
}

static void small_bright_spot_is_a_distant_light(void **state)
{
    (void)state;
    surface s = wall(0.3f);
    env_map e = map_of(small_bright_spot);
    img diffuse = picture(), shiny = picture();
    surface_add_ambient(&s, (const float(*)[3])e.sh, &diffuse);
    surface_add_reflections(&s, &e, NULL, &shiny);
    float irradiance = env_map_mean(&e) * 4 * PI, worst_diffuse = 0, worst = 0, brightest = 0;
    for (int i = 1; i < PIXELS; i++) {
        vec3 n = normal_of(&s, i);
        float n_l = fmaxf(0, vec3_dot(n, spot));
        float lobe = n_l > 0 ? irradiance * n_l * brdf_specular(s.roughness.data[i], n, spot, view_of(i)) : 0;
        worst = fmaxf(worst, fabsf(shiny.data[3 * i] - lobe));
        brightest = fmaxf(brightest, lobe);
        float lambert = irradiance * n_l * s.albedo.data[3 * i] / PI;
        worst_diffuse = fmaxf(worst_diffuse, fabsf(diffuse.data[3 * i] - lambert) / (irradiance * 0.2f / PI));
    }
    print_message("highlights %.3f of %.3f, diffuse %.3f\n", (double)worst, (double)brightest, (double)worst_diffuse);
    assert_true(worst < 0.12f * brightest); /* the header promises a tenth; the spot is not quite a point */
    /* nine coefficients give (1/4 + cosθ/2 + 5/16 P2(cosθ)) where a lamp gives cosθ: 0.094 too much at 90 degrees */
    assert_true(worst_diffuse < 0.1f);
    surface_free(&s);
    env_map_free(&e);
    img_free(&diffuse);
    img_free(&shiny);
}

static void highlights_turn_with_the_environment(void **state)
{
    (void)state;
    surface s = wall(0.3f);
    env_map e = map_of(small_bright_spot);
    img before = picture(), after = picture(), back = picture();
    surface_add_reflections(&s, &e, NULL, &before);
    env_map_turn(&e, 120);
    surface_add_reflections(&s, &e, NULL, &after);
    env_map_turn(&e, 240);
    surface_add_reflections(&s, &e, NULL, &back);
    double difference = 0, all = 0;
    for (int i = 0; i < 3 * PIXELS; i++) {
        assert_float_equal(before.data[i], back.data[i], 2e-3 * (double)(before.data[i] + 1)); /* a full turn */
        difference += fabs((double)(before.data[i] - after.data[i]));
        all += (double)before.data[i];
    }
    assert_true(difference > 0.5 * all);
    surface_free(&s);
    env_map_free(&e);
    img_free(&before);
    img_free(&after);
    img_free(&back);
}

static vec3 sunset(vec3 d)
{
    return vec3_make(1 + 0.5f * d.x, 0.8f + 0.3f * d.y, 0.6f + 0.3f * d.y * d.z);
}

/* Where the surroundings are smooth, their coefficients say as much as the map. */
static void highlights_of_smooth_surroundings_need_no_map(void **state)
{
    (void)state;
    surface s = wall(0.2f);
    env_map e = map_of(sunset);
    img by_map = picture(), by_coefficients = picture();
    surface_add_reflections(&s, &e, NULL, &by_map);
    surface_add_ambient_highlights(&s, (const float(*)[3])e.sh, &by_coefficients);
    for (int i = 0; i < 3 * PIXELS; i++)
        assert_float_equal(by_map.data[i], by_coefficients.data[i], 0.02); /* optics/ambient.h: 0.015 for radiance 1 */
    surface_free(&s);
    env_map_free(&e);
    img_free(&by_map);
    img_free(&by_coefficients);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(white_furnace_gives_the_brdfs_directional_albedo),
        cmocka_unit_test(small_bright_spot_is_a_distant_light),
        cmocka_unit_test(highlights_turn_with_the_environment),
        cmocka_unit_test(highlights_of_smooth_surroundings_need_no_map),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
