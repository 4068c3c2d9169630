/* SPDX-License-Identifier: MIT */
/* The evaluation of photometric stereo: frames, objects, draws. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "lab/eval/metrics/normal_frame.h"
#include "lab/eval/stereo/stereo_frame.h"
#include "lab/eval/stereo/stereo_object.h"
#include "lab/eval/stereo/stereo_table.h"
#include "optics/led.h"
#include "photo_stereo/near_capture.h"
#include "photo_stereo/subsets.h"
#include "scratch.h"
#include "sphere.h"
#include "stereo/integrate/surface_error.h"

/* last, as cmocka defines a macro named fail */
#include <cmocka.h>

static const sphere ball = {.centre = {0, 0, -1}, .radius = 0.28f, .albedo = {0.6f, 0.5f, 0.4f}, .roughness = 1};

/* Through the middle of a pixel, z = -1. */
static vec3 ray_of(const pinhole *c, int x, int y)
{
    return vec3_make(((float)x + 0.5f - c->x) / c->focal, (c->y - (float)y - 0.5f) / c->focal, -1);
}

/* A matte ball under `count` lights without bounces; shadows are its own alone, which shading has anyway. */
static sample ball_sample(int size, int count)
{
    sphere of = ball;
    of.size = size;
    sample s;
    assert_int_equal(sphere_sample(&of, count, &s), OK);
    camera view = {.width = size, .height = size, .fov = 60};
    for (int i = 0; i < count; i++) {
        float phi = 2.4f * (float)i, u = ((float)i + 0.5f) / (float)count;
        s.targets[i].light = s.light = frontal_light(0.3f + 0.7f * u, phi / 6.2831853f - floorf(phi / 6.2831853f));
        memset(s.direct.data, 0, 3 * sizeof(float) * (size_t)size * (size_t)size);
        for (int p = 0; p < size * size; p++)
            sphere_pixel(&of, &s, &view, p % size, p / size);
        memcpy(s.targets[i].direct.data, s.direct.data, 3 * sizeof(float) * (size_t)size * (size_t)size);
    }
    s.light = vec3_make(0, 0, 0);
    memset(s.direct.data, 0, 3 * sizeof(float) * (size_t)size * (size_t)size);
    for (int p = 0; p < size * size; p++)
        sphere_pixel(&of, &s, &view, p % size, p / size);
    return s;
}

static void read_back(const sample *s, stereo_object *out)
{
    char path[] = "/tmp/merlin-eval-stereo-XXXXXX.exr";
    int file = mkstemps(path, 4);
    assert_true(file >= 0);
    close(file);
    assert_int_equal(sample_write(path, s), OK);
    assert_int_equal(stereo_object_read(path, out), OK);
    unlink(path);
}

/* The ball is half as wide as the frame, so that the frame is cut to it: the sight of every pixel must stay what it
 * was. A normal on the ball and its pixel's ray fix each other: the ray's point is centre + radius · normal. */
static void a_sample_is_cut_to_its_object_and_keeps_its_camera(void **state)
{
    (void)state;
    sample s = ball_sample(96, 3);
    stereo_object o;
    read_back(&s, &o);
    const merlin_capture *c = &o.capture;
    assert_true(c->width < 96 && c->width == c->height && o.photo.width == c->width);
    assert_int_equal(c->count, 3);
    assert_string_equal(o.name, "0 union");
    for (int y = 0; y < c->height; y++)
        for (int x = 0; x < c->width; x++) {
            const float *n = img_at(&c->normal_true, x, y);
            if (*img_at(&c->mask, x, y) <= 0.5f) continue;
            vec3 p = vec3_fma(ball.centre, ball.radius, vec3_make(n[0], n[1], n[2]));
            vec3 ray = vec3_scale(ray_of(&c->camera, x, y), -p.z);
            assert_true(vec3_length(vec3_sub(p, ray)) < 1e-3f); /* normals are stored as halves: 5e-4 */
        }
    stereo_object_free(&o);
    sample_free(&s);
}

/* What near photometric stereo reaches on a matte ball without noise: its goal for diffuse objects is 2 degrees. */
static void real_pictures_of_a_sample_give_its_normals(void **state)
{
    (void)state;
    sample s = ball_sample(64, 34);
    stereo_object o;
    read_back(&s, &o);
    assert_int_equal(subset_count(&o.capture, SUBSET_PICTURES), SUBSETS);
    merlin_surface first, again, other;
    size_t pixels;
    assert_int_equal(subset_solve(&o.capture, 0, MERLIN_STEREO_AUTO, &first), OK);
    assert_int_equal(subset_solve(&o.capture, 0, MERLIN_STEREO_AUTO, &again), OK);
    assert_int_equal(subset_solve(&o.capture, 1, MERLIN_STEREO_AUTO, &other), OK);
    double angle = normal_mean_angle(&first.normal, &o.capture, &pixels);
    print_message("ball under 32 of 34 near lights: %.2f degrees over %zu pixels\n", angle, pixels);
    assert_true(angle < 2 && pixels > 400);
    size_t bytes = 3 * sizeof(float) * (size_t)o.capture.width * (size_t)o.capture.height;
    assert_memory_equal(first.normal.data, again.normal.data, bytes);
    assert_memory_not_equal(first.normal.data, other.normal.data, bytes);
    merlin_surface_free(&first);
    merlin_surface_free(&again);
    merlin_surface_free(&other);
    stereo_object_free(&o);
    sample_free(&s);
}

/* Makes LEDs of a sample's lights, which look straight ahead. */
static void make_leds(sample *s, float lobe)
{
    const int size = s->mask.width;
    const camera view = {.width = size, .height = size, .fov = s->fov};
    for (int i = 0; i < s->target_count; i++) {
        sample_target *led = &s->targets[i];
        led->axis = vec3_make(0, 0, -1);
        led->lobe = lobe;
        for (int p = 0; p < size * size; p++) {
            vec3 at = camera_point(&view, (float)(p % size) + 0.5f, (float)(p / size) + 0.5f, s->depth.data[p]);
            float share = led_share(led->axis, lobe, vec3_normalize(vec3_sub(led->light, at)));
            for (int k = 0; k < 3; k++)
                led->direct.data[3 * p + k] *= share;
        }
    }
}

/* Returns the mean angle to the true normals, in degrees, of the near solver on the first draw of pictures. */
static double near_angle(const stereo_object *o)
{
    merlin_surface found;
    assert_int_equal(subset_solve(&o->capture, 0, MERLIN_STEREO_NEAR, &found), OK);
    double angle = normal_mean_angle(&found.normal, &o->capture, NULL);
    merlin_surface_free(&found);
    return angle;
}

/* They are as good as point lights; taken for those, they mislead. */
static void leds_of_a_sample_are_solved_by_their_lobes(void **state)
{
    (void)state;
    sample s = ball_sample(64, 34);
    make_leds(&s, 1.25f);
    stereo_object o;
    read_back(&s, &o);
    for (int i = 0; i < o.capture.count; i++)
        assert_true(o.capture.light[i].lobe == 1.25f && o.capture.light[i].direction[2] == -1);
    double by_lobes = near_angle(&o);
    for (int i = 0; i < o.capture.count; i++)
        o.capture.light[i].lobe = 0;
    double alike = near_angle(&o);
    print_message("ball under LEDs: %.2f degrees, without their lobes %.2f\n", by_lobes, alike);
    assert_true(by_lobes < 2 && alike > 4);
    stereo_object_free(&o);
    sample_free(&s);
}

/* 40 × 24 grey pixels, the object from (10, 4) to (29, 19): a square of 25 pixels around it, which shrinks by 3 to
 * at most 10 a side. */
static merlin_capture make_wide_capture(void)
{
    merlin_capture c = {.width = 40, .height = 24, .channels = 1, .count = 1, .lighting = MERLIN_DISTANT_LIGHTS};
    c.camera = (pinhole){.focal = 60, .x = 20, .y = 12};
    c.picture = calloc(1, sizeof *c.picture);
    c.light = calloc(1, sizeof *c.light);
    c.name = calloc(1, sizeof *c.name);
    c.picture[0].wide = malloc(sizeof(uint16_t) * 40 * 24);
    assert_int_equal(img_new(&c.mask, 40, 24, 1), OK);
    for (int y = 0; y < 24; y++)
        for (int x = 0; x < 40; x++) {
            c.picture[0].wide[40 * y + x] = (uint16_t)(100 * x);
            *img_at(&c.mask, x, y) = x >= 10 && x < 30 && y >= 4 && y < 20;
        }
    return c;
}

static void a_wide_capture_is_cut_and_shrunk_with_its_camera(void **state)
{
    (void)state;
    merlin_capture c = make_wide_capture();
    c.picture[0].wide[40 * 10 + 20] = UINT16_MAX;
    img photo;
    assert_int_equal(img_new(&photo, 40, 24, 3), OK);
    assert_int_equal(stereo_frame(&c, &photo, 10), OK);
    assert_int_equal(c.width, 9);
    assert_int_equal(photo.width, 9);
    int saturated = 0;
    for (int y = 0; y < 9; y++)
        for (int x = 0; x < 9; x++) {
            uint16_t code = c.picture[0].wide[9 * y + x];
            saturated += code == UINT16_MAX;
            if (*img_at(&c.mask, x, y) < 0.5f || code == UINT16_MAX) continue;
            /* the picture's value told the column, whose ray must be the same */
            float column = (float)code / 100 + 0.5f, before = (column - 20) / 60;
            assert_float_equal(ray_of(&c.camera, x, y).x, before, 1e-3); /* codes are whole: 0.01 / 60 */
        }
    assert_int_equal(saturated, 1);
    img_free(&photo);
    pst_capture_free(&c);
}

static void normals_keep_their_angle_to_the_line_of_sight(void **state)
{
    (void)state;
    pinhole from = {.focal = 8, .x = 4, .y = 4}, to = {.focal = 0};
    img n;
    assert_int_equal(img_new(&n, 8, 8, 3), OK);
    for (int i = 0; i < 64; i++) {
        vec3 ray = vec3_scale(vec3_normalize(ray_of(&from, i % 8, i / 8)), -1);
        memcpy(n.data + 3 * i, &(float[3]){ray.x, ray.y, ray.z}, 3 * sizeof(float));
    }
    normal_frame_change(&n, &from, &to);
    for (int i = 0; i < 64; i++) /* what faced the camera faces it still */
        assert_float_equal(n.data[3 * i + 2], 1, 1e-6);
    normal_frame_change(&n, &to, &from);
    normal_frame_change(&n, &from, &from);
    vec3 corner = vec3_scale(vec3_normalize(ray_of(&from, 0, 0)), -1);
    assert_float_equal(n.data[0], corner.x, 1e-6);
    img_free(&n);
}

/* A ball between two lines of one pixel's width that cross the frame, of which pixels twice as wide keep nothing. */
static void an_object_that_shrinking_takes_apart_is_refused(void **state)
{
    (void)state;
    enum { SIDE = 264 }; /* more than STEREO_OBJECT_SIDE */
    sample s = ball_sample(SIDE, 3);
    for (int i = 0; i < SIDE; i++)
        *img_at(&s.mask, i, 20) = *img_at(&s.mask, 20, i) = 1;
    char *folder = scratch_new(), *path = sample_path(folder, 0);
    assert_int_equal(sample_write(path, &s), OK);
    stereo_options options = {
        .data = folder, .weights = MERLIN_SOURCE_DIR "/models/merlin-point.safetensors", .quiet = true};
    stereo_table table;
    assert_int_equal(stereo_table_run(&options, &table), MERLIN_BAD_INPUT);
    assert_non_null(strstr(status_message(), "too thin"));
    free(path);
    scratch_remove(folder);
    sample_free(&s);
}

static void a_sample_without_targets_is_refused(void **state)
{
    (void)state;
    sample s = ball_sample(64, 0);
    char path[] = "/tmp/merlin-eval-stereo-XXXXXX.exr";
    int file = mkstemps(path, 4);
    assert_true(file >= 0);
    close(file);
    assert_int_equal(sample_write(path, &s), OK);
    stereo_object o;
    assert_int_equal(stereo_object_read(path, &o), MERLIN_BAD_INPUT);
    assert_non_null(strstr(status_message(), "--targets"));
    unlink(path);
    sample_free(&s);
}

static char *printed(const stereo_table *t)
{
    char *text;
    size_t size;
    FILE *stream = open_memstream(&text, &size);
    assert_non_null(stream);
    stereo_table_print(t, stream);
    fclose(stream);
    return text;
}

static void the_universal_rows_are_there_if_they_were_asked_for(void **state)
{
    (void)state;
    stereo_column cup = {.name = "cup", .pixels = 100, .pictures = 32};
    const stereo_table t = {.model = "tiny", .object = &cup, .count = 1};
    for (int row = 0; row < STEREO_ROWS; row++)
        cup.row[row].error = 4;
    cup.row[STEREO_RELIT_UNIVERSAL].error = 2.25;
    char *text = printed(&t), *json = stereo_table_json(&t);
    assert_non_null(strstr(text, "relit images, universal, against the single image: -1.75 degrees; better on 1 of 1"));
    assert_non_null(strstr(json, "\"real_images_universal\""));
    free(text);
    free(json);
    cup.row[STEREO_RELIT_UNIVERSAL].error = cup.row[STEREO_REAL_UNIVERSAL].error = (double)NAN;
    text = printed(&t);
    json = stereo_table_json(&t);
    assert_null(strstr(text, "universal"));
    assert_null(strstr(json, "universal"));
    free(text);
    free(json);
}

static void a_table_without_solutions_has_no_numbers_for_them(void **state)
{
    (void)state;
    stereo_column refused = {.name = "cup", .pixels = 100, .pictures = 32};
    for (int row = STEREO_RELIT; row < STEREO_ROWS; row++)
        refused.row[row] = (stereo_score){.error = NAN, .failed = SUBSETS};
    stereo_table t = {.model = "tiny", .object = &refused, .count = 1};
    char *text = printed(&t);
    assert_null(strstr(text, "nan"));
    assert_non_null(strstr(text, "uncalibrated, against the single image: no object was solved"));
    free(text);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_sample_is_cut_to_its_object_and_keeps_its_camera),
        cmocka_unit_test(real_pictures_of_a_sample_give_its_normals),
        cmocka_unit_test(leds_of_a_sample_are_solved_by_their_lobes),
        cmocka_unit_test(a_wide_capture_is_cut_and_shrunk_with_its_camera),
        cmocka_unit_test(normals_keep_their_angle_to_the_line_of_sight),
        cmocka_unit_test(an_object_that_shrinking_takes_apart_is_refused),
        cmocka_unit_test(a_sample_without_targets_is_refused),
        cmocka_unit_test(the_universal_rows_are_there_if_they_were_asked_for),
        cmocka_unit_test(a_table_without_solutions_has_no_numbers_for_them),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
