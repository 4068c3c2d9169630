/* SPDX-License-Identifier: MIT */
/* Pictures of one object whose camera exposed each as it liked. */
#include "capture_fixture.h"

/* Appends a number, its highest byte first. */
static size_t put(unsigned char *at, uint32_t number, size_t size)
{
    for (size_t i = 0; i < size; i++)
        at[i] = (unsigned char)(number >> 8 * (size - 1 - i));
    return size;
}

/* The CRC-32 of a PNG's chunks, bit by bit. */
static uint32_t checksum(const unsigned char *data, size_t size)
{
    uint32_t crc = 0xffffffff;
    for (size_t i = 0; i < size; i++) {
        crc ^= data[i];
        for (int bit = 0; bit < 8; bit++)
            crc = crc >> 1 ^ (crc & 1 ? 0xedb88320 : 0);
    }
    return ~crc;
}

/* Writes a chunk of EXIF that states so many hundredths of a second at ISO 200 and f/2; returns its size. */
static size_t put_exposure(unsigned char *at, uint32_t hundredths)
{
    enum { RATIONAL = 5, SHORT = 3, EXIF = 34665, TIME = 33434, F_NUMBER = 33437, ISO = 34855, BEHIND = 68 };
    static const char head[] = "MM\0*\0\0\0\x08";
    const uint32_t entry[][4] = {
        {TIME, RATIONAL, 1, BEHIND}, {F_NUMBER, RATIONAL, 1, BEHIND + 8}, {ISO, SHORT, 1, 200u << 16}};
    const uint32_t fractions[] = {hundredths, 100, 2, 1};
    unsigned char *const begin = at, *const name = at + 4;
    at += 8;
    memcpy(name, "eXIf", 4);
    memcpy(at, head, sizeof head - 1);
    at += sizeof head - 1;
    at += put(at, 1, 2);
    at += put(at, EXIF, 2);
    at += put(at, 4, 2);
    at += put(at, 1, 4);
    at += put(at, 26, 4);
    at += put(at, 0, 4);
    at += put(at, 3, 2);
    for (int i = 0; i < 3; i++)
        for (int k = 0; k < 4; k++)
            at += put(at, entry[i][k], k < 2 ? 2 : 4);
    at += put(at, 0, 4);
    for (int i = 0; i < 4; i++)
        at += put(at, fractions[i], 4);
    put(begin, (uint32_t)(at - name - 4), 4);
    at += put(at, checksum(name, (size_t)(at - name)), 4);
    return (size_t)(at - begin);
}

/* Writes a picture of one value whose EXIF states an exposure. */
static void write_exposed(const char *name, float value, uint32_t hundredths)
{
    enum { HEAD = 33 }; /* a PNG's signature and first chunk */
    char *data;
    size_t size;
    unsigned char chunk[160];
    write_flat(name, 6, 4, 3, value, IMG_LINEAR16);
    assert_int_equal(file_read(scratch_path(name), 1 << 20, &data, &size), OK);
    const size_t more = put_exposure(chunk, hundredths);
    unsigned char *whole = malloc(size + more);
    assert_non_null(whole);
    memcpy(whole, data, HEAD);
    memcpy(whole + HEAD, chunk, more);
    memcpy(whole + HEAD + more, data + HEAD, size - HEAD);
    assert_int_equal(file_write(scratch_path(name), whole, size + more), OK);
    free(whole);
    free(data);
}

static void three_exposed(uint32_t a, uint32_t b, uint32_t c)
{
    three_pictures(IMG_LINEAR16);
    write_exposed("a.png", 0.2f, a);
    write_exposed("b.png", 0.5f, b);
    write_exposed("c.png", 0.7f, c);
}

static void exposures_that_differ_count_as_the_lights_strengths(void **state)
{
    (void)state;
    merlin_capture c;
    three_exposed(1, 2, 3);
    assert_int_equal(pst_capture_read(scratch, &PLAIN, &c), OK);
    for (int i = 0; i < 3; i++)
        assert_float_equal(c.light[i].intensity[1], 0.5 * (i + 1), 1e-5);
    assert_in_range(c.picture[1][0], 32767, 32769); /* the pictures stay: what is burnt out is still known */
    assert_non_null(warnings_find(&c.noticed, "exposures_differ"));
    pst_capture_free(&c);
    const merlin_capture_files unknown = {.unknown_lights = 1};
    assert_int_equal(pst_capture_read(scratch, &unknown, &c), OK);
    assert_true(c.intensities_known);
    assert_float_equal(c.light[2].intensity[0], 1.5, 1e-5);
    pst_capture_free(&c);
}

static void equal_or_unknown_exposures_change_nothing(void **state)
{
    (void)state;
    merlin_capture c;
    three_exposed(2, 2, 2);
    assert_int_equal(pst_capture_read(scratch, &PLAIN, &c), OK);
    assert_float_equal(c.light[2].intensity[0], 1, 0);
    assert_null(warnings_find(&c.noticed, "exposures_differ"));
    pst_capture_free(&c);
    three_exposed(1, 2, 3);
    write_flat("b.png", 6, 4, 3, 0.5f, IMG_LINEAR16);
    assert_int_equal(pst_capture_read(scratch, &PLAIN, &c), OK);
    assert_float_equal(c.light[2].intensity[0], 1, 0);
    pst_capture_free(&c);
    three_exposed(1, 2, 20000); /* no camera's */
    assert_int_equal(pst_capture_read(scratch, &PLAIN, &c), OK);
    assert_float_equal(c.light[2].intensity[0], 1, 0);
    pst_capture_free(&c);
}

static void listed_strengths_are_of_pictures_as_they_are(void **state)
{
    (void)state;
    merlin_capture c;
    three_exposed(1, 2, 3);
    write_text("light_intensities.txt", "1\n1\n2\n");
    assert_int_equal(pst_capture_read(scratch, &PLAIN, &c), OK);
    assert_float_equal(c.light[1].intensity[0], 1, 0);
    assert_float_equal(c.light[2].intensity[0], 2, 0);
    assert_null(warnings_find(&c.noticed, "exposures_differ"));
    pst_capture_free(&c);
}

static void ambient_light_is_exposed_as_its_picture(void **state)
{
    (void)state;
    merlin_capture c;
    three_exposed(2, 4, 8);
    write_exposed("ambient.png", 0.1f, 4);
    assert_int_equal(pst_capture_read(scratch, &PLAIN, &c), OK);
    assert_float_equal(c.picture[0][5] / 65535.0, 0.2 - 0.05, 3e-5);
    assert_float_equal(c.picture[1][5] / 65535.0, 0.5 - 0.1, 3e-5);
    assert_float_equal(c.picture[2][5] / 65535.0, 0.7 - 0.2, 3e-5);
    pst_capture_free(&c);
    write_flat("ambient.png", 6, 4, 3, 0.1f, IMG_LINEAR16); /* of an unknown one */
    assert_int_equal(pst_capture_read(scratch, &PLAIN, &c), OK);
    assert_float_equal(c.picture[2][5] / 65535.0, 0.7 - 0.1, 3e-5);
    pst_capture_free(&c);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        in_scratch(exposures_that_differ_count_as_the_lights_strengths),
        in_scratch(equal_or_unknown_exposures_change_nothing),
        in_scratch(listed_strengths_are_of_pictures_as_they_are),
        in_scratch(ambient_light_is_exposed_as_its_picture),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
