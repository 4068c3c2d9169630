/* SPDX-License-Identifier: MIT */
#include "capture_fixture.h"

static void sixteen_bit_pictures_are_taken_as_they_are(void **state)
{
    (void)state;
    three_pictures(IMG_LINEAR16);
    merlin_capture c;
    assert_int_equal(pst_capture_read(scratch, &PLAIN, &c), OK);
    assert_int_equal(c.count, 3);
    assert_int_equal(c.width, 6);
    assert_int_equal(c.height, 4);
    assert_int_equal(c.channels, 3);
    assert_int_equal(c.lighting, MERLIN_DISTANT_LIGHTS);
    assert_string_equal(c.name[1], "b.png");
    /* a code's rounding there and back */
    assert_in_range(pst_code(&c.picture[1], 0), 32767, 32769);
    assert_in_range(pst_code(&c.picture[2], 71), 49150, 49152);
    assert_float_equal(c.light[0].direction[2], 1, 1e-6);
    assert_float_equal(c.light[1].direction[0], 0.6, 1e-6);
    assert_float_equal(c.light[2].direction[1], -1, 1e-6);
    assert_float_equal(c.light[2].intensity[1], 1, 0);
    assert_float_equal(*img_at(&c.mask, 3, 3), 1, 0);
    pst_capture_free(&c);
}

static void eight_bit_pictures_are_decoded_unless_they_are_linear(void **state)
{
    (void)state;
    three_pictures(IMG_SRGB8);
    merlin_capture c;
    assert_int_equal(pst_capture_read(scratch, &PLAIN, &c), OK);
    /* half a step of 8-bit sRGB at 0.5 is 0.0035 */
    assert_float_equal(pst_code(&c.picture[1], 0) / 65535.0, 0.5, 0.0036);
    pst_capture_free(&c);
    merlin_capture_files linear = {.linear = true};
    assert_int_equal(pst_capture_read(scratch, &linear, &c), OK);
    assert_float_equal(pst_code(&c.picture[1], 0) / 65535.0, srgb_encode(0.5f), 0.002);
    pst_capture_free(&c);
}

static void ambient_light_is_subtracted_and_clipping_stays(void **state)
{
    (void)state;
    three_pictures(IMG_LINEAR16);
    write_flat("c.png", 6, 4, 3, 1, IMG_LINEAR16);
    write_flat("ambient.png", 6, 4, 3, 0.3f, IMG_LINEAR16);
    merlin_capture c;
    assert_int_equal(pst_capture_read(scratch, &PLAIN, &c), OK);
    assert_int_equal(c.count, 3);
    assert_int_equal(pst_code(&c.picture[0], 5), 0);
    assert_float_equal(pst_code(&c.picture[1], 5) / 65535.0, 0.2, 2e-5);
    assert_int_equal(pst_code(&c.picture[2], 5), 65535);
    pst_capture_free(&c);
    write_flat("ambient.png", 5, 4, 3, 0.3f, IMG_LINEAR16);
    assert_refused(&PLAIN, "ambient.png is 5 x 4");
    /* a file's kind is told by its first bytes */
    assert_int_equal(rename(scratch_path("ambient.png"), scratch_path("ambient.TIF")), 0);
    assert_refused(&PLAIN, "ambient.TIF is 5 x 4");
    write_flat("ambient.png", 6, 4, 3, 0.3f, IMG_LINEAR16);
    assert_int_equal(pst_capture_read(scratch, &PLAIN, &c), OK);
    assert_float_equal(pst_code(&c.picture[1], 5) / 65535.0, 0.2, 2e-5);
    pst_capture_free(&c);
}

static void an_ambient_picture_is_darker_than_what_lamps_add_to(void **state)
{
    (void)state;
    three_pictures(IMG_LINEAR16);
    merlin_capture c;
    write_flat("ambient.png", 6, 4, 3, 0.01f, IMG_LINEAR16);
    assert_int_equal(pst_capture_read(scratch, &PLAIN, &c), OK);
    assert_null(warnings_find(&c.noticed, "ambient_brighter"));
    pst_capture_free(&c);
    write_flat("ambient.png", 6, 4, 3, 0.6f, IMG_LINEAR16); /* that of a lamp */
    assert_int_equal(pst_capture_read(scratch, &PLAIN, &c), OK);
    assert_non_null(warnings_find(&c.noticed, "ambient_brighter"));
    pst_capture_free(&c);
    write_flat("ambient.png", 6, 4, 3, 0.5f, IMG_LINEAR16);
    assert_int_equal(pst_capture_read(scratch, &PLAIN, &c), OK);
    const warning *copied = warnings_find(&c.noticed, "ambient_copied");
    assert_non_null(copied);
    assert_non_null(strstr(copied->message, "ambient.png is the same as b.png"));
    pst_capture_free(&c);
    write_flat("ambient.png", 6, 4, 3, 1, IMG_LINEAR16);
    assert_refused(&PLAIN, "ambient.png is brighter than all pictures");
}

/* Programs save what is black, or has no colours, in grey: as an ambient picture, the first one or any other. */
static void grey_pictures_among_colour_ones_have_equal_channels(void **state)
{
    (void)state;
    merlin_capture c;
    write_text("lights.txt", "0 0 1\n0.5 0 0.8\n0 0.5 0.8\n");
    for (int grey = 0; grey < 3; grey++) {
        const char *const names[] = {"a.png", "b.png", "c.png"};
        for (int i = 0; i < 3; i++)
            write_flat(names[i], 6, 4, i == grey ? 1 : 3, 0.2f + 0.1f * (float)i, IMG_LINEAR16);
        write_flat("ambient.png", 6, 4, grey == 1 ? 3 : 1, 0.05f, IMG_LINEAR16);
        assert_int_equal(pst_capture_read(scratch, &PLAIN, &c), OK);
        assert_int_equal(c.channels, 3);
        for (int i = 0; i < 3; i++)
            for (int k = 0; k < 6 * 4 * 3; k++)
                assert_true(abs(pst_code(&c.picture[i], k) - (int)(65535 * (0.15f + 0.1f * (float)i))) <= 2);
        assert_non_null(warnings_find(&c.noticed, "grey_among_colour"));
        pst_capture_free(&c);
        write_flat(names[grey], 6, 4, 1, 0, IMG_LINEAR16);
        unlink(scratch_path("ambient.png"));
        assert_int_equal(pst_capture_read(scratch, &PLAIN, &c), OK);
        assert_null(warnings_find(&c.noticed, "grey_among_colour")); /* black is of no colour */
        pst_capture_free(&c);
    }
}

/* Its luminance is subtracted, and the capture stays grey. */
static void a_coloured_ambient_picture_is_grey_among_grey_ones(void **state)
{
    (void)state;
    merlin_capture c;
    const char *const names[] = {"a.png", "b.png", "c.png"};
    img ambient;
    write_text("lights.txt", "0 0 1\n0.5 0 0.8\n0 0.5 0.8\n");
    for (int i = 0; i < 3; i++)
        write_flat(names[i], 6, 4, 1, 0.2f + 0.1f * (float)i, IMG_LINEAR16);
    assert_int_equal(img_new(&ambient, 6, 4, 3), OK);
    for (size_t k = 0; k < img_value_count(&ambient); k++)
        ambient.data[k] = k % 3 == 1 ? 0.1f : 0;
    assert_int_equal(img_write_png(scratch_path("ambient.png"), &ambient, IMG_LINEAR16), OK);
    img_free(&ambient);
    assert_int_equal(pst_capture_read(scratch, &PLAIN, &c), OK);
    assert_int_equal(c.channels, 1);
    for (int i = 0; i < 3; i++)
        assert_float_equal(pst_code(&c.picture[i], 5) / 65535.0, 0.2 + 0.1 * i - 0.07152, 5e-5);
    assert_non_null(strstr(warnings_find(&c.noticed, "grey_among_colour")->message, "its luminance is subtracted"));
    pst_capture_free(&c);
    write_flat("c.png", 6, 4, 3, 0.4f, IMG_LINEAR16);
    assert_int_equal(pst_capture_read(scratch, &PLAIN, &c), OK);
    assert_int_equal(c.channels, 3);
    assert_float_equal(pst_code(&c.picture[0], 15) / 65535.0, 0.2, 5e-5);
    assert_float_equal(pst_code(&c.picture[0], 16) / 65535.0, 0.1, 5e-5);
    assert_non_null(strstr(warnings_find(&c.noticed, "grey_among_colour")->message, "2 are grey"));
    pst_capture_free(&c);
}

static void three_float_pictures(const float value[3])
{
    for (int i = 0; i < 3; i++) {
        img p;
        char name[] = "0.exr";
        name[0] = (char)('0' + i);
        assert_int_equal(img_new(&p, 5, 5, 3), OK);
        for (int k = 0; k < 75; k++)
            p.data[k] = value[i];
        const exr_channel rgb[] = {{"R", p.data, 3, false}, {"G", p.data + 1, 3, false}, {"B", p.data + 2, 3, false}};
        assert_int_equal(exr_write(scratch_path(name), 5, 5, rgb, 3, NULL, 0), OK);
        img_free(&p);
    }
    write_text("lights.txt", "0 0 1\n0 1 1\n1 0 1\n");
}

/* Of 0.5, 8 and 2, brighter or dimmer. */
static void floats_share_one_scale_below_saturation(void **state)
{
    (void)state;
    for (float gain = 0.0001f; gain < 2; gain *= 100) {
        three_float_pictures((const float[]){0.5f * gain, 8 * gain, 2 * gain});
        merlin_capture c;
        assert_int_equal(pst_capture_read(scratch, &PLAIN, &c), OK);
        assert_true(pst_code(&c.picture[1], 0) < 0.98 * 65535);
        /* rounding to codes of at most half a unit in 300, and to half floats */
        assert_float_equal((double)pst_code(&c.picture[1], 0) / pst_code(&c.picture[0], 0), 16, 0.04);
        assert_float_equal((double)pst_code(&c.picture[2], 0) / pst_code(&c.picture[0], 0), 4, 0.01);
        assert_float_equal(*img_at(&c.mask, 2, 2), 1, 0);
        pst_capture_free(&c);
    }
}

/* Whole numbers beside floats say nothing of their unit. */
static void floats_and_whole_numbers_are_not_mixed(void **state)
{
    (void)state;
    three_float_pictures((const float[]){0.02f, 0.05f, 0.03f});
    write_flat("ambient.png", 5, 5, 3, 0.01f, IMG_LINEAR16);
    assert_refused(&PLAIN, "ambient.png has whole numbers, but the pictures have floats");
    unlink(scratch_path("ambient.png"));
    unlink(scratch_path("1.exr"));
    write_flat("1.png", 5, 5, 3, 0.05f, IMG_LINEAR16);
    assert_refused(&PLAIN, "1.png has whole numbers, but 0.exr has floats");
}

static void an_lp_file_says_which_picture_has_which_light(void **state)
{
    (void)state;
    three_pictures(IMG_LINEAR16);
    unlink(scratch_path("lights.txt"));
    write_text("dome.lp", "2\nphotos/c.png 0 0 1\nD:\\my set\\A.PNG 0 3 4\n");
    merlin_capture c;
    assert_int_equal(pst_capture_read(scratch, &PLAIN, &c), OK);
    assert_int_equal(c.count, 2);
    assert_string_equal(c.name[0], "c.png");
    assert_string_equal(c.name[1], "a.png");
    assert_float_equal(c.light[1].direction[1], 0.6, 1e-6);
    pst_capture_free(&c);
    write_text("dome.lp", "2\nc.png 0 0 1\nd.png 0 3 4\n");
    assert_refused(&PLAIN, "names d.png");
    write_flat("D.png", 3, 2, 1, 1, IMG_LINEAR8);
    write_flat("d.PNG", 3, 2, 1, 1, IMG_LINEAR8);
    assert_refused(&PLAIN, "names d.png"); /* which of the two? */
    write_text("other.lp", "1\nc.png 0 0 1\n");
    assert_refused(&PLAIN, "2 .lp files");
}

static void a_dome_s_lights_go_to_other_pictures_in_their_order(void **state)
{
    (void)state;
    three_pictures(IMG_LINEAR16);
    unlink(scratch_path("lights.txt"));
    write_text("dome.lp", "3\nball 9.jpg 0 0 1\nball 10.jpg 0 3 4\nD:\\dome\\ball 11.jpg 1 0 0\n");
    merlin_capture c;
    assert_int_equal(pst_capture_read(scratch, &PLAIN, &c), OK);
    assert_int_equal(c.count, 3);
    assert_true(c.lights_in_order);
    assert_string_equal(c.name[1], "b.png");
    assert_float_equal(c.light[1].direction[1], 0.6, 1e-6);
    pst_capture_free(&c);
    write_text("dome.lp", "2\nball 1.jpg 0 0 1\nball 2.jpg 0 3 4\n");
    assert_refused(&PLAIN, "3 pictures");
    write_text("dome.lp", "3\nball 1.jpg 0 0 1\nball 10.jpg 0 3 4\nball 2.jpg 1 0 0\n");
    assert_refused(&PLAIN, "names ball 1.jpg"); /* in which order were they taken? */
    write_text("dome.lp", "3\na.png 0 0 1\nball 10.jpg 0 3 4\nball 11.jpg 1 0 0\n");
    assert_refused(&PLAIN, "names ball 10.jpg");
}

static void near_lights_have_positions_and_a_camera(void **state)
{
    (void)state;
    three_pictures(IMG_LINEAR16);
    merlin_capture_files options = {.near_lights = 1};
    merlin_capture c;
    assert_int_equal(pst_capture_read(scratch, &options, &c), OK);
    assert_int_equal(c.lighting, MERLIN_NEAR_LIGHTS);
    assert_float_equal(c.light[1].position[2], 4, 0);
    assert_float_equal(c.light[1].direction[2], 0, 0);
    assert_true(pinhole_is_near(&c.camera));
    /* 60 degrees across six pixels: 3 / tan 30° */
    assert_float_equal(c.camera.focal, 5.19615, 1e-4);
    assert_float_equal(c.camera.y, 2, 0);
    pst_capture_free(&c);
    write_text("lights.txt", "0 0 1\n0 0.6 0.8\n1 0 0\n");
    assert_refused(&options, "lists directions");
}

/* A lens whose focal length is the diagonal's length. */
static void before_near_lights_the_lens_of_exif_is_taken(void **state)
{
    (void)state;
    merlin_capture near = {.width = 6, .height = 4, .lighting = MERLIN_NEAR_LIGHTS, .focal_35mm = 43.2666f};
    merlin_capture distant = near;
    pst_capture_see(&near, 0, 2);
    assert_float_equal(near.camera.focal, sqrt(52), 1e-4);
    assert_float_equal(near.camera.x, 3, 0);
    assert_float_equal(near.camera.distance, 2, 0);
    pst_capture_see(&near, 90, 0); /* that of the caller goes before it */
    assert_float_equal(near.camera.focal, 3, 1e-5);
    assert_float_equal(near.camera.distance, 2, 0);
    distant.lighting = MERLIN_DISTANT_LIGHTS;
    pst_capture_see(&distant, 0, 0); /* depth stays in pixels */
    assert_false(pinhole_is_near(&distant.camera));
}

static void lists_that_differ_are_told(void **state)
{
    (void)state;
    merlin_capture c;
    three_pictures(IMG_LINEAR16);
    write_text("lights.txt", "0 0 1\n0.6 0 0.8\n0 -0.6 0.8\n");
    write_text("dome.lp", "3\na.png 0 0 1\nb.png 0.6 0 0.8\nc.png 0 -0.6 0.8\n");
    write_text("lights.csv", "c.png,0,-0.6,0.8\nb.png,0.6,0,0.8\na.png,0,0,1\n"); /* without names in the first one */
    assert_int_equal(pst_capture_read(scratch, &PLAIN, &c), OK);
    const warning *differ = warnings_find(&c.noticed, "lists_differ");
    assert_non_null(differ);
    assert_non_null(strstr(differ->message, "lights.csv lists other ones"));
    pst_capture_free(&c);
    unlink(scratch_path("lights.csv"));
    assert_int_equal(pst_capture_read(scratch, &PLAIN, &c), OK);
    assert_null(warnings_find(&c.noticed, "lists_differ"));
    pst_capture_free(&c);
    write_text("lights.txt", "c.png 0 -0.6 0.8\na.png 0 0 1\nb.png 0.6 0 0.8\n");
    assert_int_equal(pst_capture_read(scratch, &PLAIN, &c), OK);
    assert_null(warnings_find(&c.noticed, "lists_differ"));
    pst_capture_free(&c);
}

static void places_in_front_of_the_camera_want_near(void **state)
{
    (void)state;
    three_pictures(IMG_LINEAR16);
    write_text("lights.txt", "-2 0 -0.1\n2 0 -0.2\n0 2 -0.1\n");
    assert_refused(&PLAIN, "if they are places, measured from the camera, give --near");
}

static void near_lights_of_an_lp_file_are_where_it_says(void **state)
{
    (void)state;
    three_pictures(IMG_LINEAR16);
    unlink(scratch_path("lights.txt"));
    merlin_capture_files options = {.near_lights = 1};
    merlin_capture c;
    write_text("dome.lp", "3\na.png 3 0 -4\nb.png -30 12 -40\nc.png 0 0.5 0\n");
    assert_int_equal(pst_capture_read(scratch, &options, &c), OK);
    assert_float_equal(c.light[0].position[2], -4, 1e-6);
    assert_float_equal(c.light[1].position[0], -30, 1e-5);
    assert_float_equal(c.light[1].position[2], -40, 1e-5);
    assert_float_equal(c.light[2].position[1], 0.5, 1e-6);
    pst_capture_free(&c);
    /* a dome's, rounded as some write them, go round the object (pst_place_lights) */
    write_text("dome.lp", "3\na.png 0 0 1\nb.png 0.29 0 0.96\nc.png 1 0 0\n");
    assert_int_equal(pst_capture_read(scratch, &options, &c), OK);
    assert_true(c.about_object);
    assert_float_equal(c.light[0].position[2], 1, 1e-6);
    assert_float_equal(c.light[2].position[0], 1, 1e-6);
    pst_capture_free(&c);
}

static void near_lights_of_an_lp_file_before_the_object_are_about_it(void **state)
{
    (void)state;
    three_pictures(IMG_LINEAR16);
    unlink(scratch_path("lights.txt"));
    merlin_capture_files options = {.near_lights = 1};
    merlin_capture c;
    write_text("dome.lp", "3\na.png 300 0 400\nb.png -300 120 250\nc.png 0 50 300\n");
    options.distance = 600;
    assert_int_equal(pst_capture_read(scratch, &options, &c), OK);
    assert_true(c.about_object);
    assert_float_equal(c.camera.distance, 600, 1e-3);
    assert_float_equal(c.light[0].position[0], 300, 1e-3);
    assert_float_equal(c.light[0].position[2], 400, 1e-3);
    assert_float_equal(c.light[1].position[2], 250, 1e-3);
    pst_capture_free(&c);
    write_text("dome.lp", "3\na.png 300 0 400\nb.png -300 120 -250\nc.png 0 50 300\n");
    assert_refused(&options, "before and behind");
    /* as distant lights they are directions whatever their frame */
    options = (merlin_capture_files){0};
    write_text("dome.lp", "3\na.png 300 0 400\nb.png -300 120 250\nc.png 0 50 300\n");
    assert_int_equal(pst_capture_read(scratch, &options, &c), OK);
    assert_float_equal(c.light[0].direction[0], 0.6, 1e-6);
    assert_float_equal(c.light[0].direction[2], 0.8, 1e-6);
    assert_true(c.about_object);
    pst_capture_free(&c);
}

static void a_field_of_view_makes_a_camera_without_lights(void **state)
{
    (void)state;
    three_pictures(IMG_LINEAR16);
    merlin_capture c;
    merlin_capture_files options = {.unknown_lights = true};
    assert_int_equal(pst_capture_read(scratch, &options, &c), OK);
    assert_false(pinhole_is_near(&c.camera));
    pst_capture_free(&c);
    options.field_of_view = 90;
    assert_int_equal(pst_capture_read(scratch, &options, &c), OK);
    assert_int_equal(c.lighting, MERLIN_UNKNOWN_LIGHTS);
    assert_true(pinhole_is_near(&c.camera));
    assert_float_equal(c.camera.focal, 3, 1e-5); /* half of 6 pixels */
    assert_float_equal(c.camera.distance, 0, 0);
    pst_capture_free(&c);
}

static void a_distance_is_of_a_camera_that_is_known(void **state)
{
    (void)state;
    three_pictures(IMG_LINEAR16);
    merlin_capture c;
    merlin_capture_files options = {.distance = 450};
    assert_int_equal(pst_capture_read(scratch, &options, &c), MERLIN_WRONG_USE);
    assert_non_null(strstr(status_message(), "field of view is given"));
    options.field_of_view = 90;
    assert_int_equal(pst_capture_read(scratch, &options, &c), OK);
    assert_float_equal(c.camera.distance, 450, 0);
    pst_capture_free(&c);
}

static void unknown_lights_need_no_list(void **state)
{
    (void)state;
    three_pictures(IMG_LINEAR16);
    unlink(scratch_path("lights.txt"));
    assert_refused(&PLAIN, "says nothing of its lights");
    merlin_capture_files options = {.unknown_lights = true};
    merlin_capture c;
    assert_int_equal(pst_capture_read(scratch, &options, &c), OK);
    assert_int_equal(c.count, 3);
    assert_int_equal(c.lighting, MERLIN_UNKNOWN_LIGHTS);
    assert_false(c.intensities_known);
    pst_capture_free(&c);
}

static void given_intensities_are_kept(void **state)
{
    (void)state;
    three_pictures(IMG_LINEAR16);
    write_text("light_intensities.txt", "1 2 3\n4\n5 5 5\n");
    merlin_capture c;
    assert_int_equal(pst_capture_read(scratch, &PLAIN, &c), OK);
    assert_true(c.intensities_known);
    assert_float_equal(c.light[0].intensity[2], 3, 0);
    assert_float_equal(c.light[1].intensity[0], 4, 0);
    pst_capture_free(&c);
    assert_int_equal(pst_capture_read(scratch, &(merlin_capture_files){.unknown_lights = true}, &c), OK);
    assert_true(c.intensities_known);
    assert_float_equal(c.light[0].intensity[2], 3, 0);
    assert_float_equal(vec3_length(vec3_of(c.light[0].direction)), 0, 0);
    pst_capture_free(&c);
    write_text("light_intensities.txt", "# in volts\n\n7\n7\n9\n");
    assert_int_equal(pst_capture_read(scratch, &PLAIN, &c), OK);
    assert_float_equal(c.light[2].intensity[0], 9, 0);
    pst_capture_free(&c);
    write_text("light_intensities.txt", "\xef\xbb\xbf" /* as Windows puts before a text */ "2\r\n3\r\n4\r\n");
    assert_int_equal(pst_capture_read(scratch, &PLAIN, &c), OK);
    assert_float_equal(c.light[0].intensity[0], 2, 0);
    pst_capture_free(&c);
    assert_int_equal(rename(scratch_path("light_intensities.txt"), scratch_path("Light_Intensities.TXT")), 0);
    assert_int_equal(pst_capture_read(scratch, &PLAIN, &c), OK);
    assert_float_equal(c.light[2].intensity[0], 4, 0);
    pst_capture_free(&c);
    assert_int_equal(unlink(scratch_path("Light_Intensities.TXT")), 0);
    write_text("light_intensities.txt", "1\nx\n1\n");
    assert_refused(&PLAIN, "light_intensities.txt:2");
    write_text("light_intensities.txt", "1\n0\n1\n");
    assert_refused(&PLAIN, "light_intensities.txt:2");
    write_text("light_intensities.txt", "a.png 9\nb.png 9\nb.png 9\n");
    assert_refused(&PLAIN, "light_intensities.txt:3: the intensity of this light is in a line before");
    write_text("light_intensities.txt", "1\n1\n");
    assert_refused(&PLAIN, "2 intensities for 3 lights");
}

static void intensities_are_found_by_names_like_theirs_and_beside_the_list(void **state)
{
    (void)state;
    three_pictures(IMG_LINEAR16);
    static const char *const names[] = {"light_intensities.csv", "Light_Intensity.txt", "intensities.tsv"};
    merlin_capture c;
    for (size_t i = 0; i < sizeof names / sizeof *names; i++) {
        write_text(names[i], "1\n2\n5\n");
        assert_int_equal(pst_capture_read(scratch, &PLAIN, &c), OK);
        assert_true(c.intensities_known);
        assert_float_equal(c.light[2].intensity[1], 5, 0);
        pst_capture_free(&c);
        assert_int_equal(unlink(scratch_path(names[i])), 0);
    }
    assert_int_equal(mkdir(scratch_path("lists"), 0777), 0);
    write_text("lists/lights.txt", "0 0 1\n0.3 0 1\n0 0.3 1\n");
    write_text("lists/light_intensities.txt", "1\n2\n6\n");
    char lights[256];
    snprintf(lights, sizeof lights, "%s", scratch_path("lists/lights.txt"));
    const merlin_capture_files elsewhere = {.lights = lights};
    assert_int_equal(pst_capture_read(scratch, &elsewhere, &c), OK);
    assert_float_equal(c.light[2].intensity[1], 6, 0);
    pst_capture_free(&c);
    write_text("intensities.txt", "1\n2\n7\n");
    assert_refused(&elsewhere, "both say how strong");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        in_scratch(sixteen_bit_pictures_are_taken_as_they_are),
        in_scratch(eight_bit_pictures_are_decoded_unless_they_are_linear),
        in_scratch(ambient_light_is_subtracted_and_clipping_stays),
        in_scratch(an_ambient_picture_is_darker_than_what_lamps_add_to),
        in_scratch(grey_pictures_among_colour_ones_have_equal_channels),
        in_scratch(a_coloured_ambient_picture_is_grey_among_grey_ones),
        in_scratch(floats_share_one_scale_below_saturation),
        in_scratch(floats_and_whole_numbers_are_not_mixed),
        in_scratch(an_lp_file_says_which_picture_has_which_light),
        in_scratch(a_dome_s_lights_go_to_other_pictures_in_their_order),
        in_scratch(near_lights_have_positions_and_a_camera),
        cmocka_unit_test(before_near_lights_the_lens_of_exif_is_taken),
        in_scratch(lists_that_differ_are_told),
        in_scratch(places_in_front_of_the_camera_want_near),
        in_scratch(near_lights_of_an_lp_file_are_where_it_says),
        in_scratch(near_lights_of_an_lp_file_before_the_object_are_about_it),
        in_scratch(a_field_of_view_makes_a_camera_without_lights),
        in_scratch(a_distance_is_of_a_camera_that_is_known),
        in_scratch(unknown_lights_need_no_list),
        in_scratch(given_intensities_are_kept),
        in_scratch(intensities_are_found_by_names_like_theirs_and_beside_the_list),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
