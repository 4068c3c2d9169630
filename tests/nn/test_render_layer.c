/* SPDX-License-Identifier: MIT */
/* The rendering layer in float against the same physics in double, and its gradients against central differences. */
#define MERLIN_REAL double
#include "optics/camera.h"
#include "optics/light.h"

#include "tensors.h"

enum { BATCH = 2, WIDTH = 37, HEIGHT = 37, PIXELS = BATCH * WIDTH * HEIGHT };
static const float fov = 60, power = 5.95f;

typedef struct scene {
    cpu_render_tensors maps;
    cpu_tensor mask, light, dy;
    cpu_tensor lens; /* or empty: that of fov for all */
} scene;

static cpu_render_view view_of(const scene *s)
{
    return (cpu_render_view){s->mask, s->light, s->lens, fov, power};
}

static cpu_tensor map_of(int channels, uint64_t seed, float low, float high)
{
    cpu_tensor t = tensor_new(NN_FLOAT32, BATCH, HEIGHT, WIDTH, channels);
    tensor_fill(&t, seed, low, high);
    return t;
}

static void make_normals_unit(cpu_tensor *normal)
{
    float *n = normal->data;
    for (int i = 0; i < PIXELS; i++, n += 3) {
        n[2] = fabsf(n[2]) + 0.3f;
        float length = sqrtf(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]);
        for (int c = 0; c < 3; c++)
            n[c] /= length;
    }
}

/* Draws a disc with a soft edge and a hole, so that rows have spans, and pixels outside are inside spans. */
static void draw_mask(cpu_tensor *mask)
{
    for (int i = 0; i < PIXELS; i++) {
        double x = i % WIDTH - 18, y = i / WIDTH % HEIGHT - 15, r = sqrt(x * x + y * y);
        tensor_set(mask, (size_t)i, r > 3 && r < 14 ? 1 : r >= 14 && r < 15 ? 0.5 : 0);
    }
}

static scene scene_new(void)
{
    scene s = {.maps = {.albedo = map_of(3, 1, -1, 1),
                        .normal = map_of(3, 2, -1, 1),
                        .roughness = map_of(1, 3, -0.8f, 1),
                        .depth = map_of(1, 4, 0.9f, 1.1f)},
               .mask = map_of(1, 5, 0, 1),
               .light = tensor_new(NN_FLOAT32, BATCH, 1, 1, 3),
               .dy = map_of(3, 6, -1, 1)};
    make_normals_unit(&s.maps.normal);
    draw_mask(&s.mask);
    /* a flash and a light from the upper right, both dim enough that most pixels are not clipped */
    float lights[] = {0, 0, 0, 0.6f, 0.5f, -0.4f};
    memcpy(s.light.data, lights, sizeof lights);
    return s;
}

/* Makes a scene with a long lens off its axis, and a short one on it. */
static scene scene_of_other_lenses(void)
{
    scene s = scene_new();
    const float lenses[] = {0.15f, 0.3f, -0.2f, 0.7f, 0, 0};
    s.lens = tensor_new(NN_FLOAT32, BATCH, 1, 1, 3);
    memcpy(s.lens.data, lenses, sizeof lenses);
    return s;
}

static void scene_free(scene *s)
{
    tensor_free(&s->maps.albedo), tensor_free(&s->maps.normal), tensor_free(&s->maps.roughness);
    tensor_free(&s->maps.depth), tensor_free(&s->mask), tensor_free(&s->light), tensor_free(&s->dy);
    if (s->lens.data) tensor_free(&s->lens);
}

static vec3 read3(const cpu_tensor *t, size_t i)
{
    return vec3_make(tensor_get(t, 3 * i), tensor_get(t, 3 * i + 1), tensor_get(t, 3 * i + 2));
}

/* Returns the camera of a pixel's sample; relief is the distance of a unit of depth. */
static camera camera_at(const scene *s, size_t i, double *relief)
{
    camera c = {.width = WIDTH, .height = HEIGHT, .fov = (double)fov};
    size_t sample = 3 * (i / (WIDTH * HEIGHT));
    *relief = 1;
    if (!s->lens.data) return c;
    double tangent = tensor_get(&s->lens, sample);
    c.fov = 2 * atan(tangent) / DEGREE;
    c.slant = (camera_slant){tensor_get(&s->lens, sample + 1), tensor_get(&s->lens, sample + 2)};
    *relief = tangent / tan((double)fov / 2 * DEGREE);
    return c;
}

static shade_input input_at(const scene *s, size_t i)
{
    double relief;
    camera c = camera_at(s, i, &relief);
    vec3 one = vec3_make(0.5, 0.5, 0.5);
    return (shade_input){.albedo = vec3_fma(one, 0.5, read3(&s->maps.albedo, i)),
                         .roughness = 0.5 + 0.5 * tensor_get(&s->maps.roughness, i),
                         .normal = read3(&s->maps.normal, i),
                         .depth = 1 + relief * (tensor_get(&s->maps.depth, i) - 1),
                         .ray = camera_point(&c, (double)(i % WIDTH) + 0.5, (double)(i / WIDTH % HEIGHT) + 0.5, 1),
                         .light = read3(&s->light, i / (WIDTH * HEIGHT)),
                         .power = (double)power};
}

static double clip(double x)
{
    return x < 0 ? 0 : x > 1 ? 1 : x;
}

static double rendered(const shade_input *in, double mask, int channel)
{
    vec3 r = shade_point(in);
    return mask * clip(channel == 0 ? r.x : channel == 1 ? r.y : r.z);
}

static cpu_tensor expected_rendering(const scene *s)
{
    cpu_tensor y = tensor_like(&s->dy);
    for (size_t i = 0; i < PIXELS; i++) {
        shade_input in = input_at(s, i);
        for (int c = 0; c < 3; c++)
            tensor_set(&y, 3 * i + (size_t)c, rendered(&in, tensor_get(&s->mask, i), c));
    }
    return y;
}

static void check_rendering(scene s)
{
    const cpu_render_view view = view_of(&s);
    cpu_tensor y = map_of(3, 9, -1, 1), expected = expected_rendering(&s);
    cpu_render(&s.maps, &view, &y);
    /* float: the highlight's base, 1 - (n·h)² + ..., has about four correct digits at the smallest roughness, 0.1 */
    assert_near("rendering", &y, &expected, 2e-4, 1e-5);
    double brightest = 0;
    for (size_t i = 0; i < cpu_count(&y); i++)
        brightest = fmax(brightest, tensor_get(&y, i));
    assert_true(brightest > 0.5);
    tensor_free(&y), tensor_free(&expected);
    scene_free(&s);
}

static void rendering_is_the_physics_of_optics(void **state)
{
    (void)state;
    check_rendering(scene_new());
}

static void rendering_through_any_lens_is_the_physics_of_optics(void **state)
{
    (void)state;
    check_rendering(scene_of_other_lenses());
}

/* Returns d(Σ dy·y at pixel i)/d(parameter), by central differences; the parameter is a number inside `in`. */
static double numeric(const scene *s, size_t i, shade_input *in, double *parameter, double h)
{
    double at = *parameter, sum = 0;
    for (int c = 0; c < 3; c++) {
        double dy = tensor_get(&s->dy, 3 * i + (size_t)c), mask = tensor_get(&s->mask, i);
        *parameter = at + h;
        double above = rendered(in, mask, c);
        *parameter = at - h;
        sum += dy * (above - rendered(in, mask, c)) / (2 * h);
        *parameter = at;
    }
    return sum;
}

/* Tells whether a clip or a clamp is within h of its kink, where a central difference is the derivative of neither
 * side. */
static bool near_corner(const shade_input *in)
{
    vec3 r = shade_point(in);
    vec3 to_light = vec3_fma(in->light, -in->depth, in->ray);
    double values[] = {r.x - 1, r.y - 1, r.z - 1, vec3_dot(in->normal, vec3_normalize(to_light)),
                       vec3_dot(in->normal, vec3_scale(vec3_normalize(in->ray), -1))};
    for (int i = 0; i < 5; i++)
        if (fabs(values[i]) < 1e-3) return true;
    return false;
}

static void expect(const cpu_tensor *gradient, size_t i, double wanted, double *worst)
{
    double found = tensor_get(gradient, i), error = fabs(found - wanted) / (fabs(wanted) + 0.1);
    *worst = fmax(*worst, error);
}

static void check_gradients(scene s)
{
    const cpu_render_view view = view_of(&s);
    cpu_render_tensors d = {map_of(3, 7, -1, 1), map_of(3, 8, -1, 1), map_of(1, 9, -1, 1), map_of(1, 10, -1, 1)};
    cpu_render_backward(&s.maps, &view, &s.dy, &d, (cpu_render_accumulate){0});
    double worst = 0;
    int checked = 0;
    for (size_t i = 0; i < PIXELS; i++) {
        shade_input in = input_at(&s, i);
        if (near_corner(&in)) continue;
        checked += tensor_get(&s.mask, i) > 0;
        double *albedo[] = {&in.albedo.x, &in.albedo.y, &in.albedo.z};
        double *normal[] = {&in.normal.x, &in.normal.y, &in.normal.z};
        for (size_t c = 0; c < 3; c++) {
            /* the slope by albedo and roughness is halved in [-1, 1] */
            expect(&d.albedo, 3 * i + c, 0.5 * numeric(&s, i, &in, albedo[c], 1e-5), &worst);
            expect(&d.normal, 3 * i + c, numeric(&s, i, &in, normal[c], 1e-5), &worst);
        }
        expect(&d.roughness, i, 0.5 * numeric(&s, i, &in, &in.roughness, 1e-5), &worst);
        double relief;
        camera_at(&s, i, &relief);
        expect(&d.depth, i, relief * numeric(&s, i, &in, &in.depth, 1e-5), &worst);
    }
    assert_true(checked > 500);
    /* as in the rendering itself: float has about four correct digits in sharp highlights, and slopes one less */
    if (worst > 2e-3) fail_msg("worst relative error %.3g", worst);
    tensor_free(&d.albedo), tensor_free(&d.normal), tensor_free(&d.roughness), tensor_free(&d.depth);
    scene_free(&s);
}

static void gradients_are_those_of_central_differences(void **state)
{
    (void)state;
    check_gradients(scene_new());
}

static void gradients_through_any_lens_are_those_of_central_differences(void **state)
{
    (void)state;
    check_gradients(scene_of_other_lenses());
}

static void gradients_accumulate_and_may_be_unwanted(void **state)
{
    (void)state;
    scene s = scene_new();
    const cpu_render_view view = view_of(&s);
    cpu_render_tensors once = {map_of(3, 7, -1, 1), map_of(3, 8, -1, 1), map_of(1, 9, -1, 1), map_of(1, 10, -1, 1)};
    cpu_render_tensors some = {.normal = map_of(3, 11, -1, 1), .depth = map_of(1, 12, -1, 1)};
    cpu_tensor expected = tensor_like(&some.normal);
    cpu_render_backward(&s.maps, &view, &s.dy, &once, (cpu_render_accumulate){0});
    for (size_t i = 0; i < cpu_count(&expected); i++)
        tensor_set(&expected, i, tensor_get(&some.normal, i) + tensor_get(&once.normal, i));
    cpu_render_backward(&s.maps, &view, &s.dy, &some, (cpu_render_accumulate){.normal = true});
    assert_near("normal", &some.normal, &expected, 1e-6, 1e-6);
    assert_same_bits("depth", &some.depth, &once.depth);
    tensor_free(&once.albedo), tensor_free(&once.normal), tensor_free(&once.roughness), tensor_free(&once.depth);
    tensor_free(&some.normal), tensor_free(&some.depth), tensor_free(&expected);
    scene_free(&s);
}

static void assert_finite(const cpu_tensor *t)
{
    for (size_t i = 0; i < cpu_count(t); i++)
        assert_true(isfinite(tensor_get(t, i)));
}

static void nothing_but_numbers_comes_out(void **state)
{
    (void)state;
    scene s = scene_new();
    const cpu_render_view view = view_of(&s);
    static const float bad[] = {NAN, INFINITY, -INFINITY, 0, 1e30f, -1e30f, 1e-30f};
    cpu_tensor *maps[] = {&s.maps.albedo, &s.maps.normal, &s.maps.roughness, &s.maps.depth};
    for (size_t m = 0; m < 4; m++)
        for (size_t i = m; i < cpu_count(maps[m]); i += 7)
            tensor_set(maps[m], i, (double)bad[(i + m) % 7]);
    cpu_tensor y = tensor_like(&s.dy);
    cpu_render_tensors d = {map_of(3, 7, -1, 1), map_of(3, 8, -1, 1), map_of(1, 9, -1, 1), map_of(1, 10, -1, 1)};
    cpu_render(&s.maps, &view, &y);
    cpu_render_backward(&s.maps, &view, &s.dy, &d, (cpu_render_accumulate){0});
    assert_finite(&y), assert_finite(&d.albedo), assert_finite(&d.normal), assert_finite(&d.roughness);
    assert_finite(&d.depth);
    for (size_t i = 0; i < cpu_count(&y); i++) {
        double v = tensor_get(&y, i);
        assert_true(v >= 0 && v <= tensor_get(&s.mask, i / 3));
    }
    tensor_free(&y), tensor_free(&d.albedo), tensor_free(&d.normal), tensor_free(&d.roughness), tensor_free(&d.depth);
    scene_free(&s);
}

static void clipped_pixels_pass_no_gradient(void **state)
{
    (void)state;
    scene s = scene_new();
    cpu_render_view view = view_of(&s);
    cpu_render_tensors d = {map_of(3, 7, -1, 1), map_of(3, 8, -1, 1), map_of(1, 9, -1, 1), map_of(1, 10, -1, 1)};
    view.light_power = 1e6f;
    cpu_render_backward(&s.maps, &view, &s.dy, &d, (cpu_render_accumulate){0});
    int lit = 0;
    for (size_t i = 0; i < PIXELS; i++) {
        shade_input in = input_at(&s, i);
        vec3 r = shade_point(&in);
        if (fmin(r.x, fmin(r.y, r.z)) < 1e-3) continue;
        lit++;
        assert_true(tensor_get(&d.depth, i) == 0 && tensor_get(&d.roughness, i) == 0 &&
                    tensor_get(&d.albedo, 3 * i) == 0 && tensor_get(&d.normal, 3 * i) == 0);
    }
    assert_true(lit > 500);
    tensor_free(&d.albedo), tensor_free(&d.normal), tensor_free(&d.roughness), tensor_free(&d.depth);
    scene_free(&s);
}

static void results_do_not_depend_on_the_number_of_threads(void **state)
{
    (void)state;
    scene s = scene_new();
    const cpu_render_view view = view_of(&s);
    int before = parallel_threads();
    cpu_tensor y[2] = {tensor_like(&s.dy), tensor_like(&s.dy)};
    cpu_render_tensors d[2] = {{.normal = tensor_like(&s.dy)}, {.normal = tensor_like(&s.dy)}};
    for (int i = 0; i < 2; i++) {
        threads_use_here(i + 1);
        cpu_render(&s.maps, &view, &y[i]);
        cpu_render_backward(&s.maps, &view, &s.dy, &d[i], (cpu_render_accumulate){0});
    }
    threads_use_here(before);
    assert_same_bits("rendering", &y[0], &y[1]);
    assert_same_bits("gradient", &d[0].normal, &d[1].normal);
    tensor_free(&y[0]), tensor_free(&y[1]), tensor_free(&d[0].normal), tensor_free(&d[1].normal);
    scene_free(&s);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(rendering_is_the_physics_of_optics),
        cmocka_unit_test(gradients_are_those_of_central_differences),
        cmocka_unit_test(rendering_through_any_lens_is_the_physics_of_optics),
        cmocka_unit_test(gradients_through_any_lens_are_those_of_central_differences),
        cmocka_unit_test(gradients_accumulate_and_may_be_unwanted),
        cmocka_unit_test(nothing_but_numbers_comes_out),
        cmocka_unit_test(clipped_pixels_pass_no_gradient),
        cmocka_unit_test(results_do_not_depend_on_the_number_of_threads),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
