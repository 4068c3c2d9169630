/* SPDX-License-Identifier: MIT */
/* Pictures to be relit, read back by a reader that goes by what viewers do: a relief under known lights. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/file.h"
#include "base/vec.h"
#include "image/color.h"
#include "image/image.h"
#include "merlin/rti.h"
#include "reader/rti_reader.h"
#include "rti/rti_planes.h"
#include "scratch.h"

/* last, as cmocka defines a macro named fail */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

enum { WIDTH = 48, HEIGHT = 40, PIXELS = WIDTH * HEIGHT, LIGHTS = 60, MARGIN = 8 };

/* ---- scenes ---- */

/* A Fibonacci spiral over the hemisphere; another turn for lights that were not among these. */
static void light(int i, int count, float turn, float out[3])
{
    const float z = 1 - ((float)i + 0.5f) / (float)count * 0.9f, r = sqrtf(1 - z * z),
                phi = 2.3999632f * (float)i + turn;
    out[0] = r * cosf(phi), out[1] = r * sinf(phi), out[2] = z;
}

static bool is_object(int i)
{
    const int x = i % WIDTH, y = i / WIDTH;
    return x >= MARGIN && x < WIDTH - MARGIN && y >= MARGIN && y < HEIGHT - MARGIN;
}

/* A Lambertian relief of waves, orange and blue, on black. */
static void relief(const float l[3], merlin_image *out)
{
    assert_int_equal(img_new(out, WIDTH, HEIGHT, 3), OK);
    for (int i = 0; i < PIXELS; i++) {
        if (!is_object(i)) continue;
        const int row = i / WIDTH;
        const float x = (float)(i % WIDTH), y = (float)row;
        const vec3 n = vec3_normalize(vec3_make(0.5f * sinf(x / 5), 0.6f * cosf(y / 6), 1));
        const float shade = fmaxf(0, (float)vec3_dot(n, vec3_make(l[0], l[1], l[2])));
        out->data[3 * i] = shade * (i % WIDTH < WIDTH / 2 ? 0.8f : 0.2f);
        out->data[3 * i + 1] = shade * 0.4f;
        out->data[3 * i + 2] = shade * (i % WIDTH < WIDTH / 2 ? 0.1f : 0.7f);
    }
}

/* Coefficient k of a pixel's channel: small enough for the polynomial to remain within 0 to 1. */
static float coefficient(int pixel, int channel, int k)
{
    const float wave = sinf((float)(pixel * 7 + channel * 3 + k * 5));
    return k == 0 ? 0.5f + 0.1f * wave : 0.09f * wave;
}

static void polynomial(const float l[3], merlin_image *out)
{
    const float terms[6] = {1, l[0], l[1], l[0] * l[0], l[0] * l[1], l[1] * l[1]};
    assert_int_equal(img_new(out, WIDTH, HEIGHT, 3), OK);
    for (int i = 0; i < 3 * PIXELS; i++) {
        float value = 0;
        for (int k = 0; k < 6; k++)
            value += coefficient(i / 3, i % 3, k) * terms[k];
        out->data[i] = srgb_decode(value);
    }
}

static merlin_rti *made(merlin_rti_basis basis, void (*scene)(const float l[3], merlin_image *out))
{
    merlin_rti *rti;
    assert_int_equal(merlin_rti_new(WIDTH, HEIGHT, &(merlin_rti_params){.basis = basis}, &rti), OK);
    for (int i = 0; i < LIGHTS; i++) {
        merlin_image picture;
        float l[3];
        light(i, LIGHTS, 0, l);
        scene(l, &picture);
        for (int k = 0; k < 3; k++)
            l[k] *= 2; /* of any length */
        assert_int_equal(merlin_rti_add(rti, &picture, l), OK);
        merlin_image_free(&picture);
    }
    return rti;
}

static rti_reader *written(merlin_rti_basis basis, void (*scene)(const float l[3], merlin_image *out), const char *name)
{
    merlin_rti *rti = made(basis, scene);
    const bool file = strstr(name, ".ptm") != NULL;
    assert_int_equal(
        file ? merlin_rti_write_ptm(rti, scratch_path(name)) : merlin_rti_write(rti, scratch_path(name), NULL), OK);
    merlin_rti_free(rti);
    rti_reader *r = rti_reader_open(scratch_path(name));
    assert_non_null(r);
    assert_int_equal(r->width, WIDTH);
    assert_int_equal(r->height, HEIGHT);
    return r;
}

/* Mean absolute error on the object, of values encoded as sRGB, under lights between those of the pictures. */
static double error_of(const rti_reader *r, rti_viewer viewer)
{
    enum { HELD_OUT = 12 };
    float *values = malloc(3 * PIXELS * sizeof *values);
    double sum = 0, count = 0;
    for (int i = 0; i < HELD_OUT; i++) {
        merlin_image truth;
        float l[3];
        light(i, HELD_OUT, 0.7f, l);
        relief(l, &truth);
        rti_reader_render(r, l, viewer, values);
        for (int k = 0; k < 3 * PIXELS; k++) {
            if (!is_object(k / 3)) continue;
            sum += fabs((double)(fminf(fmaxf(values[k], 0), 1) - srgb_encode(truth.data[k])));
            count++;
        }
        merlin_image_free(&truth);
    }
    free(values);
    return sum / count;
}

/* ---- held-out lights ---- */

/* The bounds are what these bases cannot follow of a cosine that is cut off at 0 and encoded as sRGB, with a tenth of
 * it for the planes' 8 bits and JPEG. */
static void relief_is_relit_under_lights_that_were_held_out(void **state)
{
    (void)state;
    static const struct {
        merlin_rti_basis basis;
        const char *name;
        double most;
    } kinds[] = {{MERLIN_RTI_PTM, "relief.ptm", 0.048}, {MERLIN_RTI_LRGB, "lrgb.ptm", 0.048},
                 {MERLIN_RTI_PTM, "relief_ptm", 0.048}, {MERLIN_RTI_LRGB, "relief_lrgb", 0.048},
                 {MERLIN_RTI_HSH, "relief_hsh", 0.026}, {MERLIN_RTI_RBF, "relief_rbf", 0.036}};
    for (size_t i = 0; i < sizeof kinds / sizeof kinds[0]; i++) {
        rti_reader *r = written(kinds[i].basis, relief, kinds[i].name);
        const double openlime = error_of(r, RTI_OPENLIME), relight = error_of(r, RTI_RELIGHT);
        print_message("%s: %.4f, by relight %.4f\n", kinds[i].name, openlime, relight);
        assert_true(openlime <= kinds[i].most);
        assert_true(relight <= kinds[i].most);
        rti_reader_close(r);
    }
}

static void what_is_black_remains_black(void **state)
{
    (void)state;
    static const char *const names[] = {"relief_ptm", "relief_lrgb", "relief_hsh", "relief_rbf", "relief.ptm"};
    float *values = malloc(3 * PIXELS * sizeof *values), l[3];
    light(5, LIGHTS, 0.3f, l);
    for (int i = 0; i < 5; i++) {
        rti_reader *r = rti_reader_open(scratch_path(names[i]));
        assert_non_null(r);
        rti_reader_render(r, l, RTI_OPENLIME, values);
        for (int k = 0; k < 3 * WIDTH * MARGIN;
             k++) /* the first rows are away from the object's 8 × 8 blocks of JPEG */
            if (values[k] > 1.5f / 255) fail_msg("%s: %g at %d", names[i], (double)values[k], k);
        rti_reader_close(r);
    }
    free(values);
}

/* ---- coefficients ---- */

/* Pictures of 8 bits, whose error the 60 lights average to some thousandths; and half a step of the file's 255. */
static void coefficients_of_a_polynomial_are_found(void **state)
{
    (void)state;
    rti_reader *r = written(MERLIN_RTI_PTM, polynomial, "polynomial.ptm");
    for (int i = 0; i < PIXELS; i++)
        for (int c = 0; c < 3; c++)
            for (int k = 0; k < 6; k++) {
                const float found = r->values[i * 18 + 3 * k + c];
                if (fabsf(found - coefficient(i, c, k)) > 0.006f)
                    fail_msg("pixel %d, channel %d, term %d: %g instead of %g", i, c, k, (double)found,
                             (double)coefficient(i, c, k));
            }
    rti_reader_close(r);
}

static void wave_row(const void *context, int y, float *values)
{
    (void)context;
    for (int i = 0; i < WIDTH * 3; i++)
        values[i] = i % 3 == 2 ? 0 : (float)(i % 3 + 1) * sinf((float)(i + 31 * y)) - 0.4f;
}

static void codes_are_off_by_half_a_step_at_most(void **state)
{
    (void)state;
    rti_planes p;
    float row[WIDTH * 3];
    assert_int_equal(rti_planes_new(&(rti_values){WIDTH, HEIGHT, 3, 0, false, wave_row, NULL}, &p), OK);
    for (int y = 0; y < HEIGHT; y++) {
        wave_row(NULL, y, row);
        for (int i = 0; i < WIDTH * 3; i++) {
            const float value = (float)(p.codes[y * WIDTH * 3 + i] - p.zero[i % 3]) / 255 * p.scale[i % 3];
            assert_true(fabsf(value - row[i]) <= p.scale[i % 3] / 510 * 1.0001f);
        }
    }
    assert_true(p.scale[1] < 4.1f);
    assert_int_equal(p.codes[2], p.zero[2]);
    rti_planes_free(&p);
}

/* ---- what cannot be ---- */

static void add_ring(merlin_rti *rti, int count)
{
    merlin_image picture;
    assert_int_equal(img_new(&picture, WIDTH, HEIGHT, 3), OK);
    for (int i = 0; i < count; i++)
        assert_int_equal(merlin_rti_add(rti, &picture, (float[3]){cosf((float)i), sinf((float)i), 1}), OK);
    merlin_image_free(&picture);
}

static void lights_that_leave_the_terms_open_are_refused(void **state)
{
    (void)state;
    static const merlin_rti_basis bases[] = {MERLIN_RTI_PTM, MERLIN_RTI_LRGB, MERLIN_RTI_HSH};
    merlin_rti *rti;
    for (int i = 0; i < 3; i++) {
        assert_int_equal(merlin_rti_new(WIDTH, HEIGHT, &(merlin_rti_params){.basis = bases[i]}, &rti), OK);
        add_ring(rti, 5);
        assert_int_equal(merlin_rti_write(rti, scratch_path("few"), NULL), MERLIN_WRONG_USE);
        assert_non_null(strstr(merlin_error(), "too few"));
        add_ring(rti, 30); /* all at one height, where x² + y² is a constant */
        assert_int_equal(merlin_rti_write(rti, scratch_path("few"), NULL), MERLIN_WRONG_USE);
        assert_non_null(strstr(merlin_error(), "alike"));
        merlin_rti_free(rti);
    }
    assert_int_equal(merlin_rti_new(WIDTH, HEIGHT, &(merlin_rti_params){.basis = MERLIN_RTI_RBF}, &rti), OK);
    add_ring(rti, 3);
    assert_int_equal(merlin_rti_write(rti, scratch_path("few"), NULL), MERLIN_WRONG_USE);
    merlin_rti_free(rti);
    assert_false(file_exists(scratch_path("few")));
}

static void wrong_pictures_and_params_are_refused(void **state)
{
    (void)state;
    merlin_rti *rti;
    merlin_image picture;
    assert_int_equal(merlin_rti_new(0, 4, NULL, &rti), MERLIN_WRONG_USE);
    assert_int_equal(merlin_rti_new(4, 4, &(merlin_rti_params){.planes = 4}, &rti), MERLIN_WRONG_USE);
    assert_int_equal(merlin_rti_new(4, 4, &(merlin_rti_params){.planes = 30}, &rti), MERLIN_WRONG_USE);
    assert_int_equal(merlin_rti_new(4, 4, &(merlin_rti_params){.quality = 101}, &rti), MERLIN_WRONG_USE);
    assert_int_equal(merlin_rti_new(4, 4, &(merlin_rti_params){.basis = (merlin_rti_basis)7}, &rti), MERLIN_WRONG_USE);
    assert_null(rti);
    assert_int_equal(merlin_rti_new(WIDTH, HEIGHT, &(merlin_rti_params){.basis = MERLIN_RTI_RBF}, &rti), OK);
    assert_int_equal(img_new(&picture, WIDTH, HEIGHT, 3), OK);
    assert_int_equal(merlin_rti_add(rti, &picture, (float[3]){0.5f, 0, 0}), MERLIN_WRONG_USE);
    assert_int_equal(merlin_rti_add(rti, &picture, (float[3]){0, 0, -1}), MERLIN_WRONG_USE);
    assert_int_equal(merlin_rti_add(rti, &picture, (float[3]){0, NAN, 1}), MERLIN_WRONG_USE);
    picture.width--;
    assert_int_equal(merlin_rti_add(rti, &picture, (float[3]){0, 0, 1}), MERLIN_WRONG_USE);
    merlin_image_free(&picture);
    add_ring(rti, 8);
    assert_int_equal(merlin_rti_write_ptm(rti, scratch_path("rbf.ptm")), MERLIN_WRONG_USE);
    assert_false(file_exists(scratch_path("rbf.ptm")));
    merlin_rti_free(rti);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(relief_is_relit_under_lights_that_were_held_out),
        cmocka_unit_test(what_is_black_remains_black),
        cmocka_unit_test(coefficients_of_a_polynomial_are_found),
        cmocka_unit_test(codes_are_off_by_half_a_step_at_most),
        cmocka_unit_test(lights_that_leave_the_terms_open_are_refused),
        cmocka_unit_test(wrong_pictures_and_params_are_refused),
    };
    return cmocka_run_group_tests(tests, scratch_open, scratch_close);
}
