/* SPDX-License-Identifier: MIT */
/* Data sets: independent of the number of threads, resumable, never mixed; and the guarantees for samples. */
#include "lab/render/generate.h"
#include "lab/render/sample_lamps.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "base/file.h"
#include "base/threads.h"
#include "image/write/write.h"
#include "optics/camera.h"
#include "optics/light.h"
#include "scratch.h"

/* last, as cmocka defines a macro named fail */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

enum { COUNT = 4 };

static render_options small(const char *folder)
{
    render_options o = render_options_default();
    o.folder = folder;
    o.count = COUNT;
    o.seed = 77;
    o.quiet = true;
    o.image.size = 48;
    o.image.targets = 1;
    return o;
}

static char *read_member(const char *folder, uint64_t index, size_t *size)
{
    char *path = sample_path(folder, index), *data;
    assert_int_equal(file_read(path, 1 << 26, &data, size), OK);
    free(path);
    return data;
}

static void assert_same_sets(const char *a, const char *b)
{
    for (uint64_t i = 0; i < COUNT; i++) {
        size_t size_a, size_b;
        char *data_a = read_member(a, i, &size_a), *data_b = read_member(b, i, &size_b);
        assert_int_equal(size_a, size_b);
        assert_memory_equal(data_a, data_b, size_a);
        free(data_a);
        free(data_b);
    }
}

static void set_is_the_same_from_one_thread_and_from_two(void **state)
{
    (void)state;
    char *one = scratch_new(), *two = scratch_new();
    render_stats stats;
    render_options o = small(one);
    threads_use_here(1);
    assert_int_equal(render_samples(&o, &stats), OK);
    assert_int_equal(stats.rendered, COUNT);
    assert_true(stats.rays > 0);
    o = small(two);
    threads_use_here(2);
    assert_int_equal(render_samples(&o, &stats), OK);
    assert_same_sets(one, two);
    scratch_remove(one);
    scratch_remove(two);
}

static int polls;
static int stop_after_two(void)
{
    return ++polls > 2;
}

static void interrupted_set_is_continued_to_the_same_files(void **state)
{
    (void)state;
    char *whole = scratch_new(), *parts = scratch_new();
    render_stats stats;
    render_options o = small(whole);
    assert_int_equal(render_samples(&o, &stats), OK);
    o = small(parts);
    o.interrupted = stop_after_two;
    polls = 0;
    assert_int_equal(render_samples(&o, &stats), MERLIN_STOPPED);
    assert_true(stats.rendered <= 2);
    size_t before = stats.rendered;
    o.interrupted = NULL;
    assert_int_equal(render_samples(&o, &stats), OK);
    assert_int_equal(stats.kept, before);
    assert_int_equal(stats.rendered, COUNT - before);
    assert_same_sets(whole, parts);
    scratch_remove(whole);
    scratch_remove(parts);
}

static void samples_of_other_options_are_not_mixed_in(void **state)
{
    (void)state;
    char *folder = scratch_new();
    render_stats stats;
    render_options o = small(folder);
    o.count = 1;
    assert_int_equal(render_samples(&o, &stats), OK);
    o.seed++;
    assert_int_equal(render_samples(&o, &stats), MERLIN_WRONG_USE);
    assert_non_null(strstr(status_message(), "other options"));
    scratch_remove(folder);
}

static void write_mesh(const char *path, const char *apex)
{
    char text[256];
    int length =
        snprintf(text, sizeof text, "v 0 0 0\nv 1 0 0\nv 0 1 0\nv %s\nf 1 3 2\nf 1 2 4\nf 2 3 4\nf 3 1 4\n", apex);
    assert_int_equal(file_write(path, text, (size_t)length), OK);
}

/* Removes the checksums from a folder's render.txt, as in versions that did not write them. */
static void forget_contents(const char *folder)
{
    char *path = file_join(folder, "render.txt"), *text;
    size_t size;
    assert_int_equal(file_read(path, 65536, &text, &size), OK);
    char *contents = strstr(text, "contents ");
    assert_non_null(contents);
    assert_int_equal(file_write(path, text, (size_t)(contents - text)), OK);
    free(text);
    free(path);
}

static void samples_of_a_changed_mesh_are_not_mixed_in(void **state)
{
    (void)state;
    for (int in_folder = 0; in_folder < 2; in_folder++) {
        char *folder = scratch_new(), *meshes = scratch_new(), *mesh = file_join(meshes, "a.obj");
        render_stats stats;
        render_options o = small(folder);
        o.count = 1;
        o.environment = false;
        *(in_folder ? &o.mesh_folder : &o.mesh) = in_folder ? meshes : mesh;
        write_mesh(mesh, "0 0 1");
        assert_int_equal(render_samples(&o, &stats), OK);
        render_stats_free(&stats);
        o.count = 2;
        assert_int_equal(render_samples(&o, &stats), OK);
        assert_int_equal(stats.kept, 1);
        render_stats_free(&stats);
        write_mesh(mesh, "0 0 2");
        assert_int_equal(render_samples(&o, &stats), MERLIN_WRONG_USE);
        assert_non_null(strstr(status_message(), "made of other files than are there now"));
        render_stats_free(&stats);
        forget_contents(folder);
        assert_int_equal(render_samples(&o, &stats), OK);
        assert_int_equal(stats.kept, 2);
        render_stats_free(&stats);
        free(mesh);
        scratch_remove(folder);
        scratch_remove(meshes);
    }
}

static void samples_are_not_rendered_among_what_they_are_made_of(void **state)
{
    (void)state;
    char *materials = scratch_new(), *inside = file_join(materials, "new/samples"), *tile;
    sample s;
    render_stats stats;
    render_options o = small(NULL);
    assert_int_equal(render_sample(&o, 0, &s), OK);
    assert_non_null(tile = file_join(materials, "brick_albedo.png"));
    assert_int_equal(img_write_png(tile, &s.albedo, IMG_SRGB8), OK);
    sample_free(&s);
    o = small(inside);
    o.material_folder = materials;
    assert_int_equal(render_samples(&o, &stats), MERLIN_WRONG_USE);
    assert_non_null(strstr(status_message(), "taken for pictures of"));
    assert_false(file_exists(inside));
    o.folder = materials;
    assert_int_equal(render_samples(&o, &stats), MERLIN_WRONG_USE);
    free(tile);
    free(inside);
    scratch_remove(materials);
}

static void impossible_options_are_refused(void **state)
{
    (void)state;
    render_stats stats;
    render_options o = small(NULL);
    o.image.strata = 3;
    assert_int_equal(render_samples(&o, &stats), MERLIN_WRONG_USE);
    o = small(NULL);
    o.image.targets = SAMPLE_MAX_TARGETS + 1;
    assert_int_equal(render_samples(&o, &stats), MERLIN_WRONG_USE);
    o = small(NULL);
    o.image.lamps = SAMPLE_MAX_LAMPS + 1;
    assert_int_equal(render_samples(&o, &stats), MERLIN_WRONG_USE);
    o = small(NULL);
    o.widest_fov = o.image.fov - 1;
    assert_int_equal(render_samples(&o, &stats), MERLIN_WRONG_USE);
    o = small(NULL);
    o.mesh = "/nonexistent/mesh.obj";
    assert_int_equal(render_samples(&o, &stats), MERLIN_BAD_INPUT);
}

static void an_unreadable_mesh_claims_no_folder(void **state)
{
    (void)state;
    render_stats stats;
    char *above = scratch_new(), *folder = file_join(above, "samples");
    render_options o = small(folder);
    o.mesh = "/nonexistent/mesh.obj";
    assert_int_equal(render_samples(&o, &stats), MERLIN_BAD_INPUT);
    assert_false(file_exists(folder));
    free(folder);
    scratch_remove(above);
}

static void an_object_elsewhere_keeps_its_maps_and_flash_picture(void **state)
{
    (void)state;
    render_options o = render_options_default();
    o.image.size = 32;
    o.image.paths = 2;
    sample here, next, there;
    environment env;
    assert_int_equal(render_sample(&o, 3, &here), OK);
    assert_int_equal(render_sample(&o, 4, &next), OK);
    assert_int_equal(render_sample_elsewhere(&o, 3, 4, &there, &env), OK);
    size_t pixels = 32 * 32, rgb = 3 * pixels * sizeof(float);
    assert_memory_equal(there.albedo.data, here.albedo.data, rgb);
    assert_memory_equal(there.indirect.data, here.indirect.data, rgb);
    assert_memory_equal(there.mask.data, here.mask.data, pixels * sizeof(float));
    assert_memory_not_equal(there.env.data, here.env.data, rgb);
    assert_memory_equal(there.sh, next.sh, sizeof next.sh);
    assert_memory_equal(env.sh, next.sh, sizeof next.sh);
    sample_free(&here);
    sample_free(&next);
    sample_free(&there);
    environment_free(&env);
}

static void maps_are_zero_outside_the_mask_and_within_their_ranges_inside(void **state)
{
    (void)state;
    render_options o = small(NULL);
    for (uint64_t index = 0; index < 6; index++) {
        sample s;
        size_t inside = 0;
        assert_int_equal(render_sample(&o, index, &s), OK);
        for (size_t i = 0; i < (size_t)48 * 48; i++) {
            const float *n = s.normal.data + 3 * i, *a = s.albedo.data + 3 * i;
            float length = n[0] * n[0] + n[1] * n[1] + n[2] * n[2];
            if (s.mask.data[i] > 0) {
                inside++;
                assert_true(fabsf(length - 1) < 1e-4f && n[2] > 0);
                assert_true(s.depth.data[i] > 0.2f && s.depth.data[i] < 3);
                assert_true(s.roughness.data[i] >= 0.09f && s.roughness.data[i] <= 1);
                for (int c = 0; c < 3; c++)
                    assert_true(a[c] >= 0 && a[c] <= 1 && s.env.data[3 * i] >= 0);
            } else {
                assert_true(length == 0 && s.depth.data[i] == 0 && s.roughness.data[i] == 0);
                assert_true(s.direct.data[3 * i] == 0 && s.indirect.data[3 * i] == 0 && s.env.data[3 * i] == 0);
            }
        }
        assert_true(inside > 200);
        assert_true(s.sh[0][0] > 0 && s.light_power > 5.9f);
        sample_free(&s);
    }
}

static int by_value(const void *a, const void *b)
{
    float x = *(const float *)a, y = *(const float *)b;
    return (x > y) - (x < y);
}

/* Computes relative differences of the direct image and the BRDF on the stored maps, where a pixel and its neighbours
 * are fully covered; returns how many. */
static size_t compare_direct(const sample *s, float *error)
{
    size_t count = 0;
    int size = s->mask.width;
    camera eye = {.width = size, .height = size, .fov = s->fov, .slant = s->slant};
    for (int y = 1; y < size - 1; y++)
        for (int x = 1; x < size - 1; x++) {
            float whole = fminf(fminf(*img_at(&s->mask, x - 1, y), *img_at(&s->mask, x + 1, y)),
                                fminf(*img_at(&s->mask, x, y - 1), *img_at(&s->mask, x, y + 1)));
            if (whole < 1 || *img_at(&s->mask, x, y) < 1) continue;
            const float *a = img_at(&s->albedo, x, y), *n = img_at(&s->normal, x, y);
            shade_input in = {{a[0], a[1], a[2]},
                              *img_at(&s->roughness, x, y),
                              {n[0], n[1], n[2]},
                              *img_at(&s->depth, x, y),
                              camera_point(&eye, (float)x + 0.5f, (float)y + 0.5f, 1),
                              {0, 0, 0},
                              s->light_power};
            float expected = shade_point(&in).y;
            error[count++] = fabsf(img_at(&s->direct, x, y)[1] - expected) / fmaxf(expected, 1e-3f);
        }
    return count;
}

static void direct_images_of_generated_objects_agree_with_the_brdf_on_their_maps(void **state)
{
    (void)state;
    enum { SIZE = 128, OBJECTS = 8 };
    float *error = malloc(sizeof *error * SIZE * SIZE * OBJECTS);
    size_t count = 0;
    render_options o = small(NULL);
    o.image = render_options_default().image;
    o.environment = false;
    for (uint64_t index = 0; index < OBJECTS; index++) {
        sample s;
        assert_int_equal(render_sample(&o, index, &s), OK);
        count += compare_direct(&s, error + count);
        sample_free(&s);
    }
    qsort(error, count, sizeof *error, by_value);
    assert_true(error[count / 2] < 0.01f);
    free(error);
}

static void samples_of_any_lens_agree_with_the_brdf_on_their_maps(void **state)
{
    (void)state;
    enum { SIZE = 96, OBJECTS = 8 };
    float *error = malloc(sizeof *error * SIZE * SIZE * OBJECTS), narrowest = 180, widest = 0, slant = 0;
    size_t count = 0;
    render_options o = small(NULL);
    o.image = render_options_default().image;
    o.image.size = SIZE;
    o.image.fov = 8;
    o.widest_fov = 75;
    o.off_axis = 25;
    o.environment = false;
    for (uint64_t index = 0; index < OBJECTS; index++) {
        sample s;
        assert_int_equal(render_sample(&o, index, &s), OK);
        count += compare_direct(&s, error + count);
        narrowest = fminf(narrowest, s.fov);
        widest = fmaxf(widest, s.fov);
        slant = fmaxf(slant, hypotf(s.slant.right, s.slant.up));
        sample_free(&s);
    }
    qsort(error, count, sizeof *error, by_value);
    assert_true(count > 1000 && error[count / 2] < 0.01f);
    assert_true(narrowest > 7.9f && narrowest < 25 && widest > 45 && widest < 75.1f && slant > 0.1f && slant < 0.5f);
    free(error);
}

/* Computes the differences of a lamp's image and the maps under that lamp, times visibility. */
static size_t compare_lamp(const sample *s, const sample_lamp *under, float *error)
{
    size_t count = 0;
    const camera eye = {s->mask.width, s->mask.height, s->fov, s->slant};
    const point_light light = sample_lamp_light(under);
    for (int i = 0; i < s->mask.width * s->mask.height && under->radius == 0; i++) {
        int x = i % s->mask.width, y = i / s->mask.width;
        if (s->mask.data[i] < 1 || under->visibility.data[i] < 0.01f) continue;
        shade_input in = {vec3_of(s->albedo.data + 3 * i),
                          s->roughness.data[i],
                          vec3_of(s->normal.data + 3 * i),
                          s->depth.data[i],
                          camera_point(&eye, (float)x + 0.5f, (float)y + 0.5f, 1),
                          light.position,
                          light.power};
        float expected = shade_point(&in).y * under->visibility.data[i];
        error[count++] = fabsf(under->direct.data[3 * i + 1] - expected) / fmaxf(expected, 1e-2f);
    }
    return count;
}

static void lamps_light_the_maps_as_far_as_they_are_visible(void **state)
{
    (void)state;
    enum { SIZE = 96, OBJECTS = 4, LAMPS = 4 };
    float *error = malloc(sizeof *error * SIZE * SIZE * OBJECTS * LAMPS);
    size_t count = 0;
    render_options o = small(NULL);
    o.image = render_options_default().image;
    o.image.size = SIZE;
    o.image.lamps = LAMPS;
    o.environment = false;
    for (uint64_t index = 0; index < OBJECTS; index++) {
        sample s;
        assert_int_equal(render_sample(&o, index, &s), OK);
        assert_int_equal(s.lamp_count, LAMPS);
        for (int i = 0; i < LAMPS; i++)
            count += compare_lamp(&s, &s.lamps[i], error + count);
        sample_free(&s);
    }
    qsort(error, count, sizeof *error, by_value);
    assert_true(count > 1000 && error[count / 2] < 0.02f);
    free(error);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(set_is_the_same_from_one_thread_and_from_two),
        cmocka_unit_test(interrupted_set_is_continued_to_the_same_files),
        cmocka_unit_test(samples_of_other_options_are_not_mixed_in),
        cmocka_unit_test(samples_of_a_changed_mesh_are_not_mixed_in),
        cmocka_unit_test(samples_are_not_rendered_among_what_they_are_made_of),
        cmocka_unit_test(impossible_options_are_refused),
        cmocka_unit_test(an_unreadable_mesh_claims_no_folder),
        cmocka_unit_test(an_object_elsewhere_keeps_its_maps_and_flash_picture),
        cmocka_unit_test(maps_are_zero_outside_the_mask_and_within_their_ranges_inside),
        cmocka_unit_test(direct_images_of_generated_objects_agree_with_the_brdf_on_their_maps),
        cmocka_unit_test(samples_of_any_lens_agree_with_the_brdf_on_their_maps),
        cmocka_unit_test(lamps_light_the_maps_as_far_as_they_are_visible),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
