/* SPDX-License-Identifier: MIT */
/* include/merlin/surface.h: the files of a surface, and its maps. */
#include "merlin/surface.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "base/file.h"
#include "merlin/relight.h"
#include "merlin/view.h"
#include "scratch.h"

#include <cmocka.h>

#include "each_allocation.h"

enum { SIDE = 64, PIXELS = SIDE * SIDE };
static const float RADIUS = 28;

static merlin_image image_new(int channels)
{
    return (merlin_image){SIDE, SIDE, channels, calloc((size_t)(PIXELS * channels), sizeof(float))};
}

/* Makes the front of a grey ball seen from afar, left of the middle, brighter at the top. */
static merlin_surface ball(void)
{
    merlin_surface s = {.normal = image_new(3),
                        .albedo = image_new(1),
                        .depth = image_new(1),
                        .residual = image_new(1),
                        .mask = image_new(1),
                        .method = MERLIN_STEREO_ROBUST,
                        .picture_count = 12};
    for (int i = 0; i < PIXELS; i++) {
        float x = ((float)(i % SIDE) - 29.5f) / RADIUS, y = (31.5f - (float)(i / SIDE)) / RADIUS;
        float square = 1 - x * x - y * y;
        if (square < 0.1f) continue;
        s.normal.data[3 * i] = x;
        s.normal.data[3 * i + 1] = y;
        s.normal.data[3 * i + 2] = sqrtf(square);
        s.albedo.data[i] = 30 + 10 * y;
        s.depth.data[i] = 100 - RADIUS * sqrtf(square);
        s.residual.data[i] = 0.125f;
        s.mask.data[i] = 1;
    }
    return s;
}

static void assert_near(const merlin_image *a, const merlin_image *b, float tolerance)
{
    assert_int_equal(a->channels, b->channels);
    for (int i = 0; i < PIXELS * a->channels; i++)
        assert_float_equal(a->data[i], b->data[i], tolerance);
}

static void a_folder_is_read_back_as_the_surfaces_maps(void **state)
{
    (void)state;
    static const char *const names[] = {"albedo.png", "depth.png",  "error.png",    "mask.png",
                                        "maps.exr",   "normal.png", "overview.png", "report.json"};
    merlin_surface s = ball();
    merlin_maps made, read;
    int captured = 0;
    const char *folder = scratch_path("ball");
    char path[256];
    assert_int_equal(merlin_surface_write(&s, "pictures", NULL, folder), MERLIN_OK);
    for (size_t i = 0; i < sizeof names / sizeof *names; i++) {
        snprintf(path, sizeof path, "%s/%s", folder, names[i]);
        assert_true(file_exists(path));
    }
    assert_int_equal(merlin_maps_look(folder, &captured), MERLIN_OK);
    assert_int_equal(captured, 1);
    assert_int_equal(merlin_maps_read(folder, &read), MERLIN_OK);
    assert_int_equal(merlin_maps_from_surface(&s, &made), MERLIN_OK);
    assert_true(read.captured && made.captured);
    assert_int_equal(made.crop.x, read.crop.x);
    assert_int_equal(made.crop.side, read.crop.side);
    /* half floats keep 11 bits */
    assert_near(&made.normal, &read.normal, 1e-3f);
    assert_near(&made.albedo, &read.albedo, 1e-3f);
    assert_near(&made.depth, &read.depth, 1e-4f);
    assert_near(&made.roughness, &read.roughness, 0);
    merlin_maps_free(&made);
    merlin_maps_free(&read);
    merlin_surface_free(&s);
}

static void maps_of_a_surface_stand_where_a_photographs_do(void **state)
{
    (void)state;
    merlin_surface s = ball();
    merlin_maps maps;
    assert_int_equal(merlin_maps_from_surface(&s, &maps), MERLIN_OK);
    double sum = 0, count = 0;
    float brightest = 0, nearest = 9;
    for (int i = 0; i < PIXELS; i++) {
        if (s.mask.data[i] == 0) continue;
        sum += (double)maps.depth.data[i];
        count++;
        brightest = fmaxf(brightest, maps.albedo.data[3 * i]);
        nearest = fminf(nearest, maps.depth.data[i]);
    }
    assert_float_equal(sum / count, 1, 1e-4);
    assert_true(brightest > 0.88f && brightest <= 1);
    assert_true(nearest > 0.6f && nearest < 0.95f); /* a ball is about as deep as it is wide */
    const char *page = scratch_path("ball.html");
    assert_int_equal(merlin_view_write(&maps, NULL, page), MERLIN_OK);
    assert_true(file_exists(page));
    merlin_maps_free(&maps);
    merlin_surface_free(&s);
}

static void a_report_tells_what_is_known(void **state)
{
    (void)state;
    merlin_surface s = ball();
    char *text, none[] = "light 0", *names[] = {none};
    merlin_light lights[1] = {{.direction = {0, 0, 1}}};
    s.lights = lights;
    s.light_count = 1;
    s.picture_names = names;
    s.picture_count = 1;
    assert_int_equal(merlin_surface_report(&s, "pictures", &text), MERLIN_OK);
    static const char *const told[] = {"\"input\":\t\"pictures\"", "\"method\":\t\"robust\"", "\"mean\":\t0.125",
                                       "\"name\":\t\"light 0\"", "\"error_map\":\t\"residual\""};
    for (size_t i = 0; i < sizeof told / sizeof *told; i++)
        if (!strstr(text, told[i])) fail_msg("the report lacks %s: %s", told[i], text);
    free(text);
    assert_int_equal(merlin_surface_report(&s, NULL, &text), MERLIN_OK);
    assert_null(strstr(text, "\"input\""));
    free(text);
    s.lights = NULL;
    s.picture_names = NULL;
    s.relit = (merlin_relit_photo){.lights = 50, .subsets = 5, .model = "merlin-point", .spread = 2};
    assert_int_equal(merlin_surface_report(&s, NULL, &text), MERLIN_OK);
    assert_non_null(strstr(text, "\"normal_spread_mean_degrees\":\t2"));
    assert_null(strstr(text, "\"method\""));
    free(text);
    merlin_surface_free(&s);
}

static int always(void)
{
    return 1;
}

static void what_cannot_be_written_leaves_nothing(void **state)
{
    (void)state;
    merlin_surface s = ball(), empty = {0};
    merlin_maps maps;
    char *text;
    const char *folder = scratch_path("none");
    const merlin_write_params stops = {.stop = always};
    assert_int_equal(merlin_surface_write(&empty, NULL, NULL, folder), MERLIN_WRONG_USE);
    assert_int_equal(merlin_surface_report(&empty, NULL, &text), MERLIN_WRONG_USE);
    assert_null(text);
    assert_int_equal(merlin_maps_from_surface(&empty, &maps), MERLIN_WRONG_USE);
    assert_int_equal(merlin_surface_write(&s, NULL, &stops, folder), MERLIN_STOPPED);
    assert_false(file_exists(folder));
    s.camera.focal = 50; /* a near camera sees nothing behind itself */
    for (int i = 0; i < PIXELS; i++)
        s.depth.data[i] = -s.depth.data[i];
    assert_int_equal(merlin_maps_from_surface(&s, &maps), MERLIN_BAD_INPUT);
    assert_null(maps.albedo.data);
    merlin_surface_free(&s);
}

/* ---- lack of memory ---- */

typedef struct work {
    merlin_surface surface;
    merlin_maps maps;
    char *text;
} work;

static int make_maps(void *context)
{
    work *w = context;
    memset(&w->maps, 1, sizeof w->maps);
    return merlin_maps_from_surface(&w->surface, &w->maps);
}

static const char *check_maps(void *context, int result)
{
    work *w = context;
    const char *fault = (result == MERLIN_OK) == (w->maps.albedo.data != NULL) ? NULL : "maps after a failure";
    merlin_maps_free(&w->maps);
    return fault;
}

static int make_report(void *context)
{
    work *w = context;
    return merlin_surface_report(&w->surface, "pictures", &w->text);
}

static const char *check_report(void *context, int result)
{
    work *w = context;
    const char *fault = (result == MERLIN_OK) == (w->text != NULL) ? NULL : "a report after a failure";
    free(w->text);
    return fault;
}

static int write_files(void *context)
{
    const work *w = context;
    return merlin_surface_write(&w->surface, "pictures", NULL, scratch_path("lack"));
}

/* Removes what was written. */
static const char *check_files(void *context, int result)
{
    char **names = NULL;
    size_t count = 0;
    const char *folder = scratch_path("lack");
    (void)context;
    if (result != MERLIN_OK) return file_exists(folder) ? "a folder after a failure" : NULL;
    assert_int_equal(file_list(folder, NULL, &names, &count), OK);
    const char *fault = count == 8 ? NULL : "a folder without all of its files";
    for (size_t i = 0; i < count; i++)
        assert_int_equal(unlink(names[i]), 0);
    file_list_free(names, count);
    assert_int_equal(rmdir(folder), 0);
    return fault;
}

static void lack_of_memory_leaves_no_folder(void **state)
{
    (void)state;
    work w = {.surface = ball()};
    each_allocation_fails(&(memory_trial){"files of a surface", write_files, check_files, &w});
    merlin_surface_free(&w.surface);
}

static void lack_of_memory_makes_neither_maps_nor_report(void **state)
{
    (void)state;
    work w = {.surface = ball()};
    each_allocation_fails(&(memory_trial){"maps from a surface", make_maps, check_maps, &w});
    each_allocation_fails(&(memory_trial){"report", make_report, check_report, &w});
    merlin_surface_free(&w.surface);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_folder_is_read_back_as_the_surfaces_maps),
        cmocka_unit_test(maps_of_a_surface_stand_where_a_photographs_do),
        cmocka_unit_test(a_report_tells_what_is_known),
        cmocka_unit_test(what_cannot_be_written_leaves_nothing),
        cmocka_unit_test(lack_of_memory_makes_neither_maps_nor_report),
        cmocka_unit_test(lack_of_memory_leaves_no_folder),
    };
    merlin_set_threads(1); /* the n-th allocation is the same one each time */
    return cmocka_run_group_tests(tests, scratch_open, scratch_close);
}
