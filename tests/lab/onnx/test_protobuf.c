/* SPDX-License-Identifier: MIT */
/* Messages of Protocol Buffers against the bytes that its description of the encoding gives. */
#include "lab/onnx/protobuf.h"

/* last, as cmocka defines a macro named fail */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

static void expect_bytes(protobuf *m, const char *bytes, size_t size)
{
    assert_false(m->lost);
    assert_int_equal(m->size, size);
    assert_memory_equal(m->data, bytes, size);
    protobuf_free(m);
}

/* "Encoding": field 1 of 150 is 08 96 01, field 2 of "testing" is 12 07 and its letters. */
static void fields_are_encoded_as_documented(void **state)
{
    (void)state;
    protobuf m = {0};
    protobuf_integer(&m, 1, 150);
    expect_bytes(&m, "\x08\x96\x01", 3);
    protobuf_text(&m, 2, "testing");
    expect_bytes(&m, "\x12\x07testing", 9);
    protobuf_float(&m, 2, 1.0f);
    expect_bytes(&m, "\x15\x00\x00\x80\x3f", 5);
}

static void negative_integers_have_ten_bytes(void **state)
{
    (void)state;
    protobuf m = {0};
    protobuf_integer(&m, 1, -1);
    expect_bytes(&m, "\x08\xff\xff\xff\xff\xff\xff\xff\xff\xff\x01", 11);
}

static void fields_beyond_fifteen_have_a_key_of_two_bytes(void **state)
{
    (void)state;
    protobuf m = {0};
    protobuf_integer(&m, 20, 7);
    expect_bytes(&m, "\xa0\x01\x07", 3);
}

static void a_message_in_a_message_is_its_bytes_with_their_count(void **state)
{
    (void)state;
    protobuf inner = {0}, outer = {0};
    protobuf_integer(&inner, 1, 150);
    protobuf_message(&outer, 3, &inner);
    assert_null(inner.data);
    expect_bytes(&outer, "\x1a\x03\x08\x96\x01", 5);
}

static void an_empty_message_is_a_field_without_bytes(void **state)
{
    (void)state;
    protobuf inner = {0}, outer = {0};
    protobuf_message(&outer, 3, &inner);
    expect_bytes(&outer, "\x1a\x00", 2);
}

static void a_lost_part_loses_the_whole(void **state)
{
    (void)state;
    protobuf inner = {.lost = true}, outer = {0};
    protobuf_integer(&outer, 1, 1);
    protobuf_message(&outer, 3, &inner);
    protobuf_integer(&outer, 1, 1);
    assert_true(outer.lost);
    assert_null(outer.data);
    protobuf_free(&outer);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(fields_are_encoded_as_documented),
        cmocka_unit_test(negative_integers_have_ten_bytes),
        cmocka_unit_test(fields_beyond_fifteen_have_a_key_of_two_bytes),
        cmocka_unit_test(a_message_in_a_message_is_its_bytes_with_their_count),
        cmocka_unit_test(an_empty_message_is_a_field_without_bytes),
        cmocka_unit_test(a_lost_part_loses_the_whole),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
