/* SPDX-License-Identifier: MIT */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include "optics/camera.h"
#include "stereo/integrate/integrate.h"

#include <cmocka.h>

/* Normals of a scene, its mask and its true depth. */
typedef struct scene {
    img normal, mask, depth;
    pinhole camera;
} scene;

static scene scene_new(int width, int height)
{
    scene s = {0};
    assert_int_equal(img_new(&s.normal, width, height, 3), OK);
    assert_int_equal(img_new(&s.mask, width, height, 1), OK);
    assert_int_equal(img_new(&s.depth, width, height, 1), OK);
    return s;
}

static void scene_free(scene *s)
{
    img_free(&s->normal);
    img_free(&s->mask);
    img_free(&s->depth);
}

static void put(scene *s, int x, int y, vec3 n, float depth)
{
    float *to = img_at(&s->normal, x, y);
    n = vec3_normalize(n);
    to[0] = n.x;
    to[1] = n.y;
    to[2] = n.z;
    *img_at(&s->mask, x, y) = 1;
    *img_at(&s->depth, x, y) = depth;
}

static pinhole camera_of(int width, int height)
{
    return (pinhole){.focal = (float)width / (2 * tanf(0.5235988f)), .x = (float)width / 2, .y = (float)height / 2};
}

/* Largest error after the constant (orthographic) or the scale (perspective) is taken from the truth's mean. */
static double largest_error(const scene *s, const img *depth)
{
    double sum = 0, truth = 0, count = 0, worst = 0;
    size_t pixels = (size_t)depth->width * (size_t)depth->height;
    for (size_t i = 0; i < pixels; i++) {
        if (s->mask.data[i] == 0) {
            assert_true(depth->data[i] == 0);
            continue;
        }
        sum += (double)depth->data[i];
        truth += (double)s->depth.data[i];
        count++;
    }
    for (size_t i = 0; i < pixels; i++) {
        if (s->mask.data[i] == 0) continue;
        double d = (double)depth->data[i];
        d = pinhole_is_near(&s->camera) ? d * truth / sum : d + (truth - sum) / count;
        worst = fmax(worst, fabs(d - (double)s->depth.data[i]));
    }
    return worst;
}

static double error_of(const scene *s, bool edges)
{
    img depth;
    assert_int_equal(
        pst_integrate(&s->normal, &s->mask, &s->camera, &(pst_integration){.preserve_edges = edges}, &depth), OK);
    double worst = largest_error(s, &depth);
    img_free(&depth);
    return worst;
}

static void fill_sphere_cap(scene *s, float radius, float rim)
{
    float cx = (float)s->normal.width / 2, cy = (float)s->normal.height / 2;
    for (int y = 0; y < s->normal.height; y++)
        for (int x = 0; x < s->normal.width; x++) {
            float dx = (float)x + 0.5f - cx, dy = cy - (float)y - 0.5f, square = dx * dx + dy * dy;
            if (square > rim * rim) continue;
            float z = sqrtf(radius * radius - square);
            put(s, x, y, vec3_make(dx, dy, z), radius - z);
        }
}

/* Depth of 60 pixels in floats of 24 bits, accumulated over 64 steps: 1e-4 pixels leave a factor ten. */
static void orthographic_planes_are_exact(void **state)
{
    (void)state;
    scene s = scene_new(64, 48);
    for (int y = 0; y < 48; y++)
        for (int x = 0; x < 64; x++) /* depth grows by 0.75 to the right and by 0.5 downward */
            put(&s, x, y, vec3_make(0.75f, -0.5f, 1), 0.75f * (float)x + 0.5f * (float)y);
    assert_true(error_of(&s, false) < 1e-4);
    assert_true(error_of(&s, true) < 1e-3);
    scene_free(&s);
}

/* A chord is perpendicular to the sum of the normals at its ends: no discretization error at all. Floats again. */
static void an_orthographic_sphere_is_exact(void **state)
{
    (void)state;
    scene s = scene_new(80, 80);
    fill_sphere_cap(&s, 40, 38);
    assert_true(error_of(&s, false) < 1e-3);
    scene_free(&s);
}

/* Weights change nothing where every step fits: no pair is off by more than rounding. */
static void an_orthographic_sphere_survives_the_edge_preserving_variant(void **state)
{
    (void)state;
    scene s = scene_new(80, 80);
    fill_sphere_cap(&s, 40, 34);
    assert_true(error_of(&s, true) < 1e-3);
    scene_free(&s);
}

static void a_sphere_in_perspective_is_exact(void **state)
{
    (void)state;
    enum { SIDE = 72 };
    scene s = scene_new(SIDE, SIDE);
    s.camera = camera_of(SIDE, SIDE);
    const camera c = {.width = SIDE, .height = SIDE, .fov = 60};
    const vec3 center = {0.05f, -0.03f, -1};
    for (int y = 0; y < SIDE; y++)
        for (int x = 0; x < SIDE; x++) {
            vec3 ray = camera_ray(&c, (real)x + (real)0.5, (real)y + (real)0.5);
            real along = vec3_dot(ray, center), inside = along * along - vec3_dot(center, center) + (real)0.16;
            if (inside < (real)0.01) continue;
            vec3 p = vec3_scale(ray, along - sqrt(inside));
            put(&s, x, y, vec3_sub(p, center), -p.z);
        }
    assert_true(error_of(&s, false) < 1e-5);
    assert_true(error_of(&s, true) < 1e-5);
    scene_free(&s);
}

/* A flat square 20 pixels before a slope: on the slope's normals alone least squares has nothing to go by, and the
 * edge-preserving variant must keep each side's own shape: a ramp of 0.5 a pixel and, on the square, a plane. */
static void a_step_does_not_bend_what_lies_beside_it(void **state)
{
    (void)state;
    enum { SIDE = 48 };
    scene s = scene_new(SIDE, SIDE);
    for (int y = 0; y < SIDE; y++)
        for (int x = 0; x < SIDE; x++) {
            bool right = x >= SIDE / 2;
            float slope = right ? -0.8f : 0.8f; /* a roof's two sides, the right one cut off and lowered */
            float middle = (float)(SIDE / 2);
            put(&s, x, y, vec3_make(slope, 0, 1), slope * ((float)x - middle) + (right ? 12.0f : 0.0f));
        }
    img depth[2];
    double bend[2] = {0, 0};
    for (int edges = 0; edges < 2; edges++) {
        pst_integration o = {.preserve_edges = edges == 1};
        assert_int_equal(pst_integrate(&s.normal, &s.mask, &s.camera, &o, &depth[edges]), OK);
        for (int x = 0; x + 1 < SIDE; x++) {
            if (x + 1 == SIDE / 2) continue; /* the step itself is not in the normals */
            double step = (double)(*img_at(&depth[edges], x + 1, 20) - *img_at(&depth[edges], x, 20));
            bend[edges] = fmax(bend[edges], fabs(step - (x + 1 < SIDE / 2 ? 0.8 : -0.8)));
        }
        img_free(&depth[edges]);
    }
    assert_true(bend[0] < 1e-4 && bend[1] < 1e-3);
    scene_free(&s);
}

/* A sheet whose right half is wavy and, between two ends, raised above its flat left half by up to 10 pixels. The
 * normals do not show the step itself; that they differ along it is all there is to go by. */
static scene cracked_sheet(void)
{
    enum { SIDE = 96, FIRST = 8, LENGTH = 80 };
    const float pi = 3.14159265f, middle = sinf(0.1f * SIDE / 2);
    scene s = scene_new(SIDE, SIDE);
    for (int y = 0; y < SIDE; y++)
        for (int x = 0; x < SIDE; x++) {
            float along = fminf(fmaxf((float)(y - FIRST) / LENGTH, 0), 1), up = sinf(pi * along);
            float down = 10 * pi / LENGTH * sinf(2 * pi * along); /* slope of the step's height */
            if (x < SIDE / 2)
                put(&s, x, y, vec3_make(0, 0, 1), 0);
            else
                put(&s, x, y, vec3_make(0.3f * cosf(0.1f * (float)x), -down, 1),
                    10 * up * up + 3 * (sinf(0.1f * (float)x) - middle));
        }
    return s;
}

/* Least squares closes the crack: 5 pixels are missing on either side of its middle. It is off by 0.08 pixels when
 * edges are kept; the bound leaves a factor of two. */
static void a_crack_stays_a_step_if_edges_are_kept(void **state)
{
    (void)state;
    scene s = cracked_sheet();
    double torn = error_of(&s, false), kept = error_of(&s, true);
    print_message("cracked sheet: least squares off by %.2f, edges kept by %.3f pixels\n", torn, kept);
    assert_true(torn > 4 && kept < 0.16);
    scene_free(&s);
}

static bool inside(int side, int at, float radius)
{
    float dx = (float)(at % side) + 0.5f - (float)side / 2, dy = (float)(at / side) + 0.5f - (float)side / 2;
    return dx * dx + dy * dy < radius * radius;
}

/* Normals of a ball before a slanted background that nothing joins: the least-squares surface bends the ball. The rim's
 * outermost pixels may be taken for background, so it is looked at from 3 pixels inside, with its own constant. */
static double silhouette_error(bool edges)
{
    enum { SIDE = 96 };
    scene s = scene_new(SIDE, SIDE);
    for (int y = 0; y < SIDE; y++)
        for (int x = 0; x < SIDE; x++)
            put(&s, x, y, vec3_make(0.25f, 0, 1), 0.25f * (float)x);
    fill_sphere_cap(&s, 30, 28);
    img depth;
    assert_int_equal(pst_integrate(&s.normal, &s.mask, &s.camera, &(pst_integration){.preserve_edges = edges}, &depth),
                     OK);
    for (int i = 0; i < SIDE * SIDE; i++)
        if (!inside(SIDE, i, 25)) s.mask.data[i] = depth.data[i] = 0;
    double error = largest_error(&s, &depth);
    img_free(&depth);
    scene_free(&s);
    return error;
}

static void a_ball_before_a_background_keeps_its_shape_if_edges_are_kept(void **state)
{
    (void)state;
    double torn = silhouette_error(false), kept = silhouette_error(true);
    print_message("ball before a background: least squares off by %.2f, edges kept by %.2f pixels\n", torn, kept);
    assert_true(kept < 0.3 * torn); /* 0.22 measured */
}

/* More unknowns than are factorized: conjugate gradients under the multigrid cycle, to its own tolerance. */
static void a_mask_beyond_direct_solution_is_solved_too(void **state)
{
    (void)state;
    scene s = scene_new(700, 560);
    fill_sphere_cap(&s, 290, 270);
    double error = error_of(&s, false);
    print_message("229 thousand unknowns: largest error %.5f pixels\n", error);
    /* a residual of 1e-7 against a condition of (diameter/π)² = 3e4 and depths of 190 pixels */
    assert_true(error < 0.1);
    scene_free(&s);
}

/* Sloping stairs three pixels wide, one beside the other and each with a slope of its own: the iteration has to solve
 * them all at once. Mixed up on coarser grids, steps of 0.6 pixels are off by 0.8 after hundreds of rounds. Depths
 * below 1000 are floats with steps of 6e-5, of which a difference sums up a few. */
/* From pixel to pixel of a row, whatever constant a piece has. */
static void check_steps(const scene *s)
{
    img depth;
    assert_int_equal(pst_integrate(&s->normal, &s->mask, &s->camera, &(pst_integration){0}, &depth), OK);
    float worst = 0;
    for (int y = 0; y < depth.height; y++)
        for (int x = 0; x + 1 < depth.width; x++) {
            if (*img_at(&s->mask, x, y) == 0 || *img_at(&s->mask, x + 1, y) == 0) continue;
            float step = *img_at(&depth, x + 1, y) - *img_at(&depth, x, y);
            worst = fmaxf(worst, fabsf(step - (*img_at(&s->depth, x + 1, y) - *img_at(&s->depth, x, y))));
        }
    print_message("largest error of a step: %.5f pixels\n", (double)worst);
    assert_true(worst < 1e-3f);
    img_free(&depth);
}

static void pieces_beyond_direct_solution_keep_their_own_slopes(void **state)
{
    (void)state;
    enum { WIDTH = 700, HEIGHT = 560 };
    scene s = scene_new(WIDTH, HEIGHT);
    for (int y = 0; y < HEIGHT; y++)
        for (int x = 0; x < WIDTH; x++) {
            int piece = (x + y) / 4;
            float right = 0.5f * (float)(piece % 2), down = 0.6f * (float)(piece % 3 - 1);
            if ((x + y) % 4 < 3) put(&s, x, y, vec3_make(right, -down, 1), right * (float)x + down * (float)y);
        }
    check_steps(&s);
    scene_free(&s);
}

/* A comb: slanted teeth ten pixels wide and two apart, each of which bends its own way; most are joined at their left
 * ends. Coarse blocks have several teeth in them. */
static void one_piece_with_slits_is_solved_too(void **state)
{
    (void)state;
    enum { SIDE = 900, JOINT = 8 };
    const float way = 50;
    scene s = scene_new(SIDE, SIDE);
    for (int y = 0; y < SIDE; y++)
        for (int x = 0; x < SIDE; x++) {
            float bend = 0.5f * (float)((x + 2 * y) / 12 % 3 - 1), from = fmaxf((float)(x - JOINT), 0);
            float right = bend * (1 - expf(-from / way)), depth = bend * (from + way * expf(-from / way) - way);
            if ((x + 2 * y) % 12 < 10 || x < JOINT) put(&s, x, y, vec3_make(right, 0, 1), depth);
        }
    check_steps(&s);
    scene_free(&s);
}

/* To and fro, two pixels wide: from one end to the other are 270 thousand pixels, which the iteration does not bridge:
 * steps would be off by more than is allowed here. */
static void a_long_winding_band_is_factorized(void **state)
{
    (void)state;
    enum { SIDE = 900, WIDTH = 2 };
    scene s = scene_new(SIDE, SIDE);
    for (int y = 0; y < SIDE; y++)
        for (int x = 0; x < SIDE; x++) {
            bool band = y % (WIDTH + 1) < WIDTH, left = y / (WIDTH + 1) % 2;
            float slope = 0.4f * cosf(0.02f * (float)x);
            if (band || (left ? x < WIDTH : x >= SIDE - WIDTH))
                put(&s, x, y, vec3_make(slope, 0, 1), 20 * sinf(0.02f * (float)x));
        }
    check_steps(&s);
    scene_free(&s);
}

static void pieces_have_their_own_constant_and_depths_are_positive(void **state)
{
    (void)state;
    scene s = scene_new(40, 20);
    for (int y = 0; y < 20; y++)
        for (int x = 0; x < 40; x++)
            if (x < 15 || x >= 25) put(&s, x, y, vec3_make(x < 15 ? 1 : -2, 0, 1), 0);
    img depth;
    assert_int_equal(pst_integrate(&s.normal, &s.mask, &s.camera, &(pst_integration){0}, &depth), OK);
    double left = 0, right = 0;
    for (int y = 0; y < 20; y++)
        for (int x = 0; x < 40; x++) {
            double d = (double)*img_at(&depth, x, y);
            assert_true(x >= 15 && x < 25 ? d == 0 : d > 0);
            *(x < 15 ? &left : &right) += d / 300;
        }
    assert_true(fabs(left - right) < 1e-3);
    img_free(&depth);
    scene_free(&s);
}

static void a_prior_sets_the_distance(void **state)
{
    (void)state;
    scene s = scene_new(32, 32);
    for (int y = 0; y < 32; y++)
        for (int x = 0; x < 32; x++)
            put(&s, x, y, vec3_make(0.5f, 0, 1), 100 + 0.5f * (float)x);
    img depth;
    pst_integration o = {.prior = &s.depth, .prior_weight = 1e-3f};
    assert_int_equal(pst_integrate(&s.normal, &s.mask, &s.camera, &o, &depth), OK);
    for (int x = 0; x < 32; x++)
        assert_true(fabsf(*img_at(&depth, x, 9) - *img_at(&s.depth, x, 9)) < 1e-3f);
    img_free(&depth);
    scene_free(&s);
}

/* Two level halves, the right one 7 pixels deeper. No normal shows it; the nine pixels of each half that are trusted
 * do, and the ripple that the prior has elsewhere stays out. */
static void a_few_trusted_pixels_place_their_part(void **state)
{
    (void)state;
    enum { SIDE = 24 };
    scene s = scene_new(SIDE, SIDE);
    img prior, trust, depth;
    assert_int_equal(img_new(&prior, SIDE, SIDE, 1), OK);
    assert_int_equal(img_new(&trust, SIDE, SIDE, 1), OK);
    for (int y = 0; y < SIDE; y++)
        for (int x = 0; x < SIDE; x++) {
            bool right = x >= SIDE / 2, trusted = y >= 10 && y < 13 && x % (SIDE / 2) >= 4 && x % (SIDE / 2) < 7;
            put(&s, x, y, vec3_make(0, 0, 1), right ? 57 : 50);
            *img_at(&trust, x, y) = trusted ? 1 : 0;
            *img_at(&prior, x, y) = *img_at(&s.depth, x, y) + (trusted ? 0 : 0.2f * sinf((float)x + 2 * (float)y));
        }
    pst_integration o = {
        .preserve_edges = true, .prior = &prior, .prior_weight = 1e-2f, .trust = &trust, .from_prior = true};
    assert_int_equal(pst_integrate(&s.normal, &s.mask, &s.camera, &o, &depth), OK);
    /* the pairs that are given up keep 1e-6 of their weight, 24 of them against pulls of 0.09 */
    for (int i = 0; i < SIDE * SIDE; i++)
        assert_true(fabsf(depth.data[i] - s.depth.data[i]) < 0.02f);
    img_free(&prior);
    img_free(&trust);
    img_free(&depth);
    scene_free(&s);
}

static void what_makes_no_sense_is_refused(void **state)
{
    (void)state;
    scene s = scene_new(8, 8), other = scene_new(9, 8);
    img depth;
    assert_int_equal(pst_integrate(&s.normal, &s.mask, &s.camera, &(pst_integration){0}, &depth), MERLIN_BAD_INPUT);
    assert_int_equal(pst_integrate(&s.normal, &other.mask, &s.camera, &(pst_integration){0}, &depth), MERLIN_WRONG_USE);
    pst_integration foreign = {.prior = &s.depth, .prior_weight = 1, .trust = &other.depth};
    assert_int_equal(pst_integrate(&s.normal, &s.mask, &s.camera, &foreign, &depth), MERLIN_WRONG_USE);
    s.camera.focal = -1;
    assert_int_equal(pst_integrate(&s.normal, &s.mask, &s.camera, &(pst_integration){0}, &depth), MERLIN_WRONG_USE);
    assert_null(depth.data);
    scene_free(&s);
    scene_free(&other);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(orthographic_planes_are_exact),
        cmocka_unit_test(an_orthographic_sphere_is_exact),
        cmocka_unit_test(an_orthographic_sphere_survives_the_edge_preserving_variant),
        cmocka_unit_test(a_sphere_in_perspective_is_exact),
        cmocka_unit_test(a_step_does_not_bend_what_lies_beside_it),
        cmocka_unit_test(a_crack_stays_a_step_if_edges_are_kept),
        cmocka_unit_test(a_ball_before_a_background_keeps_its_shape_if_edges_are_kept),
        cmocka_unit_test(a_mask_beyond_direct_solution_is_solved_too),
        cmocka_unit_test(pieces_beyond_direct_solution_keep_their_own_slopes),
        cmocka_unit_test(one_piece_with_slits_is_solved_too),
        cmocka_unit_test(a_long_winding_band_is_factorized),
        cmocka_unit_test(pieces_have_their_own_constant_and_depths_are_positive),
        cmocka_unit_test(a_prior_sets_the_distance),
        cmocka_unit_test(a_few_trusted_pixels_place_their_part),
        cmocka_unit_test(what_makes_no_sense_is_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
