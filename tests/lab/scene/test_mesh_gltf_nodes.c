/* SPDX-License-Identifier: MIT */
/* Nodes of a glTF: transforms, meshes that are used twice, scenes, and what is refused. */
#include "gltf_fixture.h"

static void transforms_of_nodes_add_up(void **state)
{
    (void)state;
    document d = triangle_document();
    triangle_mesh mesh;
    int parts;
    /* translated by (0 0 7); rotated a quarter about z and scaled by two; and a matrix that translates along x */
    append(d.nodes, sizeof d.nodes,
           "{\"children\":[1],\"translation\":[0,0,7]},"
           "{\"children\":[2],\"rotation\":[0,0,0.7071067811865476,0.7071067811865476],\"scale\":[2,2,2]},"
           "{\"mesh\":0,\"matrix\":[1,0,0,0,0,1,0,0,0,0,1,0,10,0,0,1]}");
    must_read(&d, &mesh, &parts);
    /* about the mesh's own origin, at (0 20 7) */
    assert_at(corner_of(&mesh, 0, 0), 0, 0, 0);
    assert_at(corner_of(&mesh, 0, 1), 0, 4, 0);
    assert_at(corner_of(&mesh, 0, 2), -6, 0, 0);
    mesh_free(&mesh);
}

static void several_meshes_keep_their_places(void **state)
{
    (void)state;
    document d = triangle_document();
    triangle_mesh mesh;
    int parts;
    append(d.nodes, sizeof d.nodes,
           "{\"children\":[1,2]},{\"mesh\":0,\"translation\":[5e6,0,0]},{\"mesh\":0,\"translation\":[5e6,0.25,1]}");
    must_read(&d, &mesh, &parts);
    assert_int_equal(mesh.triangle_count, 2);
    assert_at(corner_of(&mesh, 0, 1), 2, 0, 0); /* floats are 0.5 apart at its position */
    assert_at(corner_of(&mesh, 1, 1), 2, 0.25f, 1);
    mesh_free(&mesh);
}

static void mirrored_nodes_wind_the_other_way_and_normals_follow(void **state)
{
    (void)state;
    static const float NORMALS[9] = {0, 0.6f, 0.8f, 0, 0.6f, 0.8f, 0, 0.6f, 0.8f};
    document d = {0};
    triangle_mesh mesh;
    int parts;
    add_array(&d, TRIANGLE, sizeof TRIANGLE, FLOAT, 3, "VEC3");
    add_array(&d, NORMALS, sizeof NORMALS, FLOAT, 3, "VEC3");
    append(d.meshes, sizeof d.meshes, "{\"primitives\":[{\"attributes\":{\"POSITION\":0,\"NORMAL\":1}}]}");
    append(d.nodes, sizeof d.nodes, "{\"mesh\":0,\"scale\":[-1,2,1]}");
    must_read(&d, &mesh, &parts);
    assert_at(corner_of(&mesh, 0, 1), 0, 6, 0);
    assert_at(corner_of(&mesh, 0, 2), -2, 0, 0);
    /* by the inverse's transpose: (0, 0.6 / 2, 0.8) */
    assert_at(mesh.normal[mesh.triangle[0][0]], 0, 0.3f / 0.8544003745f, 0.8f / 0.8544003745f);
    mesh_free(&mesh);
}

static void the_scene_that_is_meant_is_read(void **state)
{
    (void)state;
    static const struct {
        const char *scenes;
        uint32_t triangles;
    } CASES[] = {{",\"scenes\":[{\"nodes\":[0]},{\"nodes\":[0,1]}]", 1},
                 {",\"scene\":1,\"scenes\":[{\"nodes\":[0]},{\"nodes\":[0,1]}]", 3},
                 {",\"extras\":[]", 3}}; /* without scenes: all nodes */
    for (size_t i = 0; i < sizeof CASES / sizeof *CASES; i++) {
        document d = triangle_document();
        triangle_mesh mesh;
        int parts;
        append(d.more, sizeof d.more, "%s", CASES[i].scenes);
        append(d.nodes, sizeof d.nodes, "{\"mesh\":0},{\"mesh\":0,\"children\":[2]},{\"mesh\":0}");
        must_read(&d, &mesh, &parts);
        assert_int_equal(mesh.triangle_count, CASES[i].triangles);
        mesh_free(&mesh);
    }
}

static void nodes_that_are_no_tree_are_refused(void **state)
{
    (void)state;
    static const char *const NODES[][2] = {{"{\"mesh\":0,\"children\":[0]}", "two parents"},
                                           {"{\"children\":[1]},{\"mesh\":0,\"children\":[0]}", "two parents"},
                                           {"{\"children\":[1,1]},{\"mesh\":0}", "two parents"},
                                           {"{\"mesh\":0,\"children\":[1]}", "not there"},
                                           {"{\"mesh\":0,\"children\":[-1]}", "not there"},
                                           {"{\"mesh\":0,\"children\":[1e300]}", "not there"},
                                           {"{\"mesh\":0,\"children\":[\"0\"]}", "not there"},
                                           {"{\"mesh\":1}", "not there"},
                                           {"{\"mesh\":0.5}", "not there"},
                                           {"{\"mesh\":0,\"scale\":[1,1]}", "not whole"},
                                           {"{\"mesh\":0,\"matrix\":[1,1]}", "16 numbers"},
                                           {"{\"mesh\":0,\"scale\":[1e300,1,1]}", "not finite"},
                                           {"{\"mesh\":0,\"translation\":[1e999,1,1]}", "not finite"}};
    for (size_t i = 0; i < sizeof NODES / sizeof *NODES; i++) {
        document d = triangle_document();
        append(d.nodes, sizeof d.nodes, "%s", NODES[i][0]);
        must_refuse(&d, NODES[i][1]);
    }
}

static void accessors_that_reach_too_far_are_refused(void **state)
{
    (void)state;
    static const char *const POSITIONS[][2] = {
        {"\"bufferView\":0,\"componentType\":5126,\"count\":4,\"type\":\"VEC3\"", "too short"},
        {"\"bufferView\":0,\"byteOffset\":4,\"componentType\":5126,\"count\":3,\"type\":\"VEC3\"", "too short"},
        {"\"bufferView\":0,\"byteOffset\":1e15,\"componentType\":5126,\"count\":3,\"type\":\"VEC3\"", "not there"},
        {"\"bufferView\":1,\"componentType\":5126,\"count\":3,\"type\":\"VEC3\"", "not there"},
        {"\"bufferView\":0,\"componentType\":5126,\"count\":-3,\"type\":\"VEC3\"", "without type or count"},
        {"\"bufferView\":0,\"componentType\":5124,\"count\":3,\"type\":\"VEC3\"", "without type or count"},
        {"\"bufferView\":0,\"componentType\":5126,\"count\":3,\"type\":\"MAT4\"", "without type or count"},
        {"\"bufferView\":0,\"componentType\":5126,\"count\":3,\"type\":\"VEC2\"", "without x, y, z"},
        {"\"componentType\":5126,\"count\":3,\"type\":\"VEC3\"", "not stored"},
        {"\"bufferView\":0,\"componentType\":5126,\"count\":4000000000,\"type\":\"VEC3\"", "at most"},
        {"\"bufferView\":0,\"componentType\":5126,\"count\":3,\"type\":\"VEC3\",\"sparse\":{\"count\":4000000000,"
         "\"indices\":{\"bufferView\":0,\"componentType\":5123},\"values\":{\"bufferView\":0}}",
         "more than there is"},
        {"\"bufferView\":0,\"componentType\":5126,\"count\":3,\"type\":\"VEC3\",\"sparse\":{\"count\":2,"
         "\"indices\":{\"bufferView\":0,\"componentType\":5123},\"values\":{\"bufferView\":0}}",
         "do not ascend"},
        {"\"bufferView\":0,\"componentType\":5126,\"count\":3,\"type\":\"VEC3\",\"sparse\":{\"count\":1,"
         "\"indices\":{\"bufferView\":0,\"byteOffset\":14,\"componentType\":5123},\"values\":{\"bufferView\":0}}",
         "do not ascend"}, /* half of the float 2 is 16384 */
        {"\"bufferView\":0,\"componentType\":5126,\"count\":3,\"type\":\"VEC3\",\"sparse\":{\"count\":1,"
         "\"indices\":{\"bufferView\":0,\"byteOffset\":36,\"componentType\":5123},\"values\":{\"bufferView\":0}}",
         "too short"}};
    for (size_t i = 0; i < sizeof POSITIONS / sizeof *POSITIONS; i++) {
        document d = {0};
        add_view(&d, TRIANGLE, sizeof TRIANGLE, 0);
        add_accessor(&d, POSITIONS[i][0]);
        append(d.meshes, sizeof d.meshes, "{\"primitives\":[{\"attributes\":{\"POSITION\":0}}]}");
        must_refuse(&d, POSITIONS[i][1]);
    }
    static const uint8_t PLACES[] = {0, 1, 3, 0};
    document d = {0};
    add_array(&d, TRIANGLE, sizeof TRIANGLE, FLOAT, 3, "VEC3");
    add_array(&d, PLACES, sizeof PLACES, UNSIGNED_BYTE, 3, "SCALAR");
    append(d.meshes, sizeof d.meshes, "{\"primitives\":[{\"attributes\":{\"POSITION\":0},\"indices\":1}]}");
    must_refuse(&d, "vertices that are not there");
    d.meshes[0] = 0;
    append(d.meshes, sizeof d.meshes, "{\"primitives\":[{\"attributes\":{\"POSITION\":0},\"indices\":0}]}");
    must_refuse(&d, "no whole numbers");
    d.meshes[0] = 0;
    append(d.meshes, sizeof d.meshes, "{\"primitives\":[{\"attributes\":{\"POSITION\":0,\"NORMAL\":9}}]}");
    must_refuse(&d, "an accessor that is not there");
    d.meshes[0] = 0;
    append(d.meshes, sizeof d.meshes, "{\"primitives\":[{\"attributes\":{}},{}]}");
    must_refuse(&d, "no triangles");
}

static void what_is_compressed_or_of_another_version_is_refused_by_name(void **state)
{
    (void)state;
    static const char *const NAMES[] = {"KHR_draco_mesh_compression", "EXT_meshopt_compression",
                                        "EXT_mesh_gpu_instancing", "VENDOR_unknown"};
    for (size_t i = 0; i < sizeof NAMES / sizeof *NAMES; i++) {
        document d = triangle_document();
        append(d.more, sizeof d.more, ",\"scenes\":[{\"nodes\":[0]}],\"extensionsRequired\":[\"%s\"]", NAMES[i]);
        must_refuse(&d, NAMES[i]);
    }
    static const char *const OTHERS[][2] = {
        {"{\"asset\":{\"version\":\"1.0\"}}", "version 1.0"},
        {"{}", "not a glTF file"},
        {"[1,2]", "not a glTF file"},
        {"{\"asset\":{\"version\":\"2.0\"}}", "no triangles"},
        {"{\"asset\":{\"version\":\"2.0\"},\"scene\":3,\"scenes\":[{}]}", "a scene"},
        {"{\"asset\"", "JSON"},
        {"", "JSON"}};
    for (size_t i = 0; i < sizeof OTHERS / sizeof *OTHERS; i++) {
        triangle_mesh mesh = {0};
        int parts;
        assert_int_equal(mesh_parse_gltf(OTHERS[i][0], strlen(OTHERS[i][0]), NULL, &mesh, &parts), MERLIN_BAD_INPUT);
        if (!strstr(status_message(), OTHERS[i][1])) fail_msg("%s: %s", OTHERS[i][0], status_message());
        mesh_free(&mesh);
    }
}

static void json_too_deep_or_of_too_many_values_is_refused_before_it_is_taken_apart(void **state)
{
    (void)state;
    enum { SIZE = 5000000 };
    char *text = malloc(SIZE);
    assert_non_null(text);
    triangle_mesh mesh = {0};
    int parts;
    memset(text, '[', SIZE);
    assert_int_equal(mesh_parse_gltf(text, SIZE, NULL, &mesh, &parts), MERLIN_BAD_INPUT);
    assert_non_null(strstr(status_message(), "levels deep"));
    for (size_t i = 1; i + 1 < SIZE; i += 2)
        memcpy(text + i, "0,", 2);
    assert_int_equal(mesh_parse_gltf(text, SIZE, NULL, &mesh, &parts), MERLIN_BAD_INPUT);
    assert_non_null(strstr(status_message(), "values"));
    free(text);
}

/* The file is small and refers to one mesh often: 9000 times 300 triangles. */
static void a_small_file_has_no_more_triangles_than_a_million(void **state)
{
    (void)state;
    enum { TIMES = 9000, POINTS = 900, BYTES = 12 * POINTS };
    char *text = calloc(1, 500000);
    assert_non_null(text);
    size_t end = (size_t)sprintf(text,
                                 "{\"asset\":{\"version\":\"2.0\"},\"nodes\":[{\"mesh\":0}],\"bufferViews\":"
                                 "[{\"buffer\":0,\"byteLength\":%d}],\"accessors\":[{\"bufferView\":0,"
                                 "\"componentType\":5126,\"count\":%d,\"type\":\"VEC3\"}],\"buffers\":[{"
                                 "\"byteLength\":%d,\"uri\":\"data:;base64,",
                                 BYTES, POINTS, BYTES);
    memset(text + end, 'A', BYTES / 3 * 4);
    end += BYTES / 3 * 4;
    end += (size_t)sprintf(text + end, "\"}],\"meshes\":[{\"primitives\":[");
    for (int i = 0; i < TIMES; i++)
        end += (size_t)sprintf(text + end, "%s{\"attributes\":{\"POSITION\":0}}", i ? "," : "");
    end += (size_t)sprintf(text + end, "]}]}");
    triangle_mesh mesh = {0};
    int parts;
    assert_int_equal(mesh_parse_gltf(text, end, NULL, &mesh, &parts), MERLIN_BAD_INPUT);
    assert_non_null(strstr(status_message(), "triangles"));
    assert_int_equal(mesh.triangle_count, 0);
    free(text);
    assert_int_equal(mesh_most_triangles(1000), 1000250);
    assert_int_equal(mesh_most_triangles(MESH_BYTES), 5000000);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(transforms_of_nodes_add_up),
        cmocka_unit_test(several_meshes_keep_their_places),
        cmocka_unit_test(mirrored_nodes_wind_the_other_way_and_normals_follow),
        cmocka_unit_test(the_scene_that_is_meant_is_read),
        cmocka_unit_test(nodes_that_are_no_tree_are_refused),
        cmocka_unit_test(accessors_that_reach_too_far_are_refused),
        cmocka_unit_test(what_is_compressed_or_of_another_version_is_refused_by_name),
        cmocka_unit_test(json_too_deep_or_of_too_many_values_is_refused_before_it_is_taken_apart),
        cmocka_unit_test(a_small_file_has_no_more_triangles_than_a_million),
    };
    return cmocka_run_group_tests(tests, scratch_open, scratch_close);
}
