/* SPDX-License-Identifier: MIT */
/* Meshes from files: OBJ, PLY and glTF load, are posed like generated objects, and broken files are refused with a
 * clear message. */
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
#include "lab/scene/scene.h"
#include "scratch.h"

/* last, as cmocka defines a macro named fail */
#include <cmocka.h>

/* A unit cube of six quads, counter-clockwise from outside. */
#define CUBE_VERTICES "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0 0 1\nv 1 0 1\nv 1 1 1\nv 0 1 1\n"
#define CUBE_FACES "f 1 4 3 2\nf 5 6 7 8\nf 1 2 6 5\nf 2 3 7 6\nf 3 4 8 7\nf 4 1 5 8\n"

static const char INSIDE_OUT[] = CUBE_VERTICES "f 2 3 4 1\nf 8 7 6 5\nf 5 6 2 1\nf 6 7 3 2\nf 7 8 4 3\nf 8 5 1 4\n";

static const char PLY_HEAD[] = "element vertex 4\nproperty float x\nproperty float y\nproperty float z\n"
                               "element face 4\nproperty list uchar int vertex_indices\nend_header\n";

static status object_of(const char *path, uint64_t seed, uint64_t index, scene_object *out)
{
    scene_model *model;
    status s = scene_model_read(path, &model);
    if (s == OK) s = scene_object_from_model(model, seed, index, 60, out);
    scene_model_free(model);
    return s;
}

static status load(const char *name, const void *data, size_t size, scene_object *out)
{
    const char *path = scratch_path(name);
    assert_int_equal(file_write(path, data, size), OK);
    return object_of(path, 1, 2, out);
}

static double signed_volume(const scene_object *o)
{
    double sum = 0;
    for (uint32_t t = 0; t < o->triangle_count; t++) {
        vec3 p[3];
        for (int k = 0; k < 3; k++)
            p[k] = vec3_sub(o->position[o->triangle[t][k]], o->position[0]);
        sum += (double)vec3_dot(vec3_cross(p[0], p[1]), p[2]);
    }
    return sum;
}

static void check_cube(const scene_object *o)
{
    assert_int_equal(o->triangle_count, 12);
    assert_int_equal(o->vertex_count, 24); /* every corner is split by its three creases */
    assert_true(signed_volume(o) > 0);
    for (uint32_t t = 0; t < o->triangle_count; t++) {
        scene_surface s;
        scene_surfaces_eval(o, &(scene_place){t, 0.3f, 0.3f}, 1, &s);
        for (int k = 0; k < 3; k++) /* flat faces: float rounding only */
            assert_true(vec3_dot(o->normal[o->triangle[t][k]], s.geometric_normal) > 0.9999f);
    }
}

static void polygons_without_normals_are_triangulated_and_creased(void **state)
{
    (void)state;
    scene_object o;
    const char text[] = CUBE_VERTICES CUBE_FACES;
    assert_int_equal(load("cube.obj", text, sizeof text - 1, &o), OK);
    check_cube(&o);
    assert_string_equal(o.shape, "mesh");
    scene_object_free(&o);
}

/* The cube is at half its size, between vertices that no face uses. */
static void obj_numbers_may_begin_with_their_point(void **state)
{
    (void)state;
    scene_object o;
    const char text[] = "\xef\xbb\xbfv .5 0 0\nv .5\t.5 .5\nvt .25 .75\n"
                        "v 0 0 0\nv .5 0 0\nv .5 .5 0\nv 0 .5 0\nv 0 0 .5\nv .5 0 .5\nv .5 .5 .5\nv 0 .5 .5\n"
                        "v 7 7 7\nv 8 8 8\nf 3 6 5 4\nf 7 8 9 10\nf 3 4 8 7\nf 4 5 9 8\nf 5 6 10 9\nf 6 3 7 10\n";
    assert_int_equal(load("points.obj", text, sizeof text - 1, &o), OK);
    check_cube(&o);
    scene_object_free(&o);
}

static void inward_surfaces_are_turned_outward(void **state)
{
    (void)state;
    scene_object o;
    assert_int_equal(load("cube.obj", INSIDE_OUT, sizeof INSIDE_OUT - 1, &o), OK);
    check_cube(&o);
    scene_object_free(&o);
}

static void ascii_ply_is_read(void **state)
{
    (void)state;
    char text[600];
    int size =
        snprintf(text, sizeof text,
                 "ply\nformat ascii 1.0\n%s0 0 0\n1 0 0\n0 1 0\n0 0 1\n3 0 2 1\n3 0 1 3\n3 0 3 2\n3 1 2 3\n", PLY_HEAD);
    scene_object o;
    assert_int_equal(load("t.ply", text, (size_t)size, &o), OK);
    assert_int_equal(o.triangle_count, 4);
    assert_true(signed_volume(&o) > 0);
    scene_object_free(&o);
}

/* Loads the tetrahedron of ascii_ply_is_read among more vertices, in the given type, moved and scaled. */
static status load_tetrahedron(const char *type, double x, double size, const char *stray, scene_object *out)
{
    char text[800];
    int length = snprintf(text, sizeof text,
                          "ply\nformat ascii 1.0\nelement vertex %d\nproperty %s x\nproperty %s y\nproperty %s z\n"
                          "element face 4\nproperty list uchar int vertex_indices\nend_header\n"
                          "%.9f 0 0\n%.9f 0 0\n%.9f %.9f 0\n%.9f 0 %.9f\n%s3 0 2 1\n3 0 1 3\n3 0 3 2\n3 1 2 3\n",
                          *stray ? 5 : 4, type, type, type, x, x + size, x, size, x, size, stray);
    return load("t.ply", text, (size_t)length, out);
}

static void vertices_of_no_face_do_not_count_for_the_frame(void **state)
{
    (void)state;
    scene_object without, with;
    assert_int_equal(load_tetrahedron("float", 0, 1, "", &without), OK);
    assert_int_equal(load_tetrahedron("float", 0, 1, "100 0 0\n", &with), OK);
    assert_int_equal(with.vertex_count, without.vertex_count);
    assert_memory_equal(with.position, without.position, with.vertex_count * sizeof *with.position);
    scene_object_free(&with);
    scene_object_free(&without);
}

/* The square with a notch is listed from each of its corners on. */
static void concave_polygons_of_a_ply_do_not_fold_over(void **state)
{
    (void)state;
    for (int first = 0; first < 5; first++) {
        char text[400];
        int length = snprintf(text, sizeof text,
                              "ply\nformat ascii 1.0\nelement vertex 5\nproperty float x\nproperty float y\n"
                              "property float z\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n"
                              "0 0 0\n4 0 0\n4 4 0\n2 1 0\n0 4 0\n5 %d %d %d %d %d\n",
                              first, (first + 1) % 5, (first + 2) % 5, (first + 3) % 5, (first + 4) % 5);
        scene_object o;
        scene_surface one, other;
        assert_int_equal(load("notch.ply", text, (size_t)length, &o), OK);
        assert_int_equal(o.triangle_count, 3);
        scene_surfaces_eval(&o, &(scene_place){0, 0.3f, 0.3f}, 1, &one);
        for (uint32_t t = 1; t < 3; t++) {
            scene_surfaces_eval(&o, &(scene_place){t, 0.3f, 0.3f}, 1, &other);
            assert_true(vec3_dot(one.geometric_normal, other.geometric_normal) > 0.999f); /* one plane */
        }
        scene_object_free(&o);
    }
}

static void ply_far_from_its_origin_keeps_its_digits(void **state)
{
    (void)state;
    scene_object here, far;
    assert_int_equal(load_tetrahedron("double", 0, 0.7, "", &here), OK);
    assert_int_equal(load_tetrahedron("double", 5.1e6, 0.7, "", &far), OK); /* floats are 0.5 apart there */
    assert_int_equal(far.vertex_count, here.vertex_count);
    for (uint32_t v = 0; v < far.vertex_count; v++) /* float rounding of lengths near 1 */
        assert_true(vec3_length(vec3_sub(far.position[v], here.position[v])) < 1e-5f);
    scene_object_free(&far);
    scene_object_free(&here);
}

/* The square's triangles share no corner in the file. */
static void corners_that_only_texture_or_material_tells_apart_are_one_vertex(void **state)
{
    (void)state;
    static const char *const TEXTS[] = {
        "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 1 1\nvt 0.5 0\nvt 0.5 1\nvt 0 1\n"
        "f 1/1 2/2 3/3\nf 1/4 3/5 4/6\n",
        "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nusemtl a\nf 1 2 3\nusemtl b\nf 1 3 4\n"};
    for (int i = 0; i < 2; i++) {
        scene_object o;
        assert_int_equal(load("square.obj", TEXTS[i], strlen(TEXTS[i]), &o), OK);
        assert_int_equal(o.vertex_count, 4);
        assert_int_equal(o.triangle_count, 2);
        assert_int_equal(o.part[1], i);
        scene_object_free(&o);
    }
}

/* A face that is repeated, from another corner or with vertices of its own, adds nothing; its reverse does. */
static void triangles_that_lie_where_others_do_are_dropped(void **state)
{
    (void)state;
    static const char TEXT[] = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nv -0 0 0\nv 1 0 0\nv 0 1 0\n"
                               "f 1 2 3\nf 2 3 1\nf 7 5 6\nf 1 3 2\nf 1 2 4\nf 2 4 1\n";
    scene_object o;
    assert_int_equal(load("again.obj", TEXT, sizeof TEXT - 1, &o), OK);
    assert_int_equal(o.triangle_count, 3);
    scene_object_free(&o);
}

/* The mirrored half of a figure has such triangles. */
static void triangles_that_wind_against_their_normals_are_turned(void **state)
{
    (void)state;
    static const char TEXT[] = "v 1 0 0\nv 0 1 0\nv 0 0 1\nv -1 0 0\nv 0 -1 0\nv 0 0 -1\n"
                               "vn 1 0 0\nvn 0 1 0\nvn 0 0 1\nvn -1 0 0\nvn 0 -1 0\nvn 0 0 -1\n"
                               "f 1//1 2//2 3//3\nf 2//2 4//4 3//3\nf 4//4 5//5 3//3\nf 5//5 1//1 3//3\n"
                               "f 1//1 2//2 6//6\nf 2//2 4//4 6//6\nf 4//4 5//5 6//6\n";
    scene_object o;
    assert_int_equal(load("mirrored.obj", TEXT, sizeof TEXT - 1, &o), OK);
    assert_int_equal(o.triangle_count, 7);
    for (uint32_t t = 0; t < o.triangle_count; t++) {
        scene_surface s;
        scene_surfaces_eval(&o, &(scene_place){t, 0.333f, 0.333f}, 1, &s);
        for (int k = 0; k < 3; k++)
            assert_true(vec3_dot(o.normal[o.triangle[t][k]], s.geometric_normal) > 0);
    }
    scene_object_free(&o);
}

static void binary_ply_is_read(void **state)
{
    (void)state;
    static const float POINTS[12] = {0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1};
    static const int32_t FACES[4][3] = {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}};
    char data[600];
    size_t size = (size_t)snprintf(data, sizeof data, "ply\nformat binary_little_endian 1.0\n%s", PLY_HEAD);
    memcpy(data + size, POINTS, sizeof POINTS);
    size += sizeof POINTS;
    for (int i = 0; i < 4; i++) {
        data[size++] = 3;
        memcpy(data + size, FACES[i], sizeof FACES[i]);
        size += sizeof FACES[i];
    }
    scene_object o;
    assert_int_equal(load("t.ply", data, size, &o), OK);
    assert_int_equal(o.triangle_count, 4);
    assert_true(signed_volume(&o) > 0);
    scene_object_free(&o);
    for (size_t left = 0; left < size; left += 7)
        assert_int_equal(load("cut.ply", data, left, &o), MERLIN_BAD_INPUT);
}

static void gltf_is_read(void **state)
{
    (void)state;
    /* the tetrahedron above: 48 bytes of positions, then 12 indices of 16 bits, in base64 */
    static const char TEXT[] =
        "{\"asset\":{\"version\":\"2.0\"},\"scene\":0,\"scenes\":[{\"nodes\":[0]}],\"nodes\":[{\"mesh\":0}],"
        "\"meshes\":[{\"primitives\":[{\"attributes\":{\"POSITION\":0},\"indices\":1}]}],"
        "\"buffers\":[{\"byteLength\":72,\"uri\":\"data:application/octet-stream;base64,"
        "AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAAAAAAAAAAAAAAAIA/AAACAAEAAAABAAMAAAADAAIAAQACAAMA\"}],"
        "\"bufferViews\":[{\"buffer\":0,\"byteOffset\":0,\"byteLength\":48},"
        "{\"buffer\":0,\"byteOffset\":48,\"byteLength\":24}],"
        "\"accessors\":[{\"bufferView\":0,\"componentType\":5126,\"count\":4,\"type\":\"VEC3\","
        "\"min\":[0,0,0],\"max\":[1,1,1]},"
        "{\"bufferView\":1,\"componentType\":5123,\"count\":12,\"type\":\"SCALAR\"}]}";
    scene_object o;
    assert_int_equal(load("t.gltf", TEXT, sizeof TEXT - 1, &o), OK);
    assert_int_equal(o.triangle_count, 4);
    assert_true(signed_volume(&o) > 0);
    scene_object_free(&o);
}

static void assert_refused(const char *name, const char *text)
{
    scene_object o;
    assert_int_equal(load(name, text, strlen(text), &o), MERLIN_BAD_INPUT);
    assert_non_null(strstr(status_message(), name));
    assert_null(strchr(status_message(), '\n'));
}

static void broken_meshes_are_refused_in_one_line_that_names_the_file(void **state)
{
    (void)state;
    assert_refused("empty.obj", "");
    assert_refused("points.obj", CUBE_VERTICES);
    assert_refused("flat.obj", "v 0 0 0\nv 1 0 0\nv 2 0 0\nf 1 2 3\n");
    assert_refused("nan.obj", "v 0 0 0\nv nan 0 0\nv 0 1 0\nf 1 2 3\n");
    assert_refused("range.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 9\n");
    assert_refused("junk.ply", "this is not a mesh\n");
    assert_refused("list.ply", "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\n"
                               "property float z\nelement face 1\nproperty list int int other\n"
                               "property list int int vertex_indices\nend_header\n"
                               "0 0 0\n1 0 0\n0 1 0\n4e9 3 0 1 2\n");
    assert_refused("junk.glb", "glTFnot really");
    assert_refused("photo.jpg", "anything");
    scene_object o;
    assert_int_equal(object_of("/nowhere/cow.obj", 1, 1, &o), MERLIN_BAD_INPUT);
    assert_non_null(strstr(status_message(), "/nowhere/cow.obj"));
}

static void folders_and_pipes_are_refused_without_waiting(void **state)
{
    (void)state;
    static const char *const NAMES[] = {"folder.obj", "pipe.obj"};
    scene_object o;
    assert_int_equal(file_make_folder(scratch_path(NAMES[0])), OK);
    assert_int_equal(mkfifo(scratch_path(NAMES[1]), 0600), 0);
    alarm(20); /* opening a pipe without a writer would block forever */
    for (int i = 0; i < 2; i++) {
        assert_int_equal(object_of(scratch_path(NAMES[i]), 1, 1, &o), MERLIN_BAD_INPUT);
        assert_non_null(strstr(status_message(), "not a plain file"));
    }
    alarm(0);
}

static void a_mesh_is_read_once_for_many_objects(void **state)
{
    (void)state;
    const char *path = scratch_path("once.obj");
    assert_int_equal(file_write(path, INSIDE_OUT, sizeof INSIDE_OUT - 1), OK);
    scene_model *model;
    scene_object first, other, again;
    assert_int_equal(scene_model_read(path, &model), OK);
    assert_int_equal(unlink(path), 0);
    assert_int_equal(scene_object_from_model(model, 1, 2, 60, &first), OK);
    assert_int_equal(scene_object_from_model(model, 1, 3, 60, &other), OK);
    assert_int_equal(scene_object_from_model(model, 1, 2, 60, &again), OK);
    check_cube(&again);
    assert_int_equal(first.vertex_count, again.vertex_count);
    assert_memory_equal(first.position, again.position, first.vertex_count * sizeof *first.position);
    assert_memory_not_equal(first.position, other.position, first.vertex_count * sizeof *first.position);
    scene_object_free(&first);
    scene_object_free(&other);
    scene_object_free(&again);
    scene_model_free(model);
}

/* The test reads a folder of real meshes with normals and thousands of faces, if there is one. */
static void meshes_of_the_world_are_posed_before_the_camera(void **state)
{
    (void)state;
    const char *where = getenv("MERLIN_TEST_MESHES");
    static const char *const ENDINGS[] = {".obj", ".ply", ".gltf", ".glb", NULL};
    char **names;
    size_t count;
    if (!where || !file_is_folder(where)) {
        print_message("set MERLIN_TEST_MESHES to a folder of meshes to test them\n");
        skip();
    }
    assert_int_equal(file_list(where, ENDINGS, &names, &count), OK);
    for (size_t i = 0; i < count; i++) {
        scene_object o;
        assert_int_equal(object_of(names[i], 3, i, &o), OK);
        for (uint32_t v = 0; v < o.vertex_count; v++) {
            assert_true(-o.position[v].z > 0.4f);
            assert_float_equal(vec3_length(o.normal[v]), 1, 1e-5f);
        }
        scene_object_free(&o);
    }
    file_list_free(names, count);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(polygons_without_normals_are_triangulated_and_creased),
        cmocka_unit_test(obj_numbers_may_begin_with_their_point),
        cmocka_unit_test(inward_surfaces_are_turned_outward),
        cmocka_unit_test(ascii_ply_is_read),
        cmocka_unit_test(vertices_of_no_face_do_not_count_for_the_frame),
        cmocka_unit_test(concave_polygons_of_a_ply_do_not_fold_over),
        cmocka_unit_test(ply_far_from_its_origin_keeps_its_digits),
        cmocka_unit_test(corners_that_only_texture_or_material_tells_apart_are_one_vertex),
        cmocka_unit_test(triangles_that_lie_where_others_do_are_dropped),
        cmocka_unit_test(triangles_that_wind_against_their_normals_are_turned),
        cmocka_unit_test(binary_ply_is_read),
        cmocka_unit_test(gltf_is_read),
        cmocka_unit_test(broken_meshes_are_refused_in_one_line_that_names_the_file),
        cmocka_unit_test(folders_and_pipes_are_refused_without_waiting),
        cmocka_unit_test(a_mesh_is_read_once_for_many_objects),
        cmocka_unit_test(meshes_of_the_world_are_posed_before_the_camera),
    };
    return cmocka_run_group_tests(tests, scratch_open, scratch_close);
}
