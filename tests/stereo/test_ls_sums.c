/* SPDX-License-Identifier: MIT */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>

#include "base/status.h"

#include <cmocka.h> /* last, as cmocka defines a macro named fail */

#include "base/rng.h"
#include "stereo/methods/ls_sums.h"

/* More lights than a word has bits, their number odd; a picture whose end fills neither a block nor a register. */
enum { LIGHTS = 37, PIXELS = LS_BLOCK + 77 };
static const ls_limits limits = {.low = 3000, .high = 64000};

/* Lit pixels; pixels in shadow or burnt out now and then, or in long stretches. */
static uint16_t draw_code(rng *r, int pixel, int light)
{
    if (pixel > 300 && pixel < 400) return light % 3 ? 20000 : 0;
    float kind = rng_range(r, 0, 1);
    if (pixel > 100 && kind < 0.1f) return 200;
    if (pixel > 100 && kind > 0.95f) return 65535;
    return (uint16_t)rng_range(r, 4000, 60000);
}

static void make_capture(int channels, merlin_capture *c)
{
    *c = (merlin_capture){.width = PIXELS, .height = 1, .channels = channels, .count = LIGHTS};
    c->picture = calloc(LIGHTS, sizeof *c->picture);
    c->light = calloc(LIGHTS, sizeof *c->light);
    rng r = rng_at(5, 0, 0);
    for (int k = 0; k < LIGHTS; k++) {
        vec3 d = vec3_make(rng_range(&r, -1, 1), rng_range(&r, -1, 1), 1.2f);
        c->light[k] = (merlin_light){.intensity = {1, 0.8f, 1.5f}};
        vec3_put(vec3_normalize(d), c->light[k].direction);
        uint16_t *codes = malloc((size_t)(PIXELS * channels) * sizeof *codes);
        const uint16_t few = k % 3 ? 0xff00 : 0xffff; /* two thirds of the pictures are narrow */
        for (int i = 0; i < PIXELS * channels; i++)
            codes[i] = draw_code(&r, i / channels, k) & few;
        pst_plane_take(codes, (size_t)(PIXELS * channels), &c->picture[k]);
        assert_int_equal(c->picture[k].narrow != NULL, k % 3 != 0);
    }
}

static void drop(merlin_capture *c)
{
    for (int k = 0; k < LIGHTS; k++)
        pst_plane_free(&c->picture[k]);
    free(c->picture);
    free(c->light);
}

typedef struct plain_sums {
    double matrix[6], right[3][3], square;
} plain_sums;

/* The definition, a pixel at a time. */
static plain_sums sum_plainly(const merlin_capture *c, size_t pixel)
{
    plain_sums s = {0};
    for (int k = 0; k < LIGHTS; k++) {
        uint16_t buffer[3];
        const uint16_t *code = pst_codes(&c->picture[k], pixel * (size_t)c->channels, (size_t)c->channels, buffer);
        double sum = 0, top = 0;
        for (int e = 0; e < c->channels; e++) {
            sum += code[e];
            top = code[e] > top ? code[e] : top;
        }
        if (!(sum > (double)limits.low && top < (double)limits.high)) continue;
        double l[3] = {(double)c->light[k].direction[0], (double)c->light[k].direction[1],
                       (double)c->light[k].direction[2]};
        for (int i = 0, m = 0; i < 3; i++)
            for (int j = i; j < 3; j++)
                s.matrix[m++] += l[i] * l[j];
        for (int e = 0; e < c->channels; e++) {
            double v = code[e] / (65535 * (double)c->light[k].intensity[e]);
            for (int i = 0; i < 3; i++)
                s.right[e][i] += v * l[i];
            s.square += v * v;
        }
    }
    return s;
}

/* 37 additions of floats up to about 2 in any order: 37 half steps of 2^-23 at sums up to 64 make 1.5e-4. */
static const float tolerance = 1.5e-4f;

static void assert_sums(const ls_sums *s, int i, const plain_sums *p)
{
    for (int m = 0; m < 6; m++)
        assert_float_equal(s->matrix[m][i], p->matrix[m], tolerance);
    for (int e = 0; e < 3; e++)
        for (int k = 0; k < 3; k++)
            assert_float_equal(s->right[e][k][i], p->right[e][k], tolerance);
    assert_float_equal(s->square[i], p->square, tolerance);
}

static void sums_are_those_of_the_definition(void **state)
{
    (void)state;
    for (int channels = 1; channels <= 3; channels += 2) {
        merlin_capture c;
        make_capture(channels, &c);
        pst_problem p = {.capture = &c, .light = c.light};
        ls_lights *lights;
        assert_int_equal(ls_lights_new(&p, limits, &lights), OK);
        ls_sums *s = malloc(sizeof *s);
        for (int first = 0; first < PIXELS; first += LS_BLOCK) {
            int count = PIXELS - first < LS_BLOCK ? PIXELS - first : LS_BLOCK;
            ls_sums_add(lights, (size_t)first, count, s);
            for (int i = 0; i < count; i++) {
                plain_sums expected = sum_plainly(&c, (size_t)(first + i));
                assert_sums(s, i, &expected);
            }
        }
        free(s);
        ls_lights_free(lights);
        drop(&c);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(sums_are_those_of_the_definition)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
