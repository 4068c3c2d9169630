/* SPDX-License-Identifier: MIT */
/* A ball before a perspective camera under near lights, in closed form. */
#ifndef MERLIN_TESTS_STEREO_BALL_H
#define MERLIN_TESTS_STEREO_BALL_H

#include "base/rng.h"
#include "relief.h"

/* Enough pixels to be searched small. */
enum { BALL_SIZE = 128 };
static const float ball_radius = 0.3f; /* its centre is at (0, 0, -1) */

static inline float led_radiance(const merlin_light *led, vec3 at, vec3 n, float specular)
{
    vec3 to = vec3_sub(vec3_of(led->position), at), l = vec3_normalize(to), v = vec3_normalize(vec3_scale(at, -1));
    float n_l = vec3_dot(n, l);
    if (n_l <= 0) return 0;
    float lobe = powf(fmaxf(-vec3_dot(l, vec3_of(led->direction)), 0), led->lobe);
    float f = 0.6f / PI + (specular > 0 ? specular * brdf_specular(0.3f, n, l, v) : 0);
    return f * n_l * lobe / vec3_dot(to, to);
}

static inline void ball_pixel(merlin_capture *c, int i, int j, float specular)
{
    vec3 ray = vec3_normalize(vec3_make(((float)i + 0.5f - c->camera.x) / c->camera.focal,
                                        (c->camera.y - (float)j - 0.5f) / c->camera.focal, -1));
    float along = -ray.z, inside = along * along - 1 + ball_radius * ball_radius;
    if (inside < 0.12f * ball_radius * ball_radius) return; /* up to 70 degrees */
    vec3 at = vec3_scale(ray, along - sqrtf(inside)), n = vec3_scale(vec3_make(at.x, at.y, at.z + 1), 1 / ball_radius);
    size_t pixel = (size_t)j * BALL_SIZE + (size_t)i;
    c->mask.data[pixel] = 1;
    c->depth_true.data[pixel] = -at.z;
    memcpy(c->normal_true.data + 3 * pixel, &(float[3]){n.x, n.y, n.z}, 3 * sizeof(float));
    for (int k = 0; k < c->count; k++)
        c->picture[k].wide[pixel] = relief_code(0.6f * led_radiance(&c->light[k], at, n, specular));
}

/* Returns the ball's mean distance. position: of each light; lobe: of lights that face the ball. */
static inline float ball_capture(merlin_capture *c, int lights, vec3 (*position)(int), float lobe, float specular)
{
    capture_new(c, BALL_SIZE, lights, 1);
    c->lighting = MERLIN_NEAR_LIGHTS;
    c->camera = (pinhole){.focal = 1.5f * BALL_SIZE, .x = BALL_SIZE / 2.0f, .y = BALL_SIZE / 2.0f};
    for (int k = 0; k < lights; k++) {
        vec3_put(position(k), c->light[k].position);
        vec3_put(vec3_normalize(vec3_sub(vec3_make(0, 0, -1), position(k))), c->light[k].direction);
        c->light[k].lobe = lobe;
    }
    double sum = 0, count = 0;
    for (int i = 0; i < BALL_SIZE * BALL_SIZE; i++) {
        ball_pixel(c, i % BALL_SIZE, i / BALL_SIZE, specular);
        sum += c->depth_true.data[i];
        count += c->mask.data[i];
    }
    return (float)(sum / count);
}

/* A network's possible estimate of the ball. */
enum { BALL_MOST_LIGHTS = 16 };
typedef struct ball_expectation {
    img normal, depth;
    vec3 light[BALL_MOST_LIGHTS];
    float near[BALL_MOST_LIGHTS];
} ball_expectation;

/* Makes one that is flatter by a factor, lights off by some eight degrees, distances by a tenth. */
static inline void ball_expect(const merlin_capture *c, vec3 (*position)(int), float flatter, ball_expectation *out)
{
    rng r = rng_at(12, 0, 0);
    assert_true(c->count <= BALL_MOST_LIGHTS);
    assert_int_equal(img_copy(&out->normal, &c->normal_true), OK);
    assert_int_equal(img_copy(&out->depth, &c->depth_true), OK);
    for (int i = 0; i < BALL_SIZE * BALL_SIZE; i++) {
        float *n = out->normal.data + 3 * i;
        if (c->mask.data[i] == 0) continue;
        vec3_put(vec3_normalize(vec3_make(n[0] * flatter, n[1] * flatter, n[2])), n);
        out->depth.data[i] = 1 + flatter * (out->depth.data[i] - 1);
    }
    for (int k = 0; k < c->count; k++) {
        const vec3 way = vec3_sub(position(k), vec3_make(0, 0, -1)), to = vec3_normalize(way);
        const vec3 off = vec3_make(rng_range(&r, -0.15f, 0.15f), rng_range(&r, -0.15f, 0.15f), 0);
        out->light[k] = vec3_scale(vec3_normalize(vec3_add(to, off)), 0.9f);
        out->near[k] = (k % 2 ? 1.1f : 0.9f) / vec3_length(way);
    }
}

/* Returns the place of one of so many lamps around the ball. */
static inline vec3 ball_lamp(int i, int count)
{
    const float turn = 0.5f + 6.2831853f * (float)i / (float)count, aside = 0.5f + 0.1f * (float)(i % 2);
    return vec3_make(aside * cosf(turn), aside * sinf(turn), -0.25f + 0.1f * (float)(i % 3));
}

/* Photographs the ball under lights that are not told, and makes what is expected of it. */
static inline void ball_photograph(merlin_capture *c, int lights, vec3 (*position)(int), float flatter,
                                   ball_expectation *out)
{
    const float distance = ball_capture(c, lights, position, 0, 0);
    c->camera.distance = distance;
    c->lighting = MERLIN_UNKNOWN_LIGHTS;
    ball_expect(c, position, flatter, out);
}

static inline pst_expected ball_as_expected(const ball_expectation *e)
{
    return (pst_expected){
        .normal = &e->normal, .depth = &e->depth, .light = e->light, .compared = e->light, .near = e->near};
}

static inline void ball_put_away(merlin_capture *c, ball_expectation *e)
{
    img_free(&e->normal);
    img_free(&e->depth);
    capture_drop(c);
}

#endif
