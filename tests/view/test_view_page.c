/* SPDX-License-Identifier: MIT */
/* Pages of maps: what is in them comes out again, and what is refused leaves nothing. How a browser shows them is
 * looked at by tests/cli/view.sh. */
#include <libdeflate.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/file.h"
#include "estimate/relight/relighter.h"
#include "merlin/view.h"
#include "scratch.h"
#include "view/view_planes.h"

/* last, as cmocka defines a macro named fail */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

/* The size of a page without maps, bytes: that of the program. */
enum { SIDE = 96, MOST_PAGE = 200000 };

typedef struct fixture {
    char *folder, page[160];
    merlin_maps maps;
} fixture;

static merlin_image image(int channels)
{
    return (merlin_image){SIDE, SIDE, channels, calloc((size_t)channels * SIDE * SIDE, sizeof(float))};
}

/* A ball, its materials different everywhere. */
static void paint(merlin_maps *m, int i)
{
    const float x = ((float)(i % SIDE) - 47.5f) / 40, y = (47.5f - (float)(i / SIDE)) / 40, d = x * x + y * y;
    if (d >= 1) return;
    const float z = sqrtf(1 - d), normal[3] = {x, y, fmaxf(z, 0.1f)};
    const float length = sqrtf(x * x + y * y + normal[2] * normal[2]);
    for (int c = 0; c < 3; c++) {
        m->albedo.data[3 * i + c] = 0.02f + 0.9f * (float)((i * (c + 3)) % 101) / 101;
        m->normal.data[3 * i + c] = normal[c] / length;
        m->photo.data[3 * i + c] = 0.5f * m->albedo.data[3 * i + c] * z;
    }
    m->roughness.data[i] = 0.05f + 0.9f * (float)(i % SIDE) / SIDE;
    m->depth.data[i] = 1 - 0.3f * z;
    m->mask.data[i] = 1;
}

static int set_up(void **state)
{
    fixture *f = calloc(1, sizeof *f);
    *state = f;
    f->folder = scratch_new();
    snprintf(f->page, sizeof f->page, "%s/page.html", f->folder);
    f->maps = (merlin_maps){.crop = {0, 0, SIDE}, .size = SIDE, .gain = 1.5f};
    f->maps.albedo = image(3);
    f->maps.normal = image(3);
    f->maps.roughness = image(1);
    f->maps.depth = image(1);
    f->maps.mask = image(1);
    f->maps.photo = image(3);
    for (int i = 0; i < SIDE * SIDE; i++)
        paint(&f->maps, i);
    return 0;
}

static int tear_down(void **state)
{
    fixture *f = *state;
    merlin_maps_free(&f->maps);
    scratch_remove(f->folder);
    free(f);
    return 0;
}

/* ---- a page read again ---- */

/* What stands in the element of this beginning. */
static char *content(const char *page, const char *element)
{
    const char *begin = strstr(page, element);
    assert_non_null(begin);
    begin = strchr(begin, '>') + 1;
    return strndup(begin, (size_t)(strchr(begin, '<') - begin));
}

static uint32_t digit(char c)
{
    static const char letters[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    const char *at = c == '=' ? letters : strchr(letters, c);
    assert_non_null(at);
    return (uint32_t)(at - letters);
}

static uint8_t *bytes_of(const char *base64, size_t *size)
{
    const size_t length = strlen(base64);
    assert_int_equal(length % 4, 0);
    uint8_t *out = malloc(length / 4 * 3);
    for (size_t i = 0; i < length; i += 4) {
        uint32_t bits = 0;
        for (size_t k = 0; k < 4; k++)
            bits = bits << 6 | digit(base64[i + k]);
        for (size_t k = 0; k < 3; k++)
            out[i / 4 * 3 + k] = (uint8_t)(bits >> (16 - 8 * k));
    }
    *size = length / 4 * 3 - (base64[length - 1] == '=') - (base64[length - 2] == '=');
    return out;
}

/* The whole numbers of a map, as web/scene.js has them. */
static uint16_t *plane_of(const char *page, const char *name, int side)
{
    char element[64];
    snprintf(element, sizeof element, "id=\"map-%s\"", name);
    char *base64 = content(page, element);
    size_t size, count = (size_t)side * (size_t)side;
    uint8_t *packed = bytes_of(base64, &size), *bytes = malloc(2 * count);
    uint16_t *out = calloc(count, sizeof *out);
    struct libdeflate_decompressor *d = libdeflate_alloc_decompressor();
    assert_int_equal(libdeflate_zlib_decompress(d, packed, size, bytes, 2 * count, NULL), LIBDEFLATE_SUCCESS);
    libdeflate_free_decompressor(d);
    for (size_t i = 0; i < count; i++) {
        const int folded = bytes[i] << 8 | bytes[count + i], off = folded & 1 ? -(folded + 1) / 2 : folded / 2;
        const bool first = i % (size_t)side == 0, top = i < (size_t)side;
        const int left = first ? 0 : out[i - 1], above = top ? 0 : out[i - (size_t)side];
        const int corner = first || top ? 0 : out[i - (size_t)side - 1];
        out[i] = (uint16_t)(off + left + above - corner);
    }
    free(base64);
    free(packed);
    free(bytes);
    return out;
}

static char *write_page(const fixture *f, const merlin_view_params *params)
{
    file_view view;
    if (merlin_view_write(&f->maps, params, f->page) != MERLIN_OK) fail_msg("%s", merlin_error());
    assert_int_equal(file_map(f->page, 1 << 26, &view), OK);
    char *text = strndup(view.data, view.size);
    file_unmap(&view);
    return text;
}

/* ---- the tests ---- */

/* A step of the page's numbers is half a step of error. */
static void maps_come_out_of_a_page_as_they_went_in(void **state)
{
    const fixture *f = *state;
    char *page = write_page(f, NULL);
    float near, far;
    assert_int_equal(sscanf(strstr(page, "\"depth\":["), "\"depth\":[%f,%f]", &near, &far), 2);
    uint16_t *red = plane_of(page, "red", SIDE), *x = plane_of(page, "normal-x", SIDE);
    uint16_t *rough = plane_of(page, "roughness", SIDE), *depth = plane_of(page, "depth", SIDE);
    uint16_t *mask = plane_of(page, "mask", SIDE);
    for (int i = 0; i < SIDE * SIDE; i++) {
        assert_int_equal(mask[i], f->maps.mask.data[i] > 0 ? 255 : 0);
        if (!mask[i]) continue;
        const float root = (float)red[i] / 4095, roughness = 0.03f * powf(1 / 0.03f, (float)rough[i] / 4095);
        assert_true(fabsf(root - sqrtf(f->maps.albedo.data[3 * i])) <= 0.51f / 4095);
        assert_true(fabsf((float)x[i] / 4096 - 1 - f->maps.normal.data[3 * i]) <= 0.51f / 4096);
        assert_true(fabsf(roughness / f->maps.roughness.data[i] - 1) <= 0.001f);
        assert_true(fabsf(near + (far - near) * (float)depth[i] / 65535 - f->maps.depth.data[i]) <= 1e-5f);
    }
    free(red);
    free(x);
    free(rough);
    free(depth);
    free(mask);
    free(page);
}

static void a_page_is_its_maps_and_at_most_200_kilobytes(void **state)
{
    const fixture *f = *state;
    char *page = write_page(f, NULL);
    size_t maps = 0;
    for (const char *at = page; (at = strstr(at, "id=\"map-")); at++)
        maps += (size_t)(strstr(at, "</script>") - strchr(at, '>'));
    assert_true(maps > 0);
    assert_true(strlen(page) - maps <= MOST_PAGE);
    free(page);
}

/* A browser that is offline, or that must not tell anybody, has all there is. */
static void a_page_asks_the_network_for_nothing(void **state)
{
    const fixture *f = *state;
    char *page = write_page(f, NULL);
    assert_non_null(strstr(page, "default-src 'none'"));
    assert_null(strstr(page, "fetch("));
    assert_null(strstr(page, " src=\"http"));
    assert_null(strstr(page, "import "));
    free(page);
}

static void names_stay_words(void **state)
{
    const fixture *f = *state;
    const merlin_view_params params = {.name = "</script><script>alert(1)</script>\xff", .folder = "a\"b\\c"};
    char *page = write_page(f, &params), *scene = content(page, "id=\"scene\"");
    assert_null(strstr(page, "<script>alert"));
    assert_non_null(strstr(scene, "\"name\":\"\\u003c/script>\\u003cscript>alert(1)\\u003c/script>\xef\xbf\xbd\""));
    assert_non_null(strstr(scene, "\"folder\":\"a\\\"b\\\\c\""));
    free(scene);
    free(page);
}

static void larger_squares_become_as_large_as_is_asked(void **state)
{
    const fixture *f = *state;
    const merlin_view_params params = {.side = 64};
    char *page = write_page(f, &params), *scene = content(page, "id=\"scene\"");
    uint16_t *mask = plane_of(page, "mask", 64);
    assert_non_null(strstr(scene, "\"side\":64,"));
    assert_int_equal(mask[32 * 64 + 32], 255);
    assert_int_equal(mask[0], 0);
    free(mask);
    free(scene);
    free(page);
}

static void a_captured_surface_has_neither_gloss_nor_photograph(void **state)
{
    const fixture *f = *state;
    fixture captured = *f; /* whose maps are borrowed */
    captured.maps.captured = 1;
    char *page = write_page(&captured, NULL), *scene = content(page, "id=\"scene\"");
    assert_null(strstr(page, "id=\"map-roughness\""));
    assert_null(strstr(page, "id=\"map-photo\""));
    assert_non_null(strstr(scene, "\"matte\":true"));
    free(scene);
    free(page);
}

static void wrong_use_leaves_no_page(void **state)
{
    const fixture *f = *state;
    const merlin_view_params narrow = {.side = 63}, wide = {.side = 4097};
    const merlin_maps empty = {0};
    assert_int_equal(merlin_view_write(&f->maps, &narrow, f->page), MERLIN_WRONG_USE);
    assert_int_equal(merlin_view_write(&f->maps, &wide, f->page), MERLIN_WRONG_USE);
    assert_int_equal(merlin_view_write(&empty, NULL, f->page), MERLIN_WRONG_USE);
    assert_int_equal(merlin_view_write(NULL, NULL, f->page), MERLIN_WRONG_USE);
    assert_int_equal(merlin_view_write(&f->maps, NULL, NULL), MERLIN_WRONG_USE);
    assert_int_equal(merlin_view_write(&f->maps, NULL, "photo.png"), MERLIN_WRONG_USE);
    assert_false(file_exists("photo.png"));
    assert_false(file_exists(f->page));
    char nowhere[200];
    snprintf(nowhere, sizeof nowhere, "%s/none/page.html", f->folder);
    assert_int_equal(merlin_view_write(&f->maps, NULL, nowhere), MERLIN_CANNOT_WRITE);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(maps_come_out_of_a_page_as_they_went_in, set_up, tear_down),
        cmocka_unit_test_setup_teardown(a_page_is_its_maps_and_at_most_200_kilobytes, set_up, tear_down),
        cmocka_unit_test_setup_teardown(a_page_asks_the_network_for_nothing, set_up, tear_down),
        cmocka_unit_test_setup_teardown(names_stay_words, set_up, tear_down),
        cmocka_unit_test_setup_teardown(larger_squares_become_as_large_as_is_asked, set_up, tear_down),
        cmocka_unit_test_setup_teardown(a_captured_surface_has_neither_gloss_nor_photograph, set_up, tear_down),
        cmocka_unit_test_setup_teardown(wrong_use_leaves_no_page, set_up, tear_down),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
