/* SPDX-License-Identifier: MIT */
/* Generated objects satisfy scene.h: deterministic, closed, finite, in frame, materials in range. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdlib.h>
#include <string.h>

#include "base/rng.h"
#include "lab/scene/scene.h"
#include "sanitized.h"

/* last, as cmocka defines a macro named fail */
#include <cmocka.h>

enum { OBJECTS = SANITIZED ? 40 : 200 };

static const float FOV = 60;

static void generate(uint64_t index, scene_object *out)
{
    assert_int_equal(scene_object_generate(42, index, FOV, out), OK);
}

static int is_finite(vec3 v)
{
    return isfinite(v.x) && isfinite(v.y) && isfinite(v.z);
}

static void same_seed_and_index_make_the_same_object(void **state)
{
    (void)state;
    for (uint64_t i = 0; i < 12; i++) {
        scene_object a, b;
        generate(i, &a);
        generate(i, &b);
        assert_int_equal(a.vertex_count, b.vertex_count);
        assert_int_equal(a.triangle_count, b.triangle_count);
        assert_memory_equal(a.position, b.position, a.vertex_count * sizeof(vec3));
        assert_memory_equal(a.normal, b.normal, a.vertex_count * sizeof(vec3));
        for (uint32_t t = 0; t < a.triangle_count; t += 97) {
            scene_surface at = {0}, bt = {0};
            scene_surfaces_eval(&a, &(scene_place){t, 0.2f, 0.3f}, 1, &at);
            scene_surfaces_eval(&b, &(scene_place){t, 0.2f, 0.3f}, 1, &bt);
            assert_memory_equal(&at, &bt, sizeof at);
        }
        scene_object_free(&a);
        scene_object_free(&b);
    }
}

static void different_indices_make_different_objects(void **state)
{
    (void)state;
    scene_object a, b;
    generate(0, &a);
    generate(1, &b);
    assert_true(a.vertex_count != b.vertex_count || memcmp(a.position, b.position, a.vertex_count * sizeof(vec3)) != 0);
    scene_object_free(&a);
    scene_object_free(&b);
}

static void every_class_is_drawn(void **state)
{
    (void)state;
    static const char *const NAMES[] = {"union", "blend", "revolution", "superquadric", "relief"};
    int seen[5] = {0};
    for (uint64_t i = 0; i < OBJECTS; i++) {
        scene_object o;
        generate(i, &o);
        for (int k = 0; k < 5; k++)
            seen[k] += strcmp(o.shape, NAMES[k]) == 0;
        scene_object_free(&o);
    }
    for (int k = 0; k < 5; k++)
        assert_true(seen[k] >= OBJECTS / 20);
}

/* Returns six times the volume enclosed by the surface, about its own first vertex. */
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

static void check_vertices(const scene_object *o)
{
    for (uint32_t v = 0; v < o->vertex_count; v++) {
        assert_true(is_finite(o->position[v]) && is_finite(o->reference[v]));
        /* normalized in float: a few units in the last place */
        assert_float_equal(vec3_length(o->normal[v]), 1, 1e-5f);
        assert_true(-o->position[v].z > 0.4f);
    }
}

static void shapes_are_finite_closed_and_wind_outward(void **state)
{
    (void)state;
    for (uint64_t i = 0; i < OBJECTS; i++) {
        scene_object o;
        generate(i, &o);
        check_vertices(&o);
        assert_true(o.triangle_count >= 5000 && o.triangle_count <= 60000);
        double facing = 0, area = 0;
        for (uint32_t t = 0; t < o.triangle_count; t++) {
            vec3 p[3], n = {0, 0, 0};
            for (int k = 0; k < 3; k++) {
                assert_true(o.triangle[t][k] < o.vertex_count);
                p[k] = o.position[o.triangle[t][k]];
                n = vec3_add(n, o.normal[o.triangle[t][k]]);
            }
            vec3 cross = vec3_cross(vec3_sub(p[1], p[0]), vec3_sub(p[2], p[0]));
            assert_true(vec3_length(cross) > 0);
            facing += (double)vec3_dot(cross, n) / 3;
            area += (double)vec3_length(cross);
        }
        assert_true(signed_volume(&o) > 0);
        /* smooth normals are close to the faces'; over a whole surface they agree except at rounded edges */
        assert_true(facing > 0.85 * area);
        scene_object_free(&o);
    }
}

/* Returns the share of the frame under the silhouette, on a grid fine enough (1 %) for the bounds tested. */
static float coverage(const scene_object *o, int *outside)
{
    enum { SIDE = 100 };
    static uint8_t mask[SIDE][SIDE];
    float tangent = tanf(FOV * 0.5f * 0.0174532925f);
    memset(mask, 0, sizeof mask);
    *outside = 0;
    for (uint32_t t = 0; t < o->triangle_count; t++) {
        float x[3], y[3];
        for (int k = 0; k < 3; k++) {
            vec3 p = o->position[o->triangle[t][k]];
            x[k] = (p.x / (-p.z * tangent) + 1) * 0.5f * SIDE;
            y[k] = (p.y / (-p.z * tangent) + 1) * 0.5f * SIDE;
            *outside |= x[k] < 0 || x[k] > SIDE || y[k] < 0 || y[k] > SIDE;
        }
        /* points spread over the triangle rather than pixels inside it: another way than the library's own */
        float longest = fmaxf(hypotf(x[1] - x[0], y[1] - y[0]), hypotf(x[2] - x[0], y[2] - y[0]));
        int n = 1 + (int)fminf(200, 1.5f * fmaxf(longest, hypotf(x[2] - x[1], y[2] - y[1])));
        for (int i = 0; i <= n; i++)
            for (int j = 0; i + j <= n; j++) {
                float u = (float)i / (float)n, v = (float)j / (float)n;
                float px = x[0] + u * (x[1] - x[0]) + v * (x[2] - x[0]);
                float py = y[0] + u * (y[1] - y[0]) + v * (y[2] - y[0]);
                if (px >= 0 && px < SIDE && py >= 0 && py < SIDE) mask[(int)py][(int)px] = 1;
            }
    }
    int covered = 0;
    for (int i = 0; i < SIDE * SIDE; i++)
        covered += mask[i / SIDE][i % SIDE];
    return (float)covered / (SIDE * SIDE);
}

static void silhouettes_fill_a_quarter_to_three_quarters_of_the_frame(void **state)
{
    (void)state;
    int good = 0, cut = 0;
    for (uint64_t i = 0; i < OBJECTS; i++) {
        scene_object o;
        int outside;
        generate(i, &o);
        float c = coverage(&o, &outside);
        /* half a cell along the outline is counted too much: 0.5 x 4 x 80 cells of 10,000 at most */
        good += c >= 0.25f && c <= 0.77f;
        cut += outside;
        scene_object_free(&o);
    }
    assert_true(good >= OBJECTS * 95 / 100);
    /* one in twenty is pushed to the edge by design: 10 expected, 22 is four standard deviations above */
    assert_true(cut <= 22);
}

static void surfaces_have_materials_in_range_and_unit_normals(void **state)
{
    (void)state;
    for (uint64_t i = 0; i < OBJECTS; i++) {
        scene_object o;
        generate(i, &o);
        rng r = rng_at(1, i, 2);
        for (int k = 0; k < 500; k++) {
            float u = rng_uniform(&r), v = rng_uniform(&r) * (1 - u);
            scene_surface s;
            scene_place at = {(uint32_t)rng_below(&r, (int)o.triangle_count), u, v};
            scene_surfaces_eval(&o, &at, 1, &s);
            assert_true(is_finite(s.position) && is_finite(s.normal));
            assert_float_equal(vec3_length(s.normal), 1, 1e-5f);
            assert_float_equal(vec3_length(s.geometric_normal), 1, 1e-5f);
            assert_true(vec3_dot(s.normal, s.geometric_normal) > 0);
            assert_true(s.albedo.x >= 0 && s.albedo.x <= 1 && s.albedo.y >= 0 && s.albedo.y <= 1);
            assert_true(s.albedo.z >= 0 && s.albedo.z <= 1);
            assert_true(s.roughness >= 0.1f && s.roughness <= 1);
        }
        scene_object_free(&o);
    }
}

/* Borders are sharp but continuous: between close neighbours on one triangle the albedo rarely jumps. */
static void materials_are_continuous_but_at_borders(void **state)
{
    (void)state;
    int pairs = 0, jumps = 0;
    for (uint64_t i = 0; i < OBJECTS; i++) {
        scene_object o;
        generate(i, &o);
        rng r = rng_at(3, i, 4);
        for (int k = 0; k < 200; k++) {
            uint32_t t = (uint32_t)rng_below(&r, (int)o.triangle_count);
            scene_surface a, b;
            scene_surfaces_eval(&o, &(scene_place){t, 0.3f, 0.3f}, 1, &a);
            scene_surfaces_eval(&o, &(scene_place){t, 0.31f, 0.3f}, 1, &b); /* a hundredth of a triangle further */
            vec3 d = vec3_sub(a.albedo, b.albedo);
            pairs++;
            jumps += vec3_length(d) > 0.1f || fabsf(a.roughness - b.roughness) > 0.1f;
        }
        scene_object_free(&o);
    }
    /* 3e-4 of a radius apart, across borders a few hundredths wide and some truly sharp ones */
    assert_true(jumps < pairs / 200);
}

/* The corners of a triangle have its vertices' positions, whatever the material. */
static void surface_positions_are_interpolated(void **state)
{
    (void)state;
    scene_object o;
    generate(5, &o);
    for (uint32_t t = 0; t < o.triangle_count; t += 31) {
        scene_surface a, b, c, m;
        scene_surfaces_eval(&o, &(scene_place){t, 0, 0}, 1, &a);
        scene_surfaces_eval(&o, &(scene_place){t, 1, 0}, 1, &b);
        scene_surfaces_eval(&o, &(scene_place){t, 0, 1}, 1, &c);
        scene_surfaces_eval(&o, &(scene_place){t, 0.25f, 0.5f}, 1, &m);
        vec3 want = vec3_fma(vec3_fma(vec3_scale(a.position, 0.25f), 0.25f, b.position), 0.5f, c.position);
        assert_memory_equal(&b.position, &o.position[o.triangle[t][1]], sizeof(vec3));
        assert_float_equal(vec3_length(vec3_sub(want, m.position)), 0, 1e-6f);
    }
    scene_object_free(&o);
}

static void a_senseless_field_of_view_is_refused(void **state)
{
    (void)state;
    scene_object o;
    assert_int_equal(scene_object_generate(1, 1, 0, &o), MERLIN_WRONG_USE);
    assert_int_equal(scene_object_generate(1, 1, NAN, &o), MERLIN_WRONG_USE);
    scene_object_free(&o);
}

/* Every pattern occurs within forty objects; a point's result must not depend on those beside it. */
static void point_looks_the_same_alone_and_among_others(void **state)
{
    (void)state;
    enum { POINTS = 37 };
    for (uint64_t k = 0; k < 40; k++) {
        scene_object o;
        rng r = rng_at(3, k, 0);
        scene_place places[POINTS];
        scene_surface together[POINTS], alone;
        assert_int_equal(scene_object_generate(21, k, 60, &o), OK);
        for (int i = 0; i < POINTS; i++) {
            uint32_t triangle = (uint32_t)rng_below(&r, (int)o.triangle_count);
            places[i] = (scene_place){triangle, 0.5f * rng_uniform(&r), 0.5f * rng_uniform(&r)};
        }
        scene_surfaces_eval(&o, places, POINTS, together);
        for (int i = 0; i < POINTS; i++) {
            scene_surfaces_eval(&o, &places[i], 1, &alone);
            assert_memory_equal(&alone, &together[i], sizeof alone);
        }
        scene_object_free(&o);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(same_seed_and_index_make_the_same_object),
        cmocka_unit_test(different_indices_make_different_objects),
        cmocka_unit_test(every_class_is_drawn),
        cmocka_unit_test(shapes_are_finite_closed_and_wind_outward),
        cmocka_unit_test(silhouettes_fill_a_quarter_to_three_quarters_of_the_frame),
        cmocka_unit_test(surfaces_have_materials_in_range_and_unit_normals),
        cmocka_unit_test(materials_are_continuous_but_at_borders),
        cmocka_unit_test(surface_positions_are_interpolated),
        cmocka_unit_test(a_senseless_field_of_view_is_refused),
        cmocka_unit_test(point_looks_the_same_alone_and_among_others),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
