/* SPDX-License-Identifier: MIT */
/* Names of masks. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include "image/read/mask_names.h"

#include <cmocka.h>

static void a_photograph_s_own_mask_is_known_by_its_name(void **state)
{
    (void)state;
    static const char *const names[] = {
        "cup.mask.png",  "cup_mask.png",       "cup-mask.png",         "cup mask.png",     "cupMask.png",
        "CUP_MASK.TIF",  "mask_cup.png",       "Mask-cup.jpg",         "cup_matte.png",    "cup_alpha.png",
        "cup-seg.png",   "cup_silhouette.png", "cup_segmentation.png", "cup_label.png",    "cup_masks.png",
        "cup_mask1.png", "cup_mask_01.png",    "cup.jpg.mask.png",     "cup.jpg_mask.png", "mask_cup.jpg.png"};
    for (size_t i = 0; i < sizeof names / sizeof *names; i++)
        if (!mask_name_rank(names[i], "cup.jpg", false)) fail_msg("%s is no mask of cup.jpg", names[i]);
}

static void what_only_resembles_a_mask_s_name_is_none(void **state)
{
    (void)state;
    static const char *const names[] = {"cup.png",        "cup.jpg.png",    "cup2_mask.png",    "cu_mask.png",
                                        "masked_cup.png", "cup_masked.png", "cup_unmasked.png", "cupalpha.png",
                                        "mask.png",       "cup.jpg"};
    for (size_t i = 0; i < sizeof names / sizeof *names; i++)
        if (mask_name_rank(names[i], "cup.jpg", false)) fail_msg("%s is a mask of cup.jpg", names[i]);
}

static void in_a_folder_of_masks_the_photograph_s_name_is_enough(void **state)
{
    (void)state;
    static const char *const names[] = {"cup.png", "CUP.PNG", "cup.jpg.png", "cup.jpg", "cup_mask.png"};
    for (size_t i = 0; i < sizeof names / sizeof *names; i++)
        if (!mask_name_rank(names[i], "cup.jpg", true)) fail_msg("%s is no mask of cup.jpg", names[i]);
    assert_int_equal(mask_name_rank("cup2.png", "cup.jpg", true), 0);
    assert_int_equal(mask_name_rank("cup.png.png", "cup.jpg", true), 0);
}

static void the_usual_names_go_before_the_others(void **state)
{
    (void)state;
    static const char *const names[] = {"cup.mask.png",  "CUP.mask.png", "cup.mask.jpg",
                                        "cup_mask.png",  "mask_cup.png", "cup_mask1.png",
                                        "cup_alpha.png", "cup.jpg.png",  "cup.png"};
    for (size_t i = 1; i < sizeof names / sizeof *names; i++)
        assert_true(mask_name_rank(names[i - 1], "cup.jpg", true) < mask_name_rank(names[i], "cup.jpg", true));
}

static void a_folder_has_a_mask_of_its_own(void **state)
{
    (void)state;
    assert_true(mask_name_is_whole("mask.tif"));
    assert_true(mask_name_is_whole("MASK.PNG"));
    assert_true(mask_name_is_whole("silhouette.png"));
    assert_false(mask_name_is_whole("cup.mask.png"));
    assert_false(mask_name_is_whole("alpha.png"));
    assert_false(mask_name_is_whole("masked.png"));
}

static void some_names_say_mask_whatever_lies_beside_them(void **state)
{
    (void)state;
    assert_true(mask_name_is_sure("cup.mask.png"));
    assert_true(mask_name_is_sure("cup.Mask.webp"));
    assert_false(mask_name_is_sure("cup_mask.png"));
    assert_false(mask_name_is_sure("mask.png"));
    assert_true(mask_name_is_likely("cup_mask.png"));
    assert_true(mask_name_is_likely("mask_cup.png"));
    assert_true(mask_name_is_likely("mask1.png"));
    assert_true(mask_name_is_likely("cup-mask_02.png"));
    assert_false(mask_name_is_likely("masked1.png"));
    assert_false(mask_name_is_likely("cup_alpha.png"));
    assert_false(mask_name_is_likely("unmasked.png"));
}

static void the_names_looked_for_are_listed(void **state)
{
    (void)state;
    char words[256];
    mask_names_list("cup.jpg", true, words, sizeof words);
    assert_string_equal(
        words, "cup.mask.png, cup_mask.png, cup-mask.png, mask_cup.png, cup.jpg.mask.png, cup.png, cup.jpg.png");
    mask_names_list("cup.jpg", false, words, 20);
    assert_string_equal(words, "cup.mask.png, cup_m");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_photograph_s_own_mask_is_known_by_its_name),
        cmocka_unit_test(what_only_resembles_a_mask_s_name_is_none),
        cmocka_unit_test(in_a_folder_of_masks_the_photograph_s_name_is_enough),
        cmocka_unit_test(the_usual_names_go_before_the_others),
        cmocka_unit_test(a_folder_has_a_mask_of_its_own),
        cmocka_unit_test(some_names_say_mask_whatever_lies_beside_them),
        cmocka_unit_test(the_names_looked_for_are_listed),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
