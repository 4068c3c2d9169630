/* SPDX-License-Identifier: MIT */
/* A written USD file against the mesh that it was made of: two triangles over a picture of 2 × 2. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/file.h"
#include "image/image.h"
#include "image/write/write.h"
#include "merlin/mesh.h"
#include "scratch.h"

/* last, as cmocka defines a macro named fail */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

static float positions[] = {-1, 1, -2, 1, 1, -2, -1, -1, -2, 1, -1, -1.5f};
static float normals[] = {0, 0, 1, 0, 0, 1, 0.6f, 0, 0.8f, 0, 0, 1}, flat[] = {0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 1};
static float uvs[] = {0.25f, 0.25f, 0.75f, 0.25f, 0.25f, 0.75f, 0.75f, 0.75f};
static uint32_t triangles[] = {0, 2, 1, 1, 2, 3}, pixels[] = {0, 1, 2, 3};

static merlin_mesh quad(void)
{
    return (merlin_mesh){.vertex_count = 4,
                         .triangle_count = 2,
                         .positions = positions,
                         .normals = normals,
                         .uvs = uvs,
                         .triangles = triangles,
                         .width = 2,
                         .height = 2,
                         .pixels = pixels};
}

static char *written(const merlin_mesh *m, const char *name, size_t files)
{
    char *text;
    size_t size;
    merlin_files list;
    assert_int_equal(merlin_mesh_write(m, scratch_path(name), &list), MERLIN_OK);
    assert_int_equal(list.count, files);
    for (size_t i = 0; i < list.count; i++)
        assert_true(file_exists(list.at[i]));
    merlin_files_free(&list);
    assert_int_equal(file_read(scratch_path(name), 1 << 20, &text, &size), MERLIN_OK);
    return text;
}

static void expect(const char *text, const char *line)
{
    if (!strstr(text, line)) print_error("there is no %s in\n%s\n", line, text);
    assert_non_null(strstr(text, line));
}

static void geometry_is_the_mesh_s(void **state)
{
    (void)state;
    merlin_mesh m = quad();
    m.scale = 0.5;
    char *text = written(&m, "quad.usda", 1);
    assert_memory_equal(text, "#usda 1.0\n", 10);
    expect(text, "double3 xformOp:scale = (0.5, 0.5, 0.5)");
    expect(text, "int[] faceVertexCounts = [3, 3]\n");
    expect(text, "int[] faceVertexIndices = [0, 2, 1, 1, 2, 3]\n");
    expect(text, "point3f[] points = [(-1, 1, -2), (1, 1, -2), (-1, -1, -2), (1, -1, -1.5)]\n");
    expect(text, "normal3f[] normals = [(0, 0, 1), (0, 0, 1), (0.6, 0, 0.8), (0, 0, 1)] (\n");
    /* from below, unlike the pictures' rows */
    expect(text, "texCoord2f[] primvars:st = [(0.25, 0.75), (0.75, 0.75), (0.25, 0.25), (0.75, 0.25)] (\n");
    expect(text, "float3[] extent = [(-1, -1, -2), (1, 1, -1.5)]\n");
    /* without pictures it is matte and grey */
    expect(text, "float inputs:roughness = 1\n");
    expect(text, "float inputs:ior = 1.5760\n");
    assert_null(strstr(text, "UsdUVTexture"));
    free(text);
    m.matte = 1;
    text = written(&m, "quad.usda", 1);
    expect(text, "float inputs:ior = 1.0000\n");
    free(text);
}

static void every_picture_that_it_names_lies_beside_it(void **state)
{
    (void)state;
    merlin_mesh m = quad();
    m.face_normals = flat;
    assert_int_equal(img_new(&m.albedo, 2, 2, 3), MERLIN_OK);
    assert_int_equal(img_new(&m.roughness, 2, 2, 1), MERLIN_OK);
    char *text = written(&m, "all.usda", 4);
    expect(text, "asset inputs:file = @all.png@\n");
    expect(text, "asset inputs:file = @all_normal.png@\n");
    expect(text, "asset inputs:file = @all_roughness.png@\n");
    /* normals of vertices are those that the normal map is relative to */
    expect(text, "normal3f[] normals = [(0, 0, 1), (0, 0, 1), (0, 0, 1), (0, 0, 1)] (\n");
    free(text);
    img_free(&m.roughness);
    text = written(&m, "captured.usda", 3);
    assert_null(strstr(text, "captured_roughness.png"));
    free(text);
    text = written(&m, "with@sign.USDA", 3);
    expect(text, "asset inputs:file = @@@with@sign.png@@@\n");
    free(text);
    img_free(&m.albedo);
}

static void a_folder_in_the_way_of_a_picture_leaves_nothing(void **state)
{
    (void)state;
    merlin_mesh m = quad();
    assert_int_equal(img_new(&m.albedo, 2, 2, 3), MERLIN_OK);
    char *in_the_way = strdup(scratch_path("taken.png"));
    assert_int_equal(file_make_folder(in_the_way), MERLIN_OK);
    assert_int_equal(merlin_mesh_write(&m, scratch_path("taken.usda"), NULL), MERLIN_CANNOT_WRITE);
    assert_false(file_exists(scratch_path("taken.usda")));
    free(in_the_way);
    img_free(&m.albedo);
}

static void files_of_something_else_are_kept(void **state)
{
    (void)state;
    merlin_mesh m = quad();
    merlin_files list;
    assert_int_equal(img_new(&m.albedo, 2, 2, 3), MERLIN_OK);
    assert_int_equal(merlin_mesh_files(NULL, "in/owl.obj", &list), MERLIN_OK);
    assert_int_equal(list.count, 3);
    assert_string_equal(list.at[0], "in/owl.mtl");
    merlin_files_free(&list);
    assert_int_equal(merlin_mesh_files(&m, "owl.USDA", &list), MERLIN_OK);
    assert_string_equal(list.at[0], "owl.USDA");
    merlin_files_free(&list);
    assert_int_equal(merlin_mesh_files(NULL, "owl.stl", &list), MERLIN_WRONG_USE);
    assert_int_equal(img_write_png(scratch_path("owl.png"), &m.albedo, IMG_SRGB8), MERLIN_OK);
    assert_int_equal(merlin_mesh_write(&m, scratch_path("owl.usda"), NULL), MERLIN_CANNOT_WRITE);
    assert_int_equal(merlin_mesh_write(&m, scratch_path("owl.ply"), NULL), MERLIN_OK);
    assert_int_equal(merlin_mesh_write(&m, scratch_path("owl.obj"), NULL), MERLIN_CANNOT_WRITE);
    assert_int_equal(remove(scratch_path("owl.png")), 0);
    for (int i = 0; i < 2; i++)
        assert_int_equal(merlin_mesh_write(&m, scratch_path("owl.obj"), NULL), MERLIN_OK);
    assert_int_equal(merlin_mesh_write(&m, scratch_path("owl.usda"), NULL), MERLIN_OK);
    img_free(&m.albedo);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(geometry_is_the_mesh_s),
        cmocka_unit_test(every_picture_that_it_names_lies_beside_it),
        cmocka_unit_test(a_folder_in_the_way_of_a_picture_leaves_nothing),
        cmocka_unit_test(files_of_something_else_are_kept),
    };
    return cmocka_run_group_tests(tests, scratch_open, scratch_close);
}
