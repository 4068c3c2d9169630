/* SPDX-License-Identifier: MIT */
/* Tests what merlin_maps' doubts say of photographs, by maps that are made here. */
#include "base/api_needs.h"
#include "estimate/photo/photo_doubts.h"
#include "merlin/merlin.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include <cmocka.h>

enum { WIDTH = 120, HEIGHT = 90 };

/* A photograph of many shades and colours, of which a rectangle is the object. */
static void make(merlin_maps *maps, int left, int top, int right, int bottom)
{
    img photo, mask;
    *maps = (merlin_maps){.mask_source = MERLIN_MASK_FOUND, .mask_confidence = 1, .crop = {.side = WIDTH}};
    assert_int_equal(img_new(&photo, WIDTH, HEIGHT, 3), OK);
    assert_int_equal(img_new(&mask, WIDTH, HEIGHT, 1), OK);
    for (int y = 0; y < HEIGHT; y++)
        for (int x = 0; x < WIDTH; x++) {
            for (int c = 0; c < 3; c++)
                img_at(&photo, x, y)[c] = 0.1f + 0.003f * (float)((7 * x + 13 * y + 29 * c) % 200);
            *img_at(&mask, x, y) = x >= left && x < right && y >= top && y < bottom;
        }
    maps->photo = photo;
    maps->mask = mask;
}

static unsigned doubts_of(merlin_maps *maps, const merlin_shot *shot)
{
    const light_cues unknown = {.known = false};
    doubts_find(&unknown, shot, maps);
    return maps->doubts;
}

static void a_good_photograph_has_no_doubt(void **state)
{
    (void)state;
    merlin_maps maps;
    make(&maps, 20, 10, 100, 80);
    assert_int_equal(doubts_of(&maps, &(merlin_shot){.flash = MERLIN_FLASH_FIRED, .focal_35mm = 26}), 0);
    merlin_maps_free(&maps);
}

static void what_the_mask_shows_is_told(void **state)
{
    (void)state;
    const merlin_shot unknown = {0};
    merlin_maps maps;
    make(&maps, 0, 0, WIDTH, HEIGHT);
    assert_int_equal(doubts_of(&maps, &unknown), MERLIN_DOUBT_NO_OBJECT);
    merlin_maps_free(&maps);
    make(&maps, 0, 0, WIDTH / 2, HEIGHT); /* half of the upper and the lower edge, and one side */
    assert_int_equal(doubts_of(&maps, &unknown), MERLIN_DOUBT_OBJECT_CUT);
    merlin_maps_free(&maps);
    make(&maps, 0, 10, 50, 80); /* a third of its outline */
    assert_int_equal(doubts_of(&maps, &unknown), MERLIN_DOUBT_OBJECT_CUT);
    merlin_maps_free(&maps);
    make(&maps, 40, 30, 80, 60); /* 1200 pixels */
    maps.mask_confidence = 0.45f;
    assert_int_equal(doubts_of(&maps, &unknown), MERLIN_DOUBT_OBJECT_SMALL | MERLIN_DOUBT_OBJECT_UNSURE);
    merlin_maps_free(&maps);
}

static void light_from_behind_is_told(void **state)
{
    (void)state;
    merlin_maps maps;
    make(&maps, 20, 10, 100, 80);
    maps.light = (merlin_found_light){.known = 1, .flash = 0.1f, .lamp = {0.8f, 0, -0.6f}, .lamp_strength = {1, 1, 1}};
    assert_int_equal(doubts_of(&maps, &(merlin_shot){0}), MERLIN_DOUBT_LIGHT_BEHIND | MERLIN_DOUBT_LIGHT_ELSEWHERE);
    maps.light.lamp[2] = 0.6f;
    assert_int_equal(doubts_of(&maps, &(merlin_shot){0}), MERLIN_DOUBT_LIGHT_ELSEWHERE);
    char words[256];
    merlin_doubt_message(&maps, MERLIN_DOUBT_LIGHT_ELSEWHERE, words, sizeof words);
    assert_non_null(strstr(words, "it is lit by a lamp from the right"));
    maps.light = (merlin_found_light){.known = 1}; /* all of it is dark */
    merlin_doubt_message(&maps, MERLIN_DOUBT_LIGHT_ELSEWHERE, words, sizeof words);
    assert_non_null(strstr(words, "it is lit by light of an unknown kind, as far"));
    maps.light = (merlin_found_light){.known = 1, .flash = 1};
    assert_int_equal(doubts_of(&maps, &(merlin_shot){.flash = MERLIN_FLASH_NONE}), 0);
    merlin_maps_free(&maps);
}

static void what_the_pixels_show_is_told(void **state)
{
    (void)state;
    const merlin_shot unknown = {0};
    merlin_maps maps;
    make(&maps, 20, 10, 100, 80);
    for (int i = 0; i < WIDTH * HEIGHT; i++)
        maps.photo.data[3 * i + 1] = maps.photo.data[3 * i + 2] = maps.photo.data[3 * i];
    assert_int_equal(doubts_of(&maps, &unknown), MERLIN_DOUBT_GREY);
    for (int i = 0; i < 3 * WIDTH * HEIGHT; i++)
        maps.photo.data[i] = i % 3 ? 0.2f : 0.6f;
    assert_int_equal(doubts_of(&maps, &unknown), MERLIN_DOUBT_DRAWING);
    for (int i = 0; i < 3 * WIDTH * HEIGHT; i++)
        maps.photo.data[i] = 0.0004f * (float)(i % 7 + i / WIDTH % 3);
    assert_int_equal(doubts_of(&maps, &unknown) & MERLIN_DOUBT_DARK, MERLIN_DOUBT_DARK);
    merlin_maps_free(&maps);
}

static void what_exif_says_is_told(void **state)
{
    (void)state;
    merlin_maps maps;
    make(&maps, 20, 10, 100, 80);
    maps.fov = 67;
    assert_int_equal(doubts_of(&maps, &(merlin_shot){.flash = MERLIN_FLASH_NONE}), MERLIN_DOUBT_NO_FLASH);
    maps.fov = 3;
    assert_int_equal(doubts_of(&maps, &(merlin_shot){.flash = MERLIN_FLASH_FIRED}), MERLIN_DOUBT_LENS_NARROW);
    maps.fov = 100;
    assert_int_equal(doubts_of(&maps, &(merlin_shot){.flash = MERLIN_FLASH_FIRED}), MERLIN_DOUBT_LENS_WIDE);
    maps.fov = 0;
    assert_int_equal(doubts_of(&maps, &(merlin_shot){.reduced = 2}), MERLIN_DOUBT_REDUCED);
    assert_int_equal(doubts_of(&maps, &(merlin_shot){.reduced = 1, .frames = 3}), MERLIN_DOUBT_FIRST_FRAME);
    merlin_maps_free(&maps);
}

static void every_doubt_has_a_code_and_words(void **state)
{
    (void)state;
    merlin_maps maps;
    make(&maps, 20, 10, 100, 80);
    for (unsigned bit = 1; bit <= MERLIN_DOUBT_GREY; bit <<= 1) {
        char words[MERLIN_WARNING_WORDS];
        assert_true(strlen(merlin_doubt_code((merlin_doubt)bit)) > 3);
        int length = merlin_doubt_message(&maps, (merlin_doubt)bit, words, sizeof words);
        assert_true(length > 20 && length < (int)sizeof words);
    }
    assert_string_equal(merlin_doubt_code((merlin_doubt)0), "");
    maps.doubts = MERLIN_DOUBT_GREY | MERLIN_DOUBT_LIGHT_ELSEWHERE;
    merlin_warnings list;
    merlin_maps_warnings(&maps, &list);
    assert_int_equal(list.count, 2);
    assert_string_equal(list.at[0].code, "light_elsewhere"); /* the graver first */
    merlin_maps_free(&maps);
}

/* Normals of a surface that fills the picture are further off than those of an object with an outline. */
static void unrefined_surfaces_without_an_outline_are_doubted_more(void **state)
{
    (void)state;
    char object[MERLIN_WARNING_WORDS], filled[MERLIN_WARNING_WORDS];
    merlin_maps maps;
    make(&maps, 20, 10, 100, 80);
    maps.photographs = 12;
    merlin_doubt_message(&maps, MERLIN_DOUBT_NOT_REFINED, object, sizeof object);
    maps.doubts = MERLIN_DOUBT_NO_OBJECT;
    merlin_doubt_message(&maps, MERLIN_DOUBT_NOT_REFINED, filled, sizeof filled);
    assert_non_null(strstr(object, "15 to 25 degrees"));
    assert_non_null(strstr(filled, "30 degrees and more"));
    merlin_maps_free(&maps);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_good_photograph_has_no_doubt),
        cmocka_unit_test(what_the_mask_shows_is_told),
        cmocka_unit_test(light_from_behind_is_told),
        cmocka_unit_test(what_the_pixels_show_is_told),
        cmocka_unit_test(what_exif_says_is_told),
        cmocka_unit_test(every_doubt_has_a_code_and_words),
        cmocka_unit_test(unrefined_surfaces_without_an_outline_are_doubted_more),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
