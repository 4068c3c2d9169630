/* SPDX-License-Identifier: MIT */
/* A ball under near lights that were found from a flat guess of it: the network that ships makes it rounder. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include "photo_stereo/near_refine.h"

#include <cmocka.h> /* last, as cmocka defines a macro named fail */

#include "ball.h"
#include "sanitized.h"

enum { MOST = 14 };
static const merlin_stereo_params unknown = {.method = MERLIN_STEREO_UNCALIBRATED, .unchecked = 1};
static int torches;

static vec3 torch(int i)
{
    return ball_lamp(i, torches);
}

typedef struct fixture {
    merlin_capture capture;
    ball_expectation guess; /* another network's */
    pst_expected expected;
} fixture;

static void photograph(int count, bool lights_alone, fixture *f)
{
    torches = count;
    ball_photograph(&f->capture, count, torch, 0.6f, &f->guess);
    f->expected = ball_as_expected(&f->guess);
    f->expected.lights_alone = lights_alone;
}

static void put_away(fixture *f)
{
    ball_put_away(&f->capture, &f->guess);
}

static nfps_network *shipped_network(void)
{
    nfps_network *n = NULL;
    if (nfps_network_open(MERLIN_SOURCE_DIR "/models/merlin-nfps.safetensors", &n) != OK)
        fail_msg("%s", status_message());
    return n;
}

/* The lights' fit by itself leaves 1 to 3 degrees of such a ball, which the network has, too; fewer errors than what
 * was expected are asked for, and of so many pictures that photometric stereo does the rest hardly any. */
static void a_surface_under_found_lights_is_made_anew(void **state)
{
    static const struct {
        int pictures;
        double most;
        bool lights_alone; /* whether the first solution leaves the surface to the second */
    } cases[] = {{4, 5, false}, {6, 4, true}, {MOST, 0.7, false}, {MOST, 0.7, true}};
    (void)state;
    nfps_network *network = shipped_network();
    for (size_t i = SANITIZED ? 3 : 0; i < sizeof cases / sizeof *cases; i++) {
        fixture f;
        merlin_surface s;
        photograph(cases[i].pictures, cases[i].lights_alone, &f);
        if (pst_solve_expecting(&f.capture, &unknown, &f.expected, &s) != OK) fail_msg("%s", status_message());
        assert_true(s.lights_near);
        const double before = mean_angle(&f.capture, &s.normal);
        assert_true((before > 0) != (cases[i].lights_alone && cases[i].pictures == MOST)); /* normals of zero */
        const near_refinement n = {network, &f.capture, NULL};
        if (near_refine(&n, &s) != OK) fail_msg("%s", status_message());
        const double after = mean_angle(&f.capture, &s.normal);
        print_message("%d pictures: %.2f degrees, before %.2f, expected %.2f\n", cases[i].pictures, after, before,
                      mean_angle(&f.capture, &f.guess.normal));
        assert_true(after < cases[i].most);
        assert_true(s.normal.data && s.albedo.data && !s.lights_unsure);
        merlin_surface_free(&s);
        put_away(&f);
    }
    nfps_network_close(network);
}

static int give_up(void)
{
    return 1;
}

static void what_is_not_to_be_refined_stays(void **state)
{
    (void)state;
    fixture f;
    merlin_surface s;
    nfps_network *network = shipped_network();
    photograph(4, false, &f);
    if (pst_solve_expecting(&f.capture, &unknown, &f.expected, &s) != OK) fail_msg("%s", status_message());
    const float *before = s.normal.data;
    near_refinement n = {NULL, &f.capture, NULL};
    assert_int_equal(near_refine(&n, &s), OK); /* no network */
    assert_ptr_equal(s.normal.data, before);
    n.network = network;
    n.stop = give_up;
    assert_int_equal(near_refine(&n, &s), MERLIN_STOPPED);
    n.stop = NULL;
    s.lights_near = 0; /* an unknown lens */
    assert_int_equal(near_refine(&n, &s), OK);
    assert_ptr_equal(s.normal.data, before);
    merlin_surface_free(&s);
    nfps_network_close(network);
    put_away(&f);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_surface_under_found_lights_is_made_anew),
        cmocka_unit_test(what_is_not_to_be_refined_stays),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
