/* SPDX-License-Identifier: MIT */
/* Meshes of a folder as objects: chosen and deformed by (seed, index) alone, whatever else is in the folder. */
#include "lab/scene/object/model_folder.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/file.h"
#include "scratch.h"

/* last, as cmocka defines a macro named fail */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

static void write_text(const char *folder, const char *name, const char *text)
{
    char *path = file_join(folder, name);
    FILE *f = fopen(path, "w");
    assert_non_null(f);
    fputs(text, f);
    assert_int_equal(fclose(f), 0);
    free(path);
}

static const char box[] = "v -1 -1 -1\nv 1 -1 -1\nv 1 1 -1\nv -1 1 -1\nv -1 -1 1\nv 1 -1 1\nv 1 1 1\nv -1 1 1\n"
                          "f 1 4 3 2\nf 5 6 7 8\nf 1 2 6 5\nf 2 3 7 6\nf 3 4 8 7\nf 4 1 5 8\n";
static const char wedge[] = "v -1 0 -1\nv 1 0 -1\nv 1 0 1\nv -1 0 1\nv 0 2 -1\nv 0 2 1\n"
                            "f 1 2 3 4\nf 1 5 2\nf 3 6 4\nf 2 5 6 3\nf 4 6 5 1\n";

static char *make_folder(void)
{
    char *folder = scratch_new(), *inner = file_join(folder, "inner");
    assert_int_equal(file_make_folder(inner), OK);
    write_text(folder, "box.obj", box);
    write_text(inner, "wedge.obj", wedge);
    write_text(folder, "broken.ply", "ply\nformat ascii 1.0\nelement vertex 3\n");
    write_text(folder, "notes.txt", "no mesh");
    free(inner);
    return folder;
}

static void a_folder_is_read_with_those_in_it_and_what_is_broken_is_told(void **state)
{
    (void)state;
    char *folder = make_folder();
    scene_models models;
    assert_int_equal(scene_models_read(folder, &models), OK);
    assert_int_equal(models.count, 2);
    assert_int_equal(models.skipped.count, 1);
    assert_string_equal(models.skipped.at[0].name, "broken.ply");
    scene_models_free(&models);
    scratch_remove(folder);
}

static void a_folder_without_meshes_is_refused(void **state)
{
    (void)state;
    char *folder = scratch_new();
    scene_models models;
    write_text(folder, "notes.txt", "no mesh");
    assert_int_equal(scene_models_read(folder, &models), MERLIN_BAD_INPUT);
    scratch_remove(folder);
}

static void objects_are_the_same_from_the_same_numbers_and_others_from_others(void **state)
{
    (void)state;
    char *folder = make_folder();
    scene_models models;
    scene_object one, two;
    int different = 0;
    assert_int_equal(scene_models_read(folder, &models), OK);
    for (uint64_t i = 0; i < 24; i++) {
        assert_int_equal(scene_object_from_models(&models, 7, i, 40, &one), OK);
        assert_int_equal(scene_object_from_models(&models, 7, i, 40, &two), OK);
        assert_int_equal(one.vertex_count, two.vertex_count);
        assert_memory_equal(one.position, two.position, one.vertex_count * sizeof *one.position);
        for (uint32_t k = 0; k < one.vertex_count; k++) {
            assert_true(isfinite(vec3_length(one.position[k])) && isfinite(vec3_length(one.normal[k])));
            assert_true(one.position[k].z < 0);
        }
        scene_object_free(&two);
        assert_int_equal(scene_object_from_models(&models, 8, i, 40, &two), OK);
        different += one.vertex_count != two.vertex_count || one.position[0].x != two.position[0].x;
        scene_object_free(&one);
        scene_object_free(&two);
    }
    assert_int_equal(different, 24);
    scene_models_free(&models);
    scratch_remove(folder);
}

static void the_share_of_meshes_is_what_was_asked_for(void **state)
{
    (void)state;
    int chosen = 0;
    for (uint64_t i = 0; i < 2000; i++)
        chosen += scene_models_chosen(3, i, 0.3f);
    assert_true(chosen > 530 && chosen < 670);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_folder_is_read_with_those_in_it_and_what_is_broken_is_told),
        cmocka_unit_test(a_folder_without_meshes_is_refused),
        cmocka_unit_test(objects_are_the_same_from_the_same_numbers_and_others_from_others),
        cmocka_unit_test(the_share_of_meshes_is_what_was_asked_for),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
