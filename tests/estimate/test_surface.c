/* SPDX-License-Identifier: MIT */
#include "estimate/surface/crop.h"
#include "estimate/surface/exposure.h"
#include "estimate/surface/fill.h"
#include "estimate/surface/smooth.h"
#include "estimate/surface/surface.h"
#include "optics/light.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>
#include <unistd.h>

#include <cmocka.h>

static void box(img *mask, int left, int top, int width, int height)
{
    for (int y = top; y < top + height; y++)
        for (int x = left; x < left + width; x++)
            *img_at(mask, x, y) = 1;
}

static void the_object_fills_four_fifths_of_the_crop(void **state)
{
    (void)state;
    img mask;
    crop_square c;
    assert_int_equal(img_new(&mask, 400, 300, 1), OK);
    box(&mask, 100, 50, 80, 40);
    assert_int_equal(crop_around(&mask, &c), OK);
    assert_int_equal(c.side, 100);
    assert_int_equal(c.x, 90);
    assert_int_equal(c.y, 20);
    img_free(&mask);
}

static void square_photographs_framed_like_the_training_data_are_taken_whole(void **state)
{
    (void)state;
    img mask;
    crop_square c;
    assert_int_equal(img_new(&mask, 100, 100, 1), OK);
    box(&mask, 10, 10, 70, 70);
    assert_int_equal(crop_around(&mask, &c), OK);
    assert_int_equal(c.x, 0);
    assert_int_equal(c.side, 100);
    img_free(&mask);
}

static void a_crop_put_back_lands_where_it_came_from(void **state)
{
    (void)state;
    img from, part, to;
    assert_int_equal(img_new(&from, 30, 20, 2), OK);
    assert_int_equal(img_new(&to, 30, 20, 2), OK);
    for (int i = 0; i < 30 * 20 * 2; i++)
        from.data[i] = (float)i;
    crop_square c = {-5, -3, 40}; /* hangs over every edge */
    assert_int_equal(crop_take(&from, c, NULL, &part), OK);
    crop_put(&part, c, NULL, &to);
    assert_memory_equal(from.data, to.data, 30 * 20 * 2 * sizeof(float));
    img_free(&from);
    img_free(&part);
    img_free(&to);
}

static void a_crop_takes_and_puts_back_what_is_covered_alone(void **state)
{
    (void)state;
    img from, mask, part, part_mask, to;
    assert_int_equal(img_new(&from, 30, 20, 2), OK);
    assert_int_equal(img_new(&to, 30, 20, 2), OK);
    assert_int_equal(img_new(&mask, 30, 20, 1), OK);
    box(&mask, 4, 6, 9, 5);
    for (int i = 0; i < 30 * 20 * 2; i++)
        from.data[i] = (float)(i + 1);
    crop_square c = {8, -3, 12}; /* cuts the box */
    assert_int_equal(crop_take(&from, c, &mask, &part), OK);
    assert_int_equal(crop_take(&mask, c, &mask, &part_mask), OK);
    crop_put(&part, c, &part_mask, &to);
    for (int y = 0; y < 20; y++)
        for (int x = 0; x < 30; x++) {
            float expected = x >= 8 && y < 9 && *img_at(&mask, x, y) > 0 ? img_at(&from, x, y)[1] : 0;
            assert_true(img_at(&to, x, y)[1] == expected);
        }
    img *all[] = {&from, &mask, &part, &part_mask, &to};
    for (int i = 0; i < 5; i++)
        img_free(all[i]);
}

static size_t resident_bytes(void)
{
    size_t pages = 0;
    FILE *f = fopen("/proc/self/statm", "r");
    if (f && fscanf(f, "%*u %zu", &pages) != 1) pages = 0;
    if (f) fclose(f);
    return pages * (size_t)sysconf(_SC_PAGESIZE);
}

/* Two images of 144 MB; the object is a hundredth of each. */
static void memory_is_taken_for_the_object_alone(void **state)
{
    (void)state;
    img low = {0}, low_mask = {0}, mask = {0}, large = {0}, whole = {0};
    assert_int_equal(img_new(&low, 64, 48, 3), OK);
    assert_int_equal(img_new(&low_mask, 64, 48, 1), OK);
    assert_int_equal(img_new(&mask, 4000, 3000, 1), OK);
    box(&low_mask, 16, 16, 6, 5);
    box(&mask, 1000, 1000, 400, 300);
    /* some kernels count pages of zeros that were read alone, and the mask is read whole */
    for (int y = 0; y < mask.height; y++)
        assert_true(img_row_span(&mask, y).end <= mask.width);
    size_t before = resident_bytes();
    assert_true(before > 0);
    assert_int_equal(surface_resize_image(&low, &low_mask, &mask, &large), OK);
    assert_int_equal(img_new(&whole, 4000, 3000, 3), OK);
    crop_put(&large, (crop_square){0, 0, 4000}, &mask, &whole);
    size_t taken = resident_bytes() - before;
    print_message("%.1f MB\n", (double)taken / 1e6);
    assert_true(taken < 36000000); /* an eighth; sanitizers keep as much again beside every block */
    img *all[] = {&low, &low_mask, &mask, &large, &whole};
    for (int i = 0; i < 5; i++)
        img_free(all[i]);
}

static void filling_keeps_the_inside_and_continues_it(void **state)
{
    (void)state;
    img image, mask;
    assert_int_equal(img_new(&image, 37, 23, 1), OK);
    assert_int_equal(img_new(&mask, 37, 23, 1), OK);
    box(&mask, 5, 6, 7, 8);
    for (int i = 0; i < 37 * 23; i++)
        image.data[i] = mask.data[i] > 0 ? 3 : NAN;
    assert_int_equal(fill_outside(&image, &mask), OK);
    /* means of equal numbers: a few roundings */
    for (int i = 0; i < 37 * 23; i++)
        assert_float_equal(image.data[i], 3, 1e-5);
    img_free(&image);
    img_free(&mask);
}

static void filling_without_any_inside_gives_zeros(void **state)
{
    (void)state;
    img image, mask;
    assert_int_equal(img_new(&image, 5, 4, 3), OK);
    assert_int_equal(img_new(&mask, 5, 4, 1), OK);
    for (int i = 0; i < 60; i++)
        image.data[i] = NAN;
    assert_int_equal(fill_outside(&image, &mask), OK);
    for (int i = 0; i < 60; i++)
        assert_true(image.data[i] == 0);
    img_free(&image);
    img_free(&mask);
}

static void smoothing_removes_a_pattern_of_two_pixels_and_keeps_a_slope(void **state)
{
    (void)state;
    img image, mask;
    assert_int_equal(img_new(&image, 16, 16, 1), OK);
    assert_int_equal(img_new(&mask, 16, 16, 1), OK);
    box(&mask, 0, 0, 16, 16);
    for (int i = 0; i < 256; i++)
        image.data[i] = (float)(i % 16) + ((i ^ i >> 4) & 1 ? 0.5f : -0.5f);
    assert_int_equal(smooth_inside(&image, &mask), OK);
    for (int y = 1; y < 15; y++)
        for (int x = 1; x < 15; x++)
            assert_float_equal(*img_at(&image, x, y), x, 1e-5); /* a few roundings */
    img_free(&image);
    img_free(&mask);
}

static void tidy_surfaces_keep_their_promises_whatever_came_in(void **state)
{
    (void)state;
    static const float bad[] = {NAN, INFINITY, -INFINITY, -3, 7, 0};
    surface s;
    assert_int_equal(surface_new(6, 2, &s), OK);
    for (int i = 0; i < 12; i++) {
        for (int c = 0; c < 3; c++)
            s.albedo.data[3 * i + c] = s.normal.data[3 * i + c] = bad[(i + c) % 6];
        s.roughness.data[i] = s.depth.data[i] = bad[i % 6];
        s.mask.data[i] = i < 6;
    }
    surface_tidy(&s);
    for (int i = 0; i < 12; i++) {
        const float *n = s.normal.data + 3 * i, *a = s.albedo.data + 3 * i;
        float length = n[0] * n[0] + n[1] * n[1] + n[2] * n[2];
        /* a few roundings of float32 */
        assert_float_equal(length, i < 6 ? 1 : 0, 1e-5);
        assert_true(i >= 6 || n[2] > 0);
        for (int c = 0; c < 3; c++)
            assert_true(a[c] >= 0 && a[c] <= 1);
        assert_true(isfinite(s.roughness.data[i]) && isfinite(s.depth.data[i]));
        assert_true(i < 6 || (a[0] == 0 && s.depth.data[i] == 0));
    }
    surface_free(&s);
}

static surface plate(int size)
{
    surface s;
    assert_int_equal(surface_new(size, size, &s), OK);
    for (int i = 0; i < size * size; i++) {
        s.albedo.data[3 * i] = 0.5f;
        s.normal.data[3 * i + 2] = 1;
        s.roughness.data[i] = 1;
        s.depth.data[i] = 1;
        s.mask.data[i] = 1;
    }
    return s;
}

static void the_centre_of_a_plate_under_the_flash_has_the_formulas_radiance(void **state)
{
    (void)state;
    surface s = plate(63);
    img out;
    assert_int_equal(surface_shade(&s, vec3_make(0, 0, 0), &out), OK);
    /* l = v = n at distance 1: diffuse A/π, specular D F G / 4 with D = 1/π, G = 1, F = 0.05 + 0.95·2^-12.53777 */
    double fresnel = 0.05 + 0.95 * pow(2, -5.55473 - 6.98316), specular = fresnel / (4 * M_PI);
    const float *centre = img_at(&out, 31, 31);
    /* relative error of the fast exponential and float32 */
    assert_float_equal(centre[0], 5.95 * (0.5 / M_PI + specular), 1e-4);
    assert_float_equal(centre[1], 5.95 * specular, 1e-4);
    img_free(&out);
    surface_free(&s);
}

/* Not only at the centre, where a near lamp at distance 1 is as bright: parallel light is everywhere the same. */
static void a_distant_lamp_is_as_bright_everywhere_as_a_near_one_at_distance_1(void **state)
{
    (void)state;
    surface s = plate(63);
    s.matte = true;
    const vec3 direction = {0.6f, 0, 0.8f};
    const lamp afar = lamp_toward(vec3_scale(direction, 7)), near = lamp_at(vec3_add(direction, vec3_make(0, 0, -1)));
    img far_lit, near_lit;
    assert_int_equal(surface_shade_lamp(&s, &afar, &far_lit), OK);
    assert_int_equal(surface_shade_lamp(&s, &near, &near_lit), OK);
    /* A/π · Φ · n·l */
    for (int i = 0; i < 63 * 63; i++)
        assert_float_equal(far_lit.data[3 * i], 0.5 / M_PI * 5.95 * 0.8, 1e-4);
    assert_float_equal(img_at(&near_lit, 31, 31)[0], img_at(&far_lit, 31, 31)[0], 1e-4);
    assert_true(img_at(&near_lit, 62, 31)[0] > 1.2f * img_at(&far_lit, 62, 31)[0]);
    img_free(&far_lit);
    img_free(&near_lit);
    surface_free(&s);
}

static void a_matte_surface_has_no_gloss(void **state)
{
    (void)state;
    surface s = plate(63);
    s.matte = true;
    img out;
    assert_int_equal(surface_shade(&s, vec3_make(0, 0, 0), &out), OK);
    const float *centre = img_at(&out, 31, 31);
    assert_float_equal(centre[0], 5.95 * 0.5 / M_PI, 1e-4);
    assert_true(centre[1] == 0);
    img_free(&out);
    surface_free(&s);
}

static void a_light_on_the_left_brightens_the_left(void **state)
{
    (void)state;
    surface s = plate(32);
    img out;
    assert_int_equal(surface_shade(&s, vec3_make(-1, 0, -0.5f), &out), OK);
    assert_true(img_at(&out, 2, 16)[0] > 1.5f * img_at(&out, 29, 16)[0]);
    /* and neither above nor below */
    assert_float_equal(img_at(&out, 5, 10)[0], img_at(&out, 5, 21)[0], 1e-5);
    img_free(&out);
    surface_free(&s);
}

static void a_surface_survives_resizing(void **state)
{
    (void)state;
    surface s = plate(64), half;
    img mask;
    assert_int_equal(img_new(&mask, 24, 24, 1), OK);
    box(&mask, 2, 2, 20, 20);
    assert_int_equal(surface_resize(&s, &mask, &half), OK);
    const float *inside = img_at(&half.albedo, 10, 10);
    /* averages of equal numbers */
    assert_float_equal(inside[0], 0.5f, 1e-4);
    assert_float_equal(*img_at(&half.depth, 10, 10), 1, 1e-4);
    assert_float_equal(*img_at(&half.depth, 0, 0), 0, 0);
    img_free(&mask);
    surface_free(&s);
    surface_free(&half);
}

/* How much the albedo changes from one pixel to the next at an edge of a photograph whose values are `unit` times the
 * usual ones and counted accordingly. */
static float albedo_step_at_an_edge(float unit)
{
    enum { LOW = 16, FULL = 64, EDGE = 29 }; /* between two low pixels' centres */
    surface s = plate(LOW), full;
    img guide, mask;
    assert_int_equal(img_new(&guide, FULL, FULL, 3), OK);
    assert_int_equal(img_new(&mask, FULL, FULL, 1), OK);
    box(&mask, 0, 0, FULL, FULL);
    for (int i = 0; i < FULL * FULL * 3; i++)
        guide.data[i] = unit * (i / 3 % FULL < EDGE ? 0.1f : 0.6f);
    for (int i = 0; i < LOW * LOW; i++) {
        float low = (float)(i % LOW) * 4, share = fminf(fmaxf((EDGE - low) / 4, 0), 1);
        for (int c = 0; c < 3; c++)
            s.albedo.data[3 * i + c] = share * 0.2f + (1 - share) * 0.8f;
    }
    surface_encode_guide(&guide, EXPOSURE_WHITE / unit);
    assert_int_equal(surface_refine(&s, &guide, &mask, &full), OK);
    float step = img_at(&full.albedo, EDGE, 32)[0] - img_at(&full.albedo, EDGE - 1, 32)[0];
    img_free(&guide);
    img_free(&mask);
    surface_free(&s);
    surface_free(&full);
    return step;
}

static void refined_albedo_follows_the_photographs_edge(void **state)
{
    (void)state;
    /* bilinear enlargement would change by 0.15 a pixel here */
    assert_true(albedo_step_at_an_edge(1) > 0.4f);
}

static void refined_albedo_follows_the_edge_of_a_photograph_in_any_unit(void **state)
{
    (void)state;
    /* bright ones are brought to the usual exposure: the same but for roundings */
    assert_float_equal(albedo_step_at_an_edge(32), albedo_step_at_an_edge(1), 1e-4);
    assert_float_equal(albedo_step_at_an_edge(1000), albedo_step_at_an_edge(1), 1e-4);
    /* dark ones are not, for their noise is that of other photographs; what it allows to be followed is */
    assert_true(albedo_step_at_an_edge(0.1f) > 0.4f);
}

static void usual_exposures_are_left_alone_and_others_brought_near(void **state)
{
    (void)state;
    img photo, mask;
    assert_int_equal(img_new(&photo, 20, 20, 3), OK);
    assert_int_equal(img_new(&mask, 20, 20, 1), OK);
    box(&mask, 0, 0, 20, 20);
    assert_true(exposure_gain(&photo, &mask) == EXPOSURE_WHITE); /* black */
    for (int i = 0; i < 1200; i++)
        photo.data[i] = 0.5f;
    assert_true(exposure_gain(&photo, &mask) == EXPOSURE_WHITE);
    /* the percentile is known to a bin of 1/32 stop */
    for (int i = 0; i < 1200; i++)
        photo.data[i] = 0.01f;
    assert_float_equal(0.01f * exposure_gain(&photo, &mask), 0.34, 0.34 * 0.023);
    for (int i = 0; i < 1200; i++)
        photo.data[i] = 8;
    assert_float_equal(8 * exposure_gain(&photo, &mask), 2.2, 2.2 * 0.023);
    /* floats are in any unit */
    for (int i = 0; i < 1200; i++)
        photo.data[i] = 1e-5f;
    assert_float_equal(1e-5f * exposure_gain(&photo, &mask), 0.34, 0.34 * 0.023);
    for (int i = 0; i < 1200; i++)
        photo.data[i] = 5e-7f;
    assert_float_equal(5e-7f * exposure_gain(&photo, &mask), 0.34, 0.34 * 0.023);
    for (int i = 0; i < 1200; i++)
        photo.data[i] = 5e4f;
    assert_float_equal(5e4f * exposure_gain(&photo, &mask), 2.2, 2.2 * 0.023);
    assert_float_equal(exposure_from_ev(2), 4 * EXPOSURE_WHITE, 1e-5);
    img_free(&photo);
    img_free(&mask);
}

/* Pixels that the object half covers lie outside of what the network saw, and take the shape from beside them. */
static void half_covered_pixels_continue_the_shape(void **state)
{
    (void)state;
    enum { LOW = 32 };
    const int sizes[] = {LOW / 2, LOW, 2 * LOW};
    surface low;
    assert_int_equal(surface_new(LOW, LOW, &low), OK);
    box(&low.mask, 8, 8, 16, 16);
    for (int i = 0; i < LOW * LOW; i++) {
        if (!(low.mask.data[i] > 0)) continue;
        const float values[] = {0.4f, 0.6f, 0, 0.8f, 0.3f, 1.25f};
        low.albedo.data[3 * i] = values[0];
        memcpy(low.normal.data + 3 * i, values + 1, 3 * sizeof(float));
        low.roughness.data[i] = values[4];
        low.depth.data[i] = values[5];
    }
    for (int k = 0; k < 3; k++) {
        int size = sizes[k], edge = size / 4 - 1;
        img mask, guide;
        surface full;
        assert_int_equal(img_new(&mask, size, size, 1), OK);
        assert_int_equal(img_new(&guide, size, size, 3), OK);
        box(&mask, edge, edge, size / 2 + 2, size / 2 + 2);
        for (int i = 0; i < size; i++)
            *img_at(&mask, edge, i) *= 0.3f;
        assert_int_equal(surface_refine(&low, &guide, &mask, &full), OK);
        assert_float_equal(img_at(&full.normal, edge, size / 2)[0], 0.6f, 0.01);
        assert_float_equal(*img_at(&full.depth, edge, size / 2), 1.25f, 0.01);
        assert_float_equal(*img_at(&full.roughness, edge, size / 2), 0.3f, 0.01);
        surface_free(&full);
        img_free(&mask);
        img_free(&guide);
    }
    surface_free(&low);
}

static void what_is_burnt_out_is_the_share_of_covered_values_at_white(void **state)
{
    (void)state;
    img photo, mask;
    assert_int_equal(img_new(&photo, 20, 20, 3), OK);
    assert_int_equal(img_new(&mask, 20, 20, 1), OK);
    assert_true(exposure_burnt_out(&photo, &mask) == 0); /* no object */
    box(&mask, 0, 0, 10, 20);
    for (int i = 0; i < 1200; i++)
        photo.data[i] = i % 3 == 0 ? 1 : 0.97f; /* red alone, of which a quarter is not: */
    for (int y = 0; y < 5; y++)
        for (int x = 0; x < 20; x++)
            img_at(&photo, x, y)[0] = 0.5f;
    assert_float_equal(exposure_burnt_out(&photo, &mask), 0.25, 1e-6);
    for (int i = 0; i < 400; i++)
        mask.data[i] *= 0.9f; /* multiplied by it, white would not be white any more */
    assert_true(exposure_burnt_out(&photo, &mask) == 0);
    box(&mask, 0, 0, 10, 20);
    for (int i = 0; i < 1200; i++)
        photo.data[i] *= 1.2f; /* floats that go on above 1 */
    assert_true(exposure_burnt_out(&photo, &mask) == 0);
    img_free(&photo);
    img_free(&mask);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_object_fills_four_fifths_of_the_crop),
        cmocka_unit_test(square_photographs_framed_like_the_training_data_are_taken_whole),
        cmocka_unit_test(a_crop_put_back_lands_where_it_came_from),
        cmocka_unit_test(a_crop_takes_and_puts_back_what_is_covered_alone),
        cmocka_unit_test(memory_is_taken_for_the_object_alone),
        cmocka_unit_test(filling_keeps_the_inside_and_continues_it),
        cmocka_unit_test(filling_without_any_inside_gives_zeros),
        cmocka_unit_test(smoothing_removes_a_pattern_of_two_pixels_and_keeps_a_slope),
        cmocka_unit_test(half_covered_pixels_continue_the_shape),
        cmocka_unit_test(tidy_surfaces_keep_their_promises_whatever_came_in),
        cmocka_unit_test(the_centre_of_a_plate_under_the_flash_has_the_formulas_radiance),
        cmocka_unit_test(a_distant_lamp_is_as_bright_everywhere_as_a_near_one_at_distance_1),
        cmocka_unit_test(a_matte_surface_has_no_gloss),
        cmocka_unit_test(a_light_on_the_left_brightens_the_left),
        cmocka_unit_test(a_surface_survives_resizing),
        cmocka_unit_test(refined_albedo_follows_the_photographs_edge),
        cmocka_unit_test(refined_albedo_follows_the_edge_of_a_photograph_in_any_unit),
        cmocka_unit_test(usual_exposures_are_left_alone_and_others_brought_near),
        cmocka_unit_test(what_is_burnt_out_is_the_share_of_covered_values_at_white),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
