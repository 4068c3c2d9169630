/* SPDX-License-Identifier: MIT */
/* The whole way from photograph to folder with a model of random weights: everything but the answer's quality. */
#include "estimate_fixture.h"

static void assert_size(const merlin_image *image, int channels)
{
    assert_int_equal(image->width, WIDTH);
    assert_int_equal(image->height, HEIGHT);
    assert_int_equal(image->channels, channels);
}

static void assert_finite_and_zero_outside(const merlin_image *image, const merlin_image *mask)
{
    for (int i = 0; i < WIDTH * HEIGHT * image->channels; i++) {
        float x = image->data[i];
        assert_true(isfinite(x));
        if (mask->data[i / image->channels] == 0) assert_true(x == 0);
    }
}

static void maps_are_finite_have_the_photographs_size_and_are_zero_outside_the_mask(void **state)
{
    merlin_maps maps;
    estimate(*state, &maps);
    const merlin_image *images[] = {&maps.albedo, &maps.normal, &maps.roughness,     &maps.depth,
                                    &maps.mask,   &maps.photo,  &maps.reconstruction};
    const int channels[] = {3, 3, 1, 1, 1, 3, 3};
    for (int i = 0; i < 7; i++) {
        assert_size(images[i], channels[i]);
        assert_finite_and_zero_outside(images[i], &maps.mask);
    }
    merlin_maps_free(&maps);
}

static void normals_are_unit_and_face_the_camera(void **state)
{
    merlin_maps maps;
    estimate(*state, &maps);
    for (int i = 0; i < WIDTH * HEIGHT; i++) {
        const float *n = maps.normal.data + 3 * i;
        if (!(maps.mask.data[i] > 0)) continue;
        /* a few roundings of float32 */
        assert_float_equal(n[0] * n[0] + n[1] * n[1] + n[2] * n[2], 1, 1e-5);
        assert_true(n[2] > 0);
    }
    merlin_maps_free(&maps);
}

static void albedo_and_roughness_are_in_their_ranges(void **state)
{
    merlin_maps maps;
    estimate(*state, &maps);
    for (int i = 0; i < WIDTH * HEIGHT; i++) {
        for (int c = 0; c < 3; c++)
            assert_in_range((uint64_t)(maps.albedo.data[3 * i + c] * 1000), 0, 1000);
        if (maps.mask.data[i] > 0) assert_true(maps.roughness.data[i] >= 0.03f && maps.roughness.data[i] <= 1);
    }
    merlin_maps_free(&maps);
}

static void the_object_is_found_without_a_mask(void **state)
{
    const fixture *f = *state;
    merlin_maps maps;
    merlin_params p = small();
    assert_int_equal(merlin_estimate(f->model, &f->photo, NULL, &p, &maps), MERLIN_OK);
    assert_int_equal(maps.mask_source, MERLIN_MASK_FOUND);
    assert_true(maps.mask_confidence > 0.5f);
    double both = 0, either = 0;
    for (int i = 0; i < WIDTH * HEIGHT; i++) {
        both += maps.mask.data[i] > 0.5f && f->mask.data[i] > 0.5f;
        either += maps.mask.data[i] > 0.5f || f->mask.data[i] > 0.5f;
    }
    /* a pixel of error all round a disc of radius 40 costs 5 %; its dark rim costs some more */
    assert_true(both / either > 0.85);
    merlin_maps_free(&maps);
}

/* The fixture's photograph before a lighter background, in other units. */
static void search_scaled(const fixture *f, float unit, merlin_maps *maps)
{
    merlin_params p = small();
    merlin_image photo = image_new(WIDTH, HEIGHT, 3);
    for (int i = 0; i < WIDTH * HEIGHT * 3; i++)
        photo.data[i] = unit * (f->mask.data[i / 3] > 0 ? f->photo.data[i] : 0.1f);
    if (merlin_estimate(f->model, &photo, NULL, &p, maps) != MERLIN_OK) fail_msg("%s", merlin_error());
    merlin_image_free(&photo);
}

static void the_object_is_found_in_a_picture_of_any_unit(void **state)
{
    const fixture *f = *state;
    const float units[] = {32, 1 / 32.0f};
    merlin_maps usual, other;
    search_scaled(f, 1, &usual);
    for (int k = 0; k < 2; k++) {
        search_scaled(f, units[k], &other);
        double off = 0, all = 0;
        for (int i = 0; i < WIDTH * HEIGHT; i++) {
            off += fabs((double)usual.mask.data[i] - (double)other.mask.data[i]);
            all += (double)usual.mask.data[i];
        }
        /* not quite the same exposure: a part of the outline, which is a twentieth of the disc for each pixel of width
         */
        assert_true(off < 0.05 * all);
        merlin_maps_free(&other);
    }
    merlin_maps_free(&usual);
}

static void as_many_threads_work_as_was_said(void **state)
{
    merlin_maps maps;
    int before = parallel_threads();
    for (int count = 1; count <= 2; count++) {
        assert_int_equal(merlin_set_threads(count), MERLIN_OK);
        estimate(*state, &maps);
        assert_int_equal(parallel_threads(), count);
        merlin_maps_free(&maps);
    }
    assert_int_equal(merlin_set_threads(0), MERLIN_WRONG_USE);
    assert_int_equal(merlin_set_threads(1025), MERLIN_WRONG_USE);
    assert_string_equal(merlin_error(), "1025 threads are not from 1 to 1024");
    estimate(*state, &maps);
    assert_int_equal(parallel_threads(), 2);
    merlin_maps_free(&maps);
    merlin_set_threads(before);
}

static int stop_now(void)
{
    return 1;
}

static void work_stops_when_told_to(void **state)
{
    const fixture *f = *state;
    merlin_maps maps;
    merlin_params p = small();
    p.stop = stop_now;
    assert_int_equal(merlin_estimate(f->model, &f->photo, &f->mask, &p, &maps), MERLIN_STOPPED);
    assert_null(maps.albedo.data);
}

static void darker_photographs_are_brightened_to_the_same_maps(void **state)
{
    fixture *f = *state;
    merlin_params p = small();
    merlin_maps bright, dark;
    for (int i = 0; i < WIDTH * HEIGHT * 3; i++)
        f->photo.data[i] *= 0.1f; /* dark enough to be brightened */
    assert_int_equal(merlin_estimate(f->model, &f->photo, &f->mask, &p, &bright), MERLIN_OK);
    for (int i = 0; i < WIDTH * HEIGHT * 3; i++)
        f->photo.data[i] *= 0.25f;
    assert_int_equal(merlin_estimate(f->model, &f->photo, &f->mask, &p, &dark), MERLIN_OK);
    for (int i = 0; i < WIDTH * HEIGHT * 3; i++)
        f->photo.data[i] *= 40;
    /* the percentile is known to a bin of 1/32 stop */
    assert_float_equal(dark.gain / bright.gain, 4, 4 * 0.023);
    merlin_maps_free(&bright);
    merlin_maps_free(&dark);
}

/* As of a file that counts electrons. */
static void photographs_in_another_unit_are_exposed_for_it(void **state)
{
    fixture *f = *state;
    const float units[] = {64, 4096, 65536};
    const int count = WIDTH * HEIGHT * 3;
    merlin_params p = small();
    merlin_maps maps[3];
    for (int k = 0; k < 3; k++) {
        for (int i = 0; i < count; i++)
            f->photo.data[i] *= units[k];
        assert_int_equal(merlin_estimate(f->model, &f->photo, &f->mask, &p, &maps[k]), MERLIN_OK);
        for (int i = 0; i < count; i++)
            f->photo.data[i] /= units[k];
        /* by powers of two: bit for bit */
        assert_true(maps[k].gain * units[k] == maps[0].gain * units[0]);
        assert_memory_equal(maps[k].albedo.data, maps[0].albedo.data, (size_t)count * sizeof(float));
    }
    for (int k = 0; k < 3; k++)
        merlin_maps_free(&maps[k]);
}

static void written_maps_are_read_back(void **state)
{
    const fixture *f = *state;
    merlin_maps maps, again;
    estimate(f, &maps);
    assert_true(maps.burnt_out == 0);
    for (int i = 0; i < WIDTH * HEIGHT; i++)
        maps.photo.data[3 * i] = maps.mask.data[i]; /* all of red, a third of the values */
    if (merlin_maps_write(f->model, &maps, NULL, f->output) != MERLIN_OK) fail_msg("%s", merlin_error());
    if (merlin_maps_read(f->output, &again) != MERLIN_OK) fail_msg("%s", merlin_error());
    assert_int_equal(maps.crop.x, again.crop.x);
    assert_int_equal(maps.crop.side, again.crop.side);
    assert_int_equal(maps.size, again.size);
    assert_string_equal(maps.model, again.model);
    assert_float_equal(again.burnt_out, 1.0f / 3, 1e-6);
    /* half floats keep 11 bits */
    for (int i = 0; i < WIDTH * HEIGHT * 3; i++)
        assert_float_equal(maps.albedo.data[i], again.albedo.data[i], 5e-4);
    for (int i = 0; i < WIDTH * HEIGHT; i++)
        assert_float_equal(maps.depth.data[i], again.depth.data[i], 5e-4 * (1 + maps.depth.data[i]));
    merlin_maps_free(&maps);
    merlin_maps_free(&again);
}

static void a_folder_of_ones_own_is_written_in_place(void **state)
{
    const fixture *f = *state;
    const merlin_write_params params = {.in_place = 1, .last = 1};
    merlin_maps maps;
    char path[160], *text = NULL, *written = NULL;
    size_t size = 0;
    estimate(f, &maps);
    snprintf(path, sizeof path, "%s/none", f->output);
    assert_int_equal(merlin_maps_write(f->model, &maps, &params, path), MERLIN_CANNOT_WRITE);
    assert_false(file_exists(path));
    assert_int_equal(merlin_maps_write(f->model, &maps, &params, f->output), MERLIN_OK);
    snprintf(path, sizeof path, "%s/report.json", f->output);
    assert_int_equal(merlin_maps_report(&maps, &text), MERLIN_OK);
    assert_int_equal(file_read(path, 1 << 20, &written, &size), OK);
    assert_int_equal(strlen(text), size);
    assert_memory_equal(text, written, size);
    free(text);
    free(written);
    merlin_maps_free(&maps);
    assert_int_equal(merlin_maps_report(&maps, &text), MERLIN_WRONG_USE);
    assert_null(text);
}

static void maps_that_were_read_are_written_again_unless_they_cannot_be_read(void **state)
{
    const fixture *f = *state;
    merlin_maps maps, again;
    char path[160];
    snprintf(path, sizeof path, "%s/again", f->folder);
    estimate(f, &maps);
    assert_int_equal(merlin_maps_write(f->model, &maps, NULL, f->output), MERLIN_OK);
    merlin_maps_free(&maps);
    assert_int_equal(merlin_maps_read(f->output, &maps), MERLIN_OK);
    assert_null(maps.reconstruction.data);
    for (int i = 0; i < WIDTH * HEIGHT * 3; i++)
        maps.albedo.data[i] *= 255;
    assert_int_equal(merlin_maps_write(f->model, &maps, NULL, path), MERLIN_BAD_INPUT);
    assert_non_null(strstr(merlin_error(), "these maps: albedo.R goes from"));
    assert_false(file_exists(path));
    for (int i = 0; i < WIDTH * HEIGHT * 3; i++)
        maps.albedo.data[i] /= 2 * 255;
    assert_int_equal(merlin_maps_write(f->model, &maps, NULL, path), MERLIN_OK);
    assert_null(maps.reconstruction.data);
    assert_int_equal(merlin_maps_read(path, &again), MERLIN_OK);
    merlin_maps_free(&again);
    maps.captured = 1;
    assert_int_equal(merlin_maps_write(f->model, &maps, NULL, path), MERLIN_WRONG_USE);
    assert_non_null(strstr(merlin_error(), "captured surface"));
    merlin_maps_free(&maps);
}

static void a_photograph_in_any_unit_is_read_back(void **state)
{
    fixture *f = *state;
    const float units[] = {1e-6f, 1e6f};
    for (int k = 0; k < 2; k++) {
        merlin_maps maps, again;
        for (int i = 0; i < WIDTH * HEIGHT * 3; i++)
            f->photo.data[i] *= units[k];
        estimate(f, &maps);
        for (int i = 0; i < WIDTH * HEIGHT * 3; i++)
            f->photo.data[i] /= units[k];
        assert_int_equal(merlin_maps_write(f->model, &maps, NULL, f->output), MERLIN_OK);
        if (merlin_maps_read(f->output, &again) != MERLIN_OK) fail_msg("%s", merlin_error());
        for (int i = 0; i < WIDTH * HEIGHT * 3; i++)
            assert_float_equal(maps.photo.data[i], again.photo.data[i], 1e-3f * maps.photo.data[i]);
        merlin_maps_free(&maps);
        merlin_maps_free(&again);
    }
}

static void maps_of_the_farthest_exposures_are_read_back(void **state)
{
    const fixture *f = *state;
    for (int sign = -1; sign <= 1; sign += 2) {
        merlin_maps maps, again;
        merlin_params p = small();
        p.auto_exposure = 0;
        p.exposure = 20.0f * (float)sign;
        assert_int_equal(merlin_estimate(f->model, &f->photo, &f->mask, &p, &maps), MERLIN_OK);
        assert_int_equal(merlin_maps_write(f->model, &maps, NULL, f->output), MERLIN_OK);
        if (merlin_maps_read(f->output, &again) != MERLIN_OK) fail_msg("%s", merlin_error());
        assert_true(maps.gain == again.gain);
        merlin_maps_free(&maps);
        merlin_maps_free(&again);
    }
}

static void a_folder_has_every_file_and_no_other(void **state)
{
    static const char *const names[] = {"albedo.png",         "depth.png",   "mask.png",
                                        "maps.exr",           "normal.png",  "overview.png",
                                        "reconstruction.png", "report.json", "roughness.png"};
    const fixture *f = *state;
    merlin_maps maps;
    estimate(f, &maps);
    assert_int_equal(merlin_maps_write(f->model, &maps, NULL, f->output), MERLIN_OK);
    for (size_t i = 0; i < sizeof names / sizeof names[0]; i++) {
        char path[160];
        snprintf(path, sizeof path, "%s/%s", f->output, names[i]);
        if (!file_exists(path)) fail_msg("%s is missing", path);
        assert_int_equal(unlink(path), 0);
    }
    assert_int_equal(rmdir(f->output), 0); /* empty now, hidden files included */
    merlin_maps_free(&maps);
}

static void relighting_moves_the_light_and_keeps_the_outside_black(void **state)
{
    const fixture *f = *state;
    const float left[3] = {-0.7f, 0.3f, -0.4f}, right[3] = {0.7f, 0.3f, -0.4f};
    for (int how = MERLIN_BY_BRDF; how <= MERLIN_BY_BRDF_DIRECT; how++) {
        merlin_maps maps;
        merlin_image a, b;
        estimate(f, &maps);
        assert_int_equal(merlin_relight(f->model, &maps, left, (merlin_relighting)how, &a), MERLIN_OK);
        assert_int_equal(merlin_relight(f->model, &maps, right, (merlin_relighting)how, &b), MERLIN_OK);
        assert_size(&a, 3);
        assert_finite_and_zero_outside(&a, &maps.mask);
        assert_true(memcmp(a.data, b.data, WIDTH * HEIGHT * 3 * sizeof(float)) != 0);
        merlin_image_free(&a);
        merlin_image_free(&b);
        merlin_maps_free(&maps);
    }
}

static void a_photograph_in_another_unit_gives_the_same_pictures(void **state)
{
    fixture *f = *state;
    const float left[3] = {-0.7f, 0.3f, -0.4f};
    merlin_params p = small();
    merlin_image relit[2], again[2];
    p.auto_exposure = 0;
    for (int k = 0; k < 2; k++) {
        merlin_maps maps;
        assert_int_equal(merlin_estimate(f->model, &f->photo, &f->mask, &p, &maps), MERLIN_OK);
        assert_int_equal(merlin_relight(f->model, &maps, left, MERLIN_BY_BRDF, &relit[k]), MERLIN_OK);
        again[k] = maps.reconstruction;
        maps.reconstruction = (merlin_image){0};
        merlin_maps_free(&maps);
        for (int i = 0; i < WIDTH * HEIGHT * 3; i++)
            f->photo.data[i] *= k ? 1 / 16.0f : 16;
        p.exposure = -4; /* by powers of two: the network sees the same, bit for bit */
    }
    assert_memory_equal(relit[0].data, relit[1].data, WIDTH * HEIGHT * 3 * sizeof(float));
    assert_memory_equal(again[0].data, again[1].data, WIDTH * HEIGHT * 3 * sizeof(float));
    for (int k = 0; k < 2; k++) {
        merlin_image_free(&relit[k]);
        merlin_image_free(&again[k]);
    }
}

enum { RING_SIDE = 64, RING_RADIUS = 20 };

/* A square photograph of a grey ring, 16 pixels wide with a soft edge, which is taken whole. */
static void estimate_ring(const fixture *f, merlin_maps *maps)
{
    merlin_params p = small();
    merlin_image photo = image_new(RING_SIDE, RING_SIDE, 3), mask = image_new(RING_SIDE, RING_SIDE, 1);
    for (int i = 0; i < RING_SIDE * RING_SIDE; i++) {
        float x = (float)(i % RING_SIDE) - 31.5f, y = (float)(i / RING_SIDE) - 31.5f;
        mask.data[i] = fminf(fmaxf(8 - fabsf(sqrtf(x * x + y * y) - RING_RADIUS), 0), 1);
        for (int c = 0; c < 3; c++)
            photo.data[3 * i + c] = 0.5f;
    }
    assert_int_equal(merlin_estimate(f->model, &photo, &mask, &p, maps), MERLIN_OK);
    assert_int_equal(maps->crop.side, RING_SIDE);
    merlin_image_free(&photo);
    merlin_image_free(&mask);
}

static void the_decoders_picture_is_black_beside_the_object_at_the_networks_own_size_too(void **state)
{
    const fixture *f = *state;
    const float left[3] = {-0.7f, 0.3f, -0.4f};
    merlin_maps maps;
    merlin_image relit;
    estimate_ring(f, &maps);
    assert_int_equal(merlin_relight(f->model, &maps, left, MERLIN_BY_NETWORK, &relit), MERLIN_OK);
    for (int i = 0; i < 3 * RING_SIDE * RING_SIDE; i++)
        if (maps.mask.data[i / 3] == 0) assert_true(relit.data[i] == 0);
    merlin_image_free(&relit);
    merlin_maps_free(&maps);
}

static void an_enlarged_picture_is_black_beside_the_object(void **state)
{
    enum { SIDE = 4 * RING_SIDE };
    const fixture *f = *state;
    const float left[3] = {-0.7f, 0.3f, -0.4f};
    merlin_maps maps;
    merlin_relighter *relighter;
    merlin_image relit;
    estimate_ring(f, &maps);
    for (int how = MERLIN_BY_BRDF; how <= MERLIN_BY_BRDF_DIRECT; how++) {
        assert_int_equal(merlin_relighter_new(f->model, &maps, SIDE, (merlin_relighting)how, &relighter), MERLIN_OK);
        assert_int_equal(merlin_relighter_render(relighter, left, NULL, &relit), MERLIN_OK);
        for (int i = 0; i < 3 * SIDE * SIDE; i++) {
            float x = ((float)(i / 3 % SIDE) + 0.5f) / 4 - 32, y = ((float)(i / 3 / SIDE) + 0.5f) / 4 - 32;
            /* the soft edge, and a pixel of the photograph between one that is covered and one that is not */
            if (fabsf(sqrtf(x * x + y * y) - RING_RADIUS) > 8 + 1.5f) assert_true(relit.data[i] == 0);
        }
        merlin_image_free(&relit);
        merlin_relighter_free(relighter);
    }
    merlin_maps_free(&maps);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(maps_are_finite_have_the_photographs_size_and_are_zero_outside_the_mask),
        cmocka_unit_test(normals_are_unit_and_face_the_camera),
        cmocka_unit_test(albedo_and_roughness_are_in_their_ranges),
        cmocka_unit_test(the_object_is_found_without_a_mask),
        cmocka_unit_test(the_object_is_found_in_a_picture_of_any_unit),
        cmocka_unit_test(as_many_threads_work_as_was_said),
        cmocka_unit_test(work_stops_when_told_to),
        cmocka_unit_test(darker_photographs_are_brightened_to_the_same_maps),
        cmocka_unit_test(photographs_in_another_unit_are_exposed_for_it),
        cmocka_unit_test(written_maps_are_read_back),
        cmocka_unit_test(a_folder_of_ones_own_is_written_in_place),
        cmocka_unit_test(maps_that_were_read_are_written_again_unless_they_cannot_be_read),
        cmocka_unit_test(a_photograph_in_any_unit_is_read_back),
        cmocka_unit_test(maps_of_the_farthest_exposures_are_read_back),
        cmocka_unit_test(a_folder_has_every_file_and_no_other),
        cmocka_unit_test(relighting_moves_the_light_and_keeps_the_outside_black),
        cmocka_unit_test(the_decoders_picture_is_black_beside_the_object_at_the_networks_own_size_too),
        cmocka_unit_test(a_photograph_in_another_unit_gives_the_same_pictures),
        cmocka_unit_test(an_enlarged_picture_is_black_beside_the_object),
    };
    return cmocka_run_group_tests(tests, set_up, tear_down);
}
