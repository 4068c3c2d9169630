/* SPDX-License-Identifier: MIT */
/* Small mirror balls in front of black, and circles of which little is seen. */
#include "base/vec.h"
#include "base/warnings.h"
#include "capture_files.h"
#include "image/image.h"
#include "stereo/calibrate/calibrate_parts.h"

enum { SIZE = 160, LIGHTS = 7 };
static const float CENTER_X = 83.3f, CENTER_Y = 76.8f, RADIUS = 58.6f;

static vec3 light(int i)
{
    float turn = 0.9f * (float)i, lean = 0.15f + 0.1f * (float)i;
    return vec3_make(sinf(lean) * cosf(turn), sinf(lean) * sinf(turn), cosf(lean));
}

/* Writes pictures of a mirror ball that mirrors a little light of the room, in front of black. */
static void write_small_balls(float radius)
{
    img p;
    assert_int_equal(img_new(&p, SIZE, SIZE, 1), OK);
    for (int i = 0; i < LIGHTS; i++) {
        char name[16];
        snprintf(name, sizeof name, "%02d.png", i);
        for (int k = 0; k < SIZE * SIZE; k++) {
            const int row = k / SIZE;
            float sum = 0;
            for (int j = 0; j < 16; j++) {
                const float u = ((float)(k % SIZE) + (0.5f + (float)(j % 4)) / 4 - CENTER_X) / radius;
                const float v = (CENTER_Y - (float)row - (0.5f + (float)(j / 4)) / 4) / radius;
                const float rest = 1 - u * u - v * v;
                if (!(rest > 0)) continue;
                const vec3 n = {u, v, sqrtf(rest)};
                const vec3 mirrored = {2 * n.z * n.x, 2 * n.z * n.y, 2 * n.z * n.z - 1};
                sum += fminf(4 * expf(300 * (vec3_dot(mirrored, light(i)) - 1)) + 0.05f, 1) / 16;
            }
            p.data[k] = sum;
        }
        assert_int_equal(img_write_png(scratch_path(name), &p, IMG_LINEAR16), OK);
    }
    img_free(&p);
}

/* The blur around a small ball's edge is no outline around it. */
static void a_small_balls_circle_is_its_edge(void **state)
{
    (void)state;
    static const float radii[] = {11, 14, 22, 35};
    for (size_t i = 0; i < sizeof radii / sizeof *radii; i++) {
        merlin_calibration c;
        write_small_balls(radii[i]);
        assert_int_equal(merlin_calibrate(scratch, &(merlin_calibrate_params){.ball = MERLIN_CHROME_BALL}, &c), OK);
        if (c.warnings.count) fail_msg("%s: %s", c.warnings.at[0].code, c.warnings.at[0].message);
        assert_float_equal(c.circle.radius, radii[i], 0.6);
        merlin_calibration_free(&c);
    }
}

/* A circle of which a third is an edge may go through the rims of highlights. */
static void a_circle_that_is_hardly_seen_is_doubted(void **state)
{
    (void)state;
    for (int whole = 0; whole < 2; whole++) {
        img seen;
        merlin_calibration c = {.ball = MERLIN_CHROME_BALL, .circle = {CENTER_X, CENTER_Y, RADIUS}};
        assert_int_equal(img_new(&seen, SIZE, SIZE, 1), OK);
        for (int k = 0; k < SIZE * SIZE; k++) {
            const int row = k / SIZE;
            const float x = (float)(k % SIZE) + 0.5f - CENTER_X, y = (float)row + 0.5f - CENTER_Y;
            const bool shown = whole || fabsf(atan2f(y, x)) < 1.05f;
            seen.data[k] = shown && hypotf(x, y) < RADIUS ? 0.5f : 0.01f;
        }
        assert_int_equal(ball_check(NULL, &seen, &c), OK);
        assert_int_equal(c.warnings.count, whole ? 0 : 1);
        if (!whole) assert_string_equal(c.warnings.at[0].code, "circle_unsure");
        img_free(&seen);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        in_scratch(a_small_balls_circle_is_its_edge),
        in_scratch(a_circle_that_is_hardly_seen_is_doubted),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
