/* SPDX-License-Identifier: MIT */
/* LEDs about the camera: where they are drawn, and samples under them. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/file.h"
#include "lab/render/generate.h"
#include "lab/render/sample_targets.h"
#include "optics/camera.h"
#include "optics/led.h"
#include "optics/light.h"
#include "scratch.h"

/* last, as cmocka defines a macro named fail */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

static render_options small(const char *folder)
{
    render_options o = render_options_default();
    o.folder = folder;
    o.count = 1;
    o.seed = 77;
    o.quiet = true;
    o.environment = false;
    o.image.size = 32;
    o.image.paths = 1;
    return o;
}

/* The means are those of the uniform distributions: that of a share in [0, 1] over 10000 draws deviates by 0.003, that
 * of a place by 0.004. */
static void leds_are_uniform_about_the_camera_and_look_at_the_object(void **state)
{
    (void)state;
    enum { DRAWS = 10000 };
    const double steepest = sqrt(0.75);
    double square = 0, deep = 0, cosine = 0, lobe = 0, right = 0, up = 0, most[4] = {0};
    rng r = rng_at(11, 0, 0);
    for (int i = 0; i < DRAWS; i++) {
        sample_target led = {0};
        sample_target_draw_led(&r, &led);
        double radius = hypot((double)led.light.x, (double)led.light.y);
        assert_true(radius <= 0.7500001 && fabs((double)led.light.z) <= 0.1500001);
        assert_true(fabs((double)vec3_length(led.axis) - 1) < 1e-6 && -(double)led.axis.z >= steepest - 1e-6);
        assert_true(led.lobe >= 0 && led.lobe < 2);
        square += radius * radius / (0.75 * 0.75) / DRAWS;
        deep += (double)led.light.z / 0.3 / DRAWS;
        cosine += (-(double)led.axis.z - steepest) / (1 - steepest) / DRAWS;
        lobe += (double)led.lobe / 2 / DRAWS;
        right += (double)(led.light.x + led.axis.x) / DRAWS;
        up += (double)(led.light.y + led.axis.y) / DRAWS;
        most[0] = fmax(most[0], radius);
        most[1] = fmax(most[1], fabs((double)led.light.z));
        most[2] = fmax(most[2], sqrt(1 - (double)(led.axis.z * led.axis.z)));
        most[3] = fmax(most[3], (double)led.lobe);
    }
    assert_true(fabs(square - 0.5) < 0.02 && fabs(deep) < 0.02 && fabs(cosine - 0.5) < 0.02 && fabs(lobe - 0.5) < 0.02);
    assert_true(fabs(right) < 0.02 && fabs(up) < 0.02);
    assert_true(most[0] > 0.74 && most[1] > 0.149 && most[2] > 0.49 && most[3] > 1.99);
}

static void an_led_is_as_bright_on_its_axis_as_a_point_light(void **state)
{
    (void)state;
    sample_target bulb = {0}, led = {0};
    rng r = rng_at(3, 0, 0);
    sample_target_draw(&r, &bulb);
    sample_target_draw_led(&r, &led);
    point_light first = sample_target_light(&bulb), second = sample_target_light(&led);
    assert_true(first.power == LIGHT_POWER && second.power == LIGHT_POWER && first.lobe == 0 && second.lobe > 0);
    assert_true(fabsf(led_share(second.axis, second.lobe, vec3_scale(second.axis, -1)) - 1) < 1e-6f);
    assert_true(led_share(first.axis, first.lobe, vec3_make(0, 1, 0)) == 1);
}

/* Computes relative differences of an LED's direct image and of the BRDF on the maps, dimmed beside the axis or not,
 * where the surface is lit. */
static size_t compare_led(const sample *s, const sample_target *led, bool dimmed, float *error)
{
    size_t count = 0;
    const camera eye = {s->mask.width, s->mask.height, s->fov, s->slant};
    for (int i = 0; i < s->mask.width * s->mask.height; i++) {
        if (s->mask.data[i] < 1 || led->direct.data[3 * i + 1] < 0.02f) continue;
        vec3 ray = camera_point(&eye, (float)(i % s->mask.width) + 0.5f, (float)(i / s->mask.width) + 0.5f, 1);
        shade_input in = {vec3_of(s->albedo.data + 3 * i),
                          s->roughness.data[i],
                          vec3_of(s->normal.data + 3 * i),
                          s->depth.data[i],
                          ray,
                          led->light,
                          s->light_power};
        vec3 l = vec3_normalize(vec3_sub(led->light, vec3_scale(ray, in.depth)));
        float expected = shade_point(&in).y * (dimmed ? led_share(led->axis, led->lobe, l) : 1);
        error[count++] = fabsf(led->direct.data[3 * i + 1] - expected) / fmaxf(expected, 1e-2f);
    }
    return count;
}

static void leds_light_the_maps_by_their_lobes(void **state)
{
    (void)state;
    enum { SIZE = 96, OBJECTS = 3, LEDS = 6, MOST = SIZE * SIZE * OBJECTS * LEDS };
    float *by_lobes = malloc(sizeof *by_lobes * MOST), *alike = malloc(sizeof *alike * MOST);
    size_t count = 0;
    render_options o = small(NULL);
    o.image.size = SIZE;
    o.image.leds = LEDS;
    for (uint64_t index = 0; index < OBJECTS; index++) {
        sample s;
        assert_int_equal(render_sample(&o, index, &s), OK);
        assert_int_equal(s.target_count, LEDS);
        for (int i = 0; i < LEDS; i++) {
            compare_led(&s, &s.targets[i], false, alike + count);
            count += compare_led(&s, &s.targets[i], true, by_lobes + count);
        }
        sample_free(&s);
    }
    qsort(by_lobes, count, sizeof *by_lobes, number_ascending);
    qsort(alike, count, sizeof *alike, number_ascending);
    /* half of the pixels are within 0.0012, and 0.087 without the lobes */
    assert_true(count > 1000 && by_lobes[count / 2] < 0.01f && alike[count / 2] > 0.05f);
    free(by_lobes);
    free(alike);
}

static void leds_come_after_the_targets(void **state)
{
    (void)state;
    sample s, plain;
    render_options o = small(NULL);
    o.image.targets = 2;
    assert_int_equal(render_sample(&o, 0, &plain), OK);
    o.image.leds = 3;
    assert_int_equal(render_sample(&o, 0, &s), OK);
    assert_int_equal(s.target_count, 5);
    for (int t = 0; t < 5; t++)
        assert_int_equal(vec3_length(s.targets[t].axis) > 0, t >= 2);
    assert_memory_equal(&s.targets[1].light, &plain.targets[1].light, sizeof(vec3));
    sample_free(&s);
    sample_free(&plain);
}

static void more_targets_than_a_sample_holds_are_refused(void **state)
{
    (void)state;
    char *above = scratch_new(), *folder = file_join(above, "samples");
    render_stats stats;
    static const int wrong[][2] = {
        {0, SAMPLE_MAX_TARGETS + 1}, {SAMPLE_MAX_TARGETS, 1}, {1, SAMPLE_MAX_TARGETS}, {3, -1}};
    for (size_t i = 0; i < sizeof wrong / sizeof *wrong; i++) {
        render_options o = small(folder);
        o.image.targets = wrong[i][0];
        o.image.leds = wrong[i][1];
        assert_int_equal(render_samples(&o, &stats), MERLIN_WRONG_USE);
        assert_non_null(strstr(status_message(), "at most 64 together"));
        assert_false(file_exists(folder));
    }
    free(folder);
    scratch_remove(above);
}

/* Folders of versions that knew no LEDs say nothing of them. */
static void a_folder_without_leds_does_not_name_them(void **state)
{
    (void)state;
    char *folder = scratch_new(), *path = file_join(folder, "render.txt"), *text;
    size_t size;
    render_stats stats;
    render_options o = small(folder);
    assert_int_equal(render_samples(&o, &stats), OK);
    assert_int_equal(file_read(path, 65536, &text, &size), OK);
    assert_null(strstr(text, "leds"));
    free(text);
    o.image.leds = 1;
    assert_int_equal(render_samples(&o, &stats), MERLIN_WRONG_USE);
    assert_non_null(strstr(status_message(), "other options"));
    free(path);
    scratch_remove(folder);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(leds_are_uniform_about_the_camera_and_look_at_the_object),
        cmocka_unit_test(an_led_is_as_bright_on_its_axis_as_a_point_light),
        cmocka_unit_test(leds_light_the_maps_by_their_lobes),
        cmocka_unit_test(leds_come_after_the_targets),
        cmocka_unit_test(more_targets_than_a_sample_holds_are_refused),
        cmocka_unit_test(a_folder_without_leds_does_not_name_them),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
