/* SPDX-License-Identifier: MIT */
/* include/merlin/stereo.h, by pictures of a ball that are made here and read from a folder. */
#include "merlin/stereo.h"

#include <math.h>

#include "capture_files.h"
#include "image/image.h"
#include "image/write/write.h"
#include "merlin/mesh.h"

enum { SIZE = 64, LIGHTS = 12, PIXELS = SIZE * SIZE };
static const float RADIUS = 28, ALBEDO[3] = {0.6f, 0.4f, 0.2f};

static merlin_image image_new(int channels)
{
    return (merlin_image){SIZE, SIZE, channels, calloc((size_t)(PIXELS * channels), sizeof(float))};
}

/* Toward the viewer, up to 60 degrees off. */
static bool normal_at(int i, float n[3])
{
    float x = ((float)(i % SIZE) + 0.5f - SIZE / 2.0f) / RADIUS, y = (SIZE / 2.0f - (float)(i / SIZE) - 0.5f) / RADIUS;
    n[0] = x;
    n[1] = y;
    n[2] = sqrtf(fmaxf(1 - x * x - y * y, 0));
    return n[2] > 0.5f;
}

/* On a ring 30 degrees about the axis, so that no shadow falls on the ball's front. */
static merlin_light light_at(int k)
{
    float phi = 6.2831853f * (float)k / LIGHTS;
    return (merlin_light){.direction = {cosf(phi), sinf(phi), 1.7320508f}, .intensity = {0.5f + 0.04f * (float)k}};
}

static merlin_image picture_under(merlin_light l, int channels)
{
    merlin_image p = image_new(channels);
    for (int i = 0; i < PIXELS; i++) {
        float n[3];
        if (!normal_at(i, n)) continue;
        float shade = (l.direction[0] * n[0] + l.direction[1] * n[1] + l.direction[2] * n[2]) / 2; /* its length */
        for (int c = 0; c < channels; c++)
            p.data[channels * i + c] = fmaxf(shade, 0) * ALBEDO[c] * l.intensity[channels == 1 ? 0 : c];
    }
    return p;
}

static void add_pictures(merlin_capture *capture, int channels)
{
    for (int k = 0; k < LIGHTS; k++) {
        merlin_light l = light_at(k);
        l.intensity[1] = l.intensity[2] = l.intensity[0];
        merlin_image p = picture_under(l, channels);
        assert_int_equal(merlin_capture_add(capture, &p, &l), MERLIN_OK);
        merlin_image_free(&p);
    }
}

/* Mean angle to the ball's normals, in degrees, over what the surface's mask has of them. */
static float mean_error(const merlin_surface *s)
{
    double sum = 0;
    int count = 0;
    for (int i = 0; i < PIXELS; i++) {
        float n[3];
        const float *found = s->normal.data + 3 * i;
        if (s->mask.data[i] == 0 || !normal_at(i, n)) continue;
        float cosine = n[0] * found[0] + n[1] * found[1] + n[2] * found[2];
        sum += 57.29578 * (double)acosf(fminf(cosine, 1));
        count++;
    }
    assert_true(count > 1000);
    return (float)(sum / count);
}

static void pictures_in_memory_become_a_surface(void **state)
{
    (void)state;
    for (int channels = 1; channels <= 3; channels += 2) {
        merlin_capture *capture;
        merlin_surface surface;
        assert_int_equal(merlin_capture_new(NULL, NULL, &capture), MERLIN_OK);
        add_pictures(capture, channels);
        const merlin_stereo_params ls = {.method = MERLIN_STEREO_LS};
        assert_int_equal(merlin_stereo(capture, &ls, &surface), MERLIN_OK);
        assert_int_equal(surface.method, MERLIN_STEREO_LS);
        assert_true(mean_error(&surface) < 0.05f); /* 16 bits a value */
        for (int c = 0; c < channels; c++)
            assert_float_equal(surface.albedo.data[channels * (PIXELS + SIZE) / 2 + c], ALBEDO[c], 1e-3f);
        assert_int_equal(surface.albedo.channels, channels);
        assert_float_equal(surface.mask.data[0], 0, 0);
        assert_true(surface.residual.data[(PIXELS + SIZE) / 2] < 1e-3f);
        /* the ball's top is nearer than its rim at 60 degrees, by half its radius */
        float top = surface.depth.data[(PIXELS + SIZE) / 2], rim = surface.depth.data[PIXELS / 2 + 8];
        assert_float_equal(rim - top, RADIUS / 2, 0.1f * RADIUS);
        assert_true(surface.camera.focal == 0);
        assert_null(surface.lights);
        merlin_surface_free(&surface);
        assert_int_equal(merlin_stereo(capture, NULL, &surface), MERLIN_OK);
        assert_int_equal(surface.method, MERLIN_STEREO_ROBUST);
        assert_true(mean_error(&surface) < 0.2f);
        merlin_surface_free(&surface);
        merlin_capture_free(capture);
    }
}

static void unknown_strengths_are_found(void **state)
{
    (void)state;
    merlin_capture *capture;
    merlin_surface surface;
    const merlin_capture_params params = {.unknown_intensities = 1};
    assert_int_equal(merlin_capture_new(&params, NULL, &capture), MERLIN_OK);
    add_pictures(capture, 3);
    assert_int_equal(merlin_stereo(capture, NULL, &surface), MERLIN_OK);
    assert_int_equal(surface.method, MERLIN_STEREO_SEMI);
    assert_true(mean_error(&surface) < 1);
    assert_int_equal(surface.light_count, LIGHTS);
    float ratio = surface.lights[LIGHTS - 1].intensity[0] / surface.lights[0].intensity[0];
    assert_float_equal(ratio, (0.5f + 0.04f * (LIGHTS - 1)) / 0.5f, 0.05f);
    merlin_surface_free(&surface);
    merlin_capture_free(capture);
}

/* Waves that fill the picture, whose crests may as well be troughs. */
static merlin_image waves_under(int k)
{
    merlin_image p = image_new(1);
    float z = 1 - 0.5f * ((float)k + 0.5f) / LIGHTS, aside = sqrtf(1 - z * z), turn = 2.4f * (float)k;
    for (int i = 0; i < PIXELS; i++) {
        float x = 0.6f * sinf(0.4f * (float)(i % SIZE)), y = 0.5f * sinf(0.3f * (float)(i / SIZE));
        float shade = (x * aside * cosf(turn) + y * aside * sinf(turn) + z) / sqrtf(x * x + y * y + 1);
        p.data[i] = ALBEDO[0] * fmaxf(shade, 0);
    }
    return p;
}

static bool has_warning(const merlin_surface *s, const char *code)
{
    for (size_t i = 0; i < s->warnings.count; i++)
        if (strcmp(s->warnings.at[i].code, code) == 0) return strlen(s->warnings.at[i].message) > 10;
    return false;
}

static void lights_that_do_not_fit_are_told(void **state)
{
    (void)state;
    merlin_capture *capture;
    merlin_surface surface;
    assert_int_equal(merlin_capture_new(NULL, NULL, &capture), MERLIN_OK);
    for (int k = 0; k < LIGHTS; k++) {
        merlin_light l = light_at(k), other = light_at((5 * k + 1) % LIGHTS);
        memcpy(l.intensity, (const float[3]){0.9f, 0.9f, 0.9f}, sizeof l.intensity);
        merlin_image p = picture_under(l, 1);
        assert_int_equal(merlin_capture_add(capture, &p, &other), MERLIN_OK);
        merlin_image_free(&p);
    }
    assert_int_equal(merlin_stereo(capture, NULL, &surface), MERLIN_OK);
    assert_true(has_warning(&surface, "lights_do_not_fit"));
    merlin_surface_free(&surface);
    assert_int_equal(merlin_stereo(capture, &(merlin_stereo_params){.unchecked = 1}, &surface), MERLIN_OK);
    assert_int_equal(surface.warnings.count, 0);
    merlin_surface_free(&surface);
    merlin_capture_free(capture);
}

static void doubts_about_unknown_lights_are_told(void **state)
{
    (void)state;
    merlin_capture *capture;
    merlin_surface surface;
    const merlin_capture_params params = {.lighting = MERLIN_UNKNOWN_LIGHTS};
    assert_int_equal(merlin_capture_new(&params, NULL, &capture), MERLIN_OK);
    for (int k = 0; k < LIGHTS; k++) {
        merlin_image p = waves_under(k);
        assert_int_equal(merlin_capture_add(capture, &p, NULL), MERLIN_OK);
        merlin_image_free(&p);
    }
    assert_int_equal(merlin_stereo(capture, NULL, &surface), MERLIN_OK);
    assert_int_equal(surface.method, MERLIN_STEREO_UNCALIBRATED);
    assert_true(surface.lights_unsure);
    assert_true(has_warning(&surface, "lights_unsure"));
    merlin_surface_free(&surface);
    merlin_capture_free(capture);
}

/* A wall at distance 2, lit by LEDs beside the camera. */
static merlin_image wall_under(const merlin_light *l)
{
    merlin_image p = image_new(1);
    float focal = SIZE / 2.0f / tanf(0.523598776f);
    for (int i = 0; i < PIXELS; i++) {
        float x = 2 * ((float)(i % SIZE) + 0.5f - SIZE / 2.0f) / focal;
        float y = 2 * (SIZE / 2.0f - (float)(i / SIZE) - 0.5f) / focal;
        float d[3] = {l->position[0] - x, l->position[1] - y, l->position[2] + 2};
        float square = d[0] * d[0] + d[1] * d[1] + d[2] * d[2];
        p.data[i] = ALBEDO[0] * l->intensity[0] * d[2] / (square * sqrtf(square));
    }
    return p;
}

static void near_lights_and_their_camera_are_taken(void **state)
{
    (void)state;
    merlin_capture *capture;
    merlin_surface surface;
    const merlin_capture_params params = {.lighting = MERLIN_NEAR_LIGHTS, .distance = 2};
    assert_int_equal(merlin_capture_new(&params, NULL, &capture), MERLIN_OK);
    for (int k = 0; k < LIGHTS; k++) {
        float phi = 6.2831853f * (float)k / LIGHTS, ring = k % 2 ? 0.5f : 1;
        merlin_light l = {.position = {ring * cosf(phi), ring * sinf(phi), 0}, .intensity = {3}};
        merlin_image p = wall_under(&l);
        assert_int_equal(merlin_capture_add(capture, &p, &l), MERLIN_OK);
        merlin_image_free(&p);
    }
    assert_int_equal(merlin_stereo(capture, NULL, &surface), MERLIN_OK);
    assert_int_equal(surface.method, MERLIN_STEREO_NEAR);
    assert_float_equal(surface.camera.focal, SIZE / 2.0f / tanf(0.523598776f), 1e-3f);
    int middle = (PIXELS + SIZE) / 2;
    assert_true(surface.normal.data[3 * middle + 2] > 0.9998f); /* 1 degree */
    assert_float_equal(surface.depth.data[middle], 2, 0.04f);
    assert_float_equal(surface.albedo.data[middle], ALBEDO[0], 0.03f);
    merlin_surface_free(&surface);
    merlin_capture_free(capture);
}

static void mask_says_what_is_solved(void **state)
{
    (void)state;
    merlin_image mask = image_new(1);
    for (int i = 0; i < PIXELS; i++)
        mask.data[i] = i % SIZE < SIZE / 2 ? 0.5f : 0.49f;
    merlin_capture *capture;
    merlin_surface surface;
    assert_int_equal(merlin_capture_new(NULL, &mask, &capture), MERLIN_OK);
    merlin_image_free(&mask);
    add_pictures(capture, 1);
    assert_int_equal(merlin_stereo(capture, NULL, &surface), MERLIN_OK);
    int middle = (PIXELS + SIZE) / 2;
    assert_float_equal(surface.mask.data[middle - 1], 1, 0);
    assert_float_equal(surface.mask.data[middle], 0, 0);
    assert_true(surface.normal.data[3 * (middle - 1) + 2] > 0.9f);
    assert_true(surface.normal.data[3 * middle + 2] == 0);
    merlin_surface_free(&surface);
    merlin_capture_free(capture);
}

static void write_folder(void)
{
    char lights[64 * LIGHTS] = "";
    for (int k = 0; k < LIGHTS; k++) {
        merlin_light l = light_at(k);
        l.intensity[0] = l.intensity[1] = l.intensity[2] = 0.9f;
        merlin_image p = picture_under(l, 3);
        img inside = {SIZE, SIZE, 3, p.data};
        char name[32];
        snprintf(name, sizeof name, "%02d.png", k);
        assert_int_equal(img_write_png(scratch_path(name), &inside, IMG_LINEAR16), OK);
        merlin_image_free(&p);
        size_t used = strlen(lights);
        snprintf(lights + used, sizeof lights - used, "%g %g %g\n", (double)l.direction[0], (double)l.direction[1],
                 (double)l.direction[2]);
    }
    write_text("lights.txt", lights);
}

/* The ball's triangles look at the camera, its normals lie near theirs, and each vertex has what its pixel has. */
static void check_mesh(const merlin_mesh *m, const merlin_surface *s)
{
    size_t pixels = 0;
    for (int i = 0; i < PIXELS; i++)
        pixels += s->mask.data[i] > 0.5f;
    assert_int_equal(m->vertex_count, pixels);
    assert_true(m->triangle_count > pixels && m->triangle_count < 2 * pixels);
    for (size_t v = 0; v < m->vertex_count; v++) {
        const float *n = m->normals + 3 * v, *face = m->face_normals + 3 * v, *p = m->positions + 3 * v;
        const uint32_t pixel = m->pixels[v];
        for (size_t k = 0; k < 3; k++) /* made unit once more, to a float's precision */
            assert_float_equal(n[k], s->normal.data[(size_t)3 * pixel + k], 1e-6f);
        assert_true(face[2] > 0 && n[0] * face[0] + n[1] * face[1] + n[2] * face[2] > 0.8f);
        assert_true(p[2] == -s->depth.data[pixel]);
        assert_float_equal(m->uvs[2 * v] * SIZE, (float)(pixel % SIZE) + 0.5f, 1e-4f);
        assert_float_equal(m->uvs[2 * v + 1] * SIZE, (float)(pixel / SIZE) + 0.5f, 1e-4f);
        assert_memory_equal(m->colors + 3 * v, m->albedo.data + (size_t)3 * pixel, 3 * sizeof *n);
    }
    assert_float_equal(m->scale, 1.0 / SIZE, 0);
}

static void folder_becomes_a_mesh(void **state)
{
    (void)state;
    write_folder();
    merlin_capture *capture;
    merlin_surface surface;
    merlin_mesh mesh;
    merlin_files written;
    assert_int_equal(merlin_capture_read(scratch, NULL, &capture), MERLIN_OK);
    assert_int_equal(merlin_stereo(capture, &(merlin_stereo_params){.keep_edges = 1}, &surface), MERLIN_OK);
    assert_true(mean_error(&surface) < 0.2f);
    merlin_capture_free(capture);
    assert_int_equal(merlin_mesh_from_surface(&surface, &mesh), MERLIN_OK);
    check_mesh(&mesh, &surface);
    const char *const names[] = {"ball.ply", "ball.OBJ", "ball.glb"};
    for (int i = 0; i < 3; i++) {
        assert_int_equal(merlin_mesh_write(&mesh, scratch_path(names[i]), &written), MERLIN_OK);
        assert_int_equal(written.count, i == 1 ? 3 : 1);
        for (size_t k = 0; k < written.count; k++)
            assert_true(file_exists(written.at[k]));
        assert_true(written.bytes > 1000);
        merlin_files_free(&written);
    }
    assert_int_equal(merlin_mesh_write(&mesh, scratch_path("ball.stl"), &written), MERLIN_WRONG_USE);
    assert_says(".stl");
    assert_int_equal(written.count, 0);
    assert_int_equal(merlin_mesh_write(&mesh, scratch_path("nowhere/ball.glb"), NULL), MERLIN_CANNOT_WRITE);
    assert_says("nowhere/ball.glb: No such"); /* not a temporary file's name */
    mesh.triangles[4] = (uint32_t)mesh.vertex_count;
    assert_int_equal(merlin_mesh_write(&mesh, scratch_path("none.ply"), NULL), MERLIN_WRONG_USE);
    merlin_mesh_free(&mesh);
    assert_int_equal(merlin_mesh_write(&mesh, scratch_path("none.ply"), NULL), MERLIN_WRONG_USE);
    assert_false(file_exists(scratch_path("none.ply")));
    merlin_surface_free(&surface);
    assert_int_equal(merlin_mesh_from_surface(&surface, &mesh), MERLIN_WRONG_USE);
    assert_null(mesh.positions);
    assert_int_equal(merlin_capture_read(scratch_path("nowhere"), NULL, &capture), MERLIN_BAD_INPUT);
    assert_null(capture);
    static const float no_view[] = {NAN, -20, 200};
    for (int i = 0; i < 3; i++)
        assert_int_equal(merlin_capture_read(scratch, &(merlin_capture_files){.field_of_view = no_view[i]}, &capture),
                         MERLIN_WRONG_USE);
    assert_int_equal(merlin_capture_read(scratch, &(merlin_capture_files){.distance = -1}, &capture), MERLIN_WRONG_USE);
    assert_null(capture);
}

static int give_up(void)
{
    return 1;
}

static void hear(void *context, const char *stage, float share)
{
    assert_true(strcmp(stage, "solving") == 0 || strcmp(stage, "integrating") == 0);
    assert_true(share >= 0 && share <= 1);
    ++*(int *)context;
}

static void progress_is_heard_and_work_stops(void **state)
{
    (void)state;
    merlin_capture *capture;
    merlin_surface surface;
    int heard = 0;
    merlin_stereo_params params = {.progress = hear, .progress_context = &heard};
    assert_int_equal(merlin_capture_new(NULL, NULL, &capture), MERLIN_OK);
    add_pictures(capture, 1);
    assert_int_equal(merlin_stereo(capture, &params, &surface), MERLIN_OK);
    assert_true(heard > 2);
    merlin_surface_free(&surface);
    params.stop = give_up;
    assert_int_equal(merlin_stereo(capture, &params, &surface), MERLIN_STOPPED);
    assert_null(surface.normal.data);
    merlin_capture_free(capture);
}

static void wrong_use_is_named(void **state)
{
    (void)state;
    merlin_capture *capture;
    merlin_surface surface;
    merlin_image picture = image_new(3), grey = image_new(1), small = {8, 8, 3, picture.data}, two = picture,
                 none = {0};
    merlin_light light = light_at(0), lost = {.direction = {NAN, 0, 1}}, still = {0};
    two.channels = 2;
    assert_int_equal(merlin_capture_new(&(merlin_capture_params){.lighting = (merlin_lighting)9}, NULL, &capture),
                     MERLIN_WRONG_USE);
    assert_int_equal(merlin_capture_new(&(merlin_capture_params){.field_of_view = NAN}, NULL, &capture),
                     MERLIN_WRONG_USE);
    assert_int_equal(merlin_capture_new(&(merlin_capture_params){.distance = -1}, NULL, &capture), MERLIN_WRONG_USE);
    assert_int_equal(merlin_capture_new(NULL, &picture, &capture), MERLIN_WRONG_USE);
    assert_null(capture);
    assert_int_equal(merlin_capture_new(NULL, NULL, NULL), MERLIN_WRONG_USE);
    assert_int_equal(merlin_capture_new(NULL, NULL, &capture), MERLIN_OK);
    assert_int_equal(merlin_stereo(capture, NULL, &surface), MERLIN_WRONG_USE);
    assert_says("no pictures");
    assert_int_equal(merlin_capture_add(capture, &picture, NULL), MERLIN_WRONG_USE);
    assert_int_equal(merlin_capture_add(capture, &picture, &lost), MERLIN_WRONG_USE);
    assert_int_equal(merlin_capture_add(capture, &picture, &still), MERLIN_WRONG_USE);
    assert_int_equal(merlin_capture_add(capture, &two, &light), MERLIN_WRONG_USE);
    assert_int_equal(merlin_capture_add(capture, &none, &light), MERLIN_WRONG_USE);
    assert_says("no pixels");
    assert_int_equal(merlin_capture_add(capture, &picture, &light), MERLIN_OK);
    assert_int_equal(merlin_capture_add(capture, &small, &light), MERLIN_WRONG_USE);
    assert_says("8 x 8");
    assert_int_equal(merlin_capture_add(capture, &grey, &light), MERLIN_WRONG_USE);
    picture.data[5] = NAN;
    assert_int_equal(merlin_capture_add(capture, &picture, &light), MERLIN_BAD_INPUT);
    assert_says("not finite");
    assert_int_equal(merlin_stereo(capture, NULL, &surface), MERLIN_BAD_INPUT);
    assert_says("3 or more lights");
    assert_int_equal(merlin_stereo(capture, &(merlin_stereo_params){.method = (merlin_stereo_method)9}, &surface),
                     MERLIN_WRONG_USE);
    assert_null(surface.normal.data);
    merlin_surface_free(&surface);
    merlin_surface_free(NULL);
    merlin_capture_free(capture);
    merlin_capture_free(NULL);
    merlin_image_free(&picture);
    merlin_image_free(&grey);
}

/* Where squares of the albedo are no floats any more the search for a lobe found no end; strange units are fine. */
static void lights_of_absurd_strengths_are_refused(void **state)
{
    (void)state;
    static const float absurd[] = {1e-30f, 1e30f, 1e-12f, 1e12f};
    for (int i = 0; i < 4; i++) {
        merlin_capture *capture;
        merlin_surface surface;
        assert_int_equal(merlin_capture_new(NULL, NULL, &capture), MERLIN_OK);
        for (int k = 0; k < LIGHTS; k++) {
            merlin_light l = light_at(k);
            merlin_image p = picture_under(l, 1);
            l.intensity[0] *= absurd[i];
            assert_int_equal(merlin_capture_add(capture, &p, &l), MERLIN_OK);
            merlin_image_free(&p);
        }
        if (i < 2) {
            assert_int_equal(merlin_stereo(capture, NULL, &surface), MERLIN_BAD_INPUT);
            assert_says("light 1 has the intensity");
        } else {
            assert_int_equal(merlin_stereo(capture, NULL, &surface), MERLIN_OK);
            assert_true(mean_error(&surface) < 0.5f);
        }
        merlin_surface_free(&surface);
        merlin_capture_free(capture);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(pictures_in_memory_become_a_surface),
        cmocka_unit_test(unknown_strengths_are_found),
        cmocka_unit_test(lights_that_do_not_fit_are_told),
        cmocka_unit_test(doubts_about_unknown_lights_are_told),
        cmocka_unit_test(near_lights_and_their_camera_are_taken),
        cmocka_unit_test(mask_says_what_is_solved),
        in_scratch(folder_becomes_a_mesh),
        cmocka_unit_test(progress_is_heard_and_work_stops),
        cmocka_unit_test(wrong_use_is_named),
        cmocka_unit_test(lights_of_absurd_strengths_are_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
