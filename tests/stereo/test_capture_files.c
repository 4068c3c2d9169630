/* SPDX-License-Identifier: MIT */
/* Which files of a folder are a capture's, and what is refused of them. */
#include "capture_fixture.h"

static void a_mask_is_read_and_must_fit(void **state)
{
    (void)state;
    three_pictures(IMG_LINEAR16);
    write_flat("owl.mask.png", 6, 4, 1, 1, IMG_LINEAR8);
    merlin_capture c;
    assert_int_equal(pst_capture_read(scratch, &PLAIN, &c), OK);
    assert_int_equal(c.count, 3);
    pst_capture_free(&c);
    write_flat("mask.png", 6, 4, 1, 0, IMG_LINEAR8);
    assert_refused(&PLAIN, "black or transparent everywhere");
    write_flat("mask.png", 4, 6, 1, 1, IMG_LINEAR8);
    assert_refused(&PLAIN, "mask.png is 4 x 6");
    assert_refused(&(merlin_capture_files){.mask = "/nowhere/mask.png"}, "/nowhere/mask.png");
}

/* Whatever their names are, as those of uploaded files are the sender's. */
static void a_named_mask_or_ambient_picture_is_no_photograph(void **state)
{
    (void)state;
    three_pictures(IMG_LINEAR16);
    write_flat("outline.png", 6, 4, 1, 1, IMG_LINEAR8);
    write_flat("room.png", 6, 4, 3, 0.1f, IMG_LINEAR16);
    char *outline = strdup(scratch_path("outline.png")), *room = strdup(scratch_path("room.png"));
    merlin_capture_files files = {.mask = outline, .ambient = room};
    for (files.unknown_lights = 0; files.unknown_lights < 2; files.unknown_lights++) {
        merlin_capture c;
        assert_int_equal(pst_capture_read(scratch, &files, &c), OK);
        assert_int_equal(c.count, 3);
        assert_string_equal(c.name[2], "c.png");
        assert_int_equal(c.skipped.count, 0);
        pst_capture_free(&c);
    }
    assert_refused(&PLAIN, "5 pictures, but");
    free(outline);
    free(room);
}

/* As stereo -o does that names the captures' folder. */
static void results_beside_the_pictures_are_none(void **state)
{
    (void)state;
    three_pictures(IMG_LINEAR16);
    static const char *const results[] = {"normal.png", "albedo.png",         "depth.png",
                                          "error.png",  "overview.png",       "mesh.png",
                                          "maps.exr",   "reconstruction.png", "confidence.png"};
    for (size_t i = 0; i < sizeof results / sizeof *results; i++)
        write_flat(results[i], 6, 4, 3, 0.5f, IMG_SRGB8);
    merlin_capture c;
    assert_int_equal(pst_capture_read(scratch, &PLAIN, &c), OK);
    assert_int_equal(c.count, 3);
    pst_capture_free(&c);
}

/* A file's kind is told by its first bytes alone. */
static void rarer_kinds_are_taken_where_they_are_alone(void **state)
{
    (void)state;
    write_text("lights.txt", "0 0 1\n0 1 1\n1 0 1\n");
    for (int i = 0; i < 3; i++)
        write_text((const char *[]){"1.png", "2", "3.txt"}[i], "P2 2 2 255 90 91 92 93\n");
    merlin_capture c;
    assert_int_equal(pst_capture_read(scratch, &PLAIN, &c), OK);
    assert_int_equal(c.count, 3);
    pst_capture_free(&c);
    three_pictures(IMG_LINEAR16);
    assert_int_equal(pst_capture_read(scratch, &PLAIN, &c), OK);
    assert_int_equal(c.count, 3);
    assert_string_equal(c.name[0], "a.png");
    assert_int_equal(c.skipped.count, 3);
    assert_string_equal(c.skipped.at[1].name, "2");
    assert_string_equal(c.skipped.at[1].why, "of another kind than the pictures that are taken");
    pst_capture_free(&c);
}

/* With the margin that an object needs if a picture moved. */
static void pictures_are_black_far_from_a_given_mask(void **state)
{
    (void)state;
    enum { WIDTH = 160, HEIGHT = 96, MARGIN = WIDTH / 8, X = 70, Y = 40 };
    const char *const names[] = {"a.png", "b.png", "c.png"};
    for (int i = 0; i < 3; i++)
        write_flat(names[i], WIDTH, HEIGHT, 3, 0.5f, IMG_LINEAR16);
    img mask;
    assert_int_equal(img_new(&mask, WIDTH, HEIGHT, 1), OK);
    for (int y = Y; y < Y + 3; y++)
        for (int x = X; x < X + 5; x++)
            *img_at(&mask, x, y) = 1;
    assert_int_equal(img_write_png(scratch_path("mask.png"), &mask, IMG_LINEAR8), OK);
    write_text("lights.txt", "1 0 1\n0 1 1\n-1 0 1\n");
    merlin_capture c;
    if (pst_capture_read(scratch, &PLAIN, &c) != OK) fail_msg("%s", status_message());
    for (int y = 0; y < HEIGHT; y++)
        for (int x = 0; x < WIDTH; x++) {
            const bool near = x >= X - MARGIN && x < X + 5 + MARGIN && y >= Y - MARGIN && y < Y + 3 + MARGIN;
            for (int ch = 0; ch < 3; ch++)
                assert_int_equal(pst_code(&c.picture[2], 3 * (y * WIDTH + x) + ch) > 0, near);
        }
    pst_capture_free(&c);
    img_free(&mask);
}

/* As the masks of many programs are called, which no picture of the capture is. */
static void a_mask_may_have_any_usual_name(void **state)
{
    (void)state;
    three_pictures(IMG_LINEAR16);
    static const char *const names[] = {"mask.tif",      "MASK.PNG",       "Mask.jpeg",     "mask.gif",
                                        "owl.mask.webp", "b_mask.png",     "a-Mask.bmp",    "mask_c.png",
                                        "c_matte.png",   "b.png.mask.png", "silhouette.png"};
    img mask;
    assert_int_equal(img_new(&mask, 6, 4, 1), OK);
    mask.data[7] = mask.data[8] = mask.data[13] = 1;
    for (size_t i = 0; i < sizeof names / sizeof *names; i++) {
        assert_int_equal(img_write_png(scratch_path("mask"), &mask, IMG_LINEAR8), OK);
        assert_int_equal(rename(scratch_path("mask"), scratch_path(names[i])), 0);
        merlin_capture c;
        assert_int_equal(pst_capture_read(scratch, &PLAIN, &c), OK);
        assert_int_equal(c.count, 3);
        assert_float_equal(*img_at(&c.mask, 1, 1), 1, 0);
        assert_float_equal(*img_at(&c.mask, 3, 3), 0, 0);
        assert_int_equal(c.skipped.count, 0);
        pst_capture_free(&c);
        assert_int_equal(unlink(scratch_path(names[i])), 0);
    }
    img_free(&mask);
}

static void what_is_left_aside_is_listed_with_the_reason(void **state)
{
    (void)state;
    three_pictures(IMG_LINEAR16);
    write_flat("mask.png", 6, 4, 1, 1, IMG_LINEAR8);
    write_flat("mask.TIFF", 6, 4, 1, 1, IMG_LINEAR8);
    write_text("d.jxl", "\xff\x0a and more");
    assert_int_equal(file_write(scratch_path("movie.mov"), "\0\0\0\x14", 4), OK);
    write_text("notes.txt", "no picture");
    static const char wide[] = "\xff\xfen\0o\0";
    assert_int_equal(file_write(scratch_path("more.txt"), wide, sizeof wide - 1), OK);
    write_text("Thumbs.db", "no picture");
    write_text(".hidden.png", "no picture");
    write_flat("normal.png", 6, 4, 3, 0.5f, IMG_SRGB8);
    merlin_capture c;
    assert_int_equal(pst_capture_read(scratch, &PLAIN, &c), OK);
    assert_int_equal(c.count, 3);
    char words[512];
    skipped_words(&c.skipped, words, sizeof words);
    assert_string_equal(words,
                        "3 files skipped: d.jxl (JPEG XL is not read), mask.TIFF (a mask, but another is taken), "
                        "movie.mov (no picture)");
    pst_capture_free(&c);
    write_text("dome.lp", "2\na.png 0 0 1\nb.png 0 3 4\n");
    assert_int_equal(unlink(scratch_path("lights.txt")), 0);
    assert_int_equal(pst_capture_read(scratch, &PLAIN, &c), OK);
    assert_int_equal(c.skipped.count, 4);
    assert_string_equal(c.skipped.at[0].name, "c.png");
    assert_string_equal(c.skipped.at[0].why, "not listed");
    pst_capture_free(&c);
    for (int i = 0; i < 3; i++)
        assert_int_equal(unlink(scratch_path((const char *[]){"a.png", "b.png", "c.png"}[i])), 0);
    assert_int_equal(unlink(scratch_path("dome.lp")), 0);
    write_text("lights.txt", "0 0 2\n");
    assert_refused(&PLAIN, "raw files; 2 files skipped: d.jxl (JPEG XL is not read), movie.mov (no picture)");
}

/* A file's kind is told by its first bytes here, too. */
static void raw_pictures_come_before_what_the_camera_made_of_them(void **state)
{
    (void)state;
    write_text("lights.txt", "0 0 1\n0 1 1\n1 0 1\n");
    for (int i = 0; i < 6; i++)
        write_flat((const char *[]){"a.nef", "b.NEF", "c.nef", "a.jpg", "b.jpg", "c.jpg"}[i], 6, 4, 3, 0.5f,
                   IMG_LINEAR16);
    merlin_capture c;
    assert_int_equal(pst_capture_read(scratch, &PLAIN, &c), OK);
    assert_int_equal(c.count, 3);
    assert_string_equal(c.name[1], "b.NEF");
    pst_capture_free(&c);
    write_flat("chart.png", 6, 4, 3, 0.5f, IMG_LINEAR16);
    assert_int_equal(pst_capture_read(scratch, &PLAIN, &c), OK);
    assert_string_equal(c.name[1], "b.NEF");
    pst_capture_free(&c);
    assert_int_equal(unlink(scratch_path("chart.png")), 0);
    three_pictures(IMG_LINEAR16);
    for (int i = 0; i < 3; i++)
        assert_int_equal(unlink(scratch_path((const char *[]){"a.jpg", "b.jpg", "c.jpg"}[i])), 0);
    assert_int_equal(pst_capture_read(scratch, &PLAIN, &c), OK);
    assert_int_equal(c.count, 3);
    assert_string_equal(c.name[0], "a.png");
    pst_capture_free(&c);
}

static void write_mask_of(const int *pixel, int count)
{
    img mask;
    assert_int_equal(img_new(&mask, 6, 4, 1), OK);
    for (int i = 0; i < count; i++)
        mask.data[pixel[i]] = 1;
    assert_int_equal(img_write_png(scratch_path("mask.png"), &mask, IMG_LINEAR8), OK);
    img_free(&mask);
}

static void a_mask_without_three_neighbours_is_refused(void **state)
{
    (void)state;
    three_pictures(IMG_LINEAR16);
    write_mask_of((const int[]){7}, 1);
    assert_refused(&PLAIN, "mask.png shows 1 pixel, too few or too far apart for a surface");
    write_mask_of((const int[]){6, 7, 8, 9, 10, 11}, 6); /* a line */
    assert_refused(&PLAIN, "mask.png shows 6 pixels, too few or too far apart for a surface");
    write_mask_of((const int[]){0, 7, 14, 12, 2, 16}, 6); /* a chessboard's */
    assert_refused(&PLAIN, "mask.png shows 6 pixels, too few or too far apart for a surface");
    write_mask_of((const int[]){22, 23, 17}, 3);
    merlin_capture c;
    assert_int_equal(pst_capture_read(scratch, &PLAIN, &c), OK);
    pst_capture_free(&c);
}

static void a_mask_of_what_is_black_in_all_pictures_is_refused(void **state)
{
    (void)state;
    img p;
    three_pictures(IMG_LINEAR16);
    for (int i = 0; i < 3; i++) {
        assert_int_equal(img_new(&p, 6, 4, 3), OK);
        for (int k = 0; k < 36; k++)
            p.data[k] = 0.5f;
        assert_int_equal(img_write_png(scratch_path((const char *[]){"a.png", "b.png", "c.png"}[i]), &p, IMG_LINEAR16),
                         OK);
        img_free(&p);
    }
    write_mask_of((const int[]){12, 13, 18, 19}, 4); /* of the lower half */
    assert_refused(&PLAIN, "the pictures are black where the mask");
    write_mask_of((const int[]){6, 7, 12, 13}, 4);
    merlin_capture c;
    assert_int_equal(pst_capture_read(scratch, &PLAIN, &c), OK);
    pst_capture_free(&c);
}

static void black_pictures_are_called_black(void **state)
{
    (void)state;
    for (int i = 0; i < 3; i++)
        write_flat((const char *[]){"a.png", "b.png", "c.png"}[i], 6, 4, 3, 0.003f, IMG_LINEAR16);
    write_text("lights.txt", "0 0 1\n0 1 1\n1 0 1\n");
    assert_refused(&PLAIN, "are black");
    write_flat("mask.png", 6, 4, 1, 1, IMG_LINEAR8);
    merlin_capture c;
    assert_int_equal(pst_capture_read(scratch, &PLAIN, &c), OK);
    pst_capture_free(&c);
}

static void what_does_not_fit_is_refused_in_one_line(void **state)
{
    (void)state;
    merlin_capture c;
    assert_int_equal(pst_capture_read("/nowhere", &PLAIN, &c), MERLIN_BAD_INPUT);
    assert_says("/nowhere");
    write_text("lights.txt", "0 0 1\n0 1 1\n1 0 1\n");
    assert_refused(&PLAIN, "no pictures in");
    assert_int_equal(file_make_folder(scratch_path("owl")), OK);
    write_flat("owl/a.png", 6, 4, 3, 0.5f, IMG_LINEAR16);
    assert_refused(&PLAIN, "such as owl");
    unlink(scratch_path("lights.txt"));
    assert_refused(&PLAIN, "such as owl");
    three_pictures(IMG_LINEAR16);
    write_text("lights.txt", "0 0 1\n0 1 1\n");
    assert_refused(&PLAIN, "3 pictures, but");
    write_text("lights.txt", "0 0 1\n0 0 0\n1 0 1\n");
    assert_refused(&PLAIN, "lights.txt:2: the direction has no length");
    three_pictures(IMG_LINEAR16);
    write_flat("b.png", 6, 5, 3, 0.5f, IMG_LINEAR16);
    assert_refused(&PLAIN, "b.png is 6 x 5");
    write_text("b.png", "no picture");
    assert_refused(&PLAIN, "b.png");
    assert_refused(&(merlin_capture_files){.lights = "/nowhere/lights.txt"}, "/nowhere/lights.txt");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        in_scratch(a_mask_is_read_and_must_fit),
        in_scratch(a_named_mask_or_ambient_picture_is_no_photograph),
        in_scratch(results_beside_the_pictures_are_none),
        in_scratch(rarer_kinds_are_taken_where_they_are_alone),
        in_scratch(pictures_are_black_far_from_a_given_mask),
        in_scratch(a_mask_may_have_any_usual_name),
        in_scratch(what_is_left_aside_is_listed_with_the_reason),
        in_scratch(raw_pictures_come_before_what_the_camera_made_of_them),
        in_scratch(a_mask_without_three_neighbours_is_refused),
        in_scratch(a_mask_of_what_is_black_in_all_pictures_is_refused),
        in_scratch(black_pictures_are_called_black),
        in_scratch(what_does_not_fit_is_refused_in_one_line),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
