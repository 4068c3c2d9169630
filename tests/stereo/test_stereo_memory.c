/* SPDX-License-Identifier: MIT */
/* Memory runs out at any allocation between pictures, a surface and its mesh: every failure is reported, the surface is
 * empty, no mesh is left, and the next call gives the same surface as ever. */
#include "merlin/calibrate.h"
#include "merlin/mesh.h"
#include "merlin/pictures.h"

#include <math.h>
#include <stdbool.h>

#include "capture_files.h"
#include "each_allocation.h"

enum { SIDE = 16, PIXELS = SIDE * SIDE, LIGHTS = 8, FOLDER_LIGHTS = 4 };
static const float RADIUS = 0.3f; /* of the ball at (0, 0, -1) */

typedef struct work {
    merlin_lighting lighting;
    merlin_image pictures[LIGHTS];
    merlin_capture *capture;
    merlin_stereo_params params;
    merlin_surface made;
    const char *mesh;
    uint64_t first; /* checksum of what the first run gave; 0: there was none */
} work;

/* ---- pictures ---- */

/* Returns false beside the ball's front, up to 70 degrees. */
static bool normal_at(int i, float n[3])
{
    n[0] = ((float)(i % SIDE) + 0.5f - SIDE / 2.0f) / 7.5f;
    n[1] = (SIDE / 2.0f - (float)(i / SIDE) - 0.5f) / 7.5f;
    n[2] = sqrtf(fmaxf(1 - n[0] * n[0] - n[1] * n[1], 0));
    return n[2] > 0.34f;
}

/* Returns lights on a spiral about the camera, of unequal strength. */
static merlin_light light_at(int k, merlin_lighting lighting)
{
    float turn = 2.4f * (float)k, lean = 0.15f + 0.09f * (float)k, strength = 0.5f + 0.03f * (float)k;
    float at[3] = {sinf(lean) * cosf(turn), sinf(lean) * sinf(turn), cosf(lean)};
    merlin_light l = {.direction = {at[0], at[1], at[2]}, .intensity = {strength, strength, strength}};
    if (lighting != MERLIN_NEAR_LIGHTS) return l;
    return (merlin_light){.position = {0.8f * at[0], 0.8f * at[1], 0.8f * at[2] - 1}, .intensity = {strength}};
}

static float shade(const merlin_light *l, const float n[3], bool near)
{
    float to[3], square = 0, cosine = 0;
    for (int c = 0; c < 3; c++) {
        to[c] = near ? l->position[c] - RADIUS * n[c] + (c == 2) : l->direction[c];
        square += to[c] * to[c];
        cosine += to[c] * n[c];
    }
    return fmaxf(cosine, 0) / (near ? square * sqrtf(square) : sqrtf(square));
}

static merlin_image picture_under(const merlin_light *l, bool near)
{
    merlin_image p = {SIDE, SIDE, 1, calloc(PIXELS, sizeof(float))};
    for (int i = 0; i < PIXELS; i++) {
        float n[3];
        if (normal_at(i, n)) p.data[i] = fminf((near ? 0.15f : 0.9f) * l->intensity[0] * shade(l, n, near), 0.97f);
    }
    return p;
}

static work work_of(merlin_lighting lighting, merlin_stereo_params params)
{
    work w = {.lighting = lighting, .params = params};
    for (int k = 0; k < LIGHTS; k++) {
        const merlin_light l = light_at(k, lighting);
        w.pictures[k] = picture_under(&l, lighting == MERLIN_NEAR_LIGHTS);
    }
    return w;
}

static void work_end(work *w)
{
    for (int k = 0; k < LIGHTS; k++)
        free(w->pictures[k].data);
    merlin_capture_free(w->capture);
}

static int new_capture(void *context)
{
    work *w = context;
    const merlin_capture_params params = {.lighting = w->lighting,
                                          .field_of_view = w->lighting == MERLIN_NEAR_LIGHTS ? 35 : 0};
    w->capture = (merlin_capture *)1;
    merlin_status s = merlin_capture_new(&params, NULL, &w->capture);
    for (int k = 0; s == MERLIN_OK && k < LIGHTS; k++) {
        const merlin_light l = light_at(k, w->lighting);
        s = merlin_capture_add(w->capture, &w->pictures[k], w->lighting == MERLIN_UNKNOWN_LIGHTS ? NULL : &l);
    }
    if (s == MERLIN_OK || !w->capture) return s;
    merlin_capture_free(w->capture);
    w->capture = NULL;
    return s;
}

/* ---- surfaces ---- */

/* FNV-1a */
static uint64_t sum_of(uint64_t sum, const void *data, size_t size)
{
    const unsigned char *bytes = data;
    for (size_t i = 0; i < size; i++)
        sum = (sum ^ bytes[i]) * 0x100000001b3;
    return sum;
}

static const char *is_as_ever(work *w, uint64_t sum)
{
    bool other = w->first && sum != w->first;
    if (!w->first) w->first = sum;
    return other ? "another result than ever" : NULL;
}

static int solve(void *context)
{
    work *w = context;
    memset(&w->made, 1, sizeof w->made);
    return merlin_stereo(w->capture, &w->params, &w->made);
}

static const char *check_surface(void *context, int result)
{
    work *w = context;
    merlin_surface *s = &w->made;
    const merlin_image *images[] = {&s->normal, &s->albedo, &s->depth, &s->residual, &s->mask};
    uint64_t sum = 1;
    if (result != MERLIN_OK) {
        for (size_t i = 0; i < sizeof *s; i++)
            if (((const char *)s)[i]) return "a surface";
        return NULL;
    }
    for (size_t i = 0; i < sizeof images / sizeof *images; i++)
        sum = sum_of(sum, images[i]->data, PIXELS * (size_t)images[i]->channels * sizeof(float));
    for (size_t i = 0; i < s->warnings.count; i++)
        sum = sum_of(sum, s->warnings.at[i].code, strlen(s->warnings.at[i].code));
    merlin_surface_free(s);
    return is_as_ever(w, sum);
}

static int write_mesh(void *context)
{
    const work *w = context;
    merlin_mesh mesh;
    merlin_files written;
    int result = merlin_mesh_from_surface(&w->made, &mesh);
    if (result == MERLIN_OK) result = merlin_mesh_write(&mesh, w->mesh, &written);
    if (result == MERLIN_OK) merlin_files_free(&written);
    merlin_mesh_free(&mesh);
    return result;
}

static const char *check_mesh(void *context, int result)
{
    work *w = context;
    char **names = NULL;
    size_t count = 0;
    uint64_t sum = 1;
    assert_int_equal(file_list(scratch, NULL, &names, &count), OK);
    for (size_t i = 0; i < count; i++) {
        char *data;
        size_t size;
        assert_int_equal(file_read(names[i], 1 << 24, &data, &size), OK);
        sum = sum_of(sum_of(sum, names[i], strlen(names[i])), data, size);
        free(data);
        assert_int_equal(unlink(names[i]), 0);
    }
    file_list_free(names, count);
    if (result == MERLIN_OK) return is_as_ever(w, sum);
    return count ? "files" : NULL;
}

/* ---- the tests ---- */

static const char *check_capture(void *context, int result)
{
    work *w = context;
    const char *fault = result != MERLIN_OK && w->capture ? "a capture" : NULL;
    merlin_capture_free(w->capture);
    w->capture = NULL;
    return fault;
}

static void without_memory_no_pictures_are_taken(void **state)
{
    (void)state;
    work w = work_of(MERLIN_DISTANT_LIGHTS, (merlin_stereo_params){0});
    each_allocation_fails(&(memory_trial){"capture", new_capture, check_capture, &w});
    work_end(&w);
}

static void solves_or_reports(const char *name, merlin_lighting lighting, merlin_stereo_params params)
{
    work w = work_of(lighting, params);
    assert_int_equal(new_capture(&w), MERLIN_OK);
    each_allocation_fails(&(memory_trial){name, solve, check_surface, &w});
    work_end(&w);
}

static void without_memory_no_method_gives_a_surface(void **state)
{
    (void)state;
    const merlin_lighting distant = MERLIN_DISTANT_LIGHTS, near = MERLIN_NEAR_LIGHTS, unknown = MERLIN_UNKNOWN_LIGHTS;
    solves_or_reports("least squares", distant, (merlin_stereo_params){.method = MERLIN_STEREO_LS});
    solves_or_reports("edges", distant, (merlin_stereo_params){.method = MERLIN_STEREO_LS, .keep_edges = 1});
    solves_or_reports("robust", distant, (merlin_stereo_params){.method = MERLIN_STEREO_ROBUST, .unchecked = 1});
    solves_or_reports("semi", distant, (merlin_stereo_params){.method = MERLIN_STEREO_SEMI, .iterations = 1});
    solves_or_reports("near", near,
                      (merlin_stereo_params){.method = MERLIN_STEREO_NEAR, .integrate = 1, .iterations = 1});
    solves_or_reports("uncalibrated", unknown, (merlin_stereo_params){.method = MERLIN_STEREO_UNCALIBRATED});
}

static void without_memory_no_mesh_is_left(void **state)
{
    (void)state;
    static const char *const names[] = {"mesh.ply", "mesh.obj", "mesh.glb", "mesh.usda"};
    work w = work_of(MERLIN_DISTANT_LIGHTS, (merlin_stereo_params){.method = MERLIN_STEREO_LS});
    assert_int_equal(new_capture(&w), MERLIN_OK);
    assert_int_equal(solve(&w), MERLIN_OK);
    for (size_t i = 0; i < sizeof names / sizeof *names; i++) {
        w.mesh = scratch_path(names[i]);
        w.first = 0;
        each_allocation_fails(&(memory_trial){names[i], write_mesh, check_mesh, &w});
    }
    merlin_surface_free(&w.made);
    work_end(&w);
}

/* ---- folders of pictures ---- */

typedef struct folder_work {
    merlin_capture *capture;
    merlin_calibration found;
    uint64_t first;
} folder_work;

/* Writes pictures of the ball and the list of their lights into the test's folder. */
static void write_ball(int side)
{
    FILE *list = fopen(scratch_path("lights.txt"), "w");
    assert_non_null(list);
    for (int k = 0; k < FOLDER_LIGHTS; k++) {
        const merlin_light l = light_at(k, MERLIN_DISTANT_LIGHTS);
        char name[32];
        snprintf(name, sizeof name, "ball%d.png", k);
        merlin_image small = picture_under(&l, false), picture;
        assert_int_equal(merlin_image_resize(&small, side, side, &picture), MERLIN_OK);
        assert_int_equal(merlin_image_write(scratch_path(name), &picture), MERLIN_OK);
        free(small.data);
        fprintf(list, "%g %g %g\n", (double)l.direction[0], (double)l.direction[1], (double)l.direction[2]);
        free(picture.data);
    }
    assert_int_equal(fclose(list), 0);
}

static int read_capture(void *context)
{
    folder_work *w = context;
    return merlin_capture_read(scratch, NULL, &w->capture);
}

static const char *check_read(void *context, int result)
{
    folder_work *w = context;
    const char *fault = (result == MERLIN_OK) == (w->capture != NULL) ? NULL : "a capture";
    merlin_capture_free(w->capture);
    w->capture = NULL;
    return fault;
}

static int calibrate(void *context)
{
    folder_work *w = context;
    return merlin_calibrate(scratch, &(merlin_calibrate_params){.ball = MERLIN_MATTE_BALL}, &w->found);
}

static const char *check_calibration(void *context, int result)
{
    folder_work *w = context;
    const char *fault = NULL;
    if (result == MERLIN_OK) {
        uint64_t sum = sum_of(1, w->found.lights, (size_t)w->found.count * sizeof *w->found.lights);
        if (w->first && sum != w->first) fault = "other lights than ever";
        w->first = sum;
    } else if (w->found.count || w->found.lights || w->found.names || w->found.brightest.data) {
        fault = "a calibration";
    }
    merlin_calibration_free(&w->found);
    return fault;
}

static void without_memory_no_folder_is_read(void **state)
{
    (void)state;
    folder_work w = {0};
    write_ball(SIDE);
    each_allocation_fails(&(memory_trial){"capture folder", read_capture, check_read, &w});
}

static void without_memory_no_light_is_calibrated(void **state)
{
    (void)state;
    folder_work w = {0};
    write_ball(4 * SIDE); /* a ball of fewer pixels is none */
    each_allocation_fails(&(memory_trial){"calibration", calibrate, check_calibration, &w});
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(without_memory_no_pictures_are_taken),
        cmocka_unit_test(without_memory_no_method_gives_a_surface),
        in_scratch(without_memory_no_mesh_is_left),
        in_scratch(without_memory_no_folder_is_read),
        in_scratch(without_memory_no_light_is_calibrated),
    };
    merlin_set_threads(1); /* the n-th allocation is the same one each time */
    return cmocka_run_group_tests(tests, NULL, NULL);
}
