/* SPDX-License-Identifier: MIT */
/* include/merlin/mesh.h, by the maps of a photograph. */
#include "estimate_fixture.h"

static merlin_mesh mesh_of(const merlin_maps *maps, merlin_mesh_params params)
{
    merlin_mesh mesh;
    if (merlin_mesh_from_maps(maps, &params, &mesh) != MERLIN_OK) fail_msg("%s", merlin_error());
    return mesh;
}

static void a_mesh_stands_where_its_object_does(void **state)
{
    const fixture *f = *state;
    merlin_maps maps;
    estimate(f, &maps);
    merlin_mesh mesh = mesh_of(&maps, (merlin_mesh_params){0});
    assert_int_equal(mesh.width, maps.crop.side);
    assert_int_equal(mesh.albedo.width, maps.crop.side);
    assert_true(mesh.scale == 1);
    for (size_t v = 0; v < mesh.vertex_count; v++) {
        const float *p = mesh.positions + 3 * v, *n = mesh.normals + 3 * v;
        /* inside the frame of a camera 60 degrees wide */
        assert_true(p[2] < 0 && fabsf(p[0]) < 0.58f * -p[2] && fabsf(p[1]) < 0.58f * -p[2]);
        assert_float_equal(n[0] * n[0] + n[1] * n[1] + n[2] * n[2], 1, 1e-5);
        for (int c = 0; c < 3; c++)
            assert_true(mesh.colors[3 * v + (size_t)c] >= 0 && mesh.colors[3 * v + (size_t)c] <= 1);
    }
    for (size_t i = 0; i < 3 * mesh.triangle_count; i++)
        assert_true(mesh.triangles[i] < mesh.vertex_count);
    merlin_mesh_free(&mesh);
    merlin_mesh_free(&mesh); /* empty by now */
    merlin_mesh_free(NULL);
    merlin_maps_free(&maps);
}

static void its_shape_and_its_textures_may_be_smaller(void **state)
{
    const fixture *f = *state;
    merlin_maps maps;
    merlin_mesh mesh;
    estimate(f, &maps);
    mesh = mesh_of(&maps, (merlin_mesh_params){.side = 32, .texture_side = 64});
    assert_int_equal(mesh.width, 32);
    assert_int_equal(mesh.height, 32);
    assert_true(mesh.vertex_count > 256 && mesh.vertex_count < 1024);
    assert_int_equal(mesh.albedo.width, 64);
    assert_int_equal(mesh.roughness.width, 32);
    merlin_mesh_free(&mesh);
    static const int impossible[] = {-1, 1, 8193};
    for (int i = 0; i < 3; i++) {
        assert_int_equal(merlin_mesh_from_maps(&maps, &(merlin_mesh_params){.side = impossible[i]}, &mesh),
                         MERLIN_WRONG_USE);
        assert_int_equal(merlin_mesh_from_maps(&maps, &(merlin_mesh_params){.texture_side = impossible[i]}, &mesh),
                         MERLIN_WRONG_USE);
        assert_null(mesh.positions);
    }
    merlin_maps_free(&maps);
    assert_int_equal(merlin_mesh_from_maps(&maps, NULL, &mesh), MERLIN_WRONG_USE);
}

static void a_mesh_of_ones_own_needs_neither_colours_nor_maps(void **state)
{
    const fixture *f = *state;
    float positions[] = {0, 0, -1, 1, 0, -1, 0, 1, -1}, normals[] = {0, 0, 1, 0, 0, 1, 0, 0, 1};
    float uvs[] = {0, 1, 1, 1, 0, 0};
    uint32_t triangle[] = {0, 1, 2};
    merlin_mesh mesh = {.vertex_count = 3, .triangle_count = 1, .positions = positions, .normals = normals, .uvs = uvs};
    static const char *const endings[] = {".ply", ".obj", ".glb"};
    char path[128];
    mesh.triangles = triangle;
    for (int i = 0; i < 3; i++) {
        merlin_files written;
        snprintf(path, sizeof path, "%s/own%s", f->folder, endings[i]);
        assert_int_equal(merlin_mesh_write(&mesh, path, &written), MERLIN_OK);
        assert_int_equal(written.count, i == 1 ? 2 : 1); /* an OBJ has a material */
        merlin_files_free(&written);
        unlink(path);
    }
    snprintf(path, sizeof path, "%s/own.mtl", f->folder);
    assert_int_equal(unlink(path), 0);
    mesh.face_normals = normals; /* a normal map, whose pixels are not told */
    assert_int_equal(merlin_mesh_write(&mesh, path, NULL), MERLIN_WRONG_USE);
    snprintf(path, sizeof path, "%s/own.glb", f->folder);
    assert_int_equal(merlin_mesh_write(&mesh, path, NULL), MERLIN_WRONG_USE);
    assert_int_equal(merlin_mesh_check_name("own.glb"), MERLIN_OK);
    assert_int_equal(merlin_mesh_check_name("own.stl"), MERLIN_WRONG_USE);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_mesh_stands_where_its_object_does),
        cmocka_unit_test(its_shape_and_its_textures_may_be_smaller),
        cmocka_unit_test(a_mesh_of_ones_own_needs_neither_colours_nor_maps),
    };
    return cmocka_run_group_tests(tests, set_up, tear_down);
}
