/* SPDX-License-Identifier: MIT */
/* Balls on a table, which a mirror ball's rim mirrors: the circle that is seen best is not always the outline. */
#include "base/vec.h"
#include "base/warnings.h"
#include "capture_files.h"
#include "image/image.h"
#include "merlin/calibrate.h"

enum { WIDTH = 200, HEIGHT = 150, LIGHTS = 8 };

typedef struct scene {
    float x, y, radius; /* of the ball */
    merlin_ball ball;
    float table, room; /* radiance of a lit table, and of what is before the ball */
    float grain;       /* of the table */
    float end;         /* of the table, in the ball's radii from its middle; 0: endless */
    float other_x;     /* of a ball of the other kind, 30 large; 0: none */
} scene;

static vec3 light_of(int k)
{
    float tilt = k % 2 ? 0.55f : 0.9f, turn = 6.2831853f * (float)k / LIGHTS;
    return vec3_make(sinf(tilt) * cosf(turn), sinf(tilt) * sinf(turn), cosf(tilt));
}

/* In units of the ball's radius, y up, from its middle. */
static float table_at(const scene *s, float x, float y, vec3 l)
{
    float grain = 1 + s->grain * sinf(5 * x) * sinf(4.3f * y + 1), r = hypotf(x, y);
    if (s->end > 0 && r > s->end) return s->room;
    return s->table * grain * l.z;
}

static float mirrored(const scene *s, vec3 n, vec3 l)
{
    vec3 r = vec3_make(2 * n.z * n.x, 2 * n.z * n.y, 2 * n.z * n.z - 1);
    float shine = 4 * expf(1200 * (vec3_dot(vec3_normalize(r), l) - 1));
    if (r.z >= 0) return 0.85f * s->room + shine;
    float far = (n.z + 1) / -r.z; /* the table is a radius behind the ball's middle */
    return 0.85f * table_at(s, n.x + far * r.x, n.y + far * r.y, l) + shine;
}

static float shaded(const scene *s, vec3 n, vec3 l)
{
    return 0.02f * s->room + 0.7f * fmaxf(vec3_dot(n, l), 0);
}

static float seen_at(const scene *s, float x, float y, vec3 l)
{
    float u = (x - s->x) / s->radius, v = (s->y - y) / s->radius, rest = 1 - u * u - v * v;
    bool chrome = s->ball == MERLIN_CHROME_BALL;
    if (rest > 0) return (chrome ? mirrored : shaded)(s, vec3_make(u, v, sqrtf(rest)), l);
    float p = (x - s->other_x) / 30, q = (s->y - y) / 30, left = 1 - p * p - q * q;
    if (s->other_x > 0 && left > 0) return (chrome ? shaded : mirrored)(s, vec3_make(p, q, sqrtf(left)), l);
    return table_at(s, u, v, l);
}

static void write_scene(const scene *s)
{
    img p;
    assert_int_equal(img_new(&p, WIDTH, HEIGHT, 1), OK);
    for (int k = 0; k < LIGHTS; k++) {
        char name[16];
        snprintf(name, sizeof name, "%02d.png", k);
        for (int i = 0; i < WIDTH * HEIGHT; i++) {
            float sum = 0;
            for (int j = 0; j < 9; j++)
                sum += fminf(seen_at(s, (float)(i % WIDTH) + (0.5f + (float)(j % 3)) / 3,
                                     (float)(i / WIDTH) + (0.5f + (float)(j / 3)) / 3, light_of(k)),
                             1);
            p.data[i] = sum / 9;
        }
        assert_int_equal(img_write_png(scratch_path(name), &p, IMG_SRGB8), OK);
    }
    img_free(&p);
}

/* At half a pixel of a radius of 40 a mirrored light is 1.4 degrees off. */
static void assert_found(const scene *s, const char *doubt)
{
    merlin_calibration c;
    write_scene(s);
    if (merlin_calibrate(scratch, &(merlin_calibrate_params){.ball = s->ball}, &c) != OK)
        fail_msg("%s", status_message());
    print_message("%.1f %.1f %.1f: found %.1f %.1f %.1f, %s\n", (double)s->x, (double)s->y, (double)s->radius,
                  (double)c.circle.x, (double)c.circle.y, (double)c.circle.radius,
                  c.warnings.count ? c.warnings.at[0].code : "no doubt");
    assert_float_equal(c.circle.radius, s->radius, 0.8);
    assert_float_equal(c.circle.x, s->x, 0.8);
    assert_float_equal(c.circle.y, s->y, 0.8);
    if (doubt)
        assert_non_null(warnings_find(&c.warnings, doubt));
    else
        assert_int_equal(c.warnings.count, 0);
    for (int k = 0; k < LIGHTS; k++) {
        float off = 57.29578f * acosf(fminf(vec3_dot(vec3_of(c.lights[k].direction), light_of(k)), 1));
        if (off > 3) fail_msg("light %d is off by %.1f degrees", k, (double)off);
    }
    merlin_calibration_free(&c);
}

static const scene plain = {
    .x = 84.3f, .y = 71.6f, .radius = 44.7f, .ball = MERLIN_CHROME_BALL, .table = 0.5f, .room = 0.02f};

static void the_horizon_in_a_mirror_ball_is_not_its_outline(void **state)
{
    (void)state;
    for (int k = 0; k < 4; k++) {
        scene s = plain;
        s.grain = k % 2 ? 0.06f : 0;
        s.table = k / 2 ? 0.95f : 0.4f;
        assert_found(&s, NULL);
    }
}

static void a_mirror_ball_on_a_dark_table_is_found(void **state)
{
    (void)state;
    scene s = plain;
    s.table = 0.05f;
    assert_found(&s, NULL);
    s.room = 0.3f;
    assert_found(&s, NULL);
}

static void a_mirror_ball_at_the_frame_is_found(void **state)
{
    (void)state;
    scene s = plain;
    s.x = 38.2f;
    s.grain = 0.05f;
    assert_found(&s, NULL);
}

static void a_small_table_is_mirrored_within_the_outline(void **state)
{
    (void)state;
    scene s = plain;
    s.end = 4;
    s.grain = 0.04f;
    assert_found(&s, "circle_unsure");
}

static void a_matte_ball_on_a_table_is_found(void **state)
{
    (void)state;
    scene s = plain;
    s.ball = MERLIN_MATTE_BALL;
    s.grain = 0.05f;
    assert_found(&s, NULL);
    s.table = 0.05f;
    assert_found(&s, NULL);
}

static void of_two_balls_the_one_that_shines_so_is_taken(void **state)
{
    (void)state;
    scene s = plain;
    s.x = 52.4f;
    s.other_x = 150;
    s.table = 0.2f;
    assert_found(&s, "circle_unsure");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        in_scratch(the_horizon_in_a_mirror_ball_is_not_its_outline),
        in_scratch(a_mirror_ball_on_a_dark_table_is_found),
        in_scratch(a_mirror_ball_at_the_frame_is_found),
        in_scratch(a_small_table_is_mirrored_within_the_outline),
        in_scratch(a_matte_ball_on_a_table_is_found),
        in_scratch(of_two_balls_the_one_that_shines_so_is_taken),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
