/* SPDX-License-Identifier: MIT */
/* The photographs of a folder and their masks, by the public functions. */
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

#include "base/file.h"
#include "image/image.h"
#include "merlin/photos.h"
/* last, as cmocka defines a macro named fail */
#include "flat.h"

static void photograph(const char *name)
{
    write_flat(name, 4, 4, 3, 0.5f, IMG_SRGB8);
}

static void every_photograph_has_its_own_mask(void **state)
{
    (void)state;
    merlin_photos photos;
    photograph("a.png");
    photograph("b.png");
    photograph("c.png");
    photograph("a.mask.png");
    photograph("mask_c.png");
    photograph("d_mask.png");
    assert_int_equal(merlin_photos_list(scratch, NULL, &photos), MERLIN_OK);
    assert_int_equal(photos.count, 4); /* d_mask.png may be the photograph of a mask */
    assert_string_equal(file_name_of(photos.at[0].path), "a.png");
    assert_string_equal(file_name_of(photos.at[0].mask), "a.mask.png");
    assert_null(photos.at[1].mask);
    assert_string_equal(file_name_of(photos.at[2].mask), "mask_c.png");
    merlin_photos_free(&photos);
}

static void what_is_no_photograph_is_told(void **state)
{
    (void)state;
    merlin_photos photos;
    photograph("a.png");
    photograph("c.png");
    photograph("b.mask.png");
    assert_int_equal(mkdir(scratch_path("inner"), 0777), 0);
    photograph("inner/c.png");
    assert_int_equal(merlin_photos_list(scratch, NULL, &photos), MERLIN_OK);
    assert_int_equal(photos.count, 2);
    assert_int_equal(photos.skipped.count, 2);
    merlin_photos_free(&photos);
    assert_int_equal(merlin_photos_list(scratch, scratch_path("inner"), &photos), MERLIN_OK);
    assert_int_equal(photos.skipped.count, 1); /* the folder of masks is used */
    merlin_photos_free(&photos);
}

static void a_folder_without_photographs_is_refused_unless_it_holds_maps(void **state)
{
    (void)state;
    merlin_photos photos;
    assert_int_equal(merlin_photos_list(scratch, NULL, &photos), MERLIN_BAD_INPUT);
    assert_null(photos.at);
    static const char *const maps[] = {"albedo.png", "confidence.png", "error.png", "mesh.png", "reconstruction.png"};
    for (size_t i = 0; i < sizeof maps / sizeof *maps; i++)
        photograph(maps[i]);
    assert_int_equal(file_write(scratch_path("maps.exr"), "maps", 4), OK);
    assert_int_equal(merlin_photos_list(scratch, NULL, &photos), MERLIN_OK);
    assert_int_equal(photos.count, 0);
    merlin_photos_free(&photos);
    assert_int_equal(merlin_photos_list(scratch_path("none"), NULL, &photos), MERLIN_BAD_INPUT);
}

static void masks_of_a_folder_may_have_the_photographs_names(void **state)
{
    (void)state;
    const char *const photos[] = {"elsewhere/a.jpg", "elsewhere/b.jpg"}, *const more[] = {photos[0], "c.jpg"};
    char *masks[2];
    photograph("a.png");
    photograph("b_mask.png");
    assert_int_equal(merlin_masks_find(scratch, photos, 2, masks), MERLIN_OK);
    assert_string_equal(file_name_of(masks[0]), "a.png");
    assert_string_equal(file_name_of(masks[1]), "b_mask.png");
    free(masks[0]);
    free(masks[1]);
    assert_int_equal(merlin_masks_find(scratch, more, 2, masks), MERLIN_BAD_INPUT);
    assert_true(!masks[0] && !masks[1]);
}

static void a_mask_beside_a_photograph_is_found(void **state)
{
    (void)state;
    char *mask;
    photograph("a.png");
    photograph("a-mask.png");
    photograph("b.png");
    assert_int_equal(merlin_mask_find(scratch_path("a.png"), &mask), MERLIN_OK);
    assert_string_equal(file_name_of(mask), "a-mask.png");
    free(mask);
    assert_int_equal(merlin_mask_find(scratch_path("b.png"), &mask), MERLIN_OK);
    assert_null(mask);
    assert_true(merlin_mask_is_name("a-mask.png") && !merlin_mask_is_name("a.png"));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        in_scratch(every_photograph_has_its_own_mask),
        in_scratch(what_is_no_photograph_is_told),
        in_scratch(a_folder_without_photographs_is_refused_unless_it_holds_maps),
        in_scratch(masks_of_a_folder_may_have_the_photographs_names),
        in_scratch(a_mask_beside_a_photograph_is_found),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
