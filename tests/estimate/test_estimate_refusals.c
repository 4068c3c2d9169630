/* SPDX-License-Identifier: MIT */
/* What estimate refuses, and what stays empty and unwritten then. */
#include "estimate_fixture.h"

static void masks_of_another_size_are_refused(void **state)
{
    const fixture *f = *state;
    merlin_maps maps;
    merlin_image mask = image_new(WIDTH, HEIGHT - 1, 1);
    assert_int_equal(merlin_estimate(f->model, &f->photo, &mask, NULL, &maps), MERLIN_BAD_INPUT);
    assert_non_null(strstr(merlin_error(), "150×109"));
    assert_null(maps.albedo.data);
    merlin_image_free(&mask);
}

static void empty_masks_are_refused(void **state)
{
    const fixture *f = *state;
    merlin_maps maps;
    merlin_image mask = image_new(WIDTH, HEIGHT, 1);
    assert_int_equal(merlin_estimate(f->model, &f->photo, &mask, NULL, &maps), MERLIN_BAD_INPUT);
    assert_non_null(strstr(merlin_error(), "mask selects nothing"));
    merlin_image_free(&mask);
}

/* Single pixels, of which the network's larger ones are covered by a small part. */
static void an_object_too_thin_for_the_networks_pixels_is_refused_as_that(void **state)
{
    const fixture *f = *state;
    merlin_maps maps;
    merlin_params p = small();
    merlin_image dots = image_new(WIDTH, HEIGHT, 1);
    for (int i = 0; i < WIDTH * HEIGHT; i++)
        dots.data[i] = i % WIDTH % 10 == 0 && i / WIDTH % 10 == 0;
    assert_int_equal(merlin_estimate(f->model, &f->photo, &dots, &p, &maps), MERLIN_BAD_INPUT);
    assert_non_null(strstr(merlin_error(), "too thin"));
    assert_non_null(strstr(merlin_error(), "64×64"));
    merlin_image_free(&dots);
}

/* A grey PNG of 30000 by 30000 pixels as far as its head goes. */
static void a_photograph_that_is_too_large_is_refused_before_it_is_decoded(void **state)
{
    static const char head[] = "\x89PNG\r\n\x1a\n\0\0\0\x0dIHDR\0\0\x75\x30\0\0\x75\x30\x08\0\0\0\0\x43\x4c\xa7\x66"
                               "\0\0\0\0IDAT\x35\xaf\x06\x1e";
    const fixture *f = *state;
    merlin_image color;
    char path[96];
    snprintf(path, sizeof path, "%s/large.png", f->folder);
    assert_int_equal(file_write(path, head, sizeof head - 1), OK);
    assert_int_equal(merlin_image_read(path, &color, NULL), MERLIN_BAD_INPUT);
    assert_non_null(strstr(merlin_error(), "large.png: it is 30000 x 30000 pixels, more than 512 million"));
}

/* A picture of one colour under one alpha. */
static const char *save_alpha(const fixture *f, float alpha, char *path, size_t size)
{
    enum { SIDE = 20 };
    float values[SIDE * SIDE][4];
    for (int i = 0; i < SIDE * SIDE; i++)
        values[i][0] = values[i][1] = values[i][2] = 0.5f, values[i][3] = alpha;
    const exr_channel channels[] = {{"R", &values[0][0], 4, false},
                                    {"G", &values[0][1], 4, false},
                                    {"B", &values[0][2], 4, false},
                                    {"A", &values[0][3], 4, false}};
    snprintf(path, size, "%s/alpha.exr", f->folder);
    assert_int_equal(exr_write(path, SIDE, SIDE, channels, 4, NULL, 0), OK);
    return path;
}

static void an_alpha_that_shows_nothing_is_refused_by_its_name(void **state)
{
    const fixture *f = *state;
    merlin_image color, alpha;
    char path[96];
    for (int k = 0; k < 2; k++) {
        save_alpha(f, k ? 0.49f : 0, path, sizeof path);
        assert_int_equal(merlin_image_read(path, &color, &alpha), MERLIN_BAD_INPUT);
        assert_non_null(strstr(merlin_error(), "alpha.exr is transparent everywhere"));
        assert_true(!color.data && !alpha.data);
        assert_int_equal(merlin_image_read(path, &color, NULL), MERLIN_OK); /* a mask stands in for it */
        merlin_image_free(&color);
    }
    assert_int_equal(merlin_image_read(save_alpha(f, 0.5f, path, sizeof path), &color, &alpha), MERLIN_OK);
    assert_non_null(alpha.data);
    merlin_image_free(&color);
    merlin_image_free(&alpha);
    assert_int_equal(merlin_image_read(save_alpha(f, 1, path, sizeof path), &color, &alpha), MERLIN_OK);
    assert_null(alpha.data);
    merlin_image_free(&color);
}

static void only_names_of_pngs_and_jpegs_are_written_to(void **state)
{
    const fixture *f = *state;
    char path[96];
    snprintf(path, sizeof path, "%s/photo.tiff", f->folder);
    assert_int_equal(merlin_image_write(path, &f->photo), MERLIN_WRONG_USE);
    assert_non_null(strstr(merlin_error(), ".png"));
    assert_false(file_exists(path));
}

static void photographs_without_an_object_are_refused(void **state)
{
    const fixture *f = *state;
    merlin_maps maps;
    merlin_image grey = image_new(64, 64, 3);
    for (int i = 0; i < 64 * 64 * 3; i++)
        grey.data[i] = 0.2f;
    assert_int_equal(merlin_estimate(f->model, &grey, NULL, NULL, &maps), MERLIN_BAD_INPUT);
    assert_non_null(strstr(merlin_error(), "give a mask"));
    merlin_image_free(&grey);
}

static void tiny_photographs_and_odd_parameters_are_refused(void **state)
{
    const fixture *f = *state;
    merlin_maps maps;
    merlin_image tiny = image_new(1, 1, 3);
    assert_int_equal(merlin_estimate(f->model, &tiny, NULL, NULL, &maps), MERLIN_BAD_INPUT);
    merlin_image_free(&tiny); /* which empties it */
    assert_int_equal(merlin_estimate(f->model, &tiny, NULL, NULL, &maps), MERLIN_WRONG_USE);
    assert_non_null(strstr(merlin_error(), "no pixels"));
    merlin_params p = small();
    p.size = 100;
    assert_int_equal(merlin_estimate(f->model, &f->photo, &f->mask, &p, &maps), MERLIN_WRONG_USE);
    assert_non_null(strstr(merlin_error(), "multiple of 32"));
    p = small();
    p.auto_exposure = 0;
    p.exposure = NAN;
    assert_int_equal(merlin_estimate(f->model, &f->photo, &f->mask, &p, &maps), MERLIN_WRONG_USE);
}

static void photographs_with_infinities_are_refused(void **state)
{
    const fixture *f = *state;
    merlin_maps maps;
    float kept = f->photo.data[77];
    f->photo.data[77] = INFINITY;
    assert_int_equal(merlin_estimate(f->model, &f->photo, &f->mask, NULL, &maps), MERLIN_BAD_INPUT);
    f->photo.data[77] = kept;
}

static void empty_maps_are_neither_relit_nor_written(void **state)
{
    const fixture *f = *state;
    const float light[3] = {0};
    merlin_maps maps = {0};
    merlin_image image;
    assert_int_equal(merlin_relight(f->model, &maps, light, MERLIN_BY_BRDF, &image), MERLIN_WRONG_USE);
    assert_int_equal(merlin_maps_write(f->model, &maps, NULL, f->output), MERLIN_WRONG_USE);
    assert_false(file_exists(f->output));
}

static void maps_of_impossible_frames_are_refused(void **state)
{
    const fixture *f = *state;
    const float light[3] = {0};
    enum { BAD = 7 };
    merlin_maps good, bad[BAD];
    merlin_image image;
    estimate(f, &good);
    for (int i = 0; i < BAD; i++)
        bad[i] = good;
    bad[0].crop.side = INT_MAX;
    bad[1].crop.x = INT_MIN;
    bad[2].size = INT_MAX;
    bad[3].gain = INFINITY;
    bad[4].depth.width--;
    bad[5].size = 65;
    bad[6].reconstruction.height *= 100;
    for (int i = 0; i < BAD; i++) {
        assert_int_equal(merlin_relight(f->model, &bad[i], light, MERLIN_BY_BRDF, &image), MERLIN_WRONG_USE);
        assert_int_equal(merlin_maps_write(f->model, &bad[i], NULL, f->output), MERLIN_WRONG_USE);
        assert_non_null(strstr(merlin_error(), "empty or incomplete"));
    }
    assert_false(file_exists(f->output));
    assert_int_equal(merlin_relight(f->model, &good, light, (merlin_relighting)77, &image), MERLIN_WRONG_USE);
    merlin_maps_free(&good);
}

static void null_pointers_are_refused_and_freed(void **state)
{
    const fixture *f = *state;
    const float light[3] = {0};
    merlin_maps maps = {0};
    merlin_image image = {0};
    merlin_environment *room;
    assert_int_equal(merlin_model_open(NULL, NULL), MERLIN_WRONG_USE);
    assert_non_null(strstr(merlin_error(), "merlin_model_open was called with a null pointer"));
    assert_int_equal(merlin_image_read("a.png", NULL, NULL), MERLIN_WRONG_USE);
    assert_int_equal(merlin_mask_read(NULL, &image), MERLIN_WRONG_USE);
    assert_int_equal(merlin_image_write(NULL, &f->photo), MERLIN_WRONG_USE);
    assert_int_equal(merlin_image_write(f->output, &image), MERLIN_WRONG_USE); /* no pixels */
    assert_int_equal(merlin_estimate(f->model, NULL, NULL, NULL, &maps), MERLIN_WRONG_USE);
    assert_int_equal(merlin_maps_write(f->model, NULL, NULL, f->output), MERLIN_WRONG_USE);
    assert_int_equal(merlin_maps_read(NULL, &maps), MERLIN_WRONG_USE);
    assert_int_equal(merlin_relight(f->model, &maps, NULL, MERLIN_BY_BRDF, &image), MERLIN_WRONG_USE);
    assert_int_equal(merlin_environment_read(NULL, 0, 0, &room), MERLIN_WRONG_USE);
    assert_int_equal(merlin_relight_environment(NULL, &maps, NULL, light, MERLIN_BY_BRDF, &image), MERLIN_WRONG_USE);
    assert_string_equal(merlin_model_name(NULL), "");
    merlin_image_free(NULL);
    merlin_maps_free(NULL);
    merlin_environment_free(NULL);
    merlin_model_close(NULL);
}

static void what_was_to_be_filled_in_is_empty_after_wrong_use(void **state)
{
    const fixture *f = *state;
    const float light[3] = {0};
    merlin_maps maps;
    merlin_image image, alpha;
    merlin_model *model = f->model;
    merlin_environment *room = (merlin_environment *)f->model;
    memset(&image, 0x55, sizeof image);
    memset(&alpha, 0x55, sizeof alpha);
    assert_int_equal(merlin_image_read(NULL, &image, &alpha), MERLIN_WRONG_USE);
    assert_true(!image.data && !alpha.data);
    memset(&image, 0x55, sizeof image);
    assert_int_equal(merlin_mask_read(NULL, &image), MERLIN_WRONG_USE);
    assert_null(image.data);
    assert_int_equal(merlin_model_open(NULL, &model), MERLIN_WRONG_USE);
    assert_null(model);
    assert_int_equal(merlin_environment_read(NULL, 0, 0, &room), MERLIN_WRONG_USE);
    assert_null(room);
    memset(&maps, 0x55, sizeof maps);
    assert_int_equal(merlin_estimate(NULL, &f->photo, NULL, NULL, &maps), MERLIN_WRONG_USE);
    assert_null(maps.albedo.data);
    memset(&maps, 0x55, sizeof maps);
    assert_int_equal(merlin_maps_read(NULL, &maps), MERLIN_WRONG_USE);
    assert_null(maps.albedo.data);
    memset(&image, 0x55, sizeof image);
    assert_int_equal(merlin_relight(NULL, &maps, light, MERLIN_BY_BRDF, &image), MERLIN_WRONG_USE);
    assert_null(image.data);
    memset(&image, 0x55, sizeof image);
    assert_int_equal(merlin_relight_environment(NULL, &maps, NULL, light, MERLIN_BY_BRDF, &image), MERLIN_WRONG_USE);
    assert_null(image.data);
}

static void an_output_that_cannot_be_written_leaves_nothing(void **state)
{
    const fixture *f = *state;
    char inside[160];
    merlin_maps maps;
    estimate(f, &maps);
    assert_int_equal(merlin_maps_write(f->model, &maps, NULL, "/proc/merlin"), MERLIN_CANNOT_WRITE);
    snprintf(inside, sizeof inside, "%s/mask.png", f->output);
    assert_int_equal(file_make_folder(inside), OK); /* a folder where a file should go */
    assert_int_equal(merlin_maps_write(f->model, &maps, NULL, f->output), MERLIN_CANNOT_WRITE);
    assert_non_null(strstr(merlin_error(), "mask.png"));
    assert_int_equal(rmdir(inside), 0);
    assert_int_equal(rmdir(f->output), 0);
    char deep[PATH_MAX - 100];
    for (size_t i = (size_t)snprintf(deep, sizeof deep, "%s", f->output); i < sizeof deep; i++)
        deep[i] = i == sizeof deep - 1 ? 0 : i % 200 ? 'x' : '/';
    assert_int_equal(merlin_maps_write(f->model, &maps, NULL, deep), MERLIN_CANNOT_WRITE);
    assert_non_null(strstr(merlin_error(), "too long"));
    assert_false(file_exists(f->output));
    merlin_maps_free(&maps);
}

static void folders_without_maps_are_refused(void **state)
{
    const fixture *f = *state;
    merlin_maps maps;
    assert_int_equal(merlin_maps_read(f->folder, &maps), MERLIN_BAD_INPUT);
    assert_non_null(strstr(merlin_error(), "merlin estimate makes one"));
}

static void lights_that_are_nowhere_are_refused(void **state)
{
    const fixture *f = *state;
    const float nowhere[3] = {0, NAN, 0};
    merlin_maps maps;
    merlin_image image;
    estimate(f, &maps);
    assert_int_equal(merlin_relight(f->model, &maps, nowhere, MERLIN_BY_BRDF, &image), MERLIN_WRONG_USE);
    merlin_maps_free(&maps);
}

static void damaged_weights_are_refused(void **state)
{
    const fixture *f = *state;
    char *data, path[128];
    size_t size;
    merlin_model *model;
    assert_int_equal(file_read(f->weights, 1 << 28, &data, &size), OK);
    snprintf(path, sizeof path, "%s/damaged.safetensors", f->folder);
    assert_int_equal(file_write(path, data, size / 2), OK);
    assert_int_equal(merlin_model_open(path, &model), MERLIN_BAD_INPUT);
    data[size / 2] ^= 1;
    assert_int_equal(file_write(path, data, size), OK);
    assert_int_equal(merlin_model_open(path, &model), MERLIN_BAD_INPUT);
    assert_null(model);
    free(data);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(masks_of_another_size_are_refused),
        cmocka_unit_test(empty_masks_are_refused),
        cmocka_unit_test(an_object_too_thin_for_the_networks_pixels_is_refused_as_that),
        cmocka_unit_test(a_photograph_that_is_too_large_is_refused_before_it_is_decoded),
        cmocka_unit_test(an_alpha_that_shows_nothing_is_refused_by_its_name),
        cmocka_unit_test(only_names_of_pngs_and_jpegs_are_written_to),
        cmocka_unit_test(maps_of_impossible_frames_are_refused),
        cmocka_unit_test(null_pointers_are_refused_and_freed),
        cmocka_unit_test(what_was_to_be_filled_in_is_empty_after_wrong_use),
        cmocka_unit_test(photographs_without_an_object_are_refused),
        cmocka_unit_test(tiny_photographs_and_odd_parameters_are_refused),
        cmocka_unit_test(photographs_with_infinities_are_refused),
        cmocka_unit_test(empty_maps_are_neither_relit_nor_written),
        cmocka_unit_test(an_output_that_cannot_be_written_leaves_nothing),
        cmocka_unit_test(folders_without_maps_are_refused),
        cmocka_unit_test(lights_that_are_nowhere_are_refused),
        cmocka_unit_test(damaged_weights_are_refused),
    };
    return cmocka_run_group_tests(tests, set_up, tear_down);
}
