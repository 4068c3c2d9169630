/* SPDX-License-Identifier: MIT */
/* Photographed materials: which files make which, and that the surface has the pictures' properties. */
#include "lab/scene/material/texture.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "base/file.h"
#include "image/write/write.h"
#include "scratch.h"

/* last, as cmocka defines a macro named fail */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

/* Writes a picture of one colour, [0, 1] as stored in the file. */
static void put(const char *name, float r, float g, float b)
{
    img image;
    assert_int_equal(img_new(&image, 6, 4, 3), OK);
    for (int i = 0; i < 24; i++) {
        image.data[3 * i] = r;
        image.data[3 * i + 1] = g;
        image.data[3 * i + 2] = b;
    }
    char *path = file_join(scratch, name), *slash = strrchr(path, '/');
    *slash = 0;
    assert_int_equal(file_make_folder(path), OK);
    *slash = '/';
    assert_int_equal(img_write_png(path, &image, IMG_LINEAR16), OK);
    img_free(&image);
    free(path);
}

static texture_place plainly(const scene_texture *texture)
{
    return (texture_place){.texture = texture, .turn = {{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}}, .scale = 1};
}

static void files_of_one_name_make_one_material(void **state)
{
    (void)state;
    put("Bricks075A_1K-JPG_Color.png", 1, 0, 0);
    put("Bricks075A_1K-JPG_NormalGL.png", 0.5f, 0.5f, 1);
    put("Bricks075A_1K-JPG_NormalDX.png", 0.9f, 0.9f, 0.6f); /* the other form of the same map */
    put("Bricks075A_1K-JPG_Roughness.png", 0.25f, 0.25f, 0.25f);
    put("Bricks075A_1K-JPG_AmbientOcclusion.png", 1, 1, 1);
    put("wood/old_wood_diff_1k.png", 0, 1, 0);
    put("wood/old_wood_rough_1k.png", 0.75f, 0.75f, 0.75f);
    put("wood/old_wood_disp_1k.png", 0.5f, 0.5f, 0.5f);
    put("photo.png", 0, 0, 1);
    scene_textures t;
    assert_int_equal(scene_textures_read(scratch, &t), OK);
    assert_int_equal(t.count, 3);
    vec3 up = {0, 0, 1}, at = {0.3f, 0.2f, 0};
    texture_place brick = plainly(&t.texture[0]), photo = plainly(&t.texture[1]), wood = plainly(&t.texture[2]);
    assert_float_equal(texture_albedo(&brick, at, up).x, 1, 1e-3);
    assert_float_equal(texture_roughness(&brick, at, up), 0.25f, 1e-3); /* 16 bits, no sRGB decoding */
    assert_float_equal(vec3_length(texture_gradient(&brick, at, up)), 0, 1e-3);
    assert_float_equal(texture_albedo(&photo, at, up).z, 1, 1e-3);
    assert_null(photo.texture->roughness.data);
    assert_null(photo.texture->slope.data);
    assert_float_equal(texture_albedo(&wood, at, up).y, 1, 1e-3);
    assert_float_equal(texture_roughness(&wood, at, up), 0.75f, 1e-3);
    scene_textures_free(&t);
}

static void files_called_by_their_map_alone_are_their_folder_s_material(void **state)
{
    (void)state;
    put("brick/base_color.png", 1, 0, 0);
    put("brick/nor_gl.png", 0.5f, 0.5f, 1);
    put("brick/roughness.png", 0.25f, 0.25f, 0.25f);
    put("brick/height.png", 0.5f, 0.5f, 0.5f);
    put("wood/Albedo.png", 0, 1, 0);
    put("wood/Normal.png", 0.5f, 0.5f, 1);
    put("metal.png", 0, 0, 1); /* a picture of metal */
    scene_textures t;
    assert_int_equal(scene_textures_read(scratch, &t), OK);
    assert_int_equal(t.count, 3);
    vec3 up = {0, 0, 1}, at = {0.3f, 0.2f, 0};
    texture_place brick = plainly(&t.texture[0]), metal = plainly(&t.texture[1]), wood = plainly(&t.texture[2]);
    assert_float_equal(texture_albedo(&brick, at, up).x, 1, 1e-3);
    assert_float_equal(texture_roughness(&brick, at, up), 0.25f, 1e-3); /* 16 bits, no sRGB decoding */
    assert_non_null(brick.texture->slope.data);
    assert_float_equal(texture_albedo(&metal, at, up).z, 1, 1e-3);
    assert_float_equal(texture_albedo(&wood, at, up).y, 1, 1e-3);
    assert_null(wood.texture->roughness.data);
    assert_non_null(wood.texture->slope.data);
    scene_textures_free(&t);
}

static void tiles_that_are_not_square_keep_their_shape(void **state)
{
    (void)state;
    img tile;
    assert_int_equal(img_new(&tile, 8, 4, 3), OK);
    for (int i = 0; i < 16 * 3; i++) /* the upper half of the rows */
        tile.data[i] = 1;
    scene_texture texture = {.albedo = tile};
    texture_place place = plainly(&texture);
    for (int i = 0; i < 8; i++) {
        vec3 at = {0.3f, 0.125f + 0.25f * (float)i, 0};
        assert_float_equal(texture_albedo(&place, at, (vec3){0, 0, 1}).x, (float)(i % 2), 1e-6);
    }
    img_free(&tile);
}

/* A plane that rises to the right by 1/2 and upwards by 1/4 has the normal (-2, -1, 4)/√21. */
static void normal_maps_become_slopes(void **state)
{
    (void)state;
    float x = 0.5f - 0.5f * 2 / sqrtf(21), y = 0.5f * 1 / sqrtf(21), z = 0.5f + 0.5f * 4 / sqrtf(21);
    put("gl_albedo.png", 1, 1, 1);
    put("gl_nor_gl.png", x, 0.5f - y, z);
    put("dx_albedo.png", 1, 1, 1);
    put("dx_nor_dx.png", x, 0.5f + y, z);
    scene_textures t;
    assert_int_equal(scene_textures_read(scratch, &t), OK);
    assert_int_equal(t.count, 2);
    for (int i = 0; i < 2; i++) {
        texture_place place = plainly(&t.texture[i]);
        vec3 front = texture_gradient(&place, (vec3){0.1f, 0.2f, 0.3f}, (vec3){0, 0, 1});
        assert_float_equal(front.x, 0.5f, 1e-3);
        assert_float_equal(front.y, 0.25f, 1e-3);
        assert_float_equal(front.z, 0, 1e-3);
        vec3 top = texture_gradient(&place, (vec3){0.1f, 0.2f, 0.3f}, (vec3){0, 1, 0}); /* u is x, v is z there */
        assert_float_equal(top.x, 0.5f, 1e-3);
        assert_float_equal(top.z, 0.25f, 1e-3);
    }
    scene_textures_free(&t);
}

static void materials_are_told_by_content_and_others_are_listed(void **state)
{
    (void)state;
    put("brick_albedo.jpe", 1, 1, 1);
    assert_int_equal(file_write(scratch_path("tile_albedo.jxl"), "\xff\x0a and more", 11), OK);
    scene_textures t;
    assert_int_equal(scene_textures_read(scratch, &t), OK);
    assert_int_equal(t.count, 1);
    assert_int_equal(t.skipped.count, 1);
    assert_string_equal(t.skipped.at[0].name, "tile_albedo.jxl");
    scene_textures_free(&t);
}

static void folder_without_materials_is_refused(void **state)
{
    (void)state;
    put("brick_roughness.png", 1, 1, 1);
    scene_textures t;
    assert_int_equal(scene_textures_read(scratch, &t), MERLIN_BAD_INPUT);
    assert_non_null(strstr(status_message(), "brick_albedo.png"));
    assert_int_equal(scene_textures_read("/nowhere", &t), MERLIN_BAD_INPUT);
}

static void objects_wear_the_folder(void **state)
{
    (void)state;
    put("red_albedo.png", 0.8f, 0.02f, 0.02f);
    put("red_roughness.png", 0.5f, 0.5f, 0.5f);
    put("red_normal.png", 0.8f, 0.5f, 0.9f);
    scene_textures t;
    assert_int_equal(scene_textures_read(scratch, &t), OK);
    int worn = 0, points = 0;
    for (uint64_t index = 0; index < 40; index++) {
        scene_object with, again, without;
        assert_int_equal(scene_object_generate(5, index, 60, &with), OK);
        assert_int_equal(scene_object_generate(5, index, 60, &again), OK);
        assert_int_equal(scene_object_generate(5, index, 60, &without), OK);
        scene_object_apply_textures(&with, &t, 5, index);
        scene_object_apply_textures(&again, &t, 5, index);
        for (uint32_t k = 0; k < with.triangle_count; k += 1 + with.triangle_count / 20) {
            scene_surface a = {0}, b = {0}, c = {0};
            scene_surfaces_eval(&with, &(scene_place){k, 0.2f, 0.3f}, 1, &a);
            scene_surfaces_eval(&again, &(scene_place){k, 0.2f, 0.3f}, 1, &b);
            scene_surfaces_eval(&without, &(scene_place){k, 0.2f, 0.3f}, 1, &c);
            assert_memory_equal(&a, &b, sizeof a);
            assert_float_equal(vec3_length(a.normal), 1, 1e-4);
            assert_true(a.roughness >= 0.1f && a.roughness <= 1);
            points++;
            worn += memcmp(&a, &c, sizeof a) != 0;
        }
        scene_object_free(&with);
        scene_object_free(&again);
        scene_object_free(&without);
    }
    /* three objects in four, minus what paint covers wholly */
    assert_in_range(worn, points / 2, points * 9 / 10);
    scene_textures_free(&t);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        in_scratch(files_of_one_name_make_one_material),
        in_scratch(files_called_by_their_map_alone_are_their_folder_s_material),
        cmocka_unit_test(tiles_that_are_not_square_keep_their_shape),
        in_scratch(normal_maps_become_slopes),
        in_scratch(materials_are_told_by_content_and_others_are_listed),
        in_scratch(folder_without_materials_is_refused),
        in_scratch(objects_wear_the_folder),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
