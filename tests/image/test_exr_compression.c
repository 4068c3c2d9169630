/* SPDX-License-Identifier: MIT */
/* Compressed EXR files of other programs: what this OpenEXR decompresses is read, the rest is refused by name. */
#include <OpenEXR/openexr.h>

#include "base/rng.h"
#include "image/exr/exr.h"

#include "writes.h"

enum { WIDTH = 37, HEIGHT = 41, COUNT = WIDTH * HEIGHT };

/* Writes a line of half floats, compressed by ZIP, into a file that states another method. */
static void write_line(const char *path, const float *value, int said)
{
    static const char ZIP[] = "compression\0compression\0\1\0\0\0\3";
    const exr_channel channel = {"depth.Z", value, 1, false};
    char *bytes = NULL;
    size_t size = 0;
    assert_int_equal(exr_write(path, WIDTH, 1, &channel, 1, NULL, 0), OK);
    assert_int_equal(file_read(path, 1 << 20, &bytes, &size), OK);
    char *at = memmem(bytes, size, ZIP, sizeof ZIP - 1);
    assert_non_null(at);
    at[sizeof ZIP - 2] = (char)said;
    assert_int_equal(file_write(path, bytes, size), OK);
    free(bytes);
}

/* Writes a picture of floats that the library compresses, and returns the library's result. */
static exr_result_t write_packed(const char *path, const float *value, exr_compression_t how)
{
    exr_context_t c = NULL;
    exr_context_initializer_t init = EXR_DEFAULT_CONTEXT_INITIALIZER;
    int part = 0, lines = 0;
    assert_int_equal(exr_start_write(&c, path, EXR_WRITE_FILE_DIRECTLY, &init), 0);
    assert_int_equal(exr_add_part(c, "lines", EXR_STORAGE_SCANLINE, &part), 0);
    assert_int_equal(exr_initialize_required_attr_simple(c, 0, WIDTH, HEIGHT, how), 0);
    assert_int_equal(exr_add_channel(c, 0, "depth.Z", EXR_PIXEL_FLOAT, EXR_PERCEPTUALLY_LOGARITHMIC, 1, 1), 0);
    assert_int_equal(exr_write_header(c), 0);
    assert_int_equal(exr_get_scanlines_per_chunk(c, 0, &lines), 0);
    exr_encode_pipeline_t e = EXR_ENCODE_PIPELINE_INITIALIZER;
    exr_result_t said = EXR_ERR_SUCCESS;
    for (int y = 0; said == EXR_ERR_SUCCESS && y < HEIGHT; y += lines) {
        exr_chunk_info_t chunk;
        assert_int_equal(exr_write_scanline_chunk_info(c, 0, y, &chunk), 0);
        assert_int_equal((y == 0 ? exr_encoding_initialize : exr_encoding_update)(c, 0, &chunk, &e), 0);
        e.channels[0].encode_from_ptr = (const void *)(value + y * WIDTH);
        e.channels[0].user_pixel_stride = 4;
        e.channels[0].user_line_stride = 4 * WIDTH;
        if (y == 0) said = exr_encoding_choose_default_routines(c, 0, &e);
        if (said == EXR_ERR_SUCCESS) said = exr_encoding_run(c, 0, &e);
    }
    exr_encoding_destroy(c, &e);
    exr_finish(&c);
    return said;
}

static status read_depth(const char *path, float *value)
{
    exr_file *f = NULL;
    status s = exr_open(path, &f);
    if (s != OK) return s;
    const exr_target target = {"depth.Z", value, 1};
    s = exr_read(f, &target, 1);
    exr_close(f);
    return s;
}

static void read_by_library(const char *path, float *value)
{
    exr_context_t c = NULL;
    exr_context_initializer_t init = EXR_DEFAULT_CONTEXT_INITIALIZER;
    int lines = 0;
    exr_decode_pipeline_t d = EXR_DECODE_PIPELINE_INITIALIZER;
    assert_int_equal(exr_start_read(&c, path, &init), 0);
    assert_int_equal(exr_get_scanlines_per_chunk(c, 0, &lines), 0);
    for (int y = 0; y < HEIGHT; y += lines) {
        exr_chunk_info_t chunk;
        assert_int_equal(exr_read_scanline_chunk_info(c, 0, y, &chunk), 0);
        assert_int_equal((y == 0 ? exr_decoding_initialize : exr_decoding_update)(c, 0, &chunk, &d), 0);
        d.channels[0].decode_to_ptr = (uint8_t *)(value + y * WIDTH);
        d.channels[0].user_pixel_stride = 4;
        d.channels[0].user_line_stride = 4 * WIDTH;
        d.channels[0].user_bytes_per_element = 4;
        d.channels[0].user_data_type = EXR_PIXEL_FLOAT;
        if (y == 0) assert_int_equal(exr_decoding_choose_default_routines(c, 0, &d), 0);
        assert_int_equal(exr_decoding_run(c, 0, &d), 0);
    }
    exr_decoding_destroy(c, &d);
    exr_finish(&c);
}

static void zip_is_the_same_as_the_library_s(void **state)
{
    (void)state;
    static float depth[COUNT], depth2[COUNT];
    const exr_compression_t ways[] = {EXR_COMPRESSION_ZIP, EXR_COMPRESSION_ZIPS};
    const char *path = scratch_path("zip.exr");
    for (int i = 0; i < COUNT; i++)
        depth[i] = (float)(i / WIDTH) - 0.37f * (float)(i % WIDTH % 11);
    for (int w = 0; w < 2; w++) {
        assert_int_equal(write_packed(path, depth, ways[w]), 0);
        memset(depth2, 0, sizeof depth2);
        assert_int_equal(read_depth(path, depth2), OK);
        assert_memory_equal(depth2, depth, sizeof depth);
    }
    const exr_channel channel = {"depth.Z", depth, 1, true};
    assert_int_equal(exr_write(path, WIDTH, HEIGHT, &channel, 1, NULL, 0), OK);
    memset(depth2, 0, sizeof depth2);
    read_by_library(path, depth2);
    assert_memory_equal(depth2, depth, sizeof depth);
}

/* The last bytes of a file are pixels of its last chunk. */
static void damage_is_refused(void **state)
{
    (void)state;
    static float depth[COUNT], depth2[COUNT];
    const char *path = scratch_path("damaged.exr");
    char *bytes = NULL;
    size_t size = 0;
    for (int i = 0; i < COUNT; i++)
        depth[i] = (float)(i % 13);
    const exr_channel channel = {"depth.Z", depth, 1, true};
    assert_int_equal(exr_write(path, WIDTH, HEIGHT, &channel, 1, NULL, 0), OK);
    assert_int_equal(file_read(path, 1 << 20, &bytes, &size), OK);
    for (size_t back = 1; back < 40; back++) {
        bytes[size - back] = (char)(bytes[size - back] ^ 0x5a);
        assert_int_equal(file_write(path, bytes, size), OK);
        assert_int_equal(read_depth(path, depth2), MERLIN_BAD_INPUT);
        bytes[size - back] = (char)(bytes[size - back] ^ 0x5a);
    }
    free(bytes);
}

/* Noise does not get smaller by compression, and is stored raw in such files. */
static void what_b44_could_not_pack_is_read_as_it_was(void **state)
{
    (void)state;
    float depth[WIDTH], depth2[WIDTH];
    rng r = rng_at(7, 0, 0);
    for (int i = 0; i < WIDTH; i++)
        depth[i] = (float)(rng_u32(&r) % 2048) / 2048; /* exact in half */
    write_line(scratch_path("b44.exr"), depth, EXR_COMPRESSION_B44);
    assert_int_equal(read_depth(scratch_path("b44.exr"), depth2), OK);
    assert_memory_equal(depth2, depth, sizeof depth);
}

/* DWA is lossy in colour channels only. The C library of OpenEXR 3.1.5 does not support it, that of 3.1.13 does. */
static void what_dwa_packed_is_read_or_refused_with_what_to_do(void **state)
{
    (void)state;
    static float depth[COUNT], depth2[COUNT];
    for (int i = 0; i < COUNT; i++)
        depth[i] = 1 + 0.01f * (float)(i % WIDTH);
    const exr_compression_t ways[] = {EXR_COMPRESSION_DWAA, EXR_COMPRESSION_DWAB};
    for (int w = 0; w < 2; w++) {
        const char *path = scratch_path("dwa.exr");
        exr_result_t packed = write_packed(path, depth, ways[w]);
        if (packed == EXR_ERR_SUCCESS) {
            assert_int_equal(read_depth(path, depth2), OK);
            assert_memory_equal(depth2, depth, sizeof depth);
            continue;
        }
        assert_int_equal(packed, EXR_ERR_FEATURE_NOT_IMPLEMENTED);
        write_line(path, depth, ways[w]);
        assert_int_equal(read_depth(path, depth2), MERLIN_BAD_INPUT);
        assert_non_null(strstr(status_message(), "dwa.exr"));
        assert_non_null(strstr(status_message(), "save it with ZIP"));
    }
}

/* The library takes an unknown method for ZIP. */
static void compression_of_another_age_is_refused_with_what_to_do(void **state)
{
    (void)state;
    float depth[WIDTH] = {1}, depth2[WIDTH];
    write_line(scratch_path("new.exr"), depth, 200);
    assert_int_equal(read_depth(scratch_path("new.exr"), depth2), MERLIN_BAD_INPUT);
    assert_non_null(strstr(status_message(), "new.exr"));
    assert_non_null(strstr(status_message(), "save it with ZIP"));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(zip_is_the_same_as_the_library_s),
        cmocka_unit_test(damage_is_refused),
        cmocka_unit_test(what_b44_could_not_pack_is_read_as_it_was),
        cmocka_unit_test(what_dwa_packed_is_read_or_refused_with_what_to_do),
        cmocka_unit_test(compression_of_another_age_is_refused_with_what_to_do),
    };
    return cmocka_run_group_tests(tests, scratch_open, scratch_close);
}
