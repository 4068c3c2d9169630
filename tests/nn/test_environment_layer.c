/* SPDX-License-Identifier: MIT */
/* Compares setting B's environment in the rendering layer with the same sums in double, and its gradients with
 * differences. */
#define MERLIN_REAL double
#include "optics/sh.h"

#include "tensors.h"

enum { BATCH = 2, SIDE = 33, PIXELS = BATCH * SIDE * SIDE };

typedef struct scene {
    cpu_environment in;
    cpu_tensor mask, dy;
} scene;

static cpu_tensor map_of(int channels, uint64_t seed)
{
    return tensor_random(NN_FLOAT32, BATCH, SIDE, SIDE, channels, seed);
}

static scene scene_new(void)
{
    scene s = {{map_of(3, 1), map_of(3, 2), tensor_random(NN_FLOAT32, BATCH, 1, 1, 27, 3)}, map_of(1, 4), map_of(3, 5)};
    for (size_t i = 0; i < PIXELS; i++)
        tensor_set(&s.mask, i, i % 3 == 0 ? 0 : i % 5 == 0 ? 0.5 : 1);
    return s;
}

static void scene_free(scene *s)
{
    tensor_free(&s->in.albedo), tensor_free(&s->in.normal), tensor_free(&s->in.sh);
    tensor_free(&s->mask), tensor_free(&s->dy);
}

/* Returns channel c of pixel i, in double. */
static double shaded(const scene *s, size_t i, int c)
{
    real sh[9][3];
    for (size_t k = 0; k < 27; k++)
        sh[k / 3][k % 3] = tensor_get(&s->in.sh, 27 * (i / (SIDE * SIDE)) + k);
    const cpu_tensor *n = &s->in.normal;
    vec3 e = sh_irradiance((const real(*)[3])sh,
                           vec3_make(tensor_get(n, 3 * i), tensor_get(n, 3 * i + 1), tensor_get(n, 3 * i + 2)));
    double albedo = 0.5 + 0.5 * tensor_get(&s->in.albedo, 3 * i + (size_t)c);
    return tensor_get(&s->mask, i) * albedo * (c == 0 ? e.x : c == 1 ? e.y : e.z) / 3.14159265358979324;
}

/* Returns Σ dy·y over pixels [first, end), in double. */
static double objective(const scene *s, size_t first, size_t end)
{
    double sum = 0;
    for (size_t i = first; i < end; i++)
        for (int c = 0; c < 3; c++)
            sum += tensor_get(&s->dy, 3 * i + (size_t)c) * shaded(s, i, c);
    return sum;
}

static void shading_is_albedo_times_irradiance(void **state)
{
    (void)state;
    scene s = scene_new();
    cpu_tensor y = map_of(3, 9), expected = tensor_like(&s.dy);
    for (size_t i = 0; i < PIXELS; i++)
        for (int c = 0; c < 3; c++)
            tensor_set(&expected, 3 * i + (size_t)c, shaded(&s, i, c));
    cpu_shade_environment(&s.in, &s.mask, &y);
    assert_near("shading", &y, &expected, 1e-5, 1e-6); /* nine float terms of either sign, below 10 each */
    tensor_free(&y), tensor_free(&expected);
    scene_free(&s);
}

/* Returns a derivative by central differences; the objective is quadratic in each number, so that only rounding is
 * left. */
static double numeric(scene *s, cpu_tensor *t, size_t at, size_t first, size_t end)
{
    const double h = 0x1p-8, kept = tensor_get(t, at);
    tensor_set(t, at, kept + h);
    double high = tensor_get(t, at), up = objective(s, first, end);
    tensor_set(t, at, kept - h);
    double low = tensor_get(t, at), down = objective(s, first, end);
    tensor_set(t, at, kept);
    return (up - down) / (high - low);
}

static void expect_gradient(scene *s, const char *what, cpu_tensor *t, const cpu_tensor *found)
{
    size_t per_pixel = (size_t)t->c, count = cpu_count(t), whole = t->h == 1 ? SIDE * SIDE : 1;
    for (size_t i = 0; i < count; i += t->h == 1 ? 1 : 13) {
        size_t first = i / per_pixel * whole;
        double wanted = numeric(s, t, i, first, first + whole), g = tensor_get(found, i);
        if (!(fabs(g - wanted) <= 1e-4 * fabs(wanted) + 1e-4))
            fail_msg("%s %zu: %.7g, expected %.7g", what, i, g, wanted);
    }
}

static void gradients_are_those_of_central_differences(void **state)
{
    (void)state;
    scene s = scene_new();
    cpu_environment d = {tensor_like(&s.in.albedo), tensor_like(&s.in.normal), tensor_like(&s.in.sh)};
    cpu_environment_backward(&s.in, &s.mask, &s.dy, &d, (cpu_environment_accumulate){0});
    expect_gradient(&s, "albedo", &s.in.albedo, &d.albedo);
    expect_gradient(&s, "normal", &s.in.normal, &d.normal);
    expect_gradient(&s, "sh", &s.in.sh, &d.sh);
    tensor_free(&d.albedo), tensor_free(&d.normal), tensor_free(&d.sh);
    scene_free(&s);
}

static void gradients_accumulate_and_may_be_unwanted(void **state)
{
    (void)state;
    scene s = scene_new();
    cpu_environment once = {tensor_like(&s.in.albedo), tensor_like(&s.in.normal), tensor_like(&s.in.sh)};
    cpu_environment some = {.normal = map_of(3, 11), .sh = tensor_random(NN_FLOAT32, BATCH, 1, 1, 27, 12)};
    cpu_tensor normal = tensor_converted(&some.normal, NN_FLOAT32), sh = tensor_converted(&some.sh, NN_FLOAT32);
    cpu_environment_backward(&s.in, &s.mask, &s.dy, &once, (cpu_environment_accumulate){0});
    cpu_environment_backward(&s.in, &s.mask, &s.dy, &some, (cpu_environment_accumulate){.normal = true, .sh = true});
    for (size_t i = 0; i < cpu_count(&normal); i++)
        tensor_set(&normal, i, tensor_get(&normal, i) + tensor_get(&once.normal, i));
    for (size_t i = 0; i < cpu_count(&sh); i++)
        tensor_set(&sh, i, tensor_get(&sh, i) + tensor_get(&once.sh, i));
    assert_near("normal", &some.normal, &normal, 1e-6, 1e-6);
    assert_near("sh", &some.sh, &sh, 1e-6, 1e-6);
    tensor_free(&once.albedo), tensor_free(&once.normal), tensor_free(&once.sh);
    tensor_free(&some.normal), tensor_free(&some.sh), tensor_free(&normal), tensor_free(&sh);
    scene_free(&s);
}

static void pixels_outside_the_mask_are_not_looked_at(void **state)
{
    (void)state;
    scene s = scene_new();
    cpu_tensor y = map_of(3, 9);
    cpu_environment d = {map_of(3, 6), map_of(3, 7), tensor_like(&s.in.sh)};
    for (size_t i = 0; i < PIXELS; i += 3)
        for (size_t c = 3 * i; c < 3 * i + 3; c++)
            tensor_set(&s.in.albedo, c, NAN), tensor_set(&s.in.normal, c, NAN), tensor_set(&s.dy, c, NAN);
    cpu_shade_environment(&s.in, &s.mask, &y);
    cpu_environment_backward(&s.in, &s.mask, &s.dy, &d, (cpu_environment_accumulate){0});
    for (size_t i = 0; i < 3 * PIXELS; i++) {
        assert_true(isfinite(tensor_get(&y, i)) && isfinite(tensor_get(&d.albedo, i)));
        if (i / 3 % 3 == 0) assert_true(tensor_get(&y, i) == 0 && tensor_get(&d.normal, i) == 0);
    }
    for (size_t i = 0; i < cpu_count(&d.sh); i++)
        assert_true(isfinite(tensor_get(&d.sh, i)));
    tensor_free(&y), tensor_free(&d.albedo), tensor_free(&d.normal), tensor_free(&d.sh);
    scene_free(&s);
}

static void results_do_not_depend_on_the_number_of_threads(void **state)
{
    (void)state;
    scene s = scene_new();
    int before = parallel_threads();
    cpu_tensor y[2] = {tensor_like(&s.dy), tensor_like(&s.dy)};
    cpu_environment d[2] = {{.sh = tensor_like(&s.in.sh)}, {.sh = tensor_like(&s.in.sh)}};
    for (int i = 0; i < 2; i++) {
        threads_use_here(i + 1);
        cpu_shade_environment(&s.in, &s.mask, &y[i]);
        cpu_environment_backward(&s.in, &s.mask, &s.dy, &d[i], (cpu_environment_accumulate){0});
    }
    threads_use_here(before);
    assert_same_bits("shading", &y[0], &y[1]);
    assert_same_bits("gradient", &d[0].sh, &d[1].sh);
    tensor_free(&y[0]), tensor_free(&y[1]), tensor_free(&d[0].sh), tensor_free(&d[1].sh);
    scene_free(&s);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(shading_is_albedo_times_irradiance),
        cmocka_unit_test(gradients_are_those_of_central_differences),
        cmocka_unit_test(gradients_accumulate_and_may_be_unwanted),
        cmocka_unit_test(pixels_outside_the_mask_are_not_looked_at),
        cmocka_unit_test(results_do_not_depend_on_the_number_of_threads),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
