/* SPDX-License-Identifier: MIT */
/* What the evaluations measure is what merlin_estimate gives, in the sample's frame, and with --raw the network's own.
 */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>
#include <unistd.h>

#include "../../estimate/weights.h"
#include "estimate/photo/view.h"
#include "estimate/surface/exposure.h"
#include "image/resize.h"
#include "lab/eval/metrics/metrics.h"
#include "lab/eval/samples/evaluate.h"
#include "lab/eval/samples/raw.h"
#include "lab/eval/samples/truth.h"
#include "scratch.h"
#include "sphere.h"

#include <cmocka.h> /* last, as cmocka defines a macro named fail */

enum { SIZE = 96 };

static const sphere large = {{0.05f, 0, -1.2f}, 0.4f, {0.6f, 0.4f, 0.2f}, 0.5f, SIZE};

static merlin_model *open_random_model(const char *config)
{
    merlin_model *model;
    assert_int_equal(write_random_weights_of(config, scratch_path("w.safetensors")), OK);
    assert_int_equal(merlin_model_open(scratch_path("w.safetensors"), &model), MERLIN_OK);
    return model;
}

static void assert_same(const img *a, const merlin_image *b)
{
    assert_int_equal(a->width, b->width);
    assert_int_equal(a->channels, b->channels);
    assert_memory_equal(a->data, b->data, img_value_count(a) * sizeof(float));
}

static void assert_same_maps(const surface *s, const merlin_maps *maps)
{
    assert_same(&s->albedo, &maps->albedo);
    assert_same(&s->normal, &maps->normal);
    assert_same(&s->roughness, &maps->roughness);
    assert_same(&s->depth, &maps->depth);
    assert_same(&s->mask, &maps->mask);
}

/* By the public function, without anything of the evaluation's. */
static void estimate_by_hand(merlin_model *model, const sample *s, float white, merlin_maps *maps)
{
    img picture;
    assert_int_equal(img_copy(&picture, &s->direct), OK);
    for (size_t i = 0; i < img_value_count(&picture); i++)
        picture.data[i] = fminf(picture.data[i] / white, 1);
    merlin_image photo = {SIZE, SIZE, 3, picture.data}, mask = {SIZE, SIZE, 1, s->mask.data};
    merlin_params params = merlin_params_default();
    params.fov = s->fov;
    assert_int_equal(merlin_estimate(model, &photo, &mask, &params, maps), MERLIN_OK);
    img_free(&picture);
}

static void maps_are_exactly_those_of_merlin_estimate(void **state)
{
    (void)state;
    merlin_model *model = open_random_model("merlin-point-plain");
    sample s;
    eval_photo photo;
    merlin_maps maps, expected;
    surface found;
    assert_int_equal(sphere_sample(&large, 0, &s), OK);
    s.mask.data[SIZE * SIZE / 2 + SIZE / 2] = 0.7f; /* coverage reaches it as it is */
    estimate_by_hand(model, &s, 1.3f, &expected);
    assert_int_equal(eval_photo_take(&s, &s.direct, &s.mask, 1.3f, &photo), OK);
    assert_int_equal(eval_photo_estimate(model, &photo, &maps), OK);
    assert_int_equal(maps.crop.side, SIZE);
    assert_int_equal(eval_photo_surface(&photo, &maps, &found), OK);
    assert_same_maps(&found, &expected);
    img shown;
    assert_int_equal(eval_photo_radiance(&photo, &maps.reconstruction, &shown), OK);
    for (size_t i = 0; i < img_value_count(&shown); i++)
        assert_float_equal(shown.data[i], fminf(1.3f * expected.reconstruction.data[i], 1), 0);
    img_free(&shown);
    surface_free(&found);
    merlin_maps_free(&maps);
    merlin_maps_free(&expected);
    eval_photo_free(&photo);
    sample_free(&s);
    merlin_model_close(model);
}

static double unit_error(const merlin_image *a, const img *b, const img *mask)
{
    const img of = *a;
    return 4 * eval_mse(&of, b, mask); /* from [0, 1] to [-1, 1] */
}

/* As the sample's file has it, half floats. */
static void evaluations_figures_are_of_these_maps(void **state)
{
    (void)state;
    merlin_model *model = open_random_model("merlin-point-plain");
    char *folder = scratch_new(), *path = sample_path(folder, 0);
    sample s;
    merlin_maps maps;
    eval_report r;
    assert_int_equal(sphere_sample(&large, 0, &s), OK);
    assert_int_equal(sample_write(path, &s), OK);
    sample_free(&s);
    assert_int_equal(sample_read(path, &s), OK);
    eval_options options = {.data = folder, .weights = scratch_path("w.safetensors"), .quiet = true};
    for (int raw = 0; raw < 2; raw++) {
        network_estimation e = {0};
        options.raw = raw;
        assert_int_equal(eval_run(&options, &r), OK);
        assert_float_equal(r.white, raw ? 1 : EXPOSURE_WHITE, 0);
        estimate_by_hand(model, &s, EXPOSURE_WHITE, &maps);
        if (raw) {
            img picture;
            assert_int_equal(eval_picture(&s.direct, NULL, &s.mask, &picture), OK);
            network_compute_in(model->network, NN_FLOAT32);
            assert_int_equal(network_see(model->network, &picture, &s.mask, NULL, NETWORK_VIEWS, NULL, &e), OK);
            img_free(&picture);
        }
        const merlin_image albedo = raw ? e.maps.albedo : maps.albedo,
                           roughness = raw ? e.maps.roughness : maps.roughness;
        assert_float_equal(eval_score(&r.all, EVAL_ALBEDO, EVAL_MODEL), unit_error(&albedo, &s.albedo, &s.mask), 0);
        assert_float_equal(eval_score(&r.all, EVAL_ROUGHNESS, EVAL_MODEL),
                           unit_error(&roughness, &s.roughness, &s.mask), 0);
        network_estimation_free(&e);
        merlin_maps_free(&maps);
    }
    sample_free(&s);
    scratch_remove(folder);
    free(path);
    merlin_model_close(model);
}

/* ---- frames ---- */

/* Where the ray of a pixel first meets the sphere; 0 where it does not. */
static float hit(const sphere *of, vec3 centre, const camera *view, int x, int y, vec3 *normal)
{
    vec3 d = camera_ray(view, (float)x + 0.5f, (float)y + 0.5f);
    float along = vec3_dot(d, centre), inside = along * along - vec3_dot(centre, centre) + of->radius * of->radius;
    if (inside <= 0) return 0;
    vec3 p = vec3_scale(d, along - sqrtf(inside));
    *normal = vec3_scale(vec3_sub(p, centre), 1 / of->radius);
    return -p.z;
}

static void draw(const sphere *of, vec3 centre, const camera *view, int left, int top, img *normal, img *depth,
                 img *mask)
{
    for (int y = 0; y < view->height; y++)
        for (int x = 0; x < view->width; x++) {
            vec3 n;
            float at = hit(of, centre, view, x, y, &n);
            int column = left + x, row = top + y;
            if (!(at > 0) || column < 0 || row < 0 || column >= mask->width || row >= mask->height) continue;
            vec3_put(n, img_at(normal, column, row));
            *img_at(depth, column, row) = at;
            *img_at(mask, column, row) = 1;
        }
}

/* The sphere's true maps as an estimate of the photograph gives them: by a camera that looks at the crop's middle. */
static void make_perfect_maps(const sphere *of, const eval_photo *photo, merlin_maps *maps)
{
    img mask = {0}, images[5];
    crop_square crop;
    const int channels[5] = {3, 3, 1, 1, 1};
    assert_int_equal(img_crop(&photo->mask, -photo->x, -photo->y, photo->width, photo->height, &mask), OK);
    assert_int_equal(crop_around(&mask, &crop), OK);
    const sight how = sight_of(photo->params.fov, 0, photo->width, photo->height, crop);
    *maps = (merlin_maps){
        .crop = {crop.x, crop.y, crop.side}, .fov = how.lens.fov, .slant = {how.lens.slant.right, how.lens.slant.up}};
    for (int i = 0; i < 5; i++)
        assert_int_equal(img_new(&images[i], photo->width, photo->height, channels[i]), OK);
    const camera seen = camera_through(how.lens, crop.side, crop.side);
    draw(of, eval_photo_to_maps(photo, maps, of->centre), &seen, crop.x, crop.y, &images[1], &images[3], &images[4]);
    merlin_image *to[] = {&maps->albedo, &maps->normal, &maps->roughness, &maps->depth, &maps->mask};
    for (int i = 0; i < 5; i++)
        *to[i] = images[i];
    img_free(&mask);
}

/* tolerance: degrees. */
static void assert_seen_by_the_samples_camera(const sphere *of, camera_lens lens, double tolerance)
{
    sample s;
    eval_photo photo;
    merlin_maps maps;
    surface found;
    assert_int_equal(sphere_sample(of, 0, &s), OK);
    s.fov = lens.fov;
    s.slant = lens.slant;
    memset(s.mask.data, 0, img_value_count(&s.mask) * sizeof(float));
    const camera own = camera_through(lens, SIZE, SIZE);
    draw(of, of->centre, &own, 0, 0, &s.normal, &s.depth, &s.mask);
    assert_int_equal(eval_photo_take(&s, &s.direct, &s.mask, 1, &photo), OK);
    make_perfect_maps(of, &photo, &maps);
    assert_true(maps.crop.side < photo.width && maps.slant[0] != 0);
    assert_int_equal(eval_photo_surface(&photo, &maps, &found), OK);
    img inner;
    assert_int_equal(img_copy(&inner, &s.mask), OK); /* the outline may be a pixel off */
    for (int y = 0; y < SIZE; y++)
        for (int x = 0; x < SIZE; x++) {
            vec3 n;
            if (!(hit(&(sphere){.radius = 0.9f * of->radius}, of->centre, &own, x, y, &n) > 0))
                *img_at(&inner, x, y) = 0;
        }
    double angle = eval_angle(&found.normal, &s.normal, &inner), depth = sqrt(eval_mse(&found.depth, &s.depth, &inner));
    print_message("normals %.4f degrees, depth %.5f\n", angle, depth);
    assert_true(angle < tolerance && depth < tolerance / 57);
    vec3 back = eval_photo_from_maps(&photo, &maps, eval_photo_to_maps(&photo, &maps, of->centre));
    assert_true(vec3_length(vec3_sub(back, of->centre)) < 1e-6f);
    img_free(&inner);
    surface_free(&found);
    merlin_maps_free(&maps);
    eval_photo_free(&photo);
    sample_free(&s);
}

static void cropped_maps_become_what_the_samples_camera_sees(void **state)
{
    (void)state;
    const sphere small = {{-0.25f, 0.2f, -1.1f}, 0.15f, {0.5f, 0.5f, 0.5f}, 0.5f, SIZE};
    assert_seen_by_the_samples_camera(&small, (camera_lens){.fov = 60}, 0.01);
}

/* The photograph ends at whole pixels: half of one is 0.2 degrees here, seen on the sphere twice that. */
static void a_sample_beside_the_lens_axis_is_part_of_a_larger_photograph(void **state)
{
    (void)state;
    const sphere ball = {{0, 0, -1}, 0.25f, {0.5f, 0.5f, 0.5f}, 0.5f, SIZE};
    assert_seen_by_the_samples_camera(&ball, (camera_lens){40, camera_tilt(20, -10)}, 0.5);
}

/* ---- the network alone ---- */

static void run_program(const char *weights, const img *photo, const img *mask, surface *out)
{
    static const char *const outputs[] = {"albedo", "normal", "roughness", "depth", NULL};
    model_config config;
    nn_params *params;
    nn_graph *g;
    nn_program *p;
    nn_options options = {
        .batch = 1, .height = SIZE, .width = SIZE, .type = NN_FLOAT32, .purpose = NN_INFER, .outputs = outputs};
    assert_int_equal(model_load(weights, &config, &params), OK);
    assert_int_equal(model_build(&config, MODEL_MAPS, &g), OK);
    assert_int_equal(nn_compile(g, params, &options, &p), OK);
    view_put(p, 0, 0, photo, mask);
    view_put_light(p, &config, 0, 0, &(illumination){{0, 0, 0}, NULL});
    assert_int_equal(nn_forward(p), OK);
    assert_int_equal(surface_new(SIZE, SIZE, out), OK);
    img *to[] = {&out->albedo, &out->normal, &out->roughness, &out->depth};
    for (int i = 0; i < 4; i++) {
        const float *from = nn_output_data(p, outputs[i]);
        const bool encoded = i % 2 == 0; /* albedo and roughness are in [-1, 1] there */
        for (size_t k = 0; k < img_value_count(to[i]); k++)
            to[i]->data[k] = encoded ? 0.5f * from[k] + 0.5f : from[k];
    }
    nn_program_free(p);
    nn_graph_free(g);
    nn_params_free(params);
}

static void raw_maps_are_the_networks_own(void **state)
{
    (void)state;
    merlin_model *model = open_random_model("merlin-point-plain");
    sample s;
    eval_photo photo;
    merlin_maps maps;
    surface expected;
    assert_int_equal(sphere_sample(&large, 0, &s), OK);
    assert_int_equal(eval_photo_take(&s, &s.direct, &s.mask, 1, &photo), OK);
    network_compute_in(model->network, NN_FLOAT32);
    assert_int_equal(raw_estimate(model, &photo, 1, &maps), OK);
    run_program(scratch_path("w.safetensors"), &photo.picture, &s.mask, &expected);
    assert_same(&expected.albedo, &maps.albedo);
    assert_same(&expected.normal, &maps.normal);
    assert_same(&expected.roughness, &maps.roughness);
    assert_same(&expected.depth, &maps.depth);
    assert_float_equal(maps.gain, 1, 0); /* its exposure is known */
    surface_free(&expected);
    merlin_maps_free(&maps);
    eval_photo_free(&photo);
    sample_free(&s);
    merlin_model_close(model);
}

static void means_of_raw_views_are_unit_and_can_be_relit(void **state)
{
    (void)state;
    merlin_model *model = open_random_model("merlin-point");
    const float light[3] = {0.5f, 0.2f, -0.3f};
    sample s;
    eval_photo photo;
    merlin_maps maps;
    merlin_image relit;
    network_features *features;
    assert_int_equal(sphere_sample(&large, 0, &s), OK);
    assert_int_equal(eval_photo_take(&s, &s.direct, &s.mask, 2, &photo), OK);
    assert_int_equal(raw_estimate(model, &photo, 3, &maps), OK);
    for (int i = 0; i < SIZE * SIZE; i++)
        assert_float_equal(vec3_length(vec3_of(maps.normal.data + 3 * i)), 1, 1e-5);
    assert_int_equal(merlin_relight(model, &maps, light, MERLIN_BY_BRDF, &relit), MERLIN_OK);
    merlin_image_free(&relit);
    assert_int_equal(raw_features(model, &photo, 3, &features), OK);
    assert_non_null(features);
    network_features_free(features);
    merlin_maps_free(&maps);
    merlin_model_close(model);
    model = open_random_model("merlin-point-plain");
    assert_int_equal(raw_features(model, &photo, 3, &features), OK);
    assert_int_equal(features != NULL, network_config(model->network)->relight == MODEL_RELIGHT_NETWORK);
    network_features_free(features);
    eval_photo_free(&photo);
    sample_free(&s);
    merlin_model_close(model);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(maps_are_exactly_those_of_merlin_estimate),
        cmocka_unit_test(evaluations_figures_are_of_these_maps),
        cmocka_unit_test(cropped_maps_become_what_the_samples_camera_sees),
        cmocka_unit_test(a_sample_beside_the_lens_axis_is_part_of_a_larger_photograph),
        cmocka_unit_test(raw_maps_are_the_networks_own),
        cmocka_unit_test(means_of_raw_views_are_unit_and_can_be_relit),
    };
    return cmocka_run_group_tests(tests, scratch_open, scratch_close);
}
