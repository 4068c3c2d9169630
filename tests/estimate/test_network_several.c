/* SPDX-License-Identifier: MIT */
/* network_estimate_several: of one photograph it is network_estimate, the photographs' order does not matter, and each
 * has a light. */
#include "base/rng.h"
#include "estimate/photo/compare.h"
#include "scratch.h"
#include "weights.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h> /* last, as cmocka defines a macro named fail */

enum { SIZE = 64, PIXELS = SIZE * SIZE, PICTURES = 3, VIEWS = 3 };

typedef struct fixture {
    network *network, *single;
    img photo[PICTURES], mask;
} fixture;

static const sight how = {.lens = {.fov = 35, .slant = {0.1f, -0.05f}}};

static int set_up(void **state)
{
    fixture *f = calloc(1, sizeof *f);
    if (!f || scratch_open(state) != 0) return -1;
    *state = f;
    const char *several = scratch_path("several.safetensors"), *any = scratch_path("any.safetensors");
    if (write_random_weights_of("merlin-several", several) != OK || network_open(several, &f->network) != OK) return -1;
    if (write_random_weights_of("merlin-any", any) != OK || network_open(any, &f->single) != OK) return -1;
    network_compute_in(f->network, NN_FLOAT32);
    if (img_new(&f->mask, SIZE, SIZE, 1) != OK) return -1;
    for (int i = 0; i < PIXELS; i++)
        f->mask.data[i] = hypotf((float)(i % SIZE) - 30, (float)(i / SIZE) - 33) < 25;
    for (int k = 0; k < PICTURES; k++) {
        if (img_new(&f->photo[k], SIZE, SIZE, 3) != OK) return -1;
        rng r = rng_at(4, (uint64_t)k, 0);
        for (int i = 0; i < 3 * PIXELS; i++)
            f->photo[k].data[i] = f->mask.data[i / 3] * (0.2f + 0.1f * (float)k + 0.3f * rng_uniform(&r));
    }
    return 0;
}

static int tear_down(void **state)
{
    fixture *f = *state;
    network_close(f->network);
    network_close(f->single);
    for (int k = 0; k < PICTURES; k++)
        img_free(&f->photo[k]);
    img_free(&f->mask);
    free(f);
    return scratch_close(state);
}

static void assert_near(const img *a, const img *b, float tolerance)
{
    assert_int_equal(img_value_count(a), img_value_count(b));
    for (size_t i = 0; i < img_value_count(a); i++)
        assert_float_equal(a->data[i], b->data[i], tolerance);
}

static void one_photograph_is_estimated_as_alone(void **state)
{
    const fixture *f = *state;
    network_estimation alone, several;
    float lights[1][MODEL_LIGHTS];
    assert_int_equal(network_estimate(f->network, f->photo, &f->mask, &how, VIEWS, NULL, &alone), OK);
    assert_int_equal(network_estimate_several(f->network, f->photo, 1, &f->mask, &how, VIEWS, NULL, lights, &several),
                     OK);
    assert_near(&several.maps.normal, &alone.maps.normal, 0);
    assert_near(&several.maps.albedo, &alone.maps.albedo, 0);
    assert_near(&several.maps.depth, &alone.maps.depth, 0);
    assert_near(&several.visibility, &alone.visibility, 0);
    assert_memory_equal(lights[0], alone.lights, sizeof lights[0]);
    network_estimation_free(&alone);
    network_estimation_free(&several);
}

static void the_order_of_photographs_changes_only_the_lights(void **state)
{
    const fixture *f = *state;
    network_estimation found[2];
    float lights[2][PICTURES][MODEL_LIGHTS];
    const img order[2][PICTURES] = {{f->photo[0], f->photo[1], f->photo[2]}, {f->photo[2], f->photo[0], f->photo[1]}};
    for (int k = 0; k < 2; k++)
        assert_int_equal(
            network_estimate_several(f->network, order[k], PICTURES, &f->mask, &how, VIEWS, NULL, lights[k], &found[k]),
            OK);
    assert_near(&found[0].maps.normal, &found[1].maps.normal, 1e-3f); /* sums in another order */
    assert_near(&found[0].maps.albedo, &found[1].maps.albedo, 1e-3f);
    for (int i = 0; i < MODEL_LIGHTS; i++)
        for (int k = 0; k < PICTURES; k++)
            assert_float_equal(lights[1][k][i], lights[0][(k + 2) % PICTURES][i], 1e-4f);
    assert_true(fabsf(lights[0][0][0] - lights[0][1][0]) > 1e-6f);
    network_estimation_free(&found[0]);
    network_estimation_free(&found[1]);
}

/* And each photograph's light. */
static void a_network_of_one_photograph_gives_the_mean(void **state)
{
    const fixture *f = *state;
    network_estimation each[2], mean;
    float lights[2][MODEL_LIGHTS];
    for (int k = 0; k < 2; k++)
        assert_int_equal(network_estimate(f->single, &f->photo[k], &f->mask, &how, 1, NULL, &each[k]), OK);
    assert_int_equal(network_estimate_several(f->single, f->photo, 2, &f->mask, &how, 1, NULL, lights, &mean), OK);
    for (int i = 0; i < 3 * PIXELS; i++)
        assert_float_equal(mean.maps.albedo.data[i], 0.5f * (each[0].maps.albedo.data[i] + each[1].maps.albedo.data[i]),
                           1e-3);
    for (int k = 0; k < 2; k++) {
        assert_memory_equal(lights[k], each[k].lights, sizeof lights[k]);
        network_estimation_free(&each[k]);
    }
    assert_memory_equal(mean.lights, lights[0], sizeof lights[0]);
    network_estimation_free(&mean);
}

static int always(void)
{
    return 1;
}

static void what_it_cannot_take_is_refused(void **state)
{
    const fixture *f = *state;
    network_estimation e;
    network *flash;
    const char *weights = scratch_path("point.safetensors");
    assert_int_equal(write_random_weights_of("merlin-point", weights), OK);
    assert_int_equal(network_open(weights, &flash), OK);
    assert_int_equal(network_estimate_several(flash, f->photo, 2, &f->mask, &how, 1, NULL, NULL, &e), MERLIN_WRONG_USE);
    assert_non_null(strstr(status_message(), "is for flashes"));
    network_close(flash);
    assert_int_equal(network_estimate_several(f->network, f->photo, 0, &f->mask, &how, 1, NULL, NULL, &e),
                     MERLIN_WRONG_USE);
    assert_int_equal(network_estimate_several(f->network, f->photo, 2, &f->mask, &how, 1, always, NULL, &e),
                     MERLIN_STOPPED);
    assert_null(e.maps.albedo.data);
}

/* The network of lights alone has the encoder of the whole one, and tells the same of pictures of its own size. */
static void lights_alone_are_those_of_the_whole_network(void **state)
{
    const fixture *f = *state;
    network_estimation whole;
    network *alone;
    float lights[2][PICTURES][MODEL_LIGHTS];
    const char *weights = scratch_path("lights.safetensors");
    assert_int_equal(write_shared_weights_of("merlin-lights", scratch_path("several.safetensors"), weights), OK);
    assert_int_equal(network_open(weights, &alone), MERLIN_BAD_INPUT);
    assert_non_null(strstr(status_message(), "tells only the lights"));
    assert_int_equal(network_open_several(scratch_path("any.safetensors"), &alone), MERLIN_WRONG_USE);
    assert_int_equal(network_open_several(weights, &alone), OK);
    network_compute_in(alone, NN_FLOAT32);
    assert_int_equal(network_lights_several(alone, f->photo, PICTURES, &f->mask, &how, VIEWS, NULL, lights[0]), OK);
    assert_int_equal(
        network_estimate_several(f->network, f->photo, PICTURES, &f->mask, &how, VIEWS, NULL, lights[1], &whole), OK);
    for (int k = 0; k < PICTURES; k++)
        for (int i = 0; i < MODEL_LIGHTS; i++)
            assert_float_equal(lights[0][k][i], lights[1][k][i], 1e-5f);
    assert_int_equal(network_lights_several(f->single, f->photo, 2, &f->mask, &how, 1, NULL, lights[0]),
                     MERLIN_WRONG_USE);
    assert_int_equal(network_lights_several(alone, f->photo, 0, &f->mask, &how, 1, NULL, lights[0]), MERLIN_WRONG_USE);
    network_estimation_free(&whole);
    network_close(alone);
}

/* A network that makes maps, too, changes those of another; one of lights alone leaves them. */
static void a_comparison_changes_maps_if_it_makes_some(void **state)
{
    const fixture *f = *state;
    network *alone;
    network_estimation one;
    float lights[PICTURES][MODEL_LIGHTS];
    const char *weights = scratch_path("alone.safetensors");
    const photo_group of = {f->photo, PICTURES, &f->mask, &how, 1, NULL};
    assert_int_equal(write_shared_weights_of("merlin-lights", scratch_path("several.safetensors"), weights), OK);
    assert_int_equal(network_open_several(weights, &alone), OK);
    assert_int_equal(network_estimate_several(f->single, f->photo, PICTURES, &f->mask, &how, 1, NULL, NULL, &one), OK);
    img before;
    assert_int_equal(img_copy(&before, &one.maps.roughness), OK);
    assert_int_equal(compare_photographs(alone, &of, lights, &one.maps), OK);
    assert_memory_equal(before.data, one.maps.roughness.data, img_value_count(&before) * sizeof(float));
    assert_int_equal(compare_photographs(f->network, &of, lights, &one.maps), OK);
    assert_memory_not_equal(before.data, one.maps.roughness.data, img_value_count(&before) * sizeof(float));
    assert_int_equal(compare_photographs(f->single, &of, lights, NULL), MERLIN_WRONG_USE);
    img_free(&before);
    network_estimation_free(&one);
    network_close(alone);
}

/* Two photographs that are one leave nothing to differ; others do; a network of one tells it with its estimate. */
static void the_spread_is_that_of_halves(void **state)
{
    const fixture *f = *state;
    const img twice[2] = {f->photo[0], f->photo[0]};
    network_estimation one;
    img none, some;
    double sum = 0;
    assert_int_equal(network_spread_several(f->network, twice, 2, &f->mask, &how, &none), OK);
    assert_int_equal(network_spread_several(f->network, f->photo, PICTURES, &f->mask, &how, &some), OK);
    for (size_t i = 0; i < img_value_count(&none); i++) {
        assert_float_equal(none.data[i], 0, 1e-3);
        assert_true(some.data[i] >= 0 && some.data[i] <= 90);
        sum += (double)some.data[i];
    }
    assert_true(sum > 0);
    assert_int_equal(network_estimate_several(f->single, f->photo, PICTURES, &f->mask, &how, 1, NULL, NULL, &one), OK);
    assert_non_null(one.spread.data);
    network_estimation_free(&one);
    img_free(&none);
    img_free(&some);
    assert_int_equal(network_spread_several(f->single, f->photo, 2, &f->mask, &how, &none), MERLIN_WRONG_USE);
    assert_int_equal(network_spread_several(f->network, f->photo, 1, &f->mask, &how, &none), MERLIN_WRONG_USE);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(one_photograph_is_estimated_as_alone),
        cmocka_unit_test(the_order_of_photographs_changes_only_the_lights),
        cmocka_unit_test(a_network_of_one_photograph_gives_the_mean),
        cmocka_unit_test(what_it_cannot_take_is_refused),
        cmocka_unit_test(lights_alone_are_those_of_the_whole_network),
        cmocka_unit_test(a_comparison_changes_maps_if_it_makes_some),
        cmocka_unit_test(the_spread_is_that_of_halves),
    };
    return cmocka_run_group_tests(tests, set_up, tear_down);
}
