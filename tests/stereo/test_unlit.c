/* SPDX-License-Identifier: MIT */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include "base/status.h"

#include <cmocka.h> /* last, as cmocka defines a macro named fail */

#include "base/rng.h"
#include "relief.h"
#include "stereo/methods/unlit.h"

enum { SIZE = 96, LIGHTS = 50, INK_LEFT = 40, INK_RIGHT = 60 };
static const float noise = 0.004f;

static bool is_ink(int pixel)
{
    return pixel % SIZE >= INK_LEFT && pixel % SIZE < INK_RIGHT;
}

/* A ball under the lights to its right, with noise, and a stripe of black ink on it. */
static void ball_from_one_side(merlin_capture *c)
{
    relief r = {.size = SIZE, .lights = LIGHTS, .channels = 3, .exposure = 2};
    rng random = rng_at(1, 0, 0);
    int count = 0;
    relief_capture(&r, c);
    for (int k = 0; k < LIGHTS; k++) {
        if (c->light[k].direction[0] < 0.55f) {
            pst_plane_free(&c->picture[k]);
            continue;
        }
        for (int i = 0; i < 3 * SIZE * SIZE; i++) {
            float value = (float)c->picture[k].wide[i] / 65535 * (is_ink(i / 3) ? 0.05f : 1);
            c->picture[k].wide[i] = relief_code(fmaxf(value + noise * rng_normal(&random), 0));
        }
        c->light[count] = c->light[k];
        c->picture[count++] = c->picture[k];
    }
    c->count = count;
}

static bool is_lit(const merlin_capture *c, int pixel, float cosine)
{
    int lit = 0;
    for (int k = 0; k < c->count; k++)
        lit += vec3_dot(vec3_of(c->normal_true.data + 3 * pixel), vec3_of(c->light[k].direction)) > cosine;
    return lit > 0;
}

static double angle_at(const merlin_capture *c, const img *normal, int pixel)
{
    double cosine = (double)vec3_dot(vec3_of(c->normal_true.data + 3 * pixel), vec3_of(normal->data + 3 * pixel));
    return acos(fmin(fmax(cosine, -1), 1)) * 57.29577951;
}

/* From the true normals where it is lit and any where not, which is what a fit to noise gives. */
static void what_no_light_reaches_goes_on_from_what_is_lit(void **state)
{
    (void)state;
    merlin_capture c;
    merlin_surface s = {0};
    rng random = rng_at(2, 0, 0);
    ball_from_one_side(&c);
    pst_problem p = {.capture = &c, .light = c.light};
    assert_int_equal(pst_list_pixels(&c, &p), OK);
    assert_int_equal(img_copy(&s.normal, &c.normal_true), OK);
    double before = 0, after = 0;
    int unlit = 0, ink = 0, lost = 0;
    for (int i = 0; i < SIZE * SIZE; i++)
        if (c.mask.data[i] > 0.5f && !is_lit(&c, i, 0)) {
            vec3_put(vec3_normalize(vec3_make(rng_normal(&random), rng_normal(&random), 0.1f)), s.normal.data + 3 * i);
            before += angle_at(&c, &s.normal, i);
            unlit++;
        }
    assert_int_equal(pst_unlit_fill(&p, &s), OK);
    for (int i = 0; i < SIZE * SIZE; i++) {
        if (c.mask.data[i] < 0.5f) continue;
        assert_float_equal(vec3_length(vec3_of(s.normal.data + 3 * i)), 1, 1e-5);
        if (!is_lit(&c, i, 0)) {
            after += angle_at(&c, &s.normal, i);
        } else if (is_ink(i) && is_lit(&c, i, 0.7f)) { /* by more than the noise */
            ink++;
            lost += angle_at(&c, &s.normal, i) > 0.1;
        }
    }
    print_message("%d pixels without light: %.1f degrees, then %.1f; %d of ink, %d of them taken for noise\n", unlit,
                  before / unlit, after / unlit, ink, lost);
    assert_true(unlit > 200 && ink > 1000 && lost <= ink / 100);
    assert_true(before / unlit > 80 && after / unlit < 15);
    free(p.pixel);
    img_free(&s.normal);
    capture_drop(&c);
}

static void a_lit_object_stays_as_it_is(void **state)
{
    (void)state;
    relief r = {.size = SIZE, .lights = LIGHTS, .channels = 1, .bump = 8, .exposure = 2};
    merlin_capture c;
    merlin_surface s = {0};
    relief_capture(&r, &c);
    pst_problem p = {.capture = &c, .light = c.light};
    assert_int_equal(pst_list_pixels(&c, &p), OK);
    assert_int_equal(img_copy(&s.normal, &c.normal_true), OK);
    assert_int_equal(pst_unlit_fill(&p, &s), OK);
    assert_memory_equal(s.normal.data, c.normal_true.data, 3 * SIZE * SIZE * sizeof(float));
    free(p.pixel);
    img_free(&s.normal);
    capture_drop(&c);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(what_no_light_reaches_goes_on_from_what_is_lit),
        cmocka_unit_test(a_lit_object_stays_as_it_is),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
