/* SPDX-License-Identifier: MIT */
/* Exported files against the maps that they are made of: a tilted plane, whose every value is known. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/file.h"
#include "base/vec.h"
#include "image/exr/exr.h"
#include "image/image.h"
#include "image/read/read.h"
#include "merlin/export.h"
#include "optics/camera.h"
#include "scratch.h"

/* last, as cmocka defines a macro named fail */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

enum { SIDE = 64, PIXELS = SIDE * SIDE, MARGIN = 8 };
static const float ROUGH = 0.4f, FAR = 1.1f, NEAR = 0.9f;

static bool is_object(int i)
{
    int x = i % SIDE, y = i / SIDE;
    return x >= MARGIN && x < SIDE - MARGIN && y >= MARGIN && y < SIDE - MARGIN;
}

/* A plane that is farther above than below, so that it faces upwards. */
static void plane_maps(merlin_maps *m)
{
    *m = (merlin_maps){.size = SIDE, .gain = 1.5f, .crop = {0, 0, SIDE}};
    merlin_image *images[] = {&m->albedo, &m->normal, &m->photo, &m->roughness, &m->depth, &m->mask};
    for (int k = 0; k < 6; k++)
        assert_int_equal(img_new(images[k], SIDE, SIDE, k < 3 ? 3 : 1), OK);
    for (int i = 0; i < PIXELS; i++) {
        if (!is_object(i)) continue;
        float down = (float)(i / SIDE - MARGIN) / (SIDE - 2 * MARGIN - 1);
        m->mask.data[i] = 1;
        m->roughness.data[i] = ROUGH;
        m->depth.data[i] = FAR + (NEAR - FAR) * down;
        vec3_put(vec3_normalize(vec3_make(0, 0.3f, 1)), m->normal.data + 3 * i);
        for (int c = 0; c < 3; c++)
            m->albedo.data[3 * i + c] = m->photo.data[3 * i + c] = 0.2f * (float)(c + 1);
    }
}

static void export(const merlin_export_params *params, const char *folder, merlin_export_facts *facts)
{
    merlin_maps m;
    plane_maps(&m);
    assert_int_equal(merlin_maps_export(&m, params, folder, facts, NULL), OK);
    merlin_maps_free(&m);
}

/* The middle pixel's values as the file has them. */
static void middle(const char *folder, const char *name, float out[3])
{
    char *path = file_join(folder, name);
    merlin_image image;
    assert_int_equal(merlin_image_read(path, &image, NULL), OK);
    assert_int_equal(image.width, SIDE);
    memcpy(out, image.data + 3 * (size_t)(PIXELS / 2 + SIDE / 2), 3 * sizeof *out);
    merlin_image_free(&image);
    free(path);
}

/* Returns a PNG's code, which says nothing of a curve, before merlin_image_read took it for sRGB. */
static float code_of(float linear)
{
    return linear <= 0.0031308f ? 12.92f * linear : 1.055f * powf(linear, 1 / 2.4f) - 0.055f;
}

static void normals_face_up_or_down_as_asked(void **state)
{
    const char *folder = scratch;
    (void)state;
    const vec3 n = vec3_normalize(vec3_make(0, 0.3f, 1));
    for (int down = 0; down < 2; down++) {
        float value[3];
        export(&(merlin_export_params){.maps = MERLIN_EXPORT_NORMAL, .normal_down = down}, folder, NULL);
        middle(folder, "normal.png", value);
        assert_float_equal(code_of(value[0]), 0.5f, 1e-3f);
        assert_float_equal(code_of(value[1]), 0.5f + (down ? -0.5f : 0.5f) * (float)n.y, 1e-3f);
        assert_float_equal(code_of(value[2]), 0.5f + 0.5f * (float)n.z, 1e-3f);
    }
}

static void packed_and_single_maps_say_the_same(void **state)
{
    const char *folder = scratch;
    (void)state;
    float orm[3], rough[3], smooth[3], occlusion[3];
    export(&(merlin_export_params){.maps = MERLIN_EXPORT_ORM | MERLIN_EXPORT_ROUGHNESS | MERLIN_EXPORT_SMOOTHNESS |
                                           MERLIN_EXPORT_OCCLUSION},
           folder, NULL);
    middle(folder, "orm.png", orm);
    middle(folder, "roughness.png", rough);
    middle(folder, "smoothness.png", smooth);
    middle(folder, "ao.png", occlusion);
    assert_float_equal(code_of(rough[0]), ROUGH, 0.003f);
    assert_float_equal(code_of(smooth[0]), 1 - ROUGH, 0.003f);
    assert_float_equal(orm[0], occlusion[0], 0);
    assert_float_equal(orm[1], rough[0], 0);
    assert_float_equal(orm[2], 0, 0);
    assert_true(code_of(occlusion[0]) > 0.97f);
}

/* Relief and width by the plane's depths: 60 degrees wide at its mean distance, 1. */
static void heights_span_the_relief(void **state)
{
    const char *folder = scratch;
    (void)state;
    merlin_export_facts facts;
    export(&(merlin_export_params){.maps = MERLIN_EXPORT_HEIGHT | MERLIN_EXPORT_HEIGHT_FLOAT}, folder, &facts);
    const float width = 2 * (float)camera_tangent(CAMERA_FOV);
    assert_int_equal(facts.side, SIDE);
    assert_float_equal(facts.width, width, 1e-4f);
    assert_float_equal(facts.relief, (FAR - NEAR) / width, 1e-4f);

    char *path = file_join(folder, "height.exr");
    float *height = malloc(PIXELS * sizeof *height);
    exr_file *f;
    assert_int_equal(exr_open(path, &f), OK);
    assert_int_equal(exr_read(f, &(exr_target){"Y", height, 1}, 1), OK);
    exr_close(f);
    assert_float_equal(height[MARGIN * SIDE + MARGIN], 0, 1e-5f);
    assert_float_equal(height[(SIDE - MARGIN - 1) * SIDE + MARGIN], facts.relief, 1e-5f);
    assert_float_equal(height[0], 0, 0);
    free(height);
    free(path);
}

static void textures_go_on_beside_the_object(void **state)
{
    const char *folder = scratch;
    (void)state;
    export(&(merlin_export_params){.maps = MERLIN_EXPORT_ALBEDO}, folder, NULL);
    char *path = file_join(folder, "albedo.png");
    merlin_image image;
    assert_int_equal(merlin_image_read(path, &image, NULL), OK);
    for (int c = 0; c < 3; c++)
        assert_float_equal(image.data[c], 0.2f * (float)(c + 1), 0.01f);
    merlin_image_free(&image);
    free(path);
}

static void materialx_brings_the_files_that_it_names(void **state)
{
    const char *folder = scratch;
    (void)state;
    merlin_files written;
    merlin_maps m;
    plane_maps(&m);
    char *own = file_join(folder, "materialx");
    assert_int_equal(
        merlin_maps_export(&m, &(merlin_export_params){.maps = MERLIN_EXPORT_MATERIALX}, own, NULL, &written), OK);
    assert_int_equal(written.count, 5);
    assert_true(file_is_in(own, "albedo.png") && file_is_in(own, "normal.png") && file_is_in(own, "roughness.png"));
    assert_true(file_is_in(own, "material.mtlx") && file_is_in(own, "export.json"));
    merlin_files_free(&written);
    const merlin_export_params all_down = {.maps = MERLIN_EXPORT_ALL, .normal_down = 1};
    char *down = file_join(folder, "all_down");
    assert_int_equal(merlin_maps_export(&m, &all_down, down, NULL, NULL), OK);
    assert_true(file_is_in(down, "orm.png") && !file_is_in(down, "material.mtlx"));
    merlin_maps_free(&m);
    free(down);
    free(own);
}

static void what_cannot_be_is_refused_and_leaves_nothing(void **state)
{
    const char *folder = scratch;
    (void)state;
    merlin_maps m, empty = {0};
    merlin_image out;
    plane_maps(&m);
    char *own = file_join(folder, "refused");
    const merlin_export_params bad[] = {
        {.maps = MERLIN_EXPORT_ALL + 1u},
        {.side = 63},
        {.side = 8193},
        {.side = -64},
        {.maps = MERLIN_EXPORT_MATERIALX, .normal_down = 1},
    };
    for (size_t i = 0; i < sizeof bad / sizeof *bad; i++)
        assert_int_equal(merlin_maps_export(&m, &bad[i], own, NULL, NULL), MERLIN_WRONG_USE);
    assert_int_equal(merlin_maps_export(&empty, NULL, own, NULL, NULL), MERLIN_WRONG_USE);
    assert_int_equal(merlin_maps_export(NULL, NULL, own, NULL, NULL), MERLIN_WRONG_USE);
    assert_int_equal(merlin_maps_occlusion(&m, 0, &out), MERLIN_WRONG_USE);
    assert_int_equal(merlin_maps_occlusion(&empty, 64, &out), MERLIN_WRONG_USE);
    assert_false(file_exists(own));
    merlin_maps_free(&m);
    free(own);
}

/* At sizes that are computed and at those that are enlarged. */
static void occlusion_beside_the_object_is_1(void **state)
{
    (void)state;
    merlin_maps m;
    merlin_image out;
    plane_maps(&m);
    for (int side = 512; side <= 2048; side *= 2) {
        const size_t row = (size_t)side * (size_t)(side / 2);
        assert_int_equal(merlin_maps_occlusion(&m, side, &out), MERLIN_OK);
        assert_true(out.data[0] == 1 && out.data[row] == 1);
        assert_in_range(1000 * out.data[row + (size_t)side / 2], 900, 1000); /* a plane's */
        merlin_image_free(&out);
    }
    merlin_maps_free(&m);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(normals_face_up_or_down_as_asked),
        cmocka_unit_test(packed_and_single_maps_say_the_same),
        cmocka_unit_test(heights_span_the_relief),
        cmocka_unit_test(textures_go_on_beside_the_object),
        cmocka_unit_test(materialx_brings_the_files_that_it_names),
        cmocka_unit_test(what_cannot_be_is_refused_and_leaves_nothing),
        cmocka_unit_test(occlusion_beside_the_object_is_1),
    };
    return cmocka_run_group_tests(tests, scratch_open, scratch_close);
}
