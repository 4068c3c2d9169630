/* SPDX-License-Identifier: MIT */
/* EXR pictures: channels, windows, chromaticities, parts, alpha. */
#include "read_fixture.h"

static void exr_pictures_are_found_by_their_channels(void **state)
{
    (void)state;
    img picture, color = {0}, alpha = {0};
    assert_int_equal(img_new(&picture, 5, 3, 3), OK);
    for (int i = 0; i < 45; i++)
        picture.data[i] = (float)i / 8;
    const exr_channel rgb[] = {
        {"R", picture.data, 3, false}, {"G", picture.data + 1, 3, false}, {"B", picture.data + 2, 3, false}};
    assert_int_equal(exr_write(scratch_path("rgb.exr"), 5, 3, rgb, 3, NULL, 0), OK);
    assert_int_equal(img_read(scratch_path("rgb.exr"), &color, &alpha), OK);
    assert_memory_equal(color.data, picture.data, 45 * sizeof(float));
    assert_null(alpha.data);
    img_free(&color);
    const exr_channel layer[] = {{"depth.Z", picture.data, 1, false},
                                 {"env.R", picture.data, 3, false},
                                 {"env.G", picture.data + 1, 3, false},
                                 {"env.B", picture.data + 2, 3, false}};
    assert_int_equal(exr_write(scratch_path("layer.exr"), 5, 3, layer, 4, NULL, 0), OK);
    assert_int_equal(img_read(scratch_path("layer.exr"), &color, &alpha), OK);
    assert_memory_equal(color.data, picture.data, 45 * sizeof(float));
    img_free(&color);
    const exr_channel own[] = {{"view.R", picture.data, 3, false},
                               {"view.G", picture.data + 1, 3, false},
                               {"view.B", picture.data + 2, 3, false},
                               {"view.A", picture.data, 1, false},
                               {"mask.A", picture.data + 1, 1, false}};
    assert_int_equal(exr_write(scratch_path("own.exr"), 5, 3, own, 5, NULL, 0), OK);
    assert_int_equal(img_read(scratch_path("own.exr"), &color, &alpha), OK);
    assert_non_null(alpha.data);
    assert_true(alpha.data[3] == picture.data[3]);
    for (int i = 0; i < 45; i++) /* as below */
        assert_true(color.data[i] == picture.data[i] / (i < 3 || i >= 24 ? 1 : picture.data[i / 3]));
    img_free(&color);
    img_free(&alpha);
    const exr_channel grey[] = {{"Y", picture.data, 1, false}, {"A", picture.data, 1, false}};
    assert_int_equal(exr_write(scratch_path("grey.exr"), 5, 3, grey, 2, NULL, 0), OK);
    assert_int_equal(img_read(scratch_path("grey.exr"), &color, &alpha), OK);
    assert_true(color.data[27] == picture.data[9] && color.data[29] == picture.data[9]);
    assert_true(alpha.data[3] == picture.data[3] && alpha.data[14] == 1);
    img_free(&color);
    img_free(&alpha);
    const exr_channel two[] = {{"R", picture.data, 1, false}, {"G", picture.data, 1, false}};
    assert_int_equal(exr_write(scratch_path("two.exr"), 5, 3, two, 2, NULL, 0), OK);
    assert_int_equal(img_read(scratch_path("two.exr"), &color, NULL), MERLIN_BAD_INPUT);
    assert_non_null(strstr(status_message(), "it has no channel B beside the others of R, G and B"));
    assert_int_equal(exr_write(scratch_path("depth.exr"), 5, 3, layer, 1, NULL, 0), OK);
    assert_int_equal(img_read(scratch_path("depth.exr"), &color, NULL), MERLIN_BAD_INPUT);
    img_free(&picture);
}

/* Maps and renderings have layers of colour, the first of which by name is hardly ever what the picture shows. */
static void an_exr_is_the_layer_that_it_shows(void **state)
{
    (void)state;
    static const char *const layers[][2] = {{"albedo", "photo"},
                                            {"ViewLayer.AO", "ViewLayer.Combined"},
                                            {"diffuse", "RGBA"},
                                            {"C.albedo", "a.Beauty"},
                                            {"diffuse", "specular"}};
    for (size_t k = 0; k < sizeof layers / sizeof *layers; k++) {
        const bool by_name = k < 4;
        float values[7] = {0.125f, 0.25f, 0.375f, 0.5f, 0.75f, 1, 0.5f};
        char name[6][64];
        exr_channel channels[7];
        img color, alpha;
        for (size_t i = 0; i < 6; i++) {
            snprintf(name[i], sizeof name[i], "%s.%c", layers[k][i / 3], "RGB"[i % 3]);
            channels[i] = (exr_channel){name[i], values + i, 1, false};
        }
        channels[6] = (exr_channel){"mask.A", values + 6, 1, false};
        assert_int_equal(exr_write(scratch_path("layers.exr"), 1, 1, channels, 7, NULL, 0), OK);
        assert_int_equal(img_read(scratch_path("layers.exr"), &color, &alpha), OK);
        for (int c = 0; c < 3; c++) /* maps' photograph is multiplied by the mask */
            assert_true(color.data[c] == values[by_name ? 3 + c : c] * (k == 0 ? 2 : 1));
        img_free(&color);
        img_free(&alpha);
    }
}

/* Writes one line of floats, uncompressed. */
static void write_part(exr_context_t file, int part, int first_line, int channels, const float *line, int width)
{
    exr_encode_pipeline_t e = EXR_ENCODE_PIPELINE_INITIALIZER;
    exr_chunk_info_t chunk;
    assert_int_equal(exr_write_scanline_chunk_info(file, part, first_line, &chunk), 0);
    assert_int_equal(exr_encoding_initialize(file, part, &chunk, &e), 0);
    for (int i = 0; i < channels; i++) {
        e.channels[i].encode_from_ptr = (const uint8_t *)(line + i * width);
        e.channels[i].user_pixel_stride = 4;
        e.channels[i].user_line_stride = 4 * width;
    }
    assert_int_equal(exr_encoding_choose_default_routines(file, part, &e), 0);
    assert_int_equal(exr_encoding_run(file, part, &e), 0);
    exr_encoding_destroy(file, &e);
}

static void add_part(exr_context_t file, const char *name, const char *channels, int width)
{
    int part = 0;
    assert_int_equal(exr_add_part(file, name, EXR_STORAGE_SCANLINE, &part), 0);
    assert_int_equal(exr_initialize_required_attr_simple(file, part, width, 1, EXR_COMPRESSION_NONE), 0);
    for (; *channels; channels++) {
        const char channel[] = {*channels, 0};
        assert_int_equal(exr_add_channel(file, part, channel, EXR_PIXEL_FLOAT, EXR_PERCEPTUALLY_LINEAR, 1, 1), 0);
    }
}

static exr_attr_box2i_t box(int left, int top, int right, int bottom)
{
    exr_attr_box2i_t b;
    b.min.x = left;
    b.min.y = top;
    b.max.x = right;
    b.max.y = bottom;
    return b;
}

/* Writes two pixels, R = 1 and G = 1, with the given windows and chromaticities (NULL: none). */
static void write_view(const char *name, const exr_attr_box2i_t *data, const exr_attr_box2i_t *display,
                       const exr_attr_chromaticities_t *primaries)
{
    static const float bgr[6] = {0, 0, 0, 1, 1, 0};
    exr_context_initializer_t quiet = EXR_DEFAULT_CONTEXT_INITIALIZER;
    exr_context_t file;
    assert_int_equal(exr_start_write(&file, scratch_path(name), EXR_WRITE_FILE_DIRECTLY, &quiet), 0);
    add_part(file, "picture", "BGR", 2);
    assert_int_equal(exr_set_data_window(file, 0, data), 0);
    assert_int_equal(exr_set_display_window(file, 0, display), 0);
    if (primaries) assert_int_equal(exr_attr_set_chromaticities(file, 0, "chromaticities", primaries), 0);
    assert_int_equal(exr_write_header(file), 0);
    write_part(file, 0, data->min.y, 3, bgr, 2);
    assert_int_equal(exr_finish(&file), 0);
}

/* The numbers are those of ITU-R BT.2087 and of the usual ACEScg matrix (Bradford). */
static void the_chromaticities_of_an_exr_are_honoured(void **state)
{
    (void)state;
    const exr_attr_box2i_t window = box(0, 0, 1, 0);
    static const exr_attr_chromaticities_t rec2020 = {0.708f, 0.292f, 0.170f, 0.797f, 0.131f, 0.046f, 0.3127f, 0.3290f},
                                           acescg = {0.713f, 0.293f, 0.165f,   0.830f,
                                                     0.128f, 0.044f, 0.32168f, 0.33767f},
                                           none = {0};
    static const float wide[6] = {1.6605f, -0.1246f, -0.0182f, -0.5876f, 1.1329f, -0.1006f};
    static const float aces[6] = {1.70505f, -0.13026f, -0.02400f, -0.62179f, 1.14080f, -0.12897f};
    static const float same[6] = {1, 0, 0, 0, 1, 0};
    const exr_attr_chromaticities_t *primaries[] = {&rec2020, &acescg, NULL};
    const float *expected[] = {wide, aces, same};
    img color;
    int bits;
    for (int k = 0; k < 3; k++) {
        write_view("view.exr", &window, &window, primaries[k]);
        assert_int_equal(img_read(scratch_path("view.exr"), &color, NULL), OK);
        for (int i = 0; i < 6; i++)
            assert_float_equal(color.data[i], expected[k][i], 2e-4);
        img_free(&color);
    }
    write_view("view.exr", &window, &window, &acescg);
    assert_int_equal(img_read_samples(scratch_path("view.exr"), true, &color, &bits), OK);
    assert_memory_equal(color.data, same, sizeof same); /* a measurement is not converted */
    img_free(&color);
    write_view("view.exr", &window, &window, &none);
    assert_int_equal(img_read(scratch_path("view.exr"), &color, NULL), MERLIN_BAD_INPUT);
}

/* Programs crop their pictures to what is not black, and render more than is visible. */
static void an_exr_is_what_its_display_window_shows(void **state)
{
    (void)state;
    const exr_attr_box2i_t data = box(3, -1, 4, -1);
    const exr_attr_box2i_t around = box(2, -2, 5, 0), part = box(4, -1, 4, -1), elsewhere = box(9, 9, 10, 9);
    img color;
    int width, height;
    write_view("around.exr", &data, &around, NULL);
    assert_int_equal(img_read_size(scratch_path("around.exr"), &width, &height), OK);
    assert_true(width == 4 && height == 3);
    assert_int_equal(img_read(scratch_path("around.exr"), &color, NULL), OK);
    for (int i = 0; i < 36; i++) /* red in the second, green in the third pixel of the middle row */
        assert_true(color.data[i] == (i == 15 || i == 19));
    img_free(&color);
    write_view("part.exr", &data, &part, NULL);
    assert_int_equal(img_read(scratch_path("part.exr"), &color, NULL), OK);
    assert_true(color.width == 1 && color.height == 1 && color.data[0] == 0 && color.data[1] == 1);
    img_free(&color);
    write_view("elsewhere.exr", &data, &elsewhere, NULL);
    assert_int_equal(img_read(scratch_path("elsewhere.exr"), &color, NULL), OK);
    assert_true(color.width == 2 && color.height == 1 && color.data[0] == 0 && color.data[4] == 0);
    img_free(&color);
}

/* Renderers write one part a layer, in any order. */
static void an_exr_is_its_first_part_that_is_a_picture(void **state)
{
    (void)state;
    static const float depth[3] = {7, 8, 9}, abgr[8] = {1, 0.25f, 3, 4, 5, 6, 7, 8};
    exr_context_initializer_t quiet = EXR_DEFAULT_CONTEXT_INITIALIZER;
    exr_context_t file;
    img color = {0}, alpha = {0};
    int width, height;
    assert_int_equal(exr_start_write(&file, scratch_path("parts.exr"), EXR_WRITE_FILE_DIRECTLY, &quiet), 0);
    add_part(file, "depth", "Z", 3);
    add_part(file, "picture", "ABGR", 2);
    assert_int_equal(exr_write_header(file), 0);
    write_part(file, 0, 0, 1, depth, 3);
    write_part(file, 1, 0, 4, abgr, 2);
    assert_int_equal(exr_finish(&file), 0);
    assert_int_equal(img_read_size(scratch_path("parts.exr"), &width, &height), OK);
    assert_int_equal(width, 2);
    assert_int_equal(img_read(scratch_path("parts.exr"), &color, &alpha), OK);
    assert_true(color.data[0] == 7 && color.data[1] == 5 && color.data[2] == 3 && color.data[3] == 32);
    assert_non_null(alpha.data);
    assert_true(alpha.data[0] == 1 && alpha.data[1] == 0.25f);
    img_free(&color);
    img_free(&alpha);
}

/* OpenEXR's convention is premultiplied colour, which Blender follows. */
static void colour_of_an_exr_is_not_times_its_alpha(void **state)
{
    (void)state;
    float rgba[16] = {2, 1, 0.5f, 1, 1, 0.5f, 0.25f, 0.5f, 0.5f, 0.25f, 0.125f, 0.25f, 3, 3, 3, 0};
    const float own[12] = {2, 1, 0.5f, 2, 1, 0.5f, 2, 1, 0.5f, 3, 3, 3};
    const exr_channel channels[] = {
        {"R", rgba, 4, false}, {"G", rgba + 1, 4, false}, {"B", rgba + 2, 4, false}, {"A", rgba + 3, 4, false}};
    img color = {0}, alpha = {0};
    assert_int_equal(exr_write(scratch_path("rgba.exr"), 4, 1, channels, 4, NULL, 0), OK);
    assert_int_equal(img_read(scratch_path("rgba.exr"), &color, &alpha), OK);
    assert_memory_equal(color.data, own, sizeof own);
    for (int i = 0; i < 4; i++)
        assert_true(alpha.data[i] == rgba[4 * i + 3]);
    img_free(&color);
    img_free(&alpha);
    /* without alpha it is seen over black */
    assert_int_equal(img_read(scratch_path("rgba.exr"), &color, NULL), OK);
    assert_true(color.data[3] == 1);
    img_free(&color);
}

/* These are files of merlin estimate. */
static void the_mask_of_maps_is_their_alpha(void **state)
{
    (void)state;
    float albedo[9] = {0.5f, 0.25f, 0.125f, 0.5f, 0.25f, 0.125f}, cover[3] = {1, 0.25f, 0};
    const exr_channel maps[] = {{"albedo.R", albedo, 3, false},
                                {"albedo.G", albedo + 1, 3, false},
                                {"albedo.B", albedo + 2, 3, false},
                                {"mask.A", cover, 1, false}};
    img color = {0}, alpha = {0}, mask = {0};
    assert_int_equal(exr_write(scratch_path("maps.exr"), 3, 1, maps, 4, NULL, 0), OK);
    assert_int_equal(img_read(scratch_path("maps.exr"), &color, &alpha), OK);
    assert_memory_equal(color.data, albedo, sizeof albedo);
    assert_int_equal(img_read_mask(scratch_path("maps.exr"), &mask), OK);
    assert_memory_equal(mask.data, cover, sizeof cover);
    assert_non_null(alpha.data);
    assert_memory_equal(alpha.data, cover, sizeof cover);
    img_free(&color);
    img_free(&alpha);
    img_free(&mask);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(exr_pictures_are_found_by_their_channels),
        cmocka_unit_test(an_exr_is_the_layer_that_it_shows),
        cmocka_unit_test(an_exr_is_its_first_part_that_is_a_picture),
        cmocka_unit_test(the_chromaticities_of_an_exr_are_honoured),
        cmocka_unit_test(an_exr_is_what_its_display_window_shows),
        cmocka_unit_test(colour_of_an_exr_is_not_times_its_alpha),
        cmocka_unit_test(the_mask_of_maps_is_their_alpha),
    };
    return cmocka_run_group_tests(tests, start, scratch_close);
}
