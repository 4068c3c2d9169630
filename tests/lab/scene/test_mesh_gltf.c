/* SPDX-License-Identifier: MIT */
/* glTF written by hand: the effect of each feature on the surface, and what is refused. */
#include "gltf_fixture.h"

static void assert_triangle(const triangle_mesh *mesh)
{
    assert_int_equal(mesh->triangle_count, 1);
    assert_at(corner_of(mesh, 0, 0), 0, 0, 0);
    assert_at(corner_of(mesh, 0, 1), 2, 0, 0);
    assert_at(corner_of(mesh, 0, 2), 0, 3, 0);
}

static void a_buffer_may_be_text_a_file_or_a_glbs_own(void **state)
{
    (void)state;
    document d = triangle_document();
    triangle_mesh mesh;
    int parts;
    must_read(&d, &mesh, &parts);
    assert_triangle(&mesh);
    assert_int_equal(parts, 1);
    mesh_free(&mesh);

    char *text = json_of(&d, "a%20buffer.bin");
    assert_int_equal(file_write(scratch_path("a buffer.bin"), d.bytes, d.size), OK);
    assert_int_equal(file_write(scratch_path("a.gltf"), text, strlen(text)), OK);
    if (mesh_read_gltf(scratch_path("a.gltf"), &mesh, &parts) != OK) fail_msg("%s", status_message());
    assert_triangle(&mesh);
    mesh_free(&mesh);
    free(text);

    text = json_of(&d, NULL);
    size_t length = strlen(text), padded = (length + 3) / 4 * 4;
    uint32_t head[] = {0x46546c67, 2, (uint32_t)(28 + padded + d.size), (uint32_t)padded, 0x4e4f534a};
    uint32_t binary[] = {(uint32_t)d.size, 0x004e4942};
    uint8_t glb[8000];
    memcpy(glb, head, sizeof head);
    memset(glb + 20, ' ', padded);
    memcpy(glb + 20, text, length);
    memcpy(glb + 20 + padded, binary, sizeof binary);
    memcpy(glb + 28 + padded, d.bytes, d.size);
    free(text);
    if (mesh_parse_gltf(glb, 28 + padded + d.size, NULL, &mesh, &parts) != OK) fail_msg("%s", status_message());
    assert_triangle(&mesh);
    mesh_free(&mesh);
    for (size_t left = 0; left < 28 + padded + d.size; left++) {
        assert_int_equal(mesh_parse_gltf(glb, left, NULL, &mesh, &parts), MERLIN_BAD_INPUT);
        mesh_free(&mesh);
    }
    glb[4] = 1;
    assert_int_equal(mesh_parse_gltf(glb, 28 + padded + d.size, NULL, &mesh, &parts), MERLIN_BAD_INPUT);
    assert_non_null(strstr(status_message(), "version 1"));
}

static void buffers_that_are_no_plain_files_beside_it_are_refused(void **state)
{
    (void)state;
    static const char *const URIS[][2] = {
        {"pipe", "not a plain file"},         {"../../dev/zero", "not a plain file"},
        {"nowhere.bin", "nowhere.bin"},       {"http://nowhere/a.bin", "no file beside it"},
        {"data:text/plain,hello", "base 64"}, {"data:;base64,AAAA", "shorter than it says"},
        {"data:;base64,A*AA", "not base 64"}};
    document d = triangle_document();
    assert_int_equal(mkfifo(scratch_path("pipe"), 0600), 0);
    alarm(20); /* opening a pipe without a writer would block forever */
    for (size_t i = 0; i < sizeof URIS / sizeof *URIS; i++) {
        char *text = json_of(&d, URIS[i][0]);
        triangle_mesh mesh = {0};
        int parts;
        assert_int_equal(mesh_parse_gltf(text, strlen(text), scratch, &mesh, &parts), MERLIN_BAD_INPUT);
        if (!strstr(status_message(), URIS[i][1])) fail_msg("%s: %s", URIS[i][0], status_message());
        mesh_free(&mesh);
        free(text);
    }
    alarm(0);
}

static void positions_may_be_numbers_of_any_type(void **state)
{
    (void)state;
    static const int8_t BYTES[12] = {-127, -128, 127, 0, 0, 64, 0, 0, 127, 0, 0, 0};
    static const uint8_t UNSIGNED_BYTES[12] = {0, 255, 51, 0, 255, 0, 0, 0, 0, 0, 255, 0};
    static const int16_t SHORTS[12] = {-32768, 32767, 0, 0, 1000, 0, 0, 0, 0, 1000, 0, 0};
    static const uint16_t UNSIGNED_SHORTS[12] = {65535, 0, 13107, 0, 1000, 0, 0, 0, 0, 1000, 0, 0};
    static const struct {
        const void *bytes;
        size_t size;
        int type;
        float whole[3], fraction[3]; /* the first vertex */
    } CASES[] = {{BYTES, sizeof BYTES, BYTE, {-127, -128, 127}, {-1, -1, 1}},
                 {UNSIGNED_BYTES, sizeof UNSIGNED_BYTES, UNSIGNED_BYTE, {0, 255, 51}, {0, 1, 0.2f}},
                 {SHORTS, sizeof SHORTS, SHORT, {-32768, 32767, 0}, {-1, 1, 0}},
                 {UNSIGNED_SHORTS, sizeof UNSIGNED_SHORTS, UNSIGNED_SHORT, {65535, 0, 13107}, {1, 0, 0.2f}}};
    for (size_t i = 0; i < sizeof CASES / sizeof *CASES; i++)
        for (int normalized = 0; normalized < 2; normalized++) {
            document d = {0};
            char text[200];
            /* three numbers and one without meaning a vertex */
            snprintf(text, sizeof text,
                     "\"bufferView\":%d,\"componentType\":%d,\"count\":3,\"type\":\"VEC3\",\"normalized\":%s",
                     add_view(&d, CASES[i].bytes, CASES[i].size, (int)CASES[i].size / 3), CASES[i].type,
                     normalized ? "true" : "false");
            add_accessor(&d, text);
            append(d.meshes, sizeof d.meshes, "{\"primitives\":[{\"attributes\":{\"POSITION\":0}}]}");
            append(d.more, sizeof d.more,
                   ",\"extensionsRequired\":[\"KHR_mesh_quantization\",\"KHR_materials_unlit\"],\"scenes\":[{\"nodes\":"
                   "[0]}]");
            triangle_mesh mesh;
            int parts;
            must_read(&d, &mesh, &parts);
            const float *wanted = normalized ? CASES[i].fraction : CASES[i].whole;
            assert_at(corner_of(&mesh, 0, 0), wanted[0], wanted[1], wanted[2]);
            mesh_free(&mesh);
        }
}

static void corners_may_be_whole_numbers_of_three_sizes(void **state)
{
    (void)state;
    static const uint8_t BYTES[] = {2, 0, 1, 0};
    static const uint16_t SHORTS[] = {2, 0, 1, 0};
    static const uint32_t WORDS[] = {2, 0, 1, 0};
    static const struct {
        const void *bytes;
        size_t size;
        int type;
    } CASES[] = {{BYTES, sizeof BYTES, UNSIGNED_BYTE},
                 {SHORTS, sizeof SHORTS, UNSIGNED_SHORT},
                 {WORDS, sizeof WORDS, UNSIGNED_INT}};
    for (size_t i = 0; i < sizeof CASES / sizeof *CASES; i++) {
        document d = {0};
        triangle_mesh mesh;
        int parts;
        add_array(&d, TRIANGLE, sizeof TRIANGLE, FLOAT, 3, "VEC3");
        add_array(&d, CASES[i].bytes, CASES[i].size, CASES[i].type, 3, "SCALAR");
        append(d.meshes, sizeof d.meshes, "{\"primitives\":[{\"attributes\":{\"POSITION\":0},\"indices\":1}]}");
        must_read(&d, &mesh, &parts);
        assert_at(corner_of(&mesh, 0, 0), 0, 3, 0);
        assert_at(corner_of(&mesh, 0, 1), 0, 0, 0);
        assert_at(corner_of(&mesh, 0, 2), 2, 0, 0);
        mesh_free(&mesh);
    }
}

/* Vertices are interleaved with others, and normals are in the same view. */
static void elements_may_lie_apart(void **state)
{
    (void)state;
    static const float MIXED[18] = {0, 0, 0, 0, 0, 5, 2, 0, 0, 0, 0, 5, 0, 3, 0, 0, 0, 5};
    document d = {0};
    triangle_mesh mesh;
    int parts;
    add_view(&d, MIXED, sizeof MIXED, 24);
    add_accessor(&d, "\"bufferView\":0,\"componentType\":5126,\"count\":3,\"type\":\"VEC3\"");
    add_accessor(&d, "\"bufferView\":0,\"byteOffset\":12,\"componentType\":5126,\"count\":3,\"type\":\"VEC3\"");
    append(d.meshes, sizeof d.meshes, "{\"primitives\":[{\"attributes\":{\"POSITION\":0,\"NORMAL\":1}}]}");
    must_read(&d, &mesh, &parts);
    assert_triangle(&mesh);
    assert_at(mesh.normal[mesh.triangle[0][2]], 0, 0, 1);
    mesh_free(&mesh);
}

static void sparse_accessors_replace_what_is_there_or_zeros(void **state)
{
    (void)state;
    static const float OTHER[] = {9, 9, 9, 0, 0, 0, 7, 7, 7};
    static const uint8_t PLACES[] = {0, 2, 0, 0};
    static const float VALUES[] = {0, 0, 0, 0, 3, 0};
    static const uint8_t SECOND[] = {1, 2, 0, 0};
    static const float TWO[] = {2, 0, 0, 0, 3, 0};
    for (int zeros = 0; zeros < 2; zeros++) {
        document d = {0};
        triangle_mesh mesh;
        int parts;
        float base[9];
        memcpy(base, OTHER, sizeof base);
        base[3] = 2;
        add_view(&d, base, sizeof base, 0);
        add_view(&d, zeros ? SECOND : PLACES, sizeof PLACES, 0);
        add_view(&d, zeros ? TWO : VALUES, sizeof VALUES, 0);
        char text[300] = "";
        append(text, sizeof text,
               "%s\"componentType\":5126,\"count\":3,\"type\":\"VEC3\",\"sparse\":{\"count\":2,\"indices\":"
               "{\"bufferView\":1,\"componentType\":5121},\"values\":{\"bufferView\":2}}",
               zeros ? "" : "\"bufferView\":0,");
        add_accessor(&d, text);
        append(d.meshes, sizeof d.meshes, "{\"primitives\":[{\"attributes\":{\"POSITION\":0}}]}");
        must_read(&d, &mesh, &parts);
        assert_triangle(&mesh);
        mesh_free(&mesh);
    }
}

static void strips_and_fans_wind_as_their_first_triangle(void **state)
{
    (void)state;
    static const float STRIP[] = {0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 1, 0, 0, 2, 0};
    static const float FAN[] = {0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0, -1, 1, 0};
    for (int mode = 5; mode <= 6; mode++) {
        document d = {0};
        triangle_mesh mesh;
        int parts;
        add_array(&d, mode == 5 ? STRIP : FAN, sizeof STRIP, FLOAT, 5, "VEC3");
        append(d.meshes, sizeof d.meshes,
               "{\"primitives\":[{\"attributes\":{\"POSITION\":0},\"mode\":%d},"
               "{\"attributes\":{\"POSITION\":0},\"mode\":1},{\"attributes\":{\"POSITION\":0},\"mode\":0}]}",
               mode);
        must_read(&d, &mesh, &parts);
        assert_int_equal(mesh.triangle_count, 3); /* lines and points are skipped */
        assert_int_equal(mesh.vertex_count, 5);
        for (uint32_t t = 0; t < 3; t++) {
            vec3 a = corner_of(&mesh, t, 0);
            vec3 n = vec3_cross(vec3_sub(corner_of(&mesh, t, 1), a), vec3_sub(corner_of(&mesh, t, 2), a));
            assert_at(n, 0, 0, 1); /* twice its half of a square */
        }
        mesh_free(&mesh);
        append(d.meshes, sizeof d.meshes, ",{\"primitives\":[{\"attributes\":{\"POSITION\":0},\"mode\":7}]}");
        append(d.nodes, sizeof d.nodes, "{\"mesh\":1}");
        must_refuse(&d, "a primitive of no kind");
    }
}

static void materials_are_the_parts_in_their_order(void **state)
{
    (void)state;
    document d = triangle_document();
    triangle_mesh mesh;
    int parts;
    d.meshes[0] = 0;
    append(d.meshes, sizeof d.meshes,
           "{\"primitives\":[{\"attributes\":{\"POSITION\":0}},{\"attributes\":{\"POSITION\":0},\"material\":7},"
           "{\"attributes\":{\"POSITION\":0},\"material\":2},{\"attributes\":{\"POSITION\":0},\"material\":7}]},"
           "{\"primitives\":[{\"attributes\":{\"POSITION\":0},\"material\":5}]}");
    must_read(&d, &mesh, &parts);
    const uint8_t wanted[] = {2, 1, 0, 1};
    assert_int_equal(parts, 3); /* materials that are not shown are no parts */
    assert_int_equal(mesh.triangle_count, 4);
    assert_memory_equal(mesh.part, wanted, sizeof wanted);
    mesh_free(&mesh);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_buffer_may_be_text_a_file_or_a_glbs_own),
        cmocka_unit_test(buffers_that_are_no_plain_files_beside_it_are_refused),
        cmocka_unit_test(positions_may_be_numbers_of_any_type),
        cmocka_unit_test(corners_may_be_whole_numbers_of_three_sizes),
        cmocka_unit_test(elements_may_lie_apart),
        cmocka_unit_test(sparse_accessors_replace_what_is_there_or_zeros),
        cmocka_unit_test(strips_and_fans_wind_as_their_first_triangle),
        cmocka_unit_test(materials_are_the_parts_in_their_order),
    };
    return cmocka_run_group_tests(tests, scratch_open, scratch_close);
}
