/* SPDX-License-Identifier: MIT */
/* glTF by hand: what each of its features means for the surface, and what is refused. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "base/file.h"
#include "mesh/read/mesh_file.h"
#include "mesh/read/mesh_gltf.h"
#include "mesh/read/mesh_limits.h"
#include "scratch.h"

/* last: it defines a macro named fail */
#include <cmocka.h>

/* A document around a buffer: bytes that grow, views and accessors that name them, and the rest as text. */
typedef struct document {
    uint8_t bytes[4096];
    size_t size;
    char views[2000], accessors[2000], meshes[2000], nodes[2000], more[2000];
    int view_count, accessor_count;
} document;

enum { BYTE = 5120, UNSIGNED_BYTE, SHORT, UNSIGNED_SHORT, UNSIGNED_INT = 5125, FLOAT };

static const float TRIANGLE[9] = {0, 0, 0, 2, 0, 0, 0, 3, 0};

static void append(char *text, size_t room, const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    size_t end = strlen(text);
    vsnprintf(text + end, room - end, format, arguments);
    va_end(arguments);
}

/* A view of the bytes; its number. */
static int add_view(document *d, const void *bytes, size_t size, int stride)
{
    memcpy(d->bytes + d->size, bytes, size);
    append(d->views, sizeof d->views, "%s{\"buffer\":0,\"byteOffset\":%zu,\"byteLength\":%zu%s", *d->views ? "," : "",
           d->size, size, stride ? "" : "}");
    if (stride) append(d->views, sizeof d->views, ",\"byteStride\":%d}", stride);
    d->size += size;
    return d->view_count++;
}

static int add_accessor(document *d, const char *text)
{
    append(d->accessors, sizeof d->accessors, "%s{%s}", *d->accessors ? "," : "", text);
    return d->accessor_count++;
}

static int add_array(document *d, const void *bytes, size_t size, int type, int count, const char *shape)
{
    char text[200];
    snprintf(text, sizeof text, "\"bufferView\":%d,\"componentType\":%d,\"count\":%d,\"type\":\"%s\"",
             add_view(d, bytes, size, 0), type, count, shape);
    return add_accessor(d, text);
}

/* A buffer as a data: URI, by way of base 64. */
static void put_uri(const document *d, char *out)
{
    static const char letters[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    out += sprintf(out, "data:application/octet-stream;base64,");
    for (size_t i = 0; i < d->size; i += 3) {
        uint32_t word = (uint32_t)d->bytes[i] << 16 | (uint32_t)d->bytes[i + 1] << 8 | d->bytes[i + 2];
        for (int k = 0; k < 4; k++)
            *out++ = k > (int)(d->size - i) ? '=' : letters[word >> (18 - 6 * k) & 63];
    }
    *out = 0;
}

/* The JSON; uri NULL: of a GLB, which holds the buffer. */
static char *json_of(const document *d, const char *uri)
{
    char *text = NULL;
    const char *before = uri ? ",\"uri\":\"" : "", *after = uri ? "\"" : "";
    assert_true(asprintf(&text,
                         "{\"asset\":{\"version\":\"2.0\"}%s,\"buffers\":[{\"byteLength\":%zu%s%s%s}],"
                         "\"bufferViews\":[%s],\"accessors\":[%s],\"meshes\":[%s],\"nodes\":[%s]}",
                         *d->more ? d->more : ",\"scenes\":[{\"nodes\":[0]}]", d->size, before, uri ? uri : "", after,
                         d->views, d->accessors, d->meshes, *d->nodes ? d->nodes : "{\"mesh\":0}") > 0);
    return text;
}

static status read_document(const document *d, scn_mesh *mesh, int *parts)
{
    char uri[8000];
    put_uri(d, uri);
    char *text = json_of(d, uri);
    *mesh = (scn_mesh){0};
    status s = mesh_parse_gltf(text, strlen(text), NULL, mesh, parts);
    free(text);
    return s;
}

static void must_read(const document *d, scn_mesh *mesh, int *parts)
{
    if (read_document(d, mesh, parts) != OK) fail_msg("%s", status_message());
}

static void must_refuse(const document *d, const char *why)
{
    scn_mesh mesh;
    int parts;
    assert_int_equal(read_document(d, &mesh, &parts), MERLIN_BAD_INPUT);
    if (!strstr(status_message(), why)) fail_msg("\"%s\" does not say \"%s\"", status_message(), why);
    mesh_free(&mesh);
}

static vec3 corner_of(const scn_mesh *mesh, uint32_t triangle, int corner)
{
    return mesh->position[mesh->triangle[triangle][corner]];
}

static void assert_at(vec3 p, float x, float y, float z)
{
    if (fabsf(p.x - x) < 1e-6f && fabsf(p.y - y) < 1e-6f && fabsf(p.z - z) < 1e-6f) return;
    fail_msg("(%g %g %g) is not (%g %g %g)", (double)p.x, (double)p.y, (double)p.z, (double)x, (double)y, (double)z);
}

/* One triangle, (0 0 0), (2 0 0), (0 3 0), without corners. */
static document triangle_document(void)
{
    document d = {0};
    add_array(&d, TRIANGLE, sizeof TRIANGLE, FLOAT, 3, "VEC3");
    append(d.meshes, sizeof d.meshes, "{\"primitives\":[{\"attributes\":{\"POSITION\":0}}]}");
    return d;
}

static void assert_triangle(const scn_mesh *mesh)
{
    assert_int_equal(mesh->triangle_count, 1);
    assert_at(corner_of(mesh, 0, 0), 0, 0, 0);
    assert_at(corner_of(mesh, 0, 1), 2, 0, 0);
    assert_at(corner_of(mesh, 0, 2), 0, 3, 0);
}

/* ---- containers ---- */

static void a_buffer_may_be_text_a_file_or_a_glbs_own(void **state)
{
    (void)state;
    document d = triangle_document();
    scn_mesh mesh;
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
    alarm(20); /* whoever opens a pipe that nobody writes to waits for ever */
    for (size_t i = 0; i < sizeof URIS / sizeof *URIS; i++) {
        char *text = json_of(&d, URIS[i][0]);
        scn_mesh mesh = {0};
        int parts;
        assert_int_equal(mesh_parse_gltf(text, strlen(text), scratch, &mesh, &parts), MERLIN_BAD_INPUT);
        if (!strstr(status_message(), URIS[i][1])) fail_msg("%s: %s", URIS[i][0], status_message());
        mesh_free(&mesh);
        free(text);
    }
    alarm(0);
}

/* ---- accessors ---- */

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
            /* three numbers and one of no meaning a vertex */
            snprintf(text, sizeof text,
                     "\"bufferView\":%d,\"componentType\":%d,\"count\":3,\"type\":\"VEC3\",\"normalized\":%s",
                     add_view(&d, CASES[i].bytes, CASES[i].size, (int)CASES[i].size / 3), CASES[i].type,
                     normalized ? "true" : "false");
            add_accessor(&d, text);
            append(d.meshes, sizeof d.meshes, "{\"primitives\":[{\"attributes\":{\"POSITION\":0}}]}");
            append(d.more, sizeof d.more,
                   ",\"extensionsRequired\":[\"KHR_mesh_quantization\",\"KHR_materials_unlit\"],\"scenes\":[{\"nodes\":"
                   "[0]}]");
            scn_mesh mesh;
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
        scn_mesh mesh;
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

/* Vertices between others, and normals in the same view. */
static void elements_may_lie_apart(void **state)
{
    (void)state;
    static const float MIXED[18] = {0, 0, 0, 0, 0, 5, 2, 0, 0, 0, 0, 5, 0, 3, 0, 0, 0, 5};
    document d = {0};
    scn_mesh mesh;
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
        scn_mesh mesh;
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

/* ---- primitives ---- */

static void strips_and_fans_wind_as_their_first_triangle(void **state)
{
    (void)state;
    static const float STRIP[] = {0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 1, 0, 0, 2, 0};
    static const float FAN[] = {0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0, -1, 1, 0};
    for (int mode = 5; mode <= 6; mode++) {
        document d = {0};
        scn_mesh mesh;
        int parts;
        add_array(&d, mode == 5 ? STRIP : FAN, sizeof STRIP, FLOAT, 5, "VEC3");
        append(d.meshes, sizeof d.meshes,
               "{\"primitives\":[{\"attributes\":{\"POSITION\":0},\"mode\":%d},"
               "{\"attributes\":{\"POSITION\":0},\"mode\":1},{\"attributes\":{\"POSITION\":0},\"mode\":0}]}",
               mode);
        must_read(&d, &mesh, &parts);
        assert_int_equal(mesh.triangle_count, 3); /* lines and points are none */
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
    scn_mesh mesh;
    int parts;
    d.meshes[0] = 0;
    append(d.meshes, sizeof d.meshes,
           "{\"primitives\":[{\"attributes\":{\"POSITION\":0}},{\"attributes\":{\"POSITION\":0},\"material\":7},"
           "{\"attributes\":{\"POSITION\":0},\"material\":2},{\"attributes\":{\"POSITION\":0},\"material\":7}]},"
           "{\"primitives\":[{\"attributes\":{\"POSITION\":0},\"material\":5}]}");
    must_read(&d, &mesh, &parts);
    const uint8_t wanted[] = {2, 1, 0, 1};
    assert_int_equal(parts, 3); /* what is not shown is none */
    assert_int_equal(mesh.triangle_count, 4);
    assert_memory_equal(mesh.part, wanted, sizeof wanted);
    mesh_free(&mesh);
}

/* ---- nodes ---- */

static void transforms_of_nodes_add_up(void **state)
{
    (void)state;
    document d = triangle_document();
    scn_mesh mesh;
    int parts;
    /* moved by (0 0 7); turned a quarter about z and twice as large; and a matrix that moves by x */
    append(d.nodes, sizeof d.nodes,
           "{\"children\":[1],\"translation\":[0,0,7]},"
           "{\"children\":[2],\"rotation\":[0,0,0.7071067811865476,0.7071067811865476],\"scale\":[2,2,2]},"
           "{\"mesh\":0,\"matrix\":[1,0,0,0,0,1,0,0,0,0,1,0,10,0,0,1]}");
    must_read(&d, &mesh, &parts);
    /* about the mesh's own origin, which lies at (0 20 7) */
    assert_at(corner_of(&mesh, 0, 0), 0, 0, 0);
    assert_at(corner_of(&mesh, 0, 1), 0, 4, 0);
    assert_at(corner_of(&mesh, 0, 2), -6, 0, 0);
    mesh_free(&mesh);
}

static void several_meshes_keep_their_places(void **state)
{
    (void)state;
    document d = triangle_document();
    scn_mesh mesh;
    int parts;
    append(d.nodes, sizeof d.nodes,
           "{\"children\":[1,2]},{\"mesh\":0,\"translation\":[5e6,0,0]},{\"mesh\":0,\"translation\":[5e6,0.25,1]}");
    must_read(&d, &mesh, &parts);
    assert_int_equal(mesh.triangle_count, 2);
    assert_at(corner_of(&mesh, 0, 1), 2, 0, 0); /* floats lie 0.5 apart where it is */
    assert_at(corner_of(&mesh, 1, 1), 2, 0.25f, 1);
    mesh_free(&mesh);
}

static void mirrored_nodes_wind_the_other_way_and_normals_follow(void **state)
{
    (void)state;
    static const float NORMALS[9] = {0, 0.6f, 0.8f, 0, 0.6f, 0.8f, 0, 0.6f, 0.8f};
    document d = {0};
    scn_mesh mesh;
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
                 {",\"extras\":[]", 3}}; /* none: all */
    for (size_t i = 0; i < sizeof CASES / sizeof *CASES; i++) {
        document d = triangle_document();
        scn_mesh mesh;
        int parts;
        append(d.more, sizeof d.more, "%s", CASES[i].scenes);
        append(d.nodes, sizeof d.nodes, "{\"mesh\":0},{\"mesh\":0,\"children\":[2]},{\"mesh\":0}");
        must_read(&d, &mesh, &parts);
        assert_int_equal(mesh.triangle_count, CASES[i].triangles);
        mesh_free(&mesh);
    }
}

/* ---- mischief ---- */

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
        scn_mesh mesh = {0};
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
    scn_mesh mesh = {0};
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

/* A small file in which much is said by naming one thing often: 9000 times 300 triangles. */
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
    scn_mesh mesh = {0};
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
        cmocka_unit_test(a_buffer_may_be_text_a_file_or_a_glbs_own),
        cmocka_unit_test(buffers_that_are_no_plain_files_beside_it_are_refused),
        cmocka_unit_test(positions_may_be_numbers_of_any_type),
        cmocka_unit_test(corners_may_be_whole_numbers_of_three_sizes),
        cmocka_unit_test(elements_may_lie_apart),
        cmocka_unit_test(sparse_accessors_replace_what_is_there_or_zeros),
        cmocka_unit_test(strips_and_fans_wind_as_their_first_triangle),
        cmocka_unit_test(materials_are_the_parts_in_their_order),
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
