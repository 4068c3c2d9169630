/* SPDX-License-Identifier: MIT */
/* Large fields are swept band by band, with the results of a field in one piece. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include "base/status.h"

#include <cmocka.h> /* last, as cmocka defines a macro named fail */

#include "base/rng.h"
#include "relief.h"
#include "stereo/fit/field_fit.h"
#include "stereo/fit/field_job.h"

/* Two bands, whose border is after row 512; of the rows around it a field of one band. */
enum { WIDTH = 512, ROWS = 600, FIRST = 496, SOME = 32, EDGE = 4, LIGHTS = 8, SWEEPS = 3 };

static const pst_lobe matte = {.width = 0.04f, .shadow = PST_SHADOW_COST, .masking = 0.28f};

typedef struct part {
    merlin_capture capture;
    pst_problem problem;
    pst_field field;
} part;

static vec3 true_normal(int x, int y)
{
    const float tilt = 0.3f * (float)((x / 64 + y / 64) % 3);
    return vec3_make(sinf(tilt), 0, cosf(tilt));
}

/* Most pixels have a wrong result that costs much. */
static pst_shading shading_at(int x, int y)
{
    rng random = rng_at(7, (uint64_t)x, (uint64_t)y);
    const bool wrong = rng_uniform(&random) < 0.8f;
    const vec3 n = wrong ? vec3_make(0, 0.8f, 0.6f) : true_normal(x, y);
    return (pst_shading){.normal = n, .albedo = 0.8f, .cost = wrong ? 2 : 0.01f};
}

/* Makes the rows `first` .. first + rows - 1. */
static void part_new(int first, int rows, part *p)
{
    const size_t pixels = (size_t)WIDTH * (size_t)rows;
    relief matte_relief = {.exposure = 1};
    *p = (part){.capture = {.width = WIDTH, .height = rows, .channels = 1, .count = LIGHTS}};
    merlin_capture *c = &p->capture;
    assert_int_equal(img_new(&c->mask, WIDTH, rows, 1), OK);
    c->light = calloc(LIGHTS, sizeof *c->light);
    c->picture = calloc(LIGHTS, sizeof *c->picture);
    for (int k = 0; k < LIGHTS; k++) {
        const vec3 l = relief_light(k, LIGHTS);
        c->light[k] = (merlin_light){.intensity = {1, 1, 1}};
        vec3_put(l, c->light[k].direction);
        c->picture[k].wide = malloc(pixels * sizeof(uint16_t));
        for (size_t i = 0; i < pixels; i++) {
            const vec3 n = true_normal((int)(i % WIDTH), first + (int)(i / WIDTH));
            c->picture[k].wide[i] = relief_code(relief_radiance(&matte_relief, 0.8f, n, l));
        }
    }
    for (size_t i = 0; i < pixels; i++)
        c->mask.data[i] = 1;
    p->problem = (pst_problem){.capture = c, .light = c->light, .saturation = PST_SATURATED};
    assert_int_equal(pst_list_pixels(c, &p->problem), OK);
    p->field = (pst_field){.problem = &p->problem,
                           .pixel = p->problem.pixel,
                           .count = p->problem.pixel_count,
                           .lobe = &matte,
                           .shading = calloc(pixels, sizeof(pst_shading))};
    for (size_t i = 0; i < pixels; i++)
        p->field.shading[i] = shading_at((int)(i % WIDTH), first + (int)(i / WIDTH));
}

static void part_drop(part *p)
{
    free(p->field.shading);
    free(p->problem.pixel);
    capture_drop(&p->capture);
}

/* Compares the rows in the middle, which the edges of the small field do not reach. */
static void assert_alike(const part *all, const part *some)
{
    size_t changed = 0;
    for (int y = FIRST + EDGE; y < FIRST + SOME - EDGE; y++)
        for (int x = 0; x < WIDTH; x++) {
            const pst_shading *a = &all->field.shading[y * WIDTH + x];
            const pst_shading *b = &some->field.shading[(y - FIRST) * WIDTH + x];
            assert_memory_equal(&a->normal, &b->normal, sizeof a->normal);
            assert_memory_equal(&a->cost, &b->cost, sizeof a->cost);
            changed += a->cost != shading_at(x, y).cost;
        }
    assert_true(changed > 1000);
}

static void bands_have_the_results_of_one_piece(void **state)
{
    (void)state;
    part all, some;
    part_new(0, ROWS, &all);
    part_new(FIRST, SOME, &some);
    const size_t border = pst_field_band(&all.field);
    assert_true(border > (FIRST + EDGE) * WIDTH && border < (FIRST + SOME - EDGE) * WIDTH);
    assert_int_equal(pst_field_spread(&all.field, SWEEPS), OK);
    assert_int_equal(pst_field_spread(&some.field, SWEEPS), OK);
    assert_alike(&all, &some);
    part_drop(&all);
    part_drop(&some);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(bands_have_the_results_of_one_piece)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
