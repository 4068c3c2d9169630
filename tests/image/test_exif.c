/* SPDX-License-Identifier: MIT */
#include "image/metadata/exif.h"

#include <libdeflate.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/rng.h"
#include "scratch.h"

#include <cmocka.h>

/* ---- building a file ---- */

typedef struct bytes {
    unsigned char at[4096];
    size_t count;
    bool little;
} bytes;

static void put(bytes *b, uint32_t number, int size)
{
    for (int i = 0; i < size; i++)
        b->at[b->count++] = (unsigned char)(number >> 8 * (b->little ? i : size - 1 - i));
}

static void put_text(bytes *b, const char *text, size_t size)
{
    memcpy(b->at + b->count, text, size);
    b->count += size;
}

static void put_bytes(bytes *b, const bytes *more)
{
    put_text(b, (const char *)more->at, more->count);
}

enum { SHORT = 3, LONG = 4, RATIONAL = 5 };

typedef struct entry {
    unsigned tag, type, value, under; /* under: denominator of a fraction */
} entry;

/* Appends a page followed by its fractions; returns the position of the value of the entry `marked`. */
static size_t put_page(bytes *b, const entry *entries, int count, unsigned marked)
{
    size_t found = 0, behind = b->count + 2 + 12 * (size_t)count + 4;
    put(b, (uint32_t)count, 2);
    for (int i = 0; i < count; i++) {
        put(b, entries[i].tag, 2);
        put(b, entries[i].type, 2);
        put(b, 1, 4);
        if (entries[i].tag == marked) found = b->count;
        put(b, entries[i].type == RATIONAL ? (uint32_t)behind : entries[i].value, entries[i].type == SHORT ? 2 : 4);
        if (entries[i].type == SHORT) put(b, 0, 2);
        if (entries[i].type == RATIONAL) behind += 8;
    }
    put(b, 0, 4);
    for (int i = 0; i < count; i++)
        if (entries[i].type == RATIONAL) {
            put(b, entries[i].value, 4);
            put(b, entries[i].under, 4);
        }
    return found;
}

/* Returns a TIFF header with an orientation and an EXIF page of these entries. */
static bytes exif_of(bool little, const entry *entries, int count)
{
    enum { EXIF = 34665 };
    bytes b = {.little = little};
    put_text(&b, little ? "II" : "MM", 2);
    put(&b, 42, 2);
    put(&b, 8, 4);
    size_t at = put_page(&b, (const entry[]){{274, SHORT, 6, 0}, {EXIF, LONG, 0, 0}}, 2, EXIF), end = b.count;
    b.count = at;
    put(&b, (uint32_t)end, 4);
    b.count = end;
    put_page(&b, entries, count, 0);
    return b;
}

static const entry phone[] = {{37385, SHORT, 25, 0}, {37386, RATIONAL, 570, 100}, {41989, SHORT, 26, 0}};

static exif_facts facts_of(const bytes *b)
{
    exif_facts facts;
    exif_parse(b->at, b->count, &facts);
    return facts;
}

/* ---- the facts in a block ---- */

static void flash_focal_length_and_orientation_are_read(void **state)
{
    (void)state;
    for (int little = 0; little < 2; little++) {
        bytes b = exif_of(little, phone, 3);
        exif_facts facts = facts_of(&b);
        assert_int_equal(facts.orientation, 6);
        assert_int_equal(facts.flash, EXIF_FLASH_FIRED);
        assert_float_equal(facts.focal_35mm, 26, 1e-6);
    }
}

static void a_flash_that_did_not_fire_is_none(void **state)
{
    (void)state;
    static const unsigned none[] = {0, 16, 24, 32}; /* off, by choice, by the camera, no flash there */
    for (int i = 0; i < 4; i++) {
        bytes b = exif_of(true, (const entry[]){{37385, SHORT, none[i], 0}}, 1);
        assert_int_equal(facts_of(&b).flash, EXIF_FLASH_NONE);
        assert_true(facts_of(&b).focal_35mm == 0);
    }
}

/* 50 mm on 23.5 × 15.6 mm of 6000 × 4000 pixels has the field of view of 76.7 mm. */
static void the_sensors_size_serves_where_35_mm_are_not_said(void **state)
{
    (void)state;
    const entry camera[] = {{37386, RATIONAL, 50, 1},
                            {40962, LONG, 6000, 0},
                            {40963, LONG, 4000, 0},
                            {41486, RATIONAL, 60000, 235 /* a mm: 10 a cm */},
                            {41488, SHORT, 4, 0}};
    bytes b = exif_of(false, camera, 5);
    assert_float_equal(facts_of(&b).focal_35mm, 50 * 43.2666 / 28.24, 0.05);
    assert_int_equal(facts_of(&b).flash, EXIF_FLASH_UNKNOWN);
}

static void a_crop_has_another_lens(void **state)
{
    (void)state;
    const entry stated[] = {{40962, LONG, 4032, 0}, {40963, LONG, 3024, 0}, {41989, SHORT, 26, 0}};
    bytes known = exif_of(true, stated, 3), unknown = exif_of(true, phone, 3);
    const exif_facts sized = facts_of(&known), plain = facts_of(&unknown);
    static const int whole[][2] = {{4032, 3024}, {3024, 4032}, {1000, 750}, {333, 250}};
    static const int crops[][2] = {{3024, 3024}, {4032, 2268}, {1200, 1000}, {4032, 1000}};
    for (int i = 0; i < 4; i++) {
        assert_float_equal(exif_focal_35mm(&sized, whole[i][0], whole[i][1]), 26, 1e-6);
        assert_float_equal(exif_focal_35mm(&plain, whole[i][0], whole[i][1]), 26, 1e-6);
        assert_true(exif_focal_35mm(&sized, crops[i][0], crops[i][1]) == 0);
    }
    assert_float_equal(exif_focal_35mm(&plain, 4032, 2268), 26, 1e-6); /* a camera's shape, for all that is known */
    assert_float_equal(exif_focal_35mm(&plain, 4928, 3264), 26, 1e-6);
    assert_true(exif_focal_35mm(&plain, 1200, 1000) == 0);
    assert_float_equal(exif_focal_35mm(&plain, 0, 0), 26, 1e-6); /* a size that is not known */
}

static void the_exposure_is_time_and_sensitivity_by_the_f_number_squared(void **state)
{
    (void)state;
    const entry stated[] = {{33434, RATIONAL, 1, 50}, {33437, RATIONAL, 28, 10}, {34855, SHORT, 400, 0}};
    const entry unfit[] = {{33434, RATIONAL, 1, 50}, {34855, SHORT, 65535, 0}};
    bytes b = exif_of(true, stated, 3);
    assert_float_equal(facts_of(&b).exposure, 400 / 50.0 / (2.8 * 2.8), 1e-5);
    b = exif_of(false, stated, 1); /* a lens without contacts */
    assert_float_equal(facts_of(&b).exposure, 0.02, 1e-7);
    b = exif_of(true, unfit, 2);
    assert_true(facts_of(&b).exposure == 0);
    b = exif_of(true, phone, 3);
    assert_true(facts_of(&b).exposure == 0);
}

static void what_is_absurd_or_damaged_is_unknown(void **state)
{
    (void)state;
    const entry absurd[] = {{37386, RATIONAL, 5, 0}, {41989, SHORT, 65535, 0}};
    bytes b = exif_of(true, absurd, 2);
    assert_true(facts_of(&b).focal_35mm == 0);
    b = exif_of(true, phone, 3);
    for (size_t count = 0; count < b.count; count++) {
        exif_facts facts;
        exif_parse(b.at, count, &facts);
        assert_true(facts.orientation >= 1 && facts.orientation <= 8);
    }
}

/* ---- where files keep EXIF ---- */

static bytes in_jpeg(const bytes *exif)
{
    bytes b = {0};
    put_text(&b, "\xff\xd8\xff\xe0\0\x06JFIF\xff\xe1", 12);
    put(&b, (uint32_t)exif->count + 8, 2);
    put_text(&b, "Exif\0\0", 6);
    put_bytes(&b, exif);
    put_text(&b, "\xff\xda\0\x02", 4);
    return b;
}

static bytes in_png(const bytes *exif)
{
    bytes b = {0};
    put_text(&b, "\x89PNG\r\n\x1a\n\0\0\0\x02tEXtabCRC.", 22);
    put(&b, (uint32_t)exif->count, 4);
    put_text(&b, "eXIf", 4);
    put_bytes(&b, exif);
    put_text(&b, "CRC.\0\0\0\0IENDCRC.", 16);
    return b;
}

/* Returns ImageMagick's form: hexadecimal digits in lines. */
static bytes as_digits(const bytes *exif)
{
    bytes text = {0};
    char part[64];
    int length = snprintf(part, sizeof part, "\nexif\n%8zu\n", exif->count + 6);
    put_text(&text, part, (size_t)length);
    put_text(&text, "457869660000", 12);
    for (size_t i = 0; i < exif->count; i++) {
        length = snprintf(part, sizeof part, "%02x%s", exif->at[i], i % 36 == 29 ? "\n" : "");
        put_text(&text, part, (size_t)length);
    }
    return text;
}

static bytes in_png_chunk(const char name[4], const bytes *content)
{
    bytes b = {0};
    put_text(&b, "\x89PNG\r\n\x1a\n\0\0\0\x02tEXtabCRC.", 22);
    put(&b, (uint32_t)content->count, 4);
    put_text(&b, name, 4);
    put_bytes(&b, content);
    put_text(&b, "CRC.\0\0\0\0IENDCRC.", 16);
    return b;
}

static bytes in_png_text(const bytes *exif)
{
    bytes digits = as_digits(exif), content = {0};
    put_text(&content, "Raw profile type exif", 22);
    put_bytes(&content, &digits);
    return in_png_chunk("tEXt", &content);
}

static bytes in_png_packed_text(const bytes *exif)
{
    bytes digits = as_digits(exif), content = {0};
    put_text(&content, "Raw profile type APP1\0", 23);
    struct libdeflate_compressor *c = libdeflate_alloc_compressor(6);
    assert_non_null(c);
    content.count += libdeflate_zlib_compress(c, digits.at, digits.count, content.at + content.count,
                                              sizeof content.at - content.count);
    libdeflate_free_compressor(c);
    return in_png_chunk("zTXt", &content);
}

static bytes in_webp(const bytes *exif)
{
    bytes b = {.little = true};
    put_text(&b, "RIFF....WEBPVP8X", 16);
    put(&b, 3, 4);
    put_text(&b, "odd.EXIF", 8);
    put(&b, (uint32_t)exif->count + 6, 4);
    put_text(&b, "Exif\0\0", 6);
    put_bytes(&b, exif);
    return b;
}

static void put_box(bytes *to, const char name[4], const bytes *inside)
{
    put(to, (uint32_t)inside->count + 8, 4);
    put_text(to, name, 4);
    put_bytes(to, inside);
}

/* Returns a HEIC with two items, the second of which is EXIF, after the boxes. */
static bytes in_heic(const bytes *exif)
{
    bytes b = {0}, item = {0}, table = {0}, places = {0}, meta = {0};
    put_text(&b,
             "\0\0\0\x10"
             "ftypheic....",
             16);
    put_text(&table, "\0\0\0\0\0\x02", 6);
    for (int i = 1; i <= 2; i++) {
        item.count = 0;
        put(&item, 2u << 24, 4);
        put(&item, (uint32_t)i, 2);
        put(&item, 0, 2);
        put_text(&item, i == 1 ? "hvc1" : "Exif", 5);
        put_box(&table, "infe", &item);
    }
    put_text(&places, "\0\0\0\0\x44\0\0\x02", 8);
    size_t meta_size = 4 + 8 + table.count + 8 + places.count + 2 * 14;
    for (int i = 1; i <= 2; i++) {
        put(&places, (uint32_t)i, 2);
        put(&places, 0, 2);
        put(&places, 1, 2);
        put(&places, (uint32_t)(b.count + 8 + meta_size + 8), 4);
        put(&places, (uint32_t)exif->count + 10, 4);
    }
    put(&meta, 0, 4);
    put_box(&meta, "iinf", &table);
    put_box(&meta, "iloc", &places);
    assert_int_equal(meta.count, meta_size);
    put_box(&b, "meta", &meta);
    put(&b, (uint32_t)exif->count + 18, 4);
    put_text(&b,
             "mdat\0\0\0\x06"
             "Exif\0\0",
             14);
    put_bytes(&b, exif);
    return b;
}

static bytes in_cr3(const bytes *exif)
{
    bytes b = {0}, private = {0}, movie = {0};
    put_text(&b,
             "\0\0\0\x10"
             "ftypcrx ....",
             16);
    put_text(&private, "sixteen bytes id", 16);
    put_box(&private, "CMT2", exif);
    put_box(&movie, "uuid", &private);
    put_box(&b, "moov", &movie);
    return b;
}

static bytes in_raf(const bytes *exif)
{
    bytes b = {0}, jpeg = in_jpeg(exif);
    put_text(&b, "FUJIFILMCCD-RAW ", 16);
    b.count = 84;
    put(&b, 100, 4);
    b.count = 100;
    put_bytes(&b, &jpeg);
    return b;
}

static bytes as_tiff(const bytes *exif)
{
    return *exif;
}

static bytes (*const kinds[])(const bytes *exif) = {in_jpeg, in_png, in_png_text, in_png_packed_text, in_webp, in_heic,
                                                    in_cr3,  in_raf, as_tiff};
enum { KINDS = sizeof kinds / sizeof *kinds };

static exif_facts facts_in_file(const bytes *b)
{
    exif_facts facts;
    const char *path = scratch_path("photo");
    FILE *f = fopen(path, "wb");
    assert_non_null(f);
    assert_int_equal(fwrite(b->at, 1, b->count, f), b->count);
    fclose(f);
    exif_read(path, &facts);
    return facts;
}

static void every_kind_of_file_keeps_it_where_it_is_found(void **state)
{
    (void)state;
    bytes exif = exif_of(true, phone, 3);
    for (int i = 0; i < KINDS; i++) {
        bytes b = kinds[i](&exif);
        exif_facts facts = facts_in_file(&b);
        assert_int_equal(facts.flash, EXIF_FLASH_FIRED);
        assert_int_equal(facts.orientation, 6);
        assert_float_equal(facts.focal_35mm, 26, 1e-6);
    }
}

static void what_has_none_says_nothing(void **state)
{
    (void)state;
    exif_facts facts;
    bytes exif = exif_of(true, phone, 3), b = in_jpeg(&exif);
    memcpy(b.at + 12 + 2, "http", 4); /* XMP uses the same marker */
    facts = facts_in_file(&b);
    assert_int_equal(facts.flash, EXIF_FLASH_UNKNOWN);
    assert_int_equal(facts.orientation, 1);
    exif_read(scratch_path("missing"), &facts);
    assert_int_equal(facts.flash, EXIF_FLASH_UNKNOWN);
}

/* Under the sanitizers this finds memory errors; otherwise it shows that reading terminates. */
static void damaged_files_do_no_harm(void **state)
{
    (void)state;
    enum { TRIES = 300 };
    bytes exif = exif_of(true, phone, 3);
    rng r = rng_at(7, 0, 0);
    for (int i = 0; i < KINDS * TRIES; i++) {
        bytes b = kinds[i % KINDS](&exif);
        for (int k = 0; k < 4; k++)
            b.at[rng_below(&r, (int)b.count)] = (unsigned char)rng_below(&r, 256);
        if (rng_below(&r, 2)) b.count -= (size_t)rng_below(&r, (int)b.count);
        exif_facts facts = facts_in_file(&b);
        assert_true(facts.orientation >= 1 && facts.orientation <= 8);
        assert_true(facts.focal_35mm >= 0 && facts.focal_35mm <= 5000);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(flash_focal_length_and_orientation_are_read),
        cmocka_unit_test(a_flash_that_did_not_fire_is_none),
        cmocka_unit_test(the_sensors_size_serves_where_35_mm_are_not_said),
        cmocka_unit_test(a_crop_has_another_lens),
        cmocka_unit_test(the_exposure_is_time_and_sensitivity_by_the_f_number_squared),
        cmocka_unit_test(what_is_absurd_or_damaged_is_unknown),
        cmocka_unit_test(every_kind_of_file_keeps_it_where_it_is_found),
        cmocka_unit_test(what_has_none_says_nothing),
        cmocka_unit_test(damaged_files_do_no_harm),
    };
    return cmocka_run_group_tests(tests, scratch_open, scratch_close);
}
