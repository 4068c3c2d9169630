/* SPDX-License-Identifier: MIT */
/* OBJ files as people and programs write them, tested by the resulting surface. */
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
#include "mesh/read/mesh_read.h"
#include "mesh/read/mesh_read_obj.h"
#include "scratch.h"

/* last, as cmocka defines a macro named fail */
#include <cmocka.h>

#define SQUARE "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n"

static status parse(const char *text, triangle_mesh *mesh, int *parts)
{
    *mesh = (triangle_mesh){0};
    return mesh_parse_obj(text, strlen(text), 1000, mesh, parts);
}

static void assert_refused(const char *text, const char *why)
{
    triangle_mesh mesh;
    int parts;
    assert_int_equal(parse(text, &mesh, &parts), MERLIN_BAD_INPUT);
    if (!strstr(status_message(), why)) fail_msg("\"%s\" does not say \"%s\"", status_message(), why);
    mesh_free(&mesh);
}

static vec3 corner_of(const triangle_mesh *mesh, uint32_t triangle, int corner)
{
    return mesh->position[mesh->triangle[triangle][corner]];
}

static void assert_at(vec3 p, float x, float y, float z)
{
    assert_float_equal(p.x, x, 1e-6f);
    assert_float_equal(p.y, y, 1e-6f);
    assert_float_equal(p.z, z, 1e-6f);
}

/* Asserts that a text is the unit square in the plane z = 0, seen from +z, of two triangles. */
static void assert_square(const char *text)
{
    triangle_mesh mesh;
    int parts;
    if (parse(text, &mesh, &parts) != OK) fail_msg("%s: %s", status_message(), text);
    assert_int_equal(mesh.triangle_count, 2);
    float area = 0;
    for (uint32_t t = 0; t < 2; t++) {
        vec3 a = corner_of(&mesh, t, 0);
        vec3 n = vec3_cross(vec3_sub(corner_of(&mesh, t, 1), a), vec3_sub(corner_of(&mesh, t, 2), a));
        assert_float_equal(n.x, 0, 1e-6f);
        assert_float_equal(n.y, 0, 1e-6f);
        assert_float_equal(n.z, 1, 1e-6f); /* half of the square each, counter-clockwise */
        area += n.z / 2;
        for (int k = 0; k < 3; k++) {
            vec3 p = corner_of(&mesh, t, k);
            assert_true((p.x == 0 || p.x == 1) && (p.y == 0 || p.y == 1) && p.z == 0);
        }
    }
    assert_float_equal(area, 1, 1e-6f);
    mesh_free(&mesh);
}

static void faces_are_read_however_they_are_written(void **state)
{
    (void)state;
    assert_square(SQUARE "f 1 2 3 4\n");
    assert_square(SQUARE "f 1 2 3 4"); /* without a line end */
    assert_square(SQUARE "f 1/1 2/2 3/3 4/4\n");
    assert_square(SQUARE "f 1/ 2/ 3/ 4/\n");
    assert_square(SQUARE "vn 0 0 1\nf 1//1 2//1 3//1 4//1\n");
    assert_square(SQUARE "vn 0 0 1\nvt 0 0\nf 1/1/1 2/1/1 3/1/1 4/1/1\n");
    assert_square(SQUARE "vn 0 0 1\nf 1//1 2//1 3//1 4//1\nl 1 2 3\np 1\n");
    assert_square("v 9 9 9\n" SQUARE "f -4 -3 -2 -1\nv 7 7 7\n");
    assert_square(SQUARE "f 1 2 3\nf -4 -2 -1\n");
    assert_square("f 1 2 3 4\n" SQUARE); /* before its vertices */
    assert_square("v 0 0 0 1\nv 1 0 0 1.0 # w\nv 1 1 0 0.1 0.2 0.3\nv 0 1 0\nf 1 2 3 4 # a face\n");
    assert_square("# by hand\r\nv 0 0 0\r\nv 1 0 0\r\nv 1 1 0\r\nv 0 1 0\r\nf 1 2 3 4\r\n");
    assert_square("v 0 0 0\rv 1 0 0\rv 1 1 0\rv 0 1 0\rf 1 2 3 4\r");
    assert_square("\xef\xbb\xbfv 0 0 0\nv 1 0 0\nv +1 1.e0 -0\nv .0 10e-1 0\nf 1 2 3 4\n");
    assert_square("  v\t0  0 0\n\tv 1 0 0\nv 1 1 0 \nv 0 1 0\n  f  1\t2  3 4  \n");
}

static void lines_go_on_behind_a_backslash(void **state)
{
    (void)state;
    assert_square(SQUARE "f 1 2 \\\n3 4\n");
    assert_square(SQUARE "f 1 2 \\\r\n3 \\\r\n4\r\n");
    assert_square("v 0 0 \\\n0\nv 1 \\\n0 0\nv 1 1 0 \\\n1\nv 0 1 0\nf 1 2 3 4\n");
    assert_square("# a path ends so: C:\\\n" SQUARE "f 1 2 3 4\n");
    assert_refused("v 0 0 \\\n0\nv 1 0 0\nv 0 1 0\nf 1 2 \\\n x\n", "line 6");
}

static void concave_polygons_do_not_fold_over(void **state)
{
    (void)state;
    triangle_mesh mesh;
    int parts;
    /* a comb of four teeth: its triangles' areas add up to its own only if none is outside */
    char text[600] = "";
    size_t end = 0;
    for (int tooth = 0; tooth < 4; tooth++)
        end += (size_t)snprintf(text + end, sizeof text - end, "v %d 3 0\nv %g 3 0\nv %g 1 0\nv %d 1 0\n", tooth,
                                tooth + 0.5, tooth + 0.5, tooth + 1);
    snprintf(text + end, sizeof text - end, "v 4 0 0\nv 0 0 0\nf 18 17 16 15 14 13 12 11 10 9 8 7 6 5 4 3 2 1\n");
    assert_int_equal(parse(text, &mesh, &parts), OK);
    assert_int_equal(mesh.triangle_count, 16);
    float area = 0;
    for (uint32_t t = 0; t < mesh.triangle_count; t++) {
        vec3 a = corner_of(&mesh, t, 0);
        vec3 n = vec3_cross(vec3_sub(corner_of(&mesh, t, 1), a), vec3_sub(corner_of(&mesh, t, 2), a));
        assert_true(n.z >= 0); /* all in the same orientation */
        area += n.z / 2;
    }
    assert_float_equal(area, 4 * 1 + 4 * 0.5 * 2, 1e-5f); /* back and teeth */
    mesh_free(&mesh);
}

static void materials_that_faces_have_are_the_parts(void **state)
{
    (void)state;
    triangle_mesh mesh;
    int parts;
    assert_int_equal(parse(SQUARE "f 1 2 3\nusemtl none\nusemtl red \nf 1 2 3\nusemtl blue sky\nf 1 2 4\n"
                                  "usemtl red\ng other\nf 1 2 3\n",
                           &mesh, &parts),
                     OK);
    assert_int_equal(parts, 3);
    const uint8_t wanted[] = {0, 1, 2, 1};
    assert_int_equal(mesh.triangle_count, 4);
    assert_memory_equal(mesh.part, wanted, sizeof wanted);
    mesh_free(&mesh);
}

static void more_materials_than_parts_share_them(void **state)
{
    (void)state;
    char text[40000] = SQUARE;
    size_t end = strlen(text);
    for (int i = 0; i < 600; i++)
        end += (size_t)snprintf(text + end, sizeof text - end, "usemtl m%d\nf 1 2 3\n", i);
    triangle_mesh mesh;
    int parts;
    assert_int_equal(parse(text, &mesh, &parts), OK);
    assert_int_equal(parts, MESH_PARTS);
    for (uint32_t t = 0; t < mesh.triangle_count; t++)
        assert_true(mesh.part[t] < MESH_PARTS);
    assert_int_equal(mesh.part[33], 1);
    mesh_free(&mesh);
}

static void normals_are_kept_where_every_corner_has_one(void **state)
{
    (void)state;
    triangle_mesh mesh;
    int parts;
    assert_int_equal(parse(SQUARE "vn 0 3 4\nvn 0 0 1\nf 1//1 2//2 3//2\nf 1//2 3//2 4//2\n", &mesh, &parts), OK);
    assert_int_equal(mesh.vertex_count, 5); /* the first corner with either normal */
    assert_non_null(mesh.normal);
    vec3 n = mesh.normal[mesh.triangle[0][0]];
    assert_at(n, 0, 0.6f, 0.8f);
    assert_at(mesh.normal[mesh.triangle[1][0]], 0, 0, 1);
    assert_int_equal(mesh.triangle[0][2], mesh.triangle[1][1]);
    mesh_free(&mesh);
    assert_int_equal(parse(SQUARE "vn 0 3 4\nf 1//1 2//1 3\n", &mesh, &parts), OK);
    assert_null(mesh.normal);
    mesh_free(&mesh);
}

/* In national coordinates floats are half a metre apart. */
static void far_from_its_origin_a_mesh_keeps_its_digits(void **state)
{
    (void)state;
    triangle_mesh mesh;
    int parts;
    assert_int_equal(parse("v 5100000.25 0 400\nv 5100001.25 0 400\nv 5100000.25 0.5 400\nf 1 2 3\n", &mesh, &parts),
                     OK);
    vec3 a = corner_of(&mesh, 0, 0);
    assert_float_equal(vec3_sub(corner_of(&mesh, 0, 1), a).x, 1, 1e-6f);
    assert_float_equal(vec3_sub(corner_of(&mesh, 0, 2), a).y, 0.5, 1e-6f);
    mesh_free(&mesh);
    assert_int_equal(parse("v 5 0 4\nv 6 0 4\nv 5 1 4\nf 1 2 3\n", &mesh, &parts), OK);
    assert_at(corner_of(&mesh, 0, 1), 6, 0, 4); /* near its origin a mesh is not moved */
    mesh_free(&mesh);
}

static void damaged_files_are_refused_with_their_line(void **state)
{
    (void)state;
    assert_refused("", "no triangles");
    assert_refused(SQUARE "l 1 2 3\n", "no triangles");
    assert_refused(SQUARE "f 1 2\n", "no triangles");
    assert_refused(SQUARE "f 1 2 9\n", "line 5: a face of vertices that are not there");
    assert_refused(SQUARE "f 1 2 -5\n", "line 5: a face of vertices");
    assert_refused(SQUARE "f 1 2 0\n", "line 5: a face's corner");
    assert_refused(SQUARE "f 1 2 4294967297\n", "line 5: a face of vertices"); /* 1 in 32 bits */
    assert_refused(SQUARE "f 1 2 -4294967292\n", "line 5: a face of vertices");
    assert_refused(SQUARE "f 1 2 99999999999999999999999999\n", "line 5: a face of vertices");
    assert_refused(SQUARE "vn 0 0 1\nf 1//1 2//1 3//2\n", "line 6: a face of normals that are not there");
    assert_refused(SQUARE "f 1 2 3x\n", "line 5");
    assert_refused("v 0 0\nv 1 0 0\n", "line 1: three numbers");
    assert_refused("v 0 0 0\nv 1,5 0 0\n", "line 2: a number is wanted");
    assert_refused("v 0 0 0\nv 0 inf 0\n", "line 2: a vertex that is not finite");
    assert_refused("v 0 0 0\nv 0 nan 0\n", "line 2: a vertex that is not finite");
}

static void a_polygon_of_more_than_1024_corners_is_refused(void **state)
{
    (void)state;
    enum { CORNERS = 1025 };
    char *text = malloc(60 * CORNERS);
    assert_non_null(text);
    size_t end = 0;
    for (int i = 0; i < CORNERS; i++)
        end += (size_t)sprintf(text + end, "v %.9g %.9g 0\n", cos(6.28318 * i / CORNERS), sin(6.28318 * i / CORNERS));
    end += (size_t)sprintf(text + end, "f");
    for (int i = 1; i < CORNERS; i++)
        end += (size_t)sprintf(text + end, " %d", i);
    triangle_mesh mesh = {0};
    int parts;
    assert_int_equal(mesh_parse_obj(text, end, 5000, &mesh, &parts), OK);
    assert_int_equal(mesh.triangle_count, 1022);
    mesh_free(&mesh);
    sprintf(text + end, " %d", CORNERS);
    assert_int_equal(mesh_parse_obj(text, strlen(text), 5000, &mesh, &parts), MERLIN_BAD_INPUT);
    assert_non_null(strstr(status_message(), "1024 corners"));
    mesh_free(&mesh);
    free(text);
}

static void more_triangles_than_allowed_are_refused(void **state)
{
    (void)state;
    triangle_mesh mesh = {0};
    int parts;
    const char text[] = SQUARE "f 1 2 3 4\nf 1 2 3 4\n";
    assert_int_equal(mesh_parse_obj(text, sizeof text - 1, 3, &mesh, &parts), MERLIN_BAD_INPUT);
    assert_non_null(strstr(status_message(), "more than 3 triangles"));
    mesh_free(&mesh);
}

/* A vertex has as many normals as corners: searching all of them at each corner would take a minute. */
static void very_many_normals_at_a_vertex_take_no_time(void **state)
{
    (void)state;
    enum { COUNT = 100000 };
    char *text = malloc(60 * COUNT);
    assert_non_null(text);
    size_t end = (size_t)sprintf(text, SQUARE);
    for (int i = 0; i < COUNT; i++)
        end += (size_t)sprintf(text + end, "vn 0 0 1\nf 1//%d 2//%d 3//%d\n", i + 1, i + 1, i + 1);
    triangle_mesh mesh = {0};
    int parts;
    alarm(20);
    assert_int_equal(mesh_parse_obj(text, end, COUNT, &mesh, &parts), OK);
    alarm(0);
    assert_int_equal(mesh.triangle_count, COUNT);
    mesh_free(&mesh);
    free(text);
}

static void material_libraries_are_not_opened(void **state)
{
    (void)state;
    const char text[] = "mtllib pipe.mtl\n" SQUARE "usemtl red\nf 1 2 3 4\n";
    triangle_mesh mesh = {0};
    int parts;
    assert_int_equal(file_write(scratch_path("a.obj"), text, sizeof text - 1), OK);
    assert_int_equal(mkfifo(scratch_path("pipe.mtl"), 0600), 0);
    alarm(20); /* opening a pipe without a writer would block forever */
    assert_int_equal(mesh_read(scratch_path("a.obj"), &mesh, &parts), OK);
    alarm(0);
    assert_int_equal(mesh.triangle_count, 2);
    mesh_free(&mesh);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(faces_are_read_however_they_are_written),
        cmocka_unit_test(lines_go_on_behind_a_backslash),
        cmocka_unit_test(concave_polygons_do_not_fold_over),
        cmocka_unit_test(materials_that_faces_have_are_the_parts),
        cmocka_unit_test(more_materials_than_parts_share_them),
        cmocka_unit_test(normals_are_kept_where_every_corner_has_one),
        cmocka_unit_test(far_from_its_origin_a_mesh_keeps_its_digits),
        cmocka_unit_test(damaged_files_are_refused_with_their_line),
        cmocka_unit_test(a_polygon_of_more_than_1024_corners_is_refused),
        cmocka_unit_test(more_triangles_than_allowed_are_refused),
        cmocka_unit_test(very_many_normals_at_a_vertex_take_no_time),
        cmocka_unit_test(material_libraries_are_not_opened),
    };
    return cmocka_run_group_tests(tests, scratch_open, scratch_close);
}
