/* SPDX-License-Identifier: MIT */
/* Lamps, domes, orbits, lists and found lights, and a relighter under them, by the public functions. */
#include "estimate_fixture.h"

static float distance_to(const float at[3], float x, float y, float z)
{
    return sqrtf((at[0] - x) * (at[0] - x) + (at[1] - y) * (at[1] - y) + (at[2] - z) * (at[2] - z));
}

static void a_domes_lamps_are_spread_over_the_frontal_hemisphere(void **state)
{
    enum { COUNT = 50 };
    (void)state;
    float mean[3] = {0};
    for (int i = 0; i < COUNT; i++) {
        const merlin_lamp far = merlin_dome_lamp(i, COUNT, 0), near = merlin_dome_lamp(i, COUNT, 2);
        float direction[3];
        merlin_dome_direction(i, COUNT, direction);
        assert_true(far.distant && !near.distant && far.power[1] == 1);
        assert_float_equal(distance_to(far.at, 0, 0, 0), 1, 1e-6);
        assert_float_equal(distance_to(far.at, direction[0], direction[1], direction[2]), 0, 1e-6);
        assert_float_equal(distance_to(near.at, 0, 0, -1), 2, 1e-5);
        assert_true(far.at[2] > 0);
        for (int c = 0; c < 3; c++)
            mean[c] += far.at[c] / COUNT;
    }
    assert_float_equal(mean[0], 0, 0.05);
    assert_float_equal(mean[1], 0, 0.05);
    assert_float_equal(mean[2], 0.5, 0.01);
}

static void an_orbit_goes_round_at_distance_one(void **state)
{
    (void)state;
    const merlin_lamp first = merlin_orbit_lamp(0, 4), up = merlin_orbit_lamp(1, 4), last = merlin_orbit_lamp(4, 4);
    assert_true(first.at[0] > 0.7f && fabsf(first.at[1]) < 1e-6f && up.at[1] > 0.7f);
    assert_float_equal(distance_to(first.at, 0, 0, -1), 1, 1e-6);
    assert_float_equal(distance_to(first.at, last.at[0], last.at[1], last.at[2]), 0, 1e-5);
}

static void a_cold_lamp_is_blue_and_a_warm_one_red(void **state)
{
    (void)state;
    float warm[3], cold[3];
    assert_int_equal(merlin_temperature_color(2700, warm), MERLIN_OK);
    assert_int_equal(merlin_temperature_color(12000, cold), MERLIN_OK);
    assert_true(warm[0] == 1 && warm[0] > warm[1] && warm[1] > warm[2]);
    assert_true(cold[2] == 1 && cold[2] > cold[1] && cold[1] > cold[0]);
    assert_int_equal(merlin_temperature_color(900, warm), MERLIN_WRONG_USE);
    assert_int_equal(merlin_temperature_color((double)NAN, warm), MERLIN_WRONG_USE);
}

static void a_list_has_places_or_directions(void **state)
{
    const fixture *f = *state;
    static const char lp[] = "2\na.png 0 0.6 0.8\nb.png 2 0 0\n", places[] = "0 0.5 1 2 2 2\n0.1 0 1 1 1 1\n";
    char path[PATH_MAX];
    merlin_lamps lamps;
    snprintf(path, sizeof path, "%s/dome.lp", f->folder);
    assert_int_equal(file_write(path, lp, sizeof lp - 1), OK);
    assert_int_equal(merlin_lamps_read(path, 0, &lamps), MERLIN_OK);
    assert_int_equal(lamps.count, 2);
    assert_true(lamps.at[0].distant && lamps.at[1].distant && lamps.at[1].at[0] == 1);
    merlin_lamps_free(&lamps);
    assert_int_equal(merlin_lamps_read(path, 3, &lamps), MERLIN_OK);
    assert_float_equal(distance_to(lamps.at[1].at, 3, 0, -1), 0, 1e-6);
    merlin_lamps_free(&lamps);
    snprintf(path, sizeof path, "%s/lights.txt", f->folder);
    assert_int_equal(file_write(path, places, sizeof places - 1), OK);
    assert_int_equal(merlin_lamps_read(path, 0, &lamps), MERLIN_OK);
    assert_true(!lamps.at[0].distant && lamps.at[0].at[2] == 1 && lamps.at[0].power[2] == 2);
    merlin_lamps_free(&lamps);
    assert_int_equal(merlin_lamps_read(f->weights, 0, &lamps), MERLIN_BAD_INPUT);
    assert_null(lamps.at);
    assert_int_equal(merlin_lamps_read(path, -1, &lamps), MERLIN_WRONG_USE);
}

static void found_lights_turn_but_for_the_flash(void **state)
{
    (void)state;
    merlin_found_light light = {.known = 1, .flash = 0.5f, .lamp = {1, 0, 0}, .lamp_strength = {1, 2, 3}};
    merlin_found_lights lights;
    assert_int_equal(merlin_found_lights_new(&light, 90, &lights), MERLIN_OK);
    assert_int_equal(lights.count, 2);
    assert_null(lights.rest);
    assert_true(lights.lamps[0].power[0] == 0.5f && lights.lamps[1].power[2] == 3 && lights.lamps[1].distant);
    assert_float_equal(distance_to(lights.lamps[1].at, 0, 0, 1), 0, 1e-6); /* what was to the right is behind */
    merlin_found_lights_turn(&lights, 270);
    assert_float_equal(distance_to(lights.lamps[0].at, 0, 0, 0), 0, 0);
    assert_float_equal(distance_to(lights.lamps[1].at, 1, 0, 0), 0, 1e-6);
    merlin_found_lights_free(&lights);
    light.rest[0][0] = light.rest[0][1] = light.rest[0][2] = 1;
    assert_int_equal(merlin_found_lights_new(&light, 0, &lights), MERLIN_OK);
    assert_non_null(lights.rest);
    merlin_found_lights_free(&lights);
    assert_int_equal(merlin_found_lights_new(&(merlin_found_light){0}, 0, &lights), MERLIN_BAD_INPUT);
    assert_int_equal(lights.count, 0);
}

/* ---- a relighter ---- */

static const float side_light[3] = {0.5f, 0.4f, -0.3f};

static double sum_of(const merlin_image *m)
{
    double sum = 0;
    for (int i = 0; i < m->width * m->height * m->channels; i++)
        sum += (double)m->data[i];
    return sum;
}

static merlin_relighter *relighter_of(const fixture *f, const merlin_maps *maps, merlin_relighting how)
{
    merlin_relighter *made = NULL;
    assert_int_equal(merlin_relighter_new(f->model, maps, 0, how, &made), MERLIN_OK);
    return made;
}

static void a_placed_square_is_the_relit_photograph(void **state)
{
    const fixture *f = *state;
    merlin_maps maps;
    merlin_image square, placed, whole;
    const merlin_lamp lamp = merlin_lamp_at(side_light[0], side_light[1], side_light[2]);
    estimate(f, &maps);
    merlin_relighter *r = relighter_of(f, &maps, MERLIN_BY_BRDF);
    assert_int_equal(merlin_relighter_render_lamps(r, &lamp, 1, NULL, &square), MERLIN_OK);
    assert_int_equal(merlin_relighter_mask(r)->width, square.width);
    assert_int_equal(merlin_relighter_place(r, &square, &placed), MERLIN_OK);
    assert_int_equal(merlin_relight(f->model, &maps, side_light, MERLIN_BY_BRDF, &whole), MERLIN_OK);
    assert_memory_equal(placed.data, whole.data, sizeof(float) * 3 * WIDTH * HEIGHT);
    merlin_image_free(&placed);
    assert_int_equal(merlin_relighter_resize(r, &maps, 32), MERLIN_OK);
    assert_int_equal(merlin_relighter_place(r, &square, &placed), MERLIN_WRONG_USE);
    assert_null(placed.data);
    merlin_image_free(&square);
    assert_int_equal(merlin_relighter_render_lamps(r, &lamp, 1, NULL, &square), MERLIN_OK);
    assert_int_equal(square.width, 32);
    merlin_image_free(&square);
    merlin_image_free(&whole);
    merlin_relighter_free(r);
    merlin_maps_free(&maps);
}

static void lamps_add_and_white_divides(void **state)
{
    const fixture *f = *state;
    merlin_maps maps;
    merlin_image one, other, both;
    const merlin_lamp lamps[] = {merlin_lamp_at(0.5f, 0.4f, -0.3f), merlin_lamp_toward(-3, 0, 4)};
    float white = 0;
    estimate(f, &maps);
    merlin_relighter *r = relighter_of(f, &maps, MERLIN_BY_BRDF_DIRECT);
    assert_true(merlin_relighter_white(r) > 0);
    assert_int_equal(merlin_relighter_meter(r, lamps, 2, NULL, &white), MERLIN_OK);
    float each[2] = {0}, together = 0;
    for (int i = 0; i < 2; i++)
        assert_int_equal(merlin_relighter_meter(r, lamps + i, 1, NULL, each + i), MERLIN_OK);
    assert_int_equal(merlin_relighter_meter_together(r, lamps, 2, NULL, &together), MERLIN_OK);
    assert_float_equal(together, each[0] + each[1], 1e-6f * together);
    assert_int_equal(merlin_relighter_set_white(r, 4 * white), MERLIN_OK); /* nothing is clamped */
    assert_true(merlin_relighter_white(r) == 4 * white);
    assert_int_equal(merlin_relighter_render_lamps(r, &lamps[0], 1, NULL, &one), MERLIN_OK);
    assert_int_equal(merlin_relighter_render_lamps(r, &lamps[1], 1, NULL, &other), MERLIN_OK);
    assert_int_equal(merlin_relighter_render_lamps(r, lamps, 2, NULL, &both), MERLIN_OK);
    assert_true(sum_of(&one) > 1 && sum_of(&other) > 1);
    assert_float_equal(sum_of(&one) + sum_of(&other), sum_of(&both), 1e-3 * sum_of(&both));
    merlin_image_free(&other);
    assert_int_equal(merlin_relighter_set_white(r, 8 * white), MERLIN_OK);
    assert_int_equal(merlin_relighter_render_lamps(r, &lamps[0], 1, NULL, &other), MERLIN_OK);
    assert_float_equal(sum_of(&one), 2 * sum_of(&other), 1e-3 * sum_of(&one));
    assert_int_equal(merlin_relighter_set_white(r, 0), MERLIN_WRONG_USE);
    merlin_image_free(&one);
    merlin_image_free(&other);
    merlin_image_free(&both);
    merlin_relighter_free(r);
    merlin_maps_free(&maps);
}

static void without_gloss_a_picture_is_darker(void **state)
{
    const fixture *f = *state;
    merlin_maps maps;
    merlin_image glossy, matte;
    const merlin_lamp lamp = merlin_lamp_at(0.1f, 0.1f, 0);
    estimate(f, &maps);
    merlin_relighter *r = relighter_of(f, &maps, MERLIN_BY_BRDF);
    assert_int_equal(merlin_relighter_set_white(r, 100), MERLIN_OK);
    assert_int_equal(merlin_relighter_render_lamps(r, &lamp, 1, NULL, &glossy), MERLIN_OK);
    assert_int_equal(merlin_relighter_make_matte(r), MERLIN_OK);
    assert_int_equal(merlin_relighter_render_lamps(r, &lamp, 1, NULL, &matte), MERLIN_OK);
    assert_true(sum_of(&matte) < 0.99 * sum_of(&glossy));
    merlin_image_free(&glossy);
    merlin_image_free(&matte);
    merlin_relighter_free(r);
    merlin_maps_free(&maps);
}

static void lamps_that_cannot_be_are_refused(void **state)
{
    const fixture *f = *state;
    merlin_maps maps;
    merlin_image picture;
    const merlin_lamp flat = {.distant = 1, .power = {1, 1, 1}}, negative = {.power = {1, -1, 1}},
                      endless = {{0, INFINITY, 0}, 0, {1, 1, 1}}, *const bad[] = {&flat, &negative, &endless};
    const merlin_lamp far = merlin_lamp_toward(0, 0, 1), near = merlin_lamp_at(0, 0, 0);
    estimate(f, &maps);
    merlin_relighter *r = relighter_of(f, &maps, MERLIN_BY_BRDF);
    for (int i = 0; i < 3; i++) {
        assert_int_equal(merlin_relighter_render_lamps(r, bad[i], 1, NULL, &picture), MERLIN_WRONG_USE);
        assert_null(picture.data);
        assert_int_equal(merlin_relighting_check(MERLIN_BY_BRDF, bad[i], 0), MERLIN_WRONG_USE);
    }
    assert_int_equal(merlin_relighter_render_lamps(r, NULL, 0, NULL, &picture), MERLIN_WRONG_USE);
    assert_int_equal(merlin_relighter_render_lamps(r, &near, -1, NULL, &picture), MERLIN_WRONG_USE);
    assert_int_equal(merlin_relighting_check(MERLIN_BY_BRDF, &far, 1), MERLIN_OK);
    assert_int_equal(merlin_relighting_check(MERLIN_BY_NETWORK, &near, 1), MERLIN_OK);
    assert_int_equal(merlin_relighting_check(MERLIN_BY_NETWORK, &far, 0), MERLIN_WRONG_USE);
    assert_int_equal(merlin_relighting_check(MERLIN_BY_NETWORK, NULL, 1), MERLIN_WRONG_USE);
    merlin_relighter_free(r);
    merlin_maps_free(&maps);
}

static void a_photograph_straight_ahead_is_in_the_lens_space(void **state)
{
    (void)state;
    merlin_maps maps = {.mask = {200, 100, 1, NULL}, .crop = {50, 0, 100}};
    const float place[3] = {0.1f, 0.2f, -0.3f};
    float out[3];
    merlin_maps_lens_place(&maps, place, out);
    assert_float_equal(distance_to(out, place[0], place[1], place[2]), 0, 1e-6);
    /* twice as wide as the crop's 60 degrees: 2 atan(2 tan 30) */
    assert_float_equal(merlin_maps_field_of_view(&maps), 98.2132, 1e-3);
}

#define with_model(test) cmocka_unit_test_setup_teardown(test, set_up, tear_down)

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_domes_lamps_are_spread_over_the_frontal_hemisphere),
        cmocka_unit_test(an_orbit_goes_round_at_distance_one),
        cmocka_unit_test(a_cold_lamp_is_blue_and_a_warm_one_red),
        cmocka_unit_test(found_lights_turn_but_for_the_flash),
        cmocka_unit_test(a_photograph_straight_ahead_is_in_the_lens_space),
        with_model(a_list_has_places_or_directions),
        with_model(a_placed_square_is_the_relit_photograph),
        with_model(lamps_add_and_white_divides),
        with_model(without_gloss_a_picture_is_darker),
        with_model(lamps_that_cannot_be_are_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
