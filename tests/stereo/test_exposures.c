/* SPDX-License-Identifier: MIT */
/* Pictures of one object whose camera exposed each as it liked. */
#include "capture_fixture.h"
#include "png_exif.h"

/* Writes a picture of one value whose EXIF states an exposure. */
static void write_exposed(const char *name, float value, uint32_t hundredths)
{
    write_flat(name, 6, 4, 3, value, IMG_LINEAR16);
    png_add_exif(scratch_path(name), hundredths, 0);
}

static void three_exposed(uint32_t a, uint32_t b, uint32_t c)
{
    three_pictures(IMG_LINEAR16);
    write_exposed("a.png", 0.2f, a);
    write_exposed("b.png", 0.5f, b);
    write_exposed("c.png", 0.7f, c);
}

static void exposures_that_differ_count_as_the_lights_strengths(void **state)
{
    (void)state;
    merlin_capture c;
    three_exposed(1, 2, 3);
    assert_int_equal(pst_capture_read(scratch, &PLAIN, &c), OK);
    for (int i = 0; i < 3; i++)
        assert_float_equal(c.light[i].intensity[1], 0.5 * (i + 1), 1e-5);
    assert_in_range(pst_code(&c.picture[1], 0), 32767, 32769); /* the pictures stay: what is burnt out is still known */
    assert_non_null(warnings_find(&c.noticed, "exposures_differ"));
    pst_capture_free(&c);
    const merlin_capture_files unknown = {.unknown_lights = 1};
    assert_int_equal(pst_capture_read(scratch, &unknown, &c), OK);
    assert_true(c.intensities_known);
    assert_float_equal(c.light[2].intensity[0], 1.5, 1e-5);
    pst_capture_free(&c);
}

static void equal_or_unknown_exposures_change_nothing(void **state)
{
    (void)state;
    merlin_capture c;
    three_exposed(2, 2, 2);
    assert_int_equal(pst_capture_read(scratch, &PLAIN, &c), OK);
    assert_float_equal(c.light[2].intensity[0], 1, 0);
    assert_null(warnings_find(&c.noticed, "exposures_differ"));
    pst_capture_free(&c);
    write_flat("b.png", 6, 4, 3, 0.5f, IMG_LINEAR16);
    assert_int_equal(pst_capture_read(scratch, &PLAIN, &c), OK);
    assert_null(warnings_find(&c.noticed, "exposures_unknown"));
    pst_capture_free(&c);
    three_exposed(1, 2, 3);
    write_flat("b.png", 6, 4, 3, 0.5f, IMG_LINEAR16);
    assert_int_equal(pst_capture_read(scratch, &PLAIN, &c), OK);
    assert_float_equal(c.light[2].intensity[0], 1, 0);
    const warning *unknown = warnings_find(&c.noticed, "exposures_unknown");
    assert_non_null(unknown);
    assert_non_null(strstr(unknown->message, "up to 3 times as much as others, but b.png has no exposure"));
    pst_capture_free(&c);
    three_exposed(1, 2, 3);
    write_flat("ambient.png", 6, 4, 3, 0.1f, IMG_LINEAR16);
    assert_int_equal(pst_capture_read(scratch, &PLAIN, &c), OK);
    unknown = warnings_find(&c.noticed, "exposures_unknown");
    assert_non_null(unknown);
    assert_non_null(strstr(unknown->message, "ambient.png has no exposure"));
    pst_capture_free(&c);
    three_exposed(1, 2, 20000); /* no camera's */
    write_exposed("ambient.png", 0.1f, 1);
    assert_int_equal(pst_capture_read(scratch, &PLAIN, &c), OK);
    assert_float_equal(c.light[2].intensity[0], 1, 0);
    assert_float_equal(pst_code(&c.picture[2], 5) / 65535.0, 0.7 - 0.1, 3e-5);
    pst_capture_free(&c);
}

static void listed_strengths_are_of_pictures_as_they_are(void **state)
{
    (void)state;
    merlin_capture c;
    three_exposed(1, 2, 3);
    write_text("light_intensities.txt", "1\n1\n2\n");
    assert_int_equal(pst_capture_read(scratch, &PLAIN, &c), OK);
    assert_float_equal(c.light[1].intensity[0], 1, 0);
    assert_float_equal(c.light[2].intensity[0], 2, 0);
    assert_null(warnings_find(&c.noticed, "exposures_differ"));
    pst_capture_free(&c);
}

static void ambient_light_is_exposed_as_its_picture(void **state)
{
    (void)state;
    merlin_capture c;
    three_exposed(2, 4, 8);
    write_exposed("ambient.png", 0.1f, 4);
    assert_int_equal(pst_capture_read(scratch, &PLAIN, &c), OK);
    assert_float_equal(pst_code(&c.picture[0], 5) / 65535.0, 0.2 - 0.05, 3e-5);
    assert_float_equal(pst_code(&c.picture[1], 5) / 65535.0, 0.5 - 0.1, 3e-5);
    assert_float_equal(pst_code(&c.picture[2], 5) / 65535.0, 0.7 - 0.2, 3e-5);
    pst_capture_free(&c);
    write_flat("ambient.png", 6, 4, 3, 0.1f, IMG_LINEAR16); /* of an unknown one */
    assert_int_equal(pst_capture_read(scratch, &PLAIN, &c), OK);
    assert_float_equal(pst_code(&c.picture[2], 5) / 65535.0, 0.7 - 0.1, 3e-5);
    pst_capture_free(&c);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        in_scratch(exposures_that_differ_count_as_the_lights_strengths),
        in_scratch(equal_or_unknown_exposures_change_nothing),
        in_scratch(listed_strengths_are_of_pictures_as_they_are),
        in_scratch(ambient_light_is_exposed_as_its_picture),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
