/* SPDX-License-Identifier: MIT */
/* Light transport against closed forms. */
#include "lab/render/paths.h"
#include "lab/render/render.h"
#include "lab/render/sample_lamps.h"
#include "optics/camera.h"
#include "optics/light.h"
#include "shapes.h"

/* last, as cmocka defines a macro named fail */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

static const float pi = 3.14159265f;

typedef struct stage {
    trace_device *device;
    scene_object object;
    trace_scene scene;
} stage;

static void stage_open(stage *s, scene_object object, trace_surface_function *surface)
{
    s->object = object;
    assert_int_equal(trace_device_new(&s->device), OK);
    assert_int_equal(trace_scene_new(s->device, &s->object, surface, 1e6, &s->scene), OK);
}

static void stage_close(stage *s)
{
    trace_scene_free(&s->scene);
    trace_device_free(s->device);
    shape_free(&s->object);
}

static void assert_within(double value, double expected, double relative)
{
    if (!(fabs(value - expected) <= relative * fabs(expected)))
        fail_msg("%g is not %g within %g", value, expected, relative);
}

/* Radiance Φ A/π is the same everywhere on the wall, and so is irradiance: every bounce multiplies it by A. */
static void light_at_the_centre_of_a_diffuse_sphere_loses_its_albedo_at_each_bounce(void **state)
{
    (void)state;
    stage s;
    sample out;
    stage_open(&s, shape_sphere(vec3_make(0, 0, 0), 1, 96), shape_grey);
    s.scene.diffuse_only = true;
    image_settings settings = {.size = 16, .fov = 60, .strata = 4, .paths = 16, .bounces = true};
    assert_int_equal(render_image(&s.scene, &settings, 1, 0, NULL, &out), OK);
    double direct = 5.95 * 0.5 / pi;
    for (int y = 0; y < 16; y++)
        for (int x = 0; x < 16; x++) {
            /* facets of a sphere of 96 rows are up to (π/96)²/8 = 1.3e-4 inside it, twice that in 1/d² */
            assert_within(*img_at(&out.mask, x, y), 1, 0);
            assert_within(*img_at(&out.direct, x, y), direct, 0.001);
            /* and the shading normals differ from the facets': a percent of the cosine-distributed paths is cut off */
            assert_within(*img_at(&out.bounce2, x, y), 0.5 * direct, 0.01);
            assert_within(*img_at(&out.bounce3, x, y), 0.25 * direct, 0.02);
            assert_within(*img_at(&out.indirect, x, y), *img_at(&out.bounce2, x, y) + *img_at(&out.bounce3, x, y),
                          1e-6);
        }
    sample_free(&out);
    stage_close(&s);
}

static void convex_object_has_no_indirect_light_at_all(void **state)
{
    (void)state;
    stage s;
    sample out;
    stage_open(&s, shape_sphere(vec3_make(0.05f, 0, -1), 0.35f, 48), shape_patterned);
    image_settings settings = {.size = 64, .fov = 60, .strata = 4, .paths = 16, .targets = 2};
    assert_int_equal(render_image(&s.scene, &settings, 1, 0, NULL, &out), OK);
    double direct = 0;
    for (size_t i = 0; i < 64 * 64 * 3; i++) {
        assert_true(out.indirect.data[i] == 0);
        assert_true(out.targets[0].indirect.data[i] == 0 && out.targets[1].indirect.data[i] == 0);
        direct += out.direct.data[i];
    }
    assert_true(direct > 100);
    sample_free(&out);
    stage_close(&s);
}

/* Under uniform light a sphere reflects its albedo's share, whatever the radiance. */
static void surroundings_of_any_radiance_light_a_sphere_in_full(void **state)
{
    (void)state;
    enum { SIZE = 32, WIDTH = 64, HEIGHT = 32 };
    stage s;
    environment env;
    img map;
    rng r = rng_at(1, 2, 3);
    assert_int_equal(img_new(&map, WIDTH, HEIGHT, 3), OK);
    for (size_t i = 0; i < img_value_count(&map); i++)
        map.data[i] = 1;
    assert_int_equal(environment_from_map(&map, &r, &env), OK);
    stage_open(&s, shape_sphere(vec3_make(0, 0, -1), 0.35f, 48), shape_grey);
    s.scene.diffuse_only = true;
    image_settings settings = {.size = SIZE, .fov = 60, .strata = 4, .paths = 64};
    for (float radiance = 0.5f; radiance < 100; radiance *= 10) {
        sample out;
        double sum = 0, count = 0;
        for (size_t i = 0; i < img_value_count(&env.map); i++)
            env.map.data[i] = radiance;
        assert_int_equal(render_image(&s.scene, &settings, 1, 0, &env, &out), OK);
        for (size_t i = 0; i < SIZE * SIZE; i++) {
            if (out.mask.data[i] < 1) continue;
            sum += out.env.data[3 * i];
            count++;
        }
        assert_within(sum / count, 0.5 * (double)radiance, 0.02);
        sample_free(&out);
    }
    stage_close(&s);
    environment_free(&env);
    img_free(&map);
}

/* ---- a floor and a wall ---------------------------------------------------------------------------------------- */

static const vec3 floor_origin = {-0.5f, -0.4f, -0.6f}, wall_origin = {-0.5f, -0.4f, -1.6f};

static vec3 on_floor(double a, double b)
{
    return vec3_make(floor_origin.x + (float)a, floor_origin.y, floor_origin.z - (float)b);
}

static vec3 on_wall(double a, double b)
{
    return vec3_make(wall_origin.x + (float)a, wall_origin.y + (float)b, wall_origin.z);
}

static const vec3 floor_normal = {0, 1, 0}, wall_normal = {0, 0, 1};

/* Returns bounce 1 of a light that nothing hides. */
static double lit_radiance(const point_light *from, vec3 p, vec3 n)
{
    vec3 to = vec3_sub(from->position, p);
    double d2 = vec3_dot(to, to), d = sqrt(d2), beside = fmax(0, -vec3_dot(to, from->axis) / d);
    return from->power * 0.5 / pi * fmax(0, vec3_dot(n, to) / d) / d2 * pow(beside, from->lobe);
}

/* Returns cosθ cosθ' / d² between two surface points. */
static double geometry_term(vec3 p, vec3 n, vec3 q, vec3 m)
{
    vec3 d = vec3_sub(q, p);
    double d2 = vec3_dot(d, d);
    return fmax(0, vec3_dot(n, d)) * fmax(0, -vec3_dot(m, d)) / (d2 * d2);
}

/* Returns bounce 2 leaving p of the floor (or wall): the other square's direct light, by midpoint quadrature. */
static double bounce2_at(const point_light *from, vec3 p, vec3 n, vec3 (*other)(double, double), vec3 m, int steps)
{
    double sum = 0;
    for (int i = 0; i < steps; i++)
        for (int j = 0; j < steps; j++) {
            vec3 q = other((i + 0.5) / steps, (j + 0.5) / steps);
            sum += geometry_term(p, n, q, m) * lit_radiance(from, q, m);
        }
    return 0.5 / pi * sum / ((double)steps * steps);
}

static double bounce3_at(const point_light *from, vec3 p, int steps)
{
    double sum = 0;
    for (int i = 0; i < steps; i++)
        for (int j = 0; j < steps; j++) {
            vec3 q = on_wall((i + 0.5) / steps, (j + 0.5) / steps);
            sum += geometry_term(p, floor_normal, q, wall_normal) *
                   bounce2_at(from, q, wall_normal, on_floor, floor_normal, steps);
        }
    return 0.5 / pi * sum / ((double)steps * steps);
}

/* Compares bounces 2 and 3 at three places of the floor. */
static void check_corner(const point_light *light)
{
    stage s;
    shape_quad quads[2] = {{floor_origin, {1, 0, 0}, {0, 0, -1}}, {wall_origin, {1, 0, 0}, {0, 1, 0}}};
    stage_open(&s, shape_quads(quads, 2), shape_grey);
    s.scene.diffuse_only = true;
    static const double places[3][2] = {{0.5, 0.6}, {0.2, 0.8}, {0.9, 0.3}};
    for (int k = 0; k < 3; k++) {
        enum { PATHS = 400000 };
        vec3 p = on_floor(places[k][0], places[k][1]);
        scene_surface at = {p, floor_normal, floor_normal, {0.5f, 0.5f, 0.5f}, 0.4f};
        rng r = rng_at(7, (uint64_t)k, 0);
        sequence spread = sequence_of(&r);
        path_source source = {&spread, &r};
        double sum[2] = {0, 0};
        vec3 view = vec3_normalize(vec3_scale(p, -1));
        path_points points = {&at, &view, 1, 0};
        enum { ABREAST = 100 };
        for (; points.index < PATHS; points.index += ABREAST) {
            vec3 bounce[1][2];
            point_light_paths(&s.scene, &points, 1, light, &source, ABREAST, bounce);
            sum[0] += bounce[0][0].x;
            sum[1] += bounce[0][1].x;
        }
        /* 400000 paths, of which a tenth or more hit: relative deviation below 0.005, and the quadratures' own error */
        assert_within(sum[0] / PATHS, bounce2_at(light, p, floor_normal, on_wall, wall_normal, 400), 0.01);
        assert_within(sum[1] / PATHS, bounce3_at(light, p, 40), 0.03);
    }
    stage_close(&s);
}

static void open_corner_of_two_diffuse_squares_matches_quadrature(void **state)
{
    (void)state;
    check_corner(&(point_light){.power = 5.95f, .at_eye = true});
}

/* The lobe holds where the light arrives, at the other square, and not where it is seen. */
static void open_corner_under_an_led_matches_quadrature(void **state)
{
    (void)state;
    check_corner(&(point_light){.position = {0.3f, 0.2f, 0.1f},
                                .power = 5.95f,
                                .axis = vec3_normalize(vec3_make(-0.5f, 0.1f, -1)),
                                .lobe = 2.5f});
}

/* ---- direct light ---------------------------------------------------------------------------------------------- */

static int by_value(const void *a, const void *b)
{
    float x = *(const float *)a, y = *(const float *)b;
    return (x > y) - (x < y);
}

static void direct_image_agrees_with_the_brdf_applied_to_the_stored_maps(void **state)
{
    (void)state;
    enum { SIZE = 96 };
    static float error[SIZE * SIZE];
    stage s;
    sample out;
    size_t count = 0;
    stage_open(&s, shape_sphere(vec3_make(0, 0.02f, -1), 0.4f, 200), shape_patterned);
    image_settings settings = {.size = SIZE, .fov = 60, .strata = 4, .paths = 1};
    assert_int_equal(render_image(&s.scene, &settings, 3, 0, NULL, &out), OK);
    camera eye = {.width = SIZE, .height = SIZE, .fov = 60};
    for (int y = 1; y < SIZE - 1; y++)
        for (int x = 1; x < SIZE - 1; x++) {
            float covered = fminf(fminf(*img_at(&out.mask, x - 1, y), *img_at(&out.mask, x + 1, y)),
                                  fminf(*img_at(&out.mask, x, y - 1), *img_at(&out.mask, x, y + 1)));
            if (covered < 1 || *img_at(&out.mask, x, y) < 1) continue;
            const float *a = img_at(&out.albedo, x, y), *n = img_at(&out.normal, x, y), *d = img_at(&out.direct, x, y);
            shade_input in = {{a[0], a[1], a[2]},
                              *img_at(&out.roughness, x, y),
                              {n[0], n[1], n[2]},
                              *img_at(&out.depth, x, y),
                              camera_point(&eye, (float)x + 0.5f, (float)y + 0.5f, 1),
                              {0, 0, 0},
                              LIGHT_POWER};
            vec3 expected = shade_point(&in);
            error[count++] = fabsf(d[1] - expected.y) / fmaxf(expected.y, 1e-3f);
        }
    assert_true(count > 1000);
    qsort(error, count, sizeof *error, by_value);
    assert_true(error[count / 2] < 0.01f);
    sample_free(&out);
    stage_close(&s);
}

static void plate_casts_a_shadow_on_the_floor_under_it(void **state)
{
    (void)state;
    stage s;
    shape_quad quads[2] = {{{-1, -0.3f, -0.2f}, {2, 0, 0}, {0, 0, -2}},
                           {{-0.1f, 0.1f, -0.9f}, {0.2f, 0, 0}, {0, 0, -0.2f}}};
    stage_open(&s, shape_quads(quads, 2), shape_grey);
    point_light above = {.position = {0, 0.7f, -1}, .power = 5.95f};
    scene_surface under = {{0, -0.3f, -1}, {0, 1, 0}, {0, 1, 0}, {0.5f, 0.5f, 0.5f}, 0.4f}, beside = under;
    beside.position.x = 0.5f;
    vec3 view = vec3_normalize(vec3_make(0, 0.3f, 1));
    scene_surface both[2] = {under, beside};
    vec3 views[2] = {view, view}, shadowed[2], unshadowed[2];
    point_light_direct(&s.scene, both, views, 2, &above, shadowed);
    point_light_unshadowed(&s.scene, both, views, 2, &above, unshadowed);
    assert_true(shadowed[0].x == 0);
    assert_true(unshadowed[0].x > 0);
    assert_true(shadowed[1].x > 0);
    stage_close(&s);
}

/* The plane's points see the LED at the same angle from its axis and from the normal, so that the irradiance is
 * Φ cos^(lobe + 1) / d². */
static void an_led_over_a_plane_falls_off_by_its_lobe(void **state)
{
    (void)state;
    enum { POINTS = 40 };
    stage s;
    shape_quad quad = {{-2, -0.3f, 1}, {4, 0, 0}, {0, 0, -4}};
    stage_open(&s, shape_quads(&quad, 1), shape_grey);
    s.scene.diffuse_only = true;
    const double height = 0.7;
    for (float lobe = 0; lobe < 2.1f; lobe += 0.7f) {
        const point_light led = {.position = {0, 0.4f, -1}, .power = 5.95f, .axis = {0, -1, 0}, .lobe = lobe};
        scene_surface at[POINTS];
        vec3 view[POINTS], lit[POINTS];
        for (int i = 0; i < POINTS; i++) {
            at[i] = (scene_surface){{0.04f * (float)i, -0.3f, -1}, {0, 1, 0}, {0, 1, 0}, {0.5f, 0.5f, 0.5f}, 0.4f};
            view[i] = vec3_make(0, 1, 0);
        }
        point_light_direct(&s.scene, at, view, POINTS, &led, lit);
        for (int i = 0; i < POINTS; i++) {
            double d2 = height * height + 0.0016 * i * i, cosine = height / sqrt(d2);
            assert_within(lit[i].x, 0.5 / pi * 5.95 * pow(cosine, (double)lobe + 1) / d2, 1e-5);
        }
    }
    stage_close(&s);
}

static void an_led_lights_nothing_behind_itself(void **state)
{
    (void)state;
    stage s;
    shape_quad quad = {{-2, -0.3f, 1}, {4, 0, 0}, {0, 0, -4}};
    stage_open(&s, shape_quads(&quad, 1), shape_grey);
    point_light led = {.position = {0, 0.4f, -1}, .power = 5.95f, .axis = {0, 1, 0}, .lobe = 0.1f};
    scene_surface at = {{0, -0.3f, -1}, {0, 1, 0}, {0, 1, 0}, {0.5f, 0.5f, 0.5f}, 0.4f};
    vec3 view = {0, 1, 0}, lit;
    point_light_direct(&s.scene, &at, &view, 1, &led, &lit);
    assert_true(lit.x == 0 && lit.y == 0 && lit.z == 0);
    stage_close(&s);
}

/* The numbers are the same, not nearly the same, in front of the LED and behind it. */
static void a_lobe_of_exponent_zero_is_a_point_light(void **state)
{
    (void)state;
    enum { POINTS = 20, PATHS = 64 };
    stage s;
    shape_quad quads[2] = {{floor_origin, {1, 0, 0}, {0, 0, -1}}, {wall_origin, {1, 0, 0}, {0, 1, 0}}};
    stage_open(&s, shape_quads(quads, 2), shape_patterned);
    const point_light bulb = {.position = {0.1f, 0.2f, -1.1f}, .power = 5.95f};
    point_light led = bulb;
    led.axis = vec3_make(0, 0, -1);
    scene_surface at[POINTS];
    vec3 view[POINTS], by_bulb[POINTS], by_led[POINTS], bulb_bounce[1][2], led_bounce[1][2];
    for (int i = 0; i < POINTS; i++) {
        vec3 p = on_floor(0.05 * i, 0.05 * i);
        at[i] = (scene_surface){p, floor_normal, floor_normal, {0.5f, 0.3f, 0.7f}, 0.4f};
        view[i] = vec3_normalize(vec3_scale(p, -1));
    }
    point_light_direct(&s.scene, at, view, POINTS, &bulb, by_bulb);
    point_light_direct(&s.scene, at, view, POINTS, &led, by_led);
    assert_true(by_bulb[10].x > 0);
    assert_memory_equal(by_led, by_bulb, sizeof by_bulb);
    rng r = rng_at(7, 0, 0);
    sequence spread = sequence_of(&r);
    path_source source = {&spread, &r};
    path_points points = {at, view, POINTS, 0};
    point_light_paths(&s.scene, &points, 1, &bulb, &source, PATHS, bulb_bounce);
    point_light_paths(&s.scene, &points, 1, &led, &source, PATHS, led_bounce);
    assert_true(bulb_bounce[0][0].x > 0 && bulb_bounce[0][1].x > 0);
    assert_memory_equal(led_bounce, bulb_bounce, sizeof bulb_bounce);
    stage_close(&s);
}

/* The plate hides the part of the disc on its side of a line through its edge: half, directly under the edge. */
static void a_disc_half_behind_a_plate_gives_half(void **state)
{
    (void)state;
    enum { POINTS = 400 };
    stage s;
    shape_quad quads[2] = {{{-1, -0.3f, -0.2f}, {2, 0, 0}, {0, 0, -2}}, {{0, 0.1f, -0.5f}, {2, 0, 0}, {0, 0, -1}}};
    stage_open(&s, shape_quads(quads, 2), shape_grey);
    const point_light disc = {.position = {0, 0.7f, -1}, .power = 5.95f, .across = {{0.1f, 0, 0}, {0, 0, 0.1f}}};
    static vec3 view[POINTS], seen[POINTS], sent[POINTS];
    static scene_surface under[POINTS];
    double arrived = 0, all = 0;
    for (int i = 0; i < POINTS; i++) {
        under[i] =
            (scene_surface){{0, -0.3f, -0.9f - 0.0005f * (float)i}, {0, 1, 0}, {0, 1, 0}, {0.5f, 0.5f, 0.5f}, 0.4f};
        view[i] = vec3_normalize(vec3_make(0, 0.3f, 1));
    }
    point_light_both(&s.scene, under, view, POINTS, &disc, seen, sent);
    for (int i = 0; i < POINTS; i++) {
        assert_true(seen[i].x <= sent[i].x);
        arrived += seen[i].x;
        all += sent[i].x;
    }
    /* 1600 points, each testing one point a quarter: deviation below 0.01 */
    assert_true(fabs(arrived / all - 0.5) < 0.03);
    stage_close(&s);
}

static void lamps_are_as_bright_in_the_middle_as_the_flash(void **state)
{
    (void)state;
    stage s;
    stage_open(&s, shape_sphere(vec3_make(0, 0.02f, -1), 0.2f, 20), shape_grey);
    rng r = rng_at(11, 0, 0);
    int distant = 0, discs = 0, behind = 0;
    for (int i = 0; i < 400; i++) {
        sample_lamp drawn = {0};
        sample_lamp_draw(&r, s.scene.object, &drawn);
        point_light light = sample_lamp_light(&drawn);
        vec3 way = vec3_sub(light.position, vec3_make(0, 0, -1));
        double far = vec3_length(way), cosine = way.z / far;
        assert_true(fabs(light.power / (far * far) - LIGHT_POWER) < 1e-3);
        assert_true(cosine > -0.343 && (drawn.distant || (far > 0.25 && far <= 3.001)));
        assert_true(fabs(vec3_dot(light.across[0], way)) <= 1e-4 * far * vec3_length(light.across[0]));
        distant += drawn.distant;
        discs += drawn.radius > 0;
        behind += cosine < 0;
    }
    assert_true(distant > 60 && distant < 140 && discs > 150 && discs < 250 && behind > 20);
    stage_close(&s);
}

static void layers_do_not_change_when_another_is_asked_for(void **state)
{
    (void)state;
    stage s;
    sample plain, rich, richer;
    shape_quad quads[2] = {{floor_origin, {1, 0, 0}, {0, 0, -1}}, {wall_origin, {1, 0, 0}, {0, 1, 0}}};
    stage_open(&s, shape_quads(quads, 2), shape_patterned);
    image_settings settings = {.size = 32, .fov = 60, .strata = 2, .paths = 4};
    assert_int_equal(render_image(&s.scene, &settings, 5, 9, NULL, &plain), OK);
    settings.targets = 2;
    settings.lamps = 2;
    settings.bounces = true;
    assert_int_equal(render_image(&s.scene, &settings, 5, 9, NULL, &rich), OK);
    assert_memory_equal(plain.indirect.data, rich.indirect.data, 32 * 32 * 3 * sizeof(float));
    assert_memory_equal(plain.direct.data, rich.direct.data, 32 * 32 * 3 * sizeof(float));
    settings.leds = 2;
    assert_int_equal(render_image(&s.scene, &settings, 5, 9, NULL, &richer), OK);
    assert_int_equal(richer.target_count, 4);
    assert_memory_equal(rich.targets[1].indirect.data, richer.targets[1].indirect.data, 32 * 32 * 3 * sizeof(float));
    assert_memory_equal(rich.targets[1].direct.data, richer.targets[1].direct.data, 32 * 32 * 3 * sizeof(float));
    assert_memory_equal(rich.lamps[1].indirect.data, richer.lamps[1].indirect.data, 32 * 32 * 3 * sizeof(float));
    sample_free(&plain);
    sample_free(&rich);
    sample_free(&richer);
    stage_close(&s);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(light_at_the_centre_of_a_diffuse_sphere_loses_its_albedo_at_each_bounce),
        cmocka_unit_test(convex_object_has_no_indirect_light_at_all),
        cmocka_unit_test(surroundings_of_any_radiance_light_a_sphere_in_full),
        cmocka_unit_test(open_corner_of_two_diffuse_squares_matches_quadrature),
        cmocka_unit_test(open_corner_under_an_led_matches_quadrature),
        cmocka_unit_test(direct_image_agrees_with_the_brdf_applied_to_the_stored_maps),
        cmocka_unit_test(plate_casts_a_shadow_on_the_floor_under_it),
        cmocka_unit_test(an_led_over_a_plane_falls_off_by_its_lobe),
        cmocka_unit_test(an_led_lights_nothing_behind_itself),
        cmocka_unit_test(a_lobe_of_exponent_zero_is_a_point_light),
        cmocka_unit_test(a_disc_half_behind_a_plate_gives_half),
        cmocka_unit_test(lamps_are_as_bright_in_the_middle_as_the_flash),
        cmocka_unit_test(layers_do_not_change_when_another_is_asked_for),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
