/* SPDX-License-Identifier: MIT */
/* The filter of path-traced layers. */
#include "lab/render/layer_filter.h"

#include <math.h>
#include <string.h>

#include "base/rng.h"

/* last, as cmocka defines a macro named fail */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

enum { SIZE = 32 };

/* Makes a flat object facing the camera in the left part of the picture and a nearer one to the right, textured. */
static void make_maps(sample *s)
{
    *s = (sample){.fov = 60};
    assert_int_equal(img_new(&s->albedo, SIZE, SIZE, 3), OK);
    assert_int_equal(img_new(&s->normal, SIZE, SIZE, 3), OK);
    assert_int_equal(img_new(&s->depth, SIZE, SIZE, 1), OK);
    assert_int_equal(img_new(&s->mask, SIZE, SIZE, 1), OK);
    assert_int_equal(img_new(&s->indirect, SIZE, SIZE, 3), OK);
    for (int i = 0; i < SIZE * SIZE; i++) {
        s->mask.data[i] = i % SIZE > 3 ? 1 : i % SIZE == 3 ? 0.5f : 0;
        s->depth.data[i] = i % SIZE < 16 ? 1.8f : 0.6f; /* a discontinuity of some ten pixels */
        s->normal.data[3 * i + 2] = 1;
        for (int c = 0; c < 3; c++)
            s->albedo.data[3 * i + c] = 0.1f + 0.8f * (float)((i * 7 + c) % 11) / 10;
    }
}

static void constant_light_on_any_albedo_is_kept(void **state)
{
    (void)state;
    sample s;
    make_maps(&s);
    for (int i = 0; i < 3 * SIZE * SIZE; i++)
        s.indirect.data[i] = s.mask.data[i / 3] * (s.albedo.data[i] + 0.05f) * 0.3f;
    assert_int_equal(filter_layer(&s, &s.indirect, 3), OK);
    for (int i = 0; i < 3 * SIZE * SIZE; i++)
        assert_true(fabsf(s.indirect.data[i] - s.mask.data[i / 3] * (s.albedo.data[i] + 0.05f) * 0.3f) < 1e-5f);
    sample_free(&s);
}

static void grain_shrinks_and_its_mean_stays(void **state)
{
    (void)state;
    sample s;
    double before = 0, after = 0, spread_before = 0, spread_after = 0;
    make_maps(&s);
    rng r = rng_at(1, 0, 0);
    for (int i = 0; i < 3 * SIZE * SIZE; i++)
        s.albedo.data[i] = 0.5f;
    for (int i = 0; i < 3 * SIZE * SIZE; i++)
        s.indirect.data[i] = s.mask.data[i / 3] * rng_uniform(&r);
    for (int pass = 0; pass < 2; pass++) {
        double sum = 0, squares = 0, count = 0;
        for (int i = 0; i < SIZE * SIZE; i++) {
            if (i % SIZE < 8) continue;
            sum += s.indirect.data[3 * i];
            squares += s.indirect.data[3 * i] * s.indirect.data[3 * i];
            count++;
        }
        *(pass ? &after : &before) = sum / count;
        *(pass ? &spread_after : &spread_before) = squares / count - sum / count * (sum / count);
        if (!pass) assert_int_equal(filter_layer(&s, &s.indirect, 3), OK);
    }
    assert_true(fabs(after - before) < 0.02);
    /* about 30 pixels of a disc, each with a mean weight of one half: at most a tenth of the variance is left */
    assert_true(spread_after < 0.1 * spread_before);
    sample_free(&s);
}

static void light_does_not_cross_to_another_depth_or_out_of_the_mask(void **state)
{
    (void)state;
    sample s;
    make_maps(&s);
    for (int i = 0; i < SIZE * SIZE; i++)
        if (i % SIZE >= 16)
            for (int c = 0; c < 3; c++)
                s.indirect.data[3 * i + c] = 1;
    assert_int_equal(filter_layer(&s, &s.indirect, 3), OK);
    for (int y = 0; y < SIZE; y++) {
        assert_true(*img_at(&s.indirect, 0, y) == 0);
        assert_true(*img_at(&s.indirect, 15, y) < 0.05f);
    }
    sample_free(&s);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(constant_light_on_any_albedo_is_kept),
        cmocka_unit_test(grain_shrinks_and_its_mean_stays),
        cmocka_unit_test(light_does_not_cross_to_another_depth_or_out_of_the_mask),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
