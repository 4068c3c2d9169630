/* SPDX-License-Identifier: MIT */
#include <OpenEXR/openexr.h>
#include <math.h>
#include <sys/stat.h>
#include <unistd.h>

#include "image/exr/exr.h"
#include "image/read/read.h"

#include "writes.h"

enum { WIDTH = 37, HEIGHT = 41, COUNT = WIDTH * HEIGHT };

static status write_example(const char *path, const float *rgb, const float *depth)
{
    const exr_channel channels[] = {{"depth.Z", depth, 1, false},
                                    {"albedo.R", rgb, 3, false},
                                    {"albedo.G", rgb + 1, 3, false},
                                    {"albedo.B", rgb + 2, 3, false}};
    const exr_attribute attributes[] = {exr_number("fov", 60),
                                        exr_text("shape", "union"),
                                        {.name = "light", .values = {0.25f, -1, 3}, .count = 3},
                                        exr_text("a name that is longer than thirty-one letters", "kept"),
                                        {.name = "not finite", .values = {1, NAN}, .count = 2}};
    return exr_write(path, WIDTH, HEIGHT, channels, 4, attributes, 5);
}

static void fill(float *rgb, float *depth)
{
    for (int i = 0; i < 3 * COUNT; i++)
        rgb[i] = (float)(i % 2048) / 2048; /* exact in half */
    for (int i = 0; i < COUNT; i++)
        depth[i] = 1 + (float)i / 3;
}

static void written_channels_and_attributes_are_read_back(void **state)
{
    (void)state;
    static float rgb[3 * COUNT], depth[COUNT], rgb2[4 * COUNT], depth2[COUNT];
    fill(rgb, depth);
    assert_int_equal(write_example(scratch_path("a.exr"), rgb, depth), OK);
    exr_file *f = NULL;
    assert_int_equal(exr_open(scratch_path("a.exr"), &f), OK);
    assert_int_equal(exr_width(f), WIDTH);
    assert_int_equal(exr_height(f), HEIGHT);
    assert_true(exr_has_channel(f, "albedo.G"));
    assert_false(exr_has_channel(f, "albedo"));
    const exr_target targets[] = {
        {"albedo.B", rgb2 + 2, 4}, {"depth.Z", depth2, 1}, {"albedo.R", rgb2, 4}, {"albedo.G", rgb2 + 1, 4}};
    assert_int_equal(exr_read(f, targets, 4), OK);
    for (int i = 0; i < COUNT; i++) {
        for (int c = 0; c < 3; c++)
            assert_true(rgb2[4 * i + c] == rgb[3 * i + c]);
        /* half keeps 11 significant bits, rounded to nearest: a relative error of 2^-12 at most */
        assert_true(fabsf(depth2[i] - depth[i]) <= depth[i] * 0x1p-11f);
        assert_true(rgb2[4 * i + 3] == 0);
    }
    float number = 0, light[3] = {0}, two[2];
    assert_true(exr_get_numbers(f, "fov", &number, 1));
    assert_true(number == 60);
    assert_true(exr_get_numbers(f, "light", light, 3));
    assert_true(light[0] == 0.25f && light[1] == -1 && light[2] == 3);
    assert_false(exr_get_numbers(f, "light", two, 2));
    assert_false(exr_get_numbers(f, "shape", &number, 1));
    assert_false(exr_get_numbers(f, "none", &number, 1));
    assert_false(exr_get_numbers(f, "not finite", two, 2));
    assert_string_equal(exr_get_text(f, "shape"), "union");
    assert_string_equal(exr_get_text(f, "a name that is longer than thirty-one letters"), "kept");
    assert_null(exr_get_text(f, "none"));
    assert_null(exr_get_text(f, "fov"));
    exr_close(f);
}

static void values_beyond_half_are_clamped(void **state)
{
    (void)state;
    const float values[4] = {1e9f, -INFINITY, 65519, 0x1p-24f};
    float back[4] = {0};
    const exr_channel channel = {"Y", values, 1, false};
    const exr_target target = {"Y", back, 1};
    assert_int_equal(exr_write(scratch_path("b.exr"), 2, 2, &channel, 1, NULL, 0), OK);
    exr_file *f = NULL;
    assert_int_equal(exr_open(scratch_path("b.exr"), &f), OK);
    assert_int_equal(exr_read(f, &target, 1), OK);
    exr_close(f);
    assert_true(back[0] == 65504 && back[1] == -65504 && back[2] == 65504 && back[3] == 0x1p-24f);
}

/* The width is odd, so that floats after halves are not aligned in memory. */
static void full_channels_are_read_back_exactly(void **state)
{
    (void)state;
    static float rgb[3 * COUNT], depth[COUNT], depth2[COUNT], green[COUNT];
    fill(rgb, depth);
    depth[7] = 1e9f;
    depth[8] = -1234.567f;
    const exr_channel channels[] = {
        {"albedo.G", rgb + 1, 3, false}, {"depth.Z", depth, 1, true}, {"z.Y", rgb, 3, false}};
    const exr_target targets[] = {{"depth.Z", depth2, 1}, {"albedo.G", green, 1}};
    assert_int_equal(exr_write(scratch_path("floats.exr"), WIDTH, HEIGHT, channels, 3, NULL, 0), OK);
    exr_file *f = NULL;
    assert_int_equal(exr_open(scratch_path("floats.exr"), &f), OK);
    assert_int_equal(exr_read(f, targets, 2), OK);
    exr_close(f);
    assert_memory_equal(depth2, depth, sizeof depth);
    for (int i = 0; i < COUNT; i++)
        assert_true(green[i] == rgb[3 * i + 1]);
}

static void missing_channel_is_named(void **state)
{
    (void)state;
    float y = 0;
    const exr_channel channel = {"Y", &y, 1, false};
    assert_int_equal(exr_write(scratch_path("c.exr"), 1, 1, &channel, 1, NULL, 0), OK);
    exr_file *f = NULL;
    assert_int_equal(exr_open(scratch_path("c.exr"), &f), OK);
    const exr_target target = {"normal.X", &y, 1};
    assert_int_equal(exr_read(f, &target, 1), MERLIN_BAD_INPUT);
    assert_non_null(strstr(status_message(), "normal.X"));
    assert_non_null(strstr(status_message(), "c.exr"));
    exr_close(f);
}

/* Reads the depth as far as possible and returns whether all of it was read. */
static status read_depth(const char *path)
{
    static float depth[COUNT];
    exr_file *f = NULL;
    status s = exr_open(path, &f);
    if (s != OK) return s;
    assert_int_equal(exr_width(f), WIDTH);
    assert_int_equal(exr_height(f), HEIGHT);
    const exr_target target = {"depth.Z", depth, 1};
    s = exr_read(f, &target, 1);
    exr_close(f);
    return s;
}

static void every_truncation_is_refused(void **state)
{
    (void)state;
    static float rgb[3 * COUNT], depth[COUNT];
    fill(rgb, depth);
    assert_int_equal(write_example(scratch_path("d.exr"), rgb, depth), OK);
    char *data = NULL;
    size_t size = 0;
    assert_int_equal(file_read(scratch_path("d.exr"), 1u << 20, &data, &size), OK);
    for (size_t keep = 0; keep < size; keep += keep < 700 ? 1 : 97) {
        FILE *out = fopen(scratch_path("cut.exr"), "wb");
        assert_non_null(out);
        assert_int_equal(fwrite(data, 1, keep, out), keep);
        fclose(out);
        assert_int_not_equal(read_depth(scratch_path("cut.exr")), OK);
        assert_non_null(strstr(status_message(), "cut.exr"));
        assert_null(strchr(status_message(), '\n'));
    }
    free(data);
}

/* The header claims 256 million pixels, and sixteen follow. */
static void a_small_file_is_not_given_memory_for_very_many_pixels(void **state)
{
    (void)state;
    static const char *const WINDOWS[] = {"dataWindow\0box2i", "displayWindow\0box2i"};
    static const size_t LENGTHS[] = {sizeof "dataWindow\0box2i", sizeof "displayWindow\0box2i"};
    const int32_t vast[4] = {0, 0, 16383, 16383};
    const float grey[16] = {0};
    const exr_channel y = {"Y", grey, 1, false};
    const char *path = scratch_path("vast.exr");
    char *data;
    size_t size;
    assert_int_equal(exr_write(path, 4, 4, &y, 1, NULL, 0), OK);
    assert_int_equal(file_read(path, 1 << 20, &data, &size), OK);
    for (int i = 0; i < 2; i++) {
        char *at = memmem(data, size, WINDOWS[i], LENGTHS[i]);
        assert_non_null(at);
        memcpy(at + LENGTHS[i] + 4, vast, sizeof vast);
    }
    assert_int_equal(file_write(path, data, size), OK);
    free(data);
    img color;
    assert_int_equal(img_read(path, &color, NULL), MERLIN_BAD_INPUT);
    if (!strstr(status_message(), "16384 x 16384 pixels would take 4096 MB")) fail_msg("%s", status_message());
}

static void missing_and_foreign_files_are_refused(void **state)
{
    (void)state;
    exr_file *f = NULL;
    assert_int_equal(exr_open(scratch_path("none.exr"), &f), MERLIN_BAD_INPUT);
    assert_null(f);
    assert_non_null(strstr(status_message(), "none.exr"));
    assert_int_equal(file_write(scratch_path("text.exr"), "not a picture\n", 14), OK);
    assert_int_equal(exr_open(scratch_path("text.exr"), &f), MERLIN_BAD_INPUT);
    assert_null(f);
    assert_int_equal(mkfifo(scratch_path("pipe.exr"), 0600), 0);
    alarm(20); /* opening a pipe without a writer would block forever */
    assert_int_equal(exr_open(scratch_path("pipe.exr"), &f), MERLIN_BAD_INPUT);
    alarm(0);
    assert_non_null(strstr(status_message(), "not a plain file"));
}

static void failed_write_leaves_nothing(void **state)
{
    (void)state;
    float y = 0;
    const exr_channel channel = {"Y", &y, 1, false};
    assert_int_equal(exr_write(scratch_path("no/such/folder.exr"), 1, 1, &channel, 1, NULL, 0), MERLIN_CANNOT_WRITE);
    assert_non_null(strstr(status_message(), "folder.exr"));
    assert_null(strchr(status_message(), '~'));
    /* the header is refused after the file was begun: an attribute may not change the type of a standard one */
    const exr_attribute wrong = exr_text("screenWindowWidth", "wide");
    assert_int_equal(exr_write(scratch_path("wrong.exr"), 1, 1, &channel, 1, &wrong, 1), MERLIN_CANNOT_WRITE);
    assert_false(file_exists(scratch_path("wrong.exr")));
    const exr_channel twice[] = {{"Y", &y, 1, false}, {"Y", &y, 1, false}};
    assert_int_equal(exr_write(scratch_path("twice.exr"), 1, 1, twice, 2, NULL, 0), MERLIN_WRONG_USE);
    assert_false(file_exists(scratch_path("twice.exr")));
    static float rgb[3 * COUNT], depth[COUNT];
    fill(rgb, depth);
    limit_file_size(500); /* inside the first chunk */
    status full = write_example(scratch_path("full.exr"), rgb, depth);
    limit_file_size(0);
    assert_int_equal(full, MERLIN_CANNOT_WRITE);
    assert_non_null(strstr(status_message(), "full.exr"));
    assert_false(file_exists(scratch_path("full.exr")));
    assert_false(folder_has_leftovers());
}

/* Writes a tiled file of float and uint channels with the library itself. */
static void write_tiles(const char *path, const float *depth, const uint32_t *id, int tile)
{
    exr_context_t c = NULL;
    exr_context_initializer_t init = EXR_DEFAULT_CONTEXT_INITIALIZER;
    int part = 0;
    assert_int_equal(exr_start_write(&c, path, EXR_WRITE_FILE_DIRECTLY, &init), 0);
    assert_int_equal(exr_add_part(c, "tiles", EXR_STORAGE_TILED, &part), 0);
    assert_int_equal(exr_initialize_required_attr_simple(c, 0, WIDTH, HEIGHT, EXR_COMPRESSION_NONE), 0);
    assert_int_equal(
        exr_set_tile_descriptor(c, 0, (uint32_t)tile, (uint32_t)tile, EXR_TILE_ONE_LEVEL, EXR_TILE_ROUND_DOWN), 0);
    assert_int_equal(exr_add_channel(c, 0, "depth.Z", EXR_PIXEL_FLOAT, EXR_PERCEPTUALLY_LOGARITHMIC, 1, 1), 0);
    assert_int_equal(exr_add_channel(c, 0, "id.Y", EXR_PIXEL_UINT, EXR_PERCEPTUALLY_LOGARITHMIC, 1, 1), 0);
    assert_int_equal(exr_write_header(c), 0);
    exr_encode_pipeline_t e = EXR_ENCODE_PIPELINE_INITIALIZER;
    for (int y = 0, first = 1; y < HEIGHT; y += tile) {
        for (int x = 0; x < WIDTH; x += tile, first = 0) {
            exr_chunk_info_t chunk;
            assert_int_equal(exr_write_tile_chunk_info(c, 0, x / tile, y / tile, 0, 0, &chunk), 0);
            assert_int_equal((first ? exr_encoding_initialize : exr_encoding_update)(c, 0, &chunk, &e), 0);
            for (int i = 0; i < 2; i++) {
                const void *from = i == 0 ? (const void *)(depth + y * WIDTH + x) : (const void *)(id + y * WIDTH + x);
                e.channels[i].encode_from_ptr = from;
                e.channels[i].user_pixel_stride = 4;
                e.channels[i].user_line_stride = 4 * WIDTH;
            }
            if (first) assert_int_equal(exr_encoding_choose_default_routines(c, 0, &e), 0);
            assert_int_equal(exr_encoding_run(c, 0, &e), 0);
        }
    }
    exr_encoding_destroy(c, &e);
    assert_int_equal(exr_finish(&c), 0);
}

static void tiles_of_float_and_uint_are_read(void **state)
{
    (void)state;
    static float depth[COUNT], depth2[COUNT], id2[COUNT];
    static uint32_t id[COUNT];
    for (int i = 0; i < COUNT; i++) {
        depth[i] = 0.1f * (float)i;
        id[i] = (uint32_t)i;
    }
    write_tiles(scratch_path("tiles.exr"), depth, id, 16);
    exr_file *f = NULL;
    assert_int_equal(exr_open(scratch_path("tiles.exr"), &f), OK);
    const exr_target targets[] = {{"id.Y", id2, 1}, {"depth.Z", depth2, 1}};
    assert_int_equal(exr_read(f, targets, 2), OK);
    exr_close(f);
    for (int i = 0; i < COUNT; i++)
        assert_true(depth2[i] == depth[i] && id2[i] == (float)i);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(written_channels_and_attributes_are_read_back),
        cmocka_unit_test(values_beyond_half_are_clamped),
        cmocka_unit_test(full_channels_are_read_back_exactly),
        cmocka_unit_test(missing_channel_is_named),
        cmocka_unit_test(every_truncation_is_refused),
        cmocka_unit_test(a_small_file_is_not_given_memory_for_very_many_pixels),
        cmocka_unit_test(missing_and_foreign_files_are_refused),
        cmocka_unit_test(failed_write_leaves_nothing),
        cmocka_unit_test(tiles_of_float_and_uint_are_read),
    };
    return cmocka_run_group_tests(tests, scratch_open, scratch_close);
}
