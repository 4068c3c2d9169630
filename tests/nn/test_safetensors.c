/* SPDX-License-Identifier: MIT */
#include "nn/safetensors.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "base/file.h"
#include "base/half.h"
#include "scratch.h"

#include <cmocka.h>

static char *path;

static int open_folder(void **state)
{
    scratch_open(state);
    path = file_join(scratch, "w.safetensors");
    return path ? 0 : -1;
}

static int close_folder(void **state)
{
    free(path);
    return scratch_close(state);
}

static const float values[6] = {1.5f, -2, 0.25f, 3, -0.125f, 1000};
static const uint16_t halves[3] = {0x3c00, 0xc000, 0x0001}, bfloats[2] = {0x3f80, 0xbf80};
static const int64_t number = -7;

static void write_sample(void)
{
    const safetensors_tensor tensors[] = {
        {"encoder.conv1.weight", SAFETENSORS_F32, 4, {1, 2, 3, 1}, 6, values},
        {"half", SAFETENSORS_F16, 1, {3}, 3, halves},
        {"bfloat \"quoted\"", SAFETENSORS_BF16, 2, {2, 1}, 2, bfloats},
        {"empty", SAFETENSORS_F32, 1, {0}, 0, NULL},
        {"step", SAFETENSORS_I64, 0, {0}, 1, &number},
    };
    const char *const metadata[][2] = {{"config", "{\"name\": \"tiny\"}"}, {"author", "ä"}};
    assert_int_equal(safetensors_write(path, tensors, 5, metadata, 2), OK);
}

static void what_was_written_is_read(void **state)
{
    (void)state;
    write_sample();
    safetensors_file *f = NULL;
    assert_int_equal(safetensors_open(path, &f), OK);
    assert_int_equal(safetensors_count(f), 5);
    const safetensors_tensor *t = safetensors_find(f, "encoder.conv1.weight");
    assert_non_null(t);
    assert_int_equal(t->rank, 4), assert_int_equal(t->shape[2], 3), assert_int_equal(t->count, 6);
    float out[6];
    assert_int_equal(safetensors_to_float(t, out), OK);
    assert_memory_equal(out, values, sizeof values);
    assert_int_equal(safetensors_to_float(safetensors_find(f, "half"), out), OK);
    assert_true(out[0] == 1 && out[1] == -2 && out[2] == 0x1p-24f);
    assert_int_equal(safetensors_to_float(safetensors_find(f, "bfloat \"quoted\""), out), OK);
    assert_true(out[0] == 1 && out[1] == -1);
    assert_int_equal(safetensors_find(f, "empty")->count, 0);
    assert_int_equal(safetensors_find(f, "step")->rank, 0);
    assert_int_equal(safetensors_to_float(safetensors_find(f, "step"), out), MERLIN_BAD_INPUT);
    assert_memory_equal(safetensors_find(f, "step")->data, &number, sizeof number);
    assert_string_equal(safetensors_metadata(f, "config"), "{\"name\": \"tiny\"}");
    assert_string_equal(safetensors_metadata(f, "author"), "ä");
    assert_null(safetensors_metadata(f, "nobody"));
    assert_null(safetensors_find(f, "nobody"));
    safetensors_close(f);
}

static void tensors_are_given_in_their_order_in_the_file(void **state)
{
    (void)state;
    write_sample();
    safetensors_file *f = NULL;
    assert_int_equal(safetensors_open(path, &f), OK);
    assert_string_equal(safetensors_at(f, 0)->name, "encoder.conv1.weight");
    assert_string_equal(safetensors_at(f, 1)->name, "half");
    safetensors_close(f);
}

static char *sample_bytes(size_t *size)
{
    char *bytes = NULL;
    write_sample();
    assert_int_equal(file_read(path, 1 << 20, &bytes, size), OK);
    return bytes;
}

/* A large model's training state has one tensor of 1.2 GB, written as a sparse file. */
static void a_file_of_more_than_a_gigabyte_is_read(void **state)
{
    (void)state;
    static const char header[] =
        "{\"w\":{\"dtype\":\"F32\",\"shape\":[300000000],\"data_offsets\":[0,1200000000]}}    ";
    const uint64_t length = sizeof header - 1;
    FILE *out = fopen(path, "wb");
    assert_non_null(out);
    assert_int_equal(fwrite(&length, sizeof length, 1, out), 1);
    assert_int_equal(fwrite(header, length, 1, out), 1);
    assert_int_equal(fclose(out), 0);
    assert_int_equal(truncate(path, (off_t)(sizeof length + length + 1200000000)), 0);
    safetensors_file *f = NULL;
    if (safetensors_open(path, &f) != OK) fail_msg("%s", status_message());
    assert_int_equal(safetensors_find(f, "w")->count, 300000000);
    safetensors_close(f);
    assert_int_equal(unlink(path), 0);
}

static void truncated_weights_are_refused(void **state)
{
    (void)state;
    size_t size;
    char *bytes = sample_bytes(&size);
    for (size_t n = 0; n < size; n++) {
        /* a separate allocation, so that the sanitizer sees reads past the end */
        char *part = malloc(n + 1);
        assert_non_null(part);
        memcpy(part, bytes, n);
        safetensors_file *f = NULL;
        assert_int_equal(safetensors_parse(part, n, &f), MERLIN_BAD_INPUT);
        free(part);
    }
    safetensors_file *f = NULL;
    assert_int_equal(safetensors_parse(bytes, size - 3, &f), MERLIN_BAD_INPUT);
    assert_non_null(strstr(status_message(), "truncated"));
    free(bytes);
}

static void altered_weights_are_refused(void **state)
{
    (void)state;
    size_t size;
    char *bytes = sample_bytes(&size);
    for (size_t i = size - 42; i < size; i++) {
        bytes[i] ^= 4;
        safetensors_file *f = NULL;
        assert_int_equal(safetensors_parse(bytes, size, &f), MERLIN_BAD_INPUT);
        assert_non_null(strstr(status_message(), "altered"));
        bytes[i] ^= 4;
    }
    free(bytes);
}

static void other_files_are_called_what_they_are(void **state)
{
    (void)state;
    static const char *const others[] = {"", "{}", "\x89PNG\r\n\x1a\n and so on, a picture", "8 bytes!{not a length}"};
    for (size_t i = 0; i < sizeof others / sizeof *others; i++) {
        assert_int_equal(file_write(path, others[i], strlen(others[i])), OK);
        safetensors_file *f = NULL;
        assert_int_equal(safetensors_open(path, &f), MERLIN_BAD_INPUT);
        assert_non_null(strstr(status_message(), "not a safetensors file"));
        assert_non_null(strstr(status_message(), path));
    }
    safetensors_file *f = NULL;
    assert_int_equal(safetensors_open("/nowhere/w.safetensors", &f), MERLIN_BAD_INPUT);
}

/* Parses a file with this header followed by so many bytes of zeros. */
static status parse_text(const char *header, size_t data)
{
    size_t length = strlen(header), size = 8 + length + data;
    char *bytes = calloc(1, size);
    assert_non_null(bytes);
    for (int i = 0; i < 8; i++)
        bytes[i] = (char)(length >> (8 * i));
    memcpy(bytes + 8, header, length);
    safetensors_file *f = NULL;
    status s = safetensors_parse(bytes, size, &f);
    if (s == OK) safetensors_close(f);
    free(bytes);
    return s;
}

static void wellformed_headers_are_taken(void **state)
{
    (void)state;
    assert_int_equal(parse_text("{}", 0), OK);
    assert_int_equal(parse_text("{}      ", 0), OK);
    assert_int_equal(parse_text("{\"__metadata__\":{\"a\":\"b\"}}", 0), OK);
    assert_int_equal(parse_text("{\"a\":{\"dtype\":\"F32\",\"shape\":[2,1],\"data_offsets\":[0,8]}}", 8), OK);
    assert_int_equal(parse_text("{\"b\":{\"dtype\":\"F16\",\"shape\":[2],\"data_offsets\":[4,8]},"
                                "\"a\":{\"dtype\":\"F32\",\"shape\":[],\"data_offsets\":[0,4]}}",
                                8),
                     OK);
    assert_int_equal(parse_text("{\"a\":{\"dtype\":\"F32\",\"shape\":[0,3],\"data_offsets\":[0,0]}}", 0), OK);
}

typedef struct malformed {
    const char *header;
    size_t data;
} malformed;

static void malformed_headers_are_refused(void **state)
{
    (void)state;
    static const malformed list[] = {
        {"[]", 0},
        {"{", 0},
        {"{}x", 0},
        {"{}\n{}", 0},
        {"{\"a\":1}", 0},
        {"{\"a\\n\":1}", 0}, /* would break a message into two lines */
        {"{}", 1},           /* a remainder */
        {"{\"__metadata__\":[]}", 0},
        {"{\"__metadata__\":{\"a\":1}}", 0},
        {"{\"__metadata__\":{\"a\":\"1\",\"a\":\"2\"}}", 0},
        {"{\"__metadata__\":{\"crc32\":\"12345678\"}}", 0},
        {"{\"__metadata__\":{},\"__metadata__\":{}}", 0},
        {"{\"a\":{\"dtype\":\"F32\",\"shape\":[1]}}", 4},
        {"{\"a\":{\"dtype\":\"F32\",\"shape\":[1],\"data_offsets\":[0,4],\"more\":1}}", 4},
        {"{\"a\":{\"dtype\":\"F64\",\"shape\":[1],\"data_offsets\":[0,8]}}", 8},
        {"{\"a\":{\"dtype\":7,\"shape\":[1],\"data_offsets\":[0,4]}}", 4},
        {"{\"a\":{\"dtype\":\"F32\",\"shape\":1,\"data_offsets\":[0,4]}}", 4},
        {"{\"a\":{\"dtype\":\"F32\",\"shape\":[1,1,1,1,1],\"data_offsets\":[0,4]}}", 4},
        {"{\"a\":{\"dtype\":\"F32\",\"shape\":[-1],\"data_offsets\":[0,4]}}", 4},
        {"{\"a\":{\"dtype\":\"F32\",\"shape\":[1.5],\"data_offsets\":[0,6]}}", 6},
        {"{\"a\":{\"dtype\":\"F32\",\"shape\":[\"1\"],\"data_offsets\":[0,4]}}", 4},
        {"{\"a\":{\"dtype\":\"F32\",\"shape\":[2],\"data_offsets\":[0,4]}}", 4},
        {"{\"a\":{\"dtype\":\"F32\",\"shape\":[1],\"data_offsets\":[4,0]}}", 4},
        {"{\"a\":{\"dtype\":\"F32\",\"shape\":[1],\"data_offsets\":[0,4,8]}}", 4},
        {"{\"a\":{\"dtype\":\"F32\",\"shape\":[1],\"data_offsets\":[-4,0]}}", 4},
        {"{\"a\":{\"dtype\":\"F32\",\"shape\":[1],\"data_offsets\":[0,1e300]}}", 4},
        {"{\"a\":{\"dtype\":\"F32\",\"shape\":[1],\"data_offsets\":[0,4]}}", 3}, /* truncated */
        {"{\"a\":{\"dtype\":\"F32\",\"shape\":[1],\"data_offsets\":[4,8]}}", 8}, /* a gap */
        /* 2^32 · 2^32 · 4 wraps to zero bytes */
        {"{\"a\":{\"dtype\":\"F32\",\"shape\":[4294967296,4294967296],\"data_offsets\":[0,0]}}", 0},
        {"{\"a\":{\"dtype\":\"F32\",\"shape\":[4611686018427387904],\"data_offsets\":[0,0]}}", 0},
        {"{\"a\":{\"dtype\":\"F32\",\"shape\":[1],\"data_offsets\":[0,4]},"
         "\"a\":{\"dtype\":\"F32\",\"shape\":[1],\"data_offsets\":[4,8]}}",
         8},
        {"{\"a\":{\"dtype\":\"F32\",\"shape\":[1],\"data_offsets\":[0,4]},"
         "\"b\":{\"dtype\":\"F16\",\"shape\":[3],\"data_offsets\":[2,8]}}",
         8}, /* an overlap */
    };
    for (size_t i = 0; i < sizeof list / sizeof *list; i++) {
        if (parse_text(list[i].header, list[i].data) != MERLIN_BAD_INPUT) fail_msg("taken: %s", list[i].header);
        const char *message = status_message();
        assert_true(strlen(message) > 10 && !strchr(message, '\n'));
    }
}

static void a_huge_header_is_refused(void **state)
{
    (void)state;
    size_t size = 3 << 20;
    char *header = malloc(size);
    assert_non_null(header);
    memset(header, ' ', size);
    header[0] = '{', header[1] = '}', header[size - 1] = 0;
    assert_int_equal(parse_text(header, 0), MERLIN_BAD_INPUT);
    free(header);
}

static void a_failed_write_leaves_the_old_file(void **state)
{
    (void)state;
    size_t size, now;
    char *bytes = sample_bytes(&size), *again = NULL;
    safetensors_tensor t = {"x", SAFETENSORS_F32, 1, {1}, 1, values};
    char *nowhere = file_join(path, "below-a-file");
    assert_non_null(nowhere);
    assert_int_equal(safetensors_write(nowhere, &t, 1, NULL, 0), MERLIN_CANNOT_WRITE);
    assert_int_equal(file_read(path, 1 << 20, &again, &now), OK);
    assert_int_equal(size, now);
    assert_memory_equal(bytes, again, size);
    free(bytes), free(again), free(nowhere);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(what_was_written_is_read),
        cmocka_unit_test(tensors_are_given_in_their_order_in_the_file),
        cmocka_unit_test(a_file_of_more_than_a_gigabyte_is_read),
        cmocka_unit_test(truncated_weights_are_refused),
        cmocka_unit_test(altered_weights_are_refused),
        cmocka_unit_test(other_files_are_called_what_they_are),
        cmocka_unit_test(wellformed_headers_are_taken),
        cmocka_unit_test(malformed_headers_are_refused),
        cmocka_unit_test(a_huge_header_is_refused),
        cmocka_unit_test(a_failed_write_leaves_the_old_file),
    };
    return cmocka_run_group_tests(tests, open_folder, close_folder);
}
