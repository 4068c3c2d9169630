/* SPDX-License-Identifier: MIT */
/* The scales of the network of near lights on a capture. Its weights are random here: what is tested is that maps come
 * out where the object is, whole and in their units, and that it says what it cannot do. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "model/model.h"
#include "model/model_export.h"
#include "nfps/nfps_stereo.h"

/* last, as cmocka defines a macro named fail */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "scratch.h"

enum { WIDTH = 120, HEIGHT = 90, LIGHTS = 5 };
static const float distance = 2;

static char *weights_of(const char *folder, const model_config *config)
{
    static char path[4200];
    nn_graph *g = NULL;
    nn_params *params = NULL;
    snprintf(path, sizeof path, "%s/%s.safetensors", folder, config->name);
    char *json = model_config_write(config);
    const char *const metadata[][2] = {{"config", json}};
    status s = model_build(config, MODEL_WHOLE, &g);
    if (s == OK) s = nn_params_new(g, 1, &params);
    if (s == OK) s = model_export(path, params, metadata, 1);
    if (s != OK) fail_msg("%s", status_message());
    nn_params_free(params);
    nn_graph_free(g);
    free(json);
    return path;
}

static nfps_network *network_new(void)
{
    const model_config config = {.name = "tiny", .nfps_width = 8};
    char *folder = scratch_new();
    nfps_network *n = NULL;
    if (nfps_network_open(weights_of(folder, &config), &n) != OK) fail_msg("%s", status_message());
    scratch_remove(folder);
    return n;
}

/* An ellipse near the picture's right edge. */
static void capture_of(merlin_capture *c)
{
    *c = (merlin_capture){.width = WIDTH, .height = HEIGHT, .channels = 1, .lighting = MERLIN_NEAR_LIGHTS};
    c->camera = (pinhole){.focal = 150, .x = WIDTH / 2.0f, .y = HEIGHT / 2.0f, .distance = distance};
    assert_int_equal(pst_capture_reserve(c, LIGHTS), OK);
    assert_int_equal(img_new(&c->mask, WIDTH, HEIGHT, 1), OK);
    for (int k = 0; k < LIGHTS; k++) {
        c->light[k].position[0] = (float)(k - 2) * 0.3f;
        c->light[k].position[1] = (float)(k % 2) * 0.3f;
        c->name[k] = strdup("light");
        c->picture[k].wide = calloc(WIDTH * HEIGHT, sizeof(uint16_t));
        assert_non_null(c->picture[k].wide);
    }
    for (int i = 0; i < WIDTH * HEIGHT; i++) {
        const float x = ((float)(i % WIDTH) - 85) / 34, y = ((float)(i / WIDTH) - 44) / 25;
        c->mask.data[i] = x * x + y * y < 1;
        for (int k = 0; k < LIGHTS; k++)
            c->picture[k].wide[i] = (uint16_t)(c->mask.data[i] * (20000 + 3000 * (float)k * x));
    }
}

static void maps_are_whole_and_in_their_units(void **state)
{
    (void)state;
    merlin_capture c;
    img normal = {0}, depth = {0};
    nfps_network *n = network_new();
    capture_of(&c);
    assert_int_equal(nfps_stereo(n, &c, &(nfps_options){0}, &normal, &depth), OK);
    assert_true(normal.width == WIDTH && normal.height == HEIGHT && depth.width == WIDTH && depth.channels == 1);
    double sum = 0, count = 0;
    for (int i = 0; i < WIDTH * HEIGHT; i++) {
        const vec3 is = vec3_of(normal.data + 3 * i);
        if (c.mask.data[i] > 0.5f) {
            assert_true(fabsf(vec3_length(is) - 1) < 1e-3f && is.z >= 0 && depth.data[i] > 0);
            sum += (double)depth.data[i];
            count++;
        } else {
            assert_true(vec3_length(is) == 0 && depth.data[i] == 0);
        }
    }
    assert_true(fabs(sum / count - (double)distance) < 0.05);
    img_free(&normal);
    img_free(&depth);
    pst_capture_free(&c);
    nfps_network_close(n);
}

/* Half of no pixel of the coarsest scale is covered by a thin ring. */
static void thin_objects_are_found(void **state)
{
    (void)state;
    merlin_capture c;
    img normal = {0}, depth = {0};
    nfps_network *n = network_new();
    capture_of(&c);
    for (int i = 0; i < WIDTH * HEIGHT; i++) {
        const float x = (float)(i % WIDTH) - 85, y = (float)(i / WIDTH) - 50;
        c.mask.data[i] = fabsf(sqrtf(x * x + y * y) - 48) < 0.6f;
    }
    assert_int_equal(nfps_stereo(n, &c, &(nfps_options){0}, &normal, &depth), OK);
    for (int i = 0; i < WIDTH * HEIGHT; i++)
        assert_true((depth.data[i] > 0) == (c.mask.data[i] > 0.5f));
    img_free(&normal);
    img_free(&depth);
    pst_capture_free(&c);
    nfps_network_close(n);
}

/* The library's functions: the surface has the network's normals, and near begins with them if it is told to. */
static void surfaces_come_by_the_network(void **state)
{
    (void)state;
    const model_config config = {.name = "tiny", .nfps_width = 8};
    char *folder = scratch_new();
    merlin_near_network *n = NULL;
    merlin_surface s;
    merlin_capture c;
    capture_of(&c);
    assert_int_equal(merlin_near_network_open("/nowhere/w.safetensors", &n), MERLIN_BAD_INPUT);
    assert_null(n);
    assert_int_equal(merlin_near_network_open(weights_of(folder, &config), &n), OK);
    const merlin_stereo_method methods[] = {MERLIN_STEREO_NFPS, MERLIN_STEREO_NEAR};
    for (int i = 0; i < 2; i++) {
        assert_int_equal(merlin_stereo_by_network(n, &c, &(merlin_stereo_params){.method = methods[i]}, &s), OK);
        assert_int_equal(s.method, methods[i]);
        assert_true(s.by_network);
        for (int k = 0; k < WIDTH * HEIGHT; k++)
            assert_true((s.depth.data[k] > 0) == (c.mask.data[k] > 0.5f) && s.albedo.data[k] >= 0);
        merlin_surface_free(&s);
    }
    assert_int_equal(merlin_stereo(&c, &(merlin_stereo_params){.method = MERLIN_STEREO_NFPS}, &s), MERLIN_WRONG_USE);
    const merlin_stereo_params nfps = {.method = MERLIN_STEREO_NFPS};
    assert_int_equal(merlin_stereo_by_network(NULL, &c, &nfps, &s), MERLIN_WRONG_USE);
    merlin_near_network_close(n);
    pst_capture_free(&c);
    scratch_remove(folder);
}

static int stops(void)
{
    return 1;
}

static void what_it_cannot_do_is_said(void **state)
{
    (void)state;
    merlin_capture c;
    img normal, depth;
    nfps_network *n = network_new(), *other = NULL;
    capture_of(&c);
    const watch impatient = {.stop = stops};
    assert_int_equal(nfps_stereo(n, &c, &(nfps_options){.watch = &impatient}, &normal, &depth), MERLIN_STOPPED);
    c.camera.focal = 0;
    assert_int_equal(nfps_stereo(n, &c, &(nfps_options){0}, &normal, &depth), MERLIN_WRONG_USE);
    c.camera.focal = 150;
    c.lighting = MERLIN_UNKNOWN_LIGHTS;
    assert_int_equal(nfps_stereo(n, &c, &(nfps_options){0}, &normal, &depth), MERLIN_WRONG_USE);
    c.lighting = MERLIN_NEAR_LIGHTS;
    c.count = 1;
    assert_int_equal(nfps_stereo(n, &c, &(nfps_options){0}, &normal, &depth), MERLIN_BAD_INPUT);
    assert_null(normal.data);
    c.count = LIGHTS;
    pst_capture_free(&c);
    nfps_network_close(n);
    const model_config maps = {.name = "maps", .rival = MODEL_SANG, .relight = MODEL_RELIGHT_NETWORK};
    char *folder = scratch_new();
    assert_int_equal(nfps_network_open(weights_of(folder, &maps), &other), MERLIN_BAD_INPUT);
    assert_null(other);
    scratch_remove(folder);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(maps_are_whole_and_in_their_units),
        cmocka_unit_test(thin_objects_are_found),
        cmocka_unit_test(surfaces_come_by_the_network),
        cmocka_unit_test(what_it_cannot_do_is_said),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
