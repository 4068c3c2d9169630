/* SPDX-License-Identifier: MIT */
#include "base/rng.h"
#include "estimate/light/shadow.h"
#include "estimate/surface/fuse.h"
#include "optics/camera.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include <cmocka.h> /* last, as cmocka defines a macro named fail */

enum { SIDE = 128, PIXELS = SIDE * SIDE };
static const camera view = {.width = SIDE, .height = SIDE, .fov = 60};

typedef struct scene {
    img depth, normal, mask;
} scene;

static void scene_new(scene *s)
{
    assert_int_equal(img_new(&s->depth, SIDE, SIDE, 1), OK);
    assert_int_equal(img_new(&s->normal, SIDE, SIDE, 3), OK);
    assert_int_equal(img_new(&s->mask, SIDE, SIDE, 1), OK);
}

static void scene_free(scene *s)
{
    img_free(&s->depth);
    img_free(&s->normal);
    img_free(&s->mask);
}

static vec3 ray_of(int i)
{
    return camera_point(&view, (float)(i % SIDE) + 0.5f, (float)(i / SIDE) + 0.5f, 1);
}

static vec3 point_of(const scene *s, int i)
{
    return vec3_scale(ray_of(i), s->depth.data[i]);
}

static void put(scene *s, int i, float depth, vec3 normal)
{
    s->depth.data[i] = depth;
    s->mask.data[i] = 1;
    memcpy(s->normal.data + 3 * i, (float[]){normal.x, normal.y, normal.z}, 3 * sizeof(float));
}

/* Over whatever is there. */
static void put_ball(scene *s, vec3 centre, float radius)
{
    for (int i = 0; i < PIXELS; i++) {
        vec3 d = vec3_normalize(ray_of(i));
        float along = vec3_dot(d, centre);
        float inside = along * along - vec3_dot(centre, centre) + radius * radius;
        if (inside <= 0) continue;
        vec3 p = vec3_scale(d, along - sqrtf(inside));
        put(s, i, -p.z, vec3_scale(vec3_sub(p, centre), 1 / radius));
    }
}

/* The plane n·p = offset, over the whole frame. */
static void put_plane(scene *s, vec3 n, float offset)
{
    for (int i = 0; i < PIXELS; i++)
        put(s, i, offset / vec3_dot(n, ray_of(i)), n);
}

static void cast(const scene *s, vec3 light, int side, img *seen)
{
    shadow_occluder occluder;
    assert_int_equal(shadow_occluder_new(&s->depth, &s->normal, &s->mask, (camera_lens){.fov = view.fov}, &occluder),
                     OK);
    assert_int_equal(shadow_cast(&occluder, light, side, side, seen), OK);
    shadow_occluder_free(&occluder);
}

/* Of the segments p..q and a..b, by trying points of the second: exact to |b - a| / 64. */
static float distance_between(vec3 p, vec3 q, vec3 a, vec3 b)
{
    float least = INFINITY;
    vec3 d = vec3_sub(q, p);
    for (int i = 0; i <= 32; i++) {
        vec3 c = vec3_lerp(a, b, (float)i / 32);
        float t = vec3_dot(vec3_sub(c, p), d) / vec3_dot(d, d);
        vec3 nearest = vec3_fma(p, fminf(fmaxf(t, 0), 1), d);
        least = fminf(least, vec3_length(vec3_sub(nearest, c)));
    }
    return least;
}

/* A ball before a wall. Only its front is in the depth map, so behind it the shadow may be as wide as that of the ball
 * drawn out along the line of sight by the thickness that is assumed (0.19 to the end of its border). */
static void the_shadow_of_a_ball_on_a_wall_has_the_outline_of_the_ball(void **state)
{
    (void)state;
    const vec3 centre = {0.05f, -0.02f, -0.9f}, wall = {0, 0, 1};
    const vec3 lights[] = {{0.7f, 0.2f, -0.4f}, {-0.5f, 0.6f, -0.5f}, {0.1f, -0.4f, -0.1f}};
    const float radius = 0.07f, thickness = 0.19f, pixel = camera_pixel_size(&view);
    const vec3 behind = vec3_scale(centre, 1 + thickness / 0.9f);
    /* the border is 3 % of the way of at most 0.6 from the wall to the ball, and a pixel's margin and width */
    const float border = 0.02f + 2 * 1.2f * pixel;
    scene s = {0};
    scene_new(&s);
    put_plane(&s, wall, -1.2f);
    put_ball(&s, centre, radius);
    for (size_t l = 0; l < sizeof lights / sizeof lights[0]; l++) {
        img seen;
        int dark = 0;
        cast(&s, lights[l], SIDE, &seen);
        for (int i = 0; i < PIXELS; i++) {
            if (s.depth.data[i] < 1.19f) continue; /* the ball itself */
            vec3 p = point_of(&s, i);
            if (distance_between(p, lights[l], centre, centre) < radius - border) assert_true(seen.data[i] < 0.5f);
            if (distance_between(p, lights[l], centre, behind) > radius + border) assert_true(seen.data[i] > 0.99f);
            dark += seen.data[i] < 0.5f;
        }
        assert_true(dark > 50);
        img_free(&seen);
    }
    scene_free(&s);
}

/* At this many points a side, most of which lie between the map's pixels. */
static void check_ball_is_lit(const scene *s, vec3 light, int side)
{
    img seen;
    cast(s, light, side, &seen);
    for (int k = 0; k < side * side; k++) {
        int i = k / side * SIDE / side * SIDE + k % side * SIDE / side;
        const float *n = s->normal.data + 3 * i;
        if (s->mask.data[i] < 0.5f) continue;
        vec3 normal = vec3_make(n[0], n[1], n[2]);
        vec3 to_light = vec3_normalize(vec3_sub(light, point_of(s, i)));
        vec3 to_camera = vec3_normalize(vec3_scale(point_of(s, i), -1));
        /* not at the terminator, where rays graze the ball, nor in the outermost three pixels, where from one to
         * the next the ball falls off by several */
        if (vec3_dot(normal, to_light) > 0.25f && vec3_dot(normal, to_camera) > 0.3f) assert_true(seen.data[k] > 0.99f);
    }
    img_free(&seen);
}

static void a_ball_alone_has_no_shadow_where_it_faces_the_light(void **state)
{
    (void)state;
    const vec3 centre = {0, 0, -1};
    scene s = {0};
    scene_new(&s);
    put_ball(&s, centre, 0.35f);
    for (int l = 0; l < 8; l++) {
        float phi = 0.785f * (float)l;
        vec3 light = {0.9f * cosf(phi), 0.9f * sinf(phi), -0.56f};
        check_ball_is_lit(&s, light, SIDE);
        check_ball_is_lit(&s, light, 447);
    }
    scene_free(&s);
}

/* What an estimated depth is like: a pixel's size of noise, which is a slope of 45 degrees from pixel to pixel. */
static void noise_in_the_depth_alone_casts_no_shadow(void **state)
{
    (void)state;
    scene s = {0};
    scene_new(&s);
    put_plane(&s, vec3_normalize(vec3_make(0.2f, 0.1f, 1)), -1);
    rng r = rng_at(1, 2, 3);
    for (int i = 0; i < PIXELS; i++)
        s.depth.data[i] += camera_pixel_size(&view) * rng_range(&r, -0.5f, 0.5f);
    img seen;
    cast(&s, vec3_make(0.8f, 0, -0.5f), SIDE, &seen);
    double sum = 0;
    for (int i = 0; i < PIXELS; i++)
        sum += (double)seen.data[i];
    assert_true(sum / PIXELS > 0.999);
    img_free(&seen);
    scene_free(&s);
}

static void a_flash_at_the_camera_sees_everything(void **state)
{
    (void)state;
    scene s = {0};
    scene_new(&s);
    put_plane(&s, vec3_make(0, 0, 1), -1.2f);
    put_ball(&s, vec3_make(0.1f, 0, -0.8f), 0.1f);
    img seen;
    cast(&s, vec3_make(0, 0, 0), SIDE, &seen);
    for (int i = 0; i < PIXELS; i++)
        assert_true(seen.data[i] == 1);
    img_free(&seen);
    scene_free(&s);
}

static void lights_anywhere_give_shares_between_nothing_and_all(void **state)
{
    (void)state;
    const vec3 lights[] = {{0, 0, -1.2f},     {0, 0, -0.7f}, {0, 0, -9},          {0.1f, 0, -1.2f},
                           {5, 5, -1.1999f},  {0, 0, 3},     {1e30f, 0, -1.000f}, {1e-30f, 1e-30f, -1e-30f},
                           {0, -1e30f, 1e30f}};
    scene s = {0};
    scene_new(&s);
    put_plane(&s, vec3_make(0, 0, 1), -1.2f);
    put_ball(&s, vec3_make(0.1f, 0, -0.8f), 0.1f);
    for (int i = 0; i < PIXELS / 3; i++) /* and an edge of the object */
        s.mask.data[i] = s.depth.data[i] = 0;
    for (size_t l = 0; l < sizeof lights / sizeof lights[0]; l++) {
        img seen;
        cast(&s, lights[l], SIDE / 3, &seen);
        for (int i = 0; i < SIDE / 3 * (SIDE / 3); i++)
            assert_true(seen.data[i] >= 0 && seen.data[i] <= 1);
        img_free(&seen);
    }
    scene_free(&s);
}

static void a_surface_of_no_pixels_has_no_shadow(void **state)
{
    (void)state;
    scene s = {0};
    scene_new(&s);
    img seen;
    cast(&s, vec3_make(1, 0, 0), SIDE, &seen);
    for (int i = 0; i < PIXELS; i++)
        assert_true(seen.data[i] == 1);
    img_free(&seen);
    scene_free(&s);
}

static void a_finer_grid_of_rays_sees_the_same(void **state)
{
    (void)state;
    const vec3 light = {0.7f, 0.2f, -0.4f};
    scene s = {0};
    scene_new(&s);
    put_plane(&s, vec3_make(0, 0, 1), -1.2f);
    put_ball(&s, vec3_make(0.05f, 0, -0.9f), 0.1f);
    img coarse, fine, ones;
    cast(&s, light, SIDE, &coarse);
    cast(&s, light, 2 * SIDE, &fine);
    assert_int_equal(img_new(&ones, SIDE, SIDE, 1), OK);
    for (int i = 0; i < PIXELS; i++)
        ones.data[i] = 1;
    shadow_darken(&fine, &ones); /* the mean of the four finer points */
    double difference = 0, shadow = 0;
    for (int i = 0; i < PIXELS; i++) {
        difference += fabs((double)ones.data[i] - (double)coarse.data[i]);
        shadow += 1 - (double)coarse.data[i];
    }
    /* only along the outline, where a finer point is half a pixel nearer to it: a shadow 20 pixels wide has an outline
     * of about a fifth of its area for each pixel of width */
    assert_true(shadow > 100);
    assert_true(difference < 0.1 * shadow);
    img_free(&coarse);
    img_free(&fine);
    img_free(&ones);
    scene_free(&s);
}

/* Rays that start in the outer half of the outermost pixels, as a finer grid's do, and run along the edge. */
static void a_shadow_reaches_the_edge_of_the_frame(void **state)
{
    (void)state;
    enum { FINE = 2 * SIDE };
    const vec3 lights[] = {{0, 0.9f, -0.6f}, {0, -0.9f, -0.6f}, {0.9f, 0, -0.6f}, {-0.9f, 0, -0.6f}};
    const float far = 0.55f; /* the ball's middle is beyond the frame's edge */
    const vec3 balls[] = {{-far, 0, -0.9f}, {far, 0, -0.9f}, {0, far, -0.9f}, {0, -far, -0.9f}};
    for (int l = 0; l < 4; l++) {
        scene s = {0};
        scene_new(&s);
        put_plane(&s, vec3_make(0, 0, 1), -1.2f);
        put_ball(&s, balls[l], 0.15f);
        img seen;
        int dark_outside = 0, dark_inside = 0;
        cast(&s, lights[l], FINE, &seen);
        for (int i = 0; i < FINE; i++) {
            int across = balls[l].x != 0, end = balls[l].x + balls[l].y > 0, edge = end == across ? FINE - 1 : 0;
            int next = edge ? FINE - 2 : 1; /* rows run downwards */
            dark_outside += (across ? *img_at(&seen, edge, i) : *img_at(&seen, i, edge)) < 0.5f;
            dark_inside += (across ? *img_at(&seen, next, i) : *img_at(&seen, i, next)) < 0.5f;
        }
        assert_true(dark_inside > 20);
        /* half of a occluder's pixel apart, the ends of the shadow may have moved by a few points */
        assert_true(dark_outside > 0.9 * dark_inside);
        img_free(&seen);
        scene_free(&s);
    }
}

/* A picture finer than the map has pixels of the object beside the map's, and interpolates between these and the next.
 */
static void a_shadow_goes_on_beside_the_map(void **state)
{
    (void)state;
    enum { END = SIDE / 2 };
    scene s = {0};
    scene_new(&s);
    put_plane(&s, vec3_make(0, 0, 1), -1.2f);
    put_ball(&s, vec3_make(-0.2f, 0, -0.9f), 0.07f);
    for (int i = 0; i < PIXELS; i++)
        if (i % SIDE >= END) s.mask.data[i] = s.depth.data[i] = 0;
    for (int scale = 1; scale <= 2; scale++) {
        img seen;
        int dark_outside = 0, dark_inside = 0;
        cast(&s, vec3_make(-0.6f, 0, -0.6f), scale * SIDE, &seen);
        for (int row = 0; row < scale * SIDE; row++) {
            dark_inside += *img_at(&seen, scale * END - 1, row) < 0.5f;
            dark_outside += *img_at(&seen, scale * END + scale - 1, row) < 0.5f;
        }
        assert_true(dark_inside > 10 * scale);
        /* a pixel of the map apart, the ends of the shadow may have moved by as much */
        assert_true(dark_outside >= dark_inside - 2 * scale);
        img_free(&seen);
    }
    scene_free(&s);
}

static void fusion_takes_noise_out_of_a_slope_and_leaves_a_jump(void **state)
{
    (void)state;
    const vec3 n = vec3_normalize(vec3_make(0.3f, -0.2f, 1));
    const float pixel = camera_pixel_size(&view);
    scene noisy = {0}, smooth = {0};
    scene_new(&noisy);
    scene_new(&smooth);
    put_plane(&smooth, n, -1);
    put_plane(&noisy, n, -1);
    rng r = rng_at(1, 2, 3);
    double before = 0, after = 0;
    for (int i = 0; i < PIXELS; i++) {
        if (i % SIDE >= SIDE / 2) smooth.depth.data[i] *= 1.2f; /* the same normals, twenty pixels' size further away */
        noisy.depth.data[i] = smooth.depth.data[i] + pixel * rng_range(&r, -0.5f, 0.5f);
        before += pow((double)(noisy.depth.data[i] - smooth.depth.data[i]), 2);
    }
    assert_int_equal(fuse_depth(&noisy.normal, &noisy.mask, (camera_lens){.fov = view.fov}, &noisy.depth), OK);
    for (int i = 0; i < PIXELS; i++)
        after += pow((double)(noisy.depth.data[i] - smooth.depth.data[i]), 2);
    /* white noise over a reach of 20 pixels would fall to a few percent; the normals' pairs next to the jump are lost
     */
    assert_true(sqrt(after / before) < 0.15);
    scene_free(&noisy);
    scene_free(&smooth);
}

/* The share of pixels that a scene's distant lamp and a near one in the same direction do not light alike. */
static double unlike(const scene *s, vec3 direction, real distance)
{
    shadow_occluder occluder;
    img far_seen, near_seen;
    const lamp afar = lamp_toward(direction);
    const vec3 place = vec3_fma(vec3_make(0, 0, -1), distance, vec3_normalize(direction));
    assert_int_equal(shadow_occluder_new(&s->depth, &s->normal, &s->mask, (camera_lens){.fov = view.fov}, &occluder),
                     OK);
    assert_int_equal(shadow_cast_lamp(&occluder, &afar, SIDE, SIDE, &far_seen), OK);
    assert_int_equal(shadow_cast(&occluder, place, SIDE, SIDE, &near_seen), OK);
    double count = 0, shadowed = 0;
    for (int i = 0; i < PIXELS; i++) {
        count += (far_seen.data[i] < 0.5f) != (near_seen.data[i] < 0.5f);
        shadowed += far_seen.data[i] < 0.5f;
    }
    assert_true(shadowed > 0.01 * PIXELS);
    shadow_occluder_free(&occluder);
    img_free(&far_seen);
    img_free(&near_seen);
    return count / PIXELS;
}

static void a_distant_lamp_casts_the_shadows_that_near_ones_further_and_further_away_do(void **state)
{
    (void)state;
    const vec3 directions[] = {{0.7f, 0.2f, 0.5f}, {-0.5f, 0.6f, 0.6f}};
    scene s = {0};
    scene_new(&s);
    put_plane(&s, vec3_make(0, 0, 1), -1.2f);
    put_ball(&s, vec3_make(0.05f, -0.02f, -0.9f), 0.12f);
    for (size_t l = 0; l < sizeof directions / sizeof directions[0]; l++) {
        assert_true(unlike(&s, directions[l], 100) < 0.002);
        assert_true(unlike(&s, directions[l], 1) > 0.002);
    }
    scene_free(&s);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_shadow_of_a_ball_on_a_wall_has_the_outline_of_the_ball),
        cmocka_unit_test(a_ball_alone_has_no_shadow_where_it_faces_the_light),
        cmocka_unit_test(noise_in_the_depth_alone_casts_no_shadow),
        cmocka_unit_test(a_distant_lamp_casts_the_shadows_that_near_ones_further_and_further_away_do),
        cmocka_unit_test(a_flash_at_the_camera_sees_everything),
        cmocka_unit_test(lights_anywhere_give_shares_between_nothing_and_all),
        cmocka_unit_test(a_surface_of_no_pixels_has_no_shadow),
        cmocka_unit_test(a_finer_grid_of_rays_sees_the_same),
        cmocka_unit_test(a_shadow_reaches_the_edge_of_the_frame),
        cmocka_unit_test(a_shadow_goes_on_beside_the_map),
        cmocka_unit_test(fusion_takes_noise_out_of_a_slope_and_leaves_a_jump),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
