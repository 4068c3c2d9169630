/* SPDX-License-Identifier: MIT */
/* Photographs under mixtures of light: sums of rendered images, and their ground truth. */
#include "lab/train/samples/mixture.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/file.h"
#include "lab/render/generate.h"
#include "optics/light.h"
#include "optics/orientation.h"
#include "scratch.h"

/* last, as cmocka defines a macro named fail */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

/* Kinds of light as often as by default. */
static const train_config usual = {.flash_alone = 1.0 / 3};

enum { SIZE = 64, PIXELS = SIZE * SIZE, SAMPLES = 4, FLOATS = 108 * PIXELS };

typedef struct fixture {
    char *folder;
    train_dataset *data;
    float *memory;
    train_view view;
} fixture;

static void place(fixture *f)
{
    float *at = f->memory;
    train_view *v = &f->view;
    v->size = SIZE;
    const struct {
        float **where;
        size_t floats;
    } fields[] = {
        {&v->albedo, 3 * PIXELS},
        {&v->normal, 3 * PIXELS},
        {&v->direct, 3 * PIXELS},
        {&v->indirect, 3 * PIXELS},
        {&v->env, 3 * PIXELS},
        {&v->image, 3 * PIXELS},
        {&v->relit, 3 * PIXELS},
        {&v->reconstruction, 3 * PIXELS},
        {&v->photo, 3 * PIXELS},
        {&v->roughness, PIXELS},
        {&v->depth, PIXELS},
        {&v->mask, PIXELS},
        {&v->loss_mask, PIXELS},
        {&v->visibility, PIXELS},
        {&v->sight, 4 * PIXELS},
        {&v->visibility_weight, PIXELS},
        {&v->lamps, TRAIN_LAMPS * TRAIN_LAMP_VALUES * PIXELS},
        {&v->sh, 27},
        {&v->light, 3},
        {&v->lens_values, 3},
        {&v->lights, MODEL_LIGHTS},
        {&v->lamp_weight, 1},
        {&v->rest_weight, 1},
    };
    for (size_t i = 0; i < sizeof fields / sizeof *fields; i++) {
        *fields[i].where = at;
        at += fields[i].floats;
    }
    assert_true(at <= f->memory + FLOATS);
}

static int set_up(void **state)
{
    fixture *f = calloc(1, sizeof *f);
    render_options o = render_options_default();
    render_stats stats;
    assert_non_null(f);
    f->folder = scratch_new();
    o.folder = f->folder;
    o.count = SAMPLES;
    o.image = (image_settings){.size = SIZE, .fov = 10, .strata = 2, .paths = 1, .lamps = 3};
    o.widest_fov = 70;
    o.off_axis = 20;
    o.quiet = true;
    assert_int_equal(render_samples(&o, &stats), OK);
    render_stats_free(&stats);
    f->memory = calloc(FLOATS, sizeof(float));
    assert_non_null(f->memory);
    place(f);
    const train_dataset_options options = {.size = SIZE, .memory_gib = 1, .lamps = true};
    if (train_dataset_open(f->folder, &options, &f->data) != OK) fail_msg("%s", status_message());
    *state = f;
    return 0;
}

static int tear_down(void **state)
{
    fixture *f = *state;
    train_dataset_close(f->data);
    scratch_remove(f->folder);
    free(f->memory);
    free(f);
    return 0;
}

static void prepare(fixture *f, const train_mixture *m, const train_camera *lens)
{
    rng noise = rng_at(1, 2, 3);
    assert_int_equal(train_prepare_any(&f->view, m, lens, vec3_make(0.5f, 0, -0.2f), &noise), OK);
}

/* Decodes what the network sees back to radiance. */
static float shown(const train_view *v, size_t value)
{
    return v->image[value] * v->image[value];
}

static void a_photograph_is_the_sum_of_its_lights(void **state)
{
    fixture *f = *state;
    train_view *v = &f->view;
    train_camera lens = train_camera_perfect();
    lens.white = 1000;
    const float gain = 0.01f;
    lens.gain[0] = lens.gain[1] = lens.gain[2] = gain;
    const train_mixture m = {.kind = TRAIN_MIXED,
                             .flash = {1, 2, 3},
                             .room = {2, 1, 1},
                             .lamp = {{0}, {1, 1, 4}},
                             .strongest = 1,
                             .presence = 1};
    assert_int_equal(train_dataset_get(f->data, 0, 0, v), OK);
    float *raw = malloc(FLOATS * sizeof(float));
    memcpy(raw, f->memory, FLOATS * sizeof(float));
    prepare(f, &m, &lens);
    const float *direct = raw + (v->direct - f->memory), *indirect = raw + (v->indirect - f->memory),
                *env = raw + (v->env - f->memory), *second = raw + (v->lamps - f->memory) + 4 * PIXELS;
    size_t seen = 0;
    for (size_t i = 0; i < PIXELS; i++) {
        if (v->mask[i] == 0) continue;
        float blue = 3 * (direct[3 * i + 2] + indirect[3 * i + 2]) + env[3 * i + 2] + 4 * second[4 * i + 2];
        float red = direct[3 * i] + indirect[3 * i] + 2 * env[3 * i] + second[4 * i];
        assert_true(fabsf(shown(v, 3 * i + 2) - gain * blue) < 1e-4f * (1 + blue));
        assert_true(fabsf(shown(v, 3 * i) - gain * red) < 1e-4f * (1 + red));
        seen++;
    }
    assert_true(seen > PIXELS / 10);
    free(raw);
}

/* The lamp of the ground truth, applied to the maps with its visibility, gives the photograph in any orientation. */
static void the_truth_about_a_lamp_makes_the_photograph(void **state)
{
    fixture *f = *state;
    train_view *v = &f->view;
    train_camera lens = train_camera_perfect();
    size_t right = 0, total = 0;
    lens.white = 1000;
    for (int orientation = 0; orientation < ORIENTATIONS; orientation++) {
        size_t close = 0, all = 0;
        train_mixture m = {.kind = TRAIN_MIXED, .strongest = orientation % 3, .presence = 1};
        m.lamp[m.strongest] = vec3_make(0.5f, 0.25f, 0.25f);
        assert_int_equal(train_dataset_get(f->data, (size_t)orientation % SAMPLES, orientation, v), OK);
        prepare(f, &m, &lens);
        const float *code = v->lights, inverse = fmaxf(code[MODEL_LIGHTS_DISTANCE], 1e-3f);
        vec3 toward = vec3_of(code + MODEL_LIGHTS_LAMP);
        assert_true(fabsf(vec3_length(toward) - 1) < 1e-4f);
        const vec3 at = vec3_fma(vec3_make(0, 0, -1), 1 / inverse, toward);
        const float strength = model_decode_strength(code[MODEL_LIGHTS_STRENGTH + 1]);
        assert_true(fabsf(strength - 0.25f) < 1e-4f && code[MODEL_LIGHTS_FLASH] == 0);
        for (size_t i = 0; i < PIXELS; i++) {
            if (v->visibility_weight[i] == 0 || v->visibility[i] < 0.99f) continue;
            float x = (float)(i % SIZE) + 0.5f, y = (float)(i / SIZE) + 0.5f;
            float relief = v->lens_values[0] / camera_tangent(CAMERA_FOV);
            shade_input in = {.albedo = vec3_make(0.5f * v->albedo[3 * i] + 0.5f, 0.5f * v->albedo[3 * i + 1] + 0.5f,
                                                  0.5f * v->albedo[3 * i + 2] + 0.5f),
                              .roughness = 0.5f * v->roughness[i] + 0.5f,
                              .normal = vec3_of(v->normal + 3 * i),
                              .depth = 1 + (v->depth[i] - 1) * relief,
                              .ray = camera_point(&v->lens, x, y, 1),
                              .light = at,
                              .power = LIGHT_POWER * strength / (inverse * inverse)};
            float expected = shade_point(&in).y, found = shown(v, 3 * i + 1);
            if (expected > 0.9f * MODEL_BRIGHTEST) continue;             /* the input is clipped there */
            close += fabsf(found - expected) < 0.06f * expected + 0.01f; /* without bounces */
            all++;
        }
        total += all;
        right += close;
        assert_true(close * 10 >= all * 4); /* one of the samples has bounces as bright as its lamps */
    }
    assert_true(total > 0 && right * 10 >= total * 9);
}

static void kinds_come_as_often_as_they_should(void **state)
{
    fixture *f = *state;
    enum { DRAWS = 1200 };
    int kinds[3] = {0}, lamps = 0, told = 0, known = 0;
    for (int i = 0; i < DRAWS; i++) {
        rng r = rng_at(4, (uint64_t)i, 0);
        train_camera lens = train_camera_perfect();
        train_mixture m;
        if (i % 300 == 0) assert_int_equal(train_dataset_get(f->data, (size_t)i / 300, 0, &f->view), OK);
        train_mixture_draw(&f->view, &usual, &r, NULL, &lens, &m);
        kinds[m.kind]++;
        lamps += m.strongest >= 0;
        told += m.told_flash;
        known += m.lens_known;
        assert_true(!m.told_flash || m.kind == TRAIN_FLASH);
        assert_true(isfinite(lens.gain[0]) && lens.gain[0] > 0);
        assert_true(vec3_length(m.flash) + vec3_length(m.room) + (float)(m.strongest >= 0) > 0);
    }
    assert_true(abs(kinds[TRAIN_FLASH] - DRAWS / 3) < 60 && abs(kinds[TRAIN_ROOM] - DRAWS / 6) < 50);
    assert_true(lamps > DRAWS / 3 && lamps < DRAWS / 2 && told > DRAWS / 8 && told < DRAWS / 4);
    assert_true(abs(known - DRAWS * 3 / 4) < 60);
}

static void kinds_come_as_often_as_configured(void **state)
{
    fixture *f = *state;
    enum { DRAWS = 1200 };
    const train_config c = {.flash_alone = 0.05, .flash_in_room = 0.25, .lamp_alone = 0.5};
    int flash = 0, both = 0, alone = 0;
    assert_int_equal(train_dataset_get(f->data, 0, 0, &f->view), OK);
    for (int i = 0; i < DRAWS; i++) {
        rng r = rng_at(14, (uint64_t)i, 0);
        train_camera lens = train_camera_perfect();
        train_mixture m;
        train_mixture_draw(&f->view, &c, &r, NULL, &lens, &m);
        const bool lit = vec3_length(m.flash) > 0, room = vec3_length(m.room) > 0;
        flash += m.kind == TRAIN_FLASH;
        both += lit && room && m.strongest < 0;
        alone += !lit && !room && m.strongest >= 0 && m.presence == 1;
    }
    assert_true(abs(flash - DRAWS / 20) < 30 && abs(both - DRAWS / 4) < 60);
    assert_true(alone > DRAWS * 4 / 10 && alone < DRAWS * 11 / 20); /* a lamp behind the object lights nothing */
}

/* The flash or the room alone would repeat what a first picture shows. */
static void further_pictures_are_mixed(void **state)
{
    fixture *f = *state;
    assert_int_equal(train_dataset_get(f->data, 0, 0, &f->view), OK);
    for (int i = 0; i < 100; i++) {
        rng r = rng_at(4, (uint64_t)i, 0);
        train_camera lens = train_camera_perfect();
        train_mixture m;
        train_mixture_draw(&f->view, &usual, &r, &(train_capture){.picture = 1}, &lens, &m);
        assert_int_equal(m.kind, TRAIN_MIXED);
        assert_false(m.told_flash);
    }
}

/* Each picture has one lamp, another one than the last, and all have the same surroundings. */
static void a_torch_lights_each_picture_from_elsewhere(void **state)
{
    fixture *f = *state;
    int torches = 0, rooms = 0;
    assert_int_equal(train_dataset_get(f->data, 0, 0, &f->view), OK);
    for (int object = 0; object < 200; object++) {
        float room = 0;
        int last = -1;
        for (int picture = 0; picture < 4; picture++) {
            rng steady = rng_at(5, (uint64_t)object, 0), r = rng_at(5, (uint64_t)(4 * object + picture), 1);
            const train_capture capture = train_capture_draw(&steady, picture);
            train_camera lens = train_camera_perfect();
            train_mixture m;
            if (!capture.torch) continue;
            train_mixture_draw(&f->view, &usual, &r, &capture, &lens, &m);
            assert_int_equal(m.kind, TRAIN_MIXED);
            assert_true(m.flash.x == 0 && m.strongest >= 0 && m.strongest != last);
            assert_true(picture == 0 || m.room.x == room);
            last = m.strongest;
            room = m.room.x;
        }
        torches += last >= 0;
        rooms += room > 0;
    }
    assert_true(torches > 100 && torches < 140);
    assert_true(rooms > 40 && rooms < 80);
}

static void exposure_leaves_neither_darkness_nor_white_alone(void **state)
{
    fixture *f = *state;
    train_view *v = &f->view;
    for (int i = 0; i < 60; i++) {
        rng r = rng_at(9, (uint64_t)i, 0);
        train_camera lens = train_camera_perfect();
        train_mixture m;
        assert_int_equal(train_dataset_get(f->data, (size_t)i % SAMPLES, 0, v), OK);
        train_mixture_draw(v, &usual, &r, NULL, &lens, &m);
        if (m.kind == TRAIN_FLASH) continue;
        prepare(f, &m, &lens);
        float brightest = 0;
        for (size_t k = 0; k < 3 * PIXELS; k++)
            brightest = fmaxf(brightest, shown(v, k));
        assert_true(brightest > 0.2f);
    }
}

static void nobody_photographs_darkness(void **state)
{
    fixture *f = *state;
    train_view *v = &f->view;
    assert_int_equal(train_dataset_get(f->data, 0, 0, v), OK);
    memset(v->lamps, 0, 16 * PIXELS * sizeof(float)); /* all lamps are behind the object, and there is no other light */
    memset(v->env, 0, 3 * PIXELS * sizeof(float));
    memset(v->sh, 0, 27 * sizeof(float));
    for (int i = 0; i < 200; i++) {
        rng r = rng_at(10, (uint64_t)i, 0);
        train_camera lens = train_camera_perfect();
        train_mixture m;
        train_mixture_draw(v, &usual, &r, NULL, &lens, &m);
        assert_true(isfinite(lens.gain[0]) && lens.gain[0] > 0 && m.flash.x > 0);
        assert_int_equal(m.strongest, -1);
    }
}

/* Exposure was once so high that black became visible, and the lamp's strength was 1e9. */
static void a_camera_exposes_for_what_is_lit(void **state)
{
    fixture *f = *state;
    train_view *v = &f->view;
    assert_int_equal(train_dataset_get(f->data, 0, 0, v), OK);
    memset(v->lamps, 0, 16 * PIXELS * sizeof(float));
    memset(v->env, 0, 3 * PIXELS * sizeof(float));
    memset(v->sh, 0, 27 * sizeof(float));
    size_t object = 0, lit = 0;
    for (size_t i = 0; i < PIXELS; i++)
        object += v->mask[i] > 0.5f;
    for (size_t i = 0; i < PIXELS && lit < object / 50; i++)
        if (v->mask[i] > 0.5f && ++lit)
            for (size_t k = 0; k < 4; k++)
                v->lamps[4 * (k * PIXELS + i)] = v->lamps[4 * (k * PIXELS + i) + 1] = 5;
    int lamps = 0;
    for (int i = 0; i < 200; i++) {
        rng r = rng_at(12, (uint64_t)i, 0);
        train_camera lens = train_camera_perfect();
        train_mixture m;
        train_mixture_draw(v, &usual, &r, NULL, &lens, &m);
        lamps += m.strongest >= 0;
        for (int c = 0; c < 3; c++)
            assert_true(lens.gain[c] < 2000);
    }
    assert_true(lamps > 40);
}

static void samples_without_lamps_are_refused(void **state)
{
    (void)state;
    char *folder = scratch_new();
    render_options o = render_options_default();
    render_stats stats;
    train_view v = {.size = SIZE};
    train_dataset *d;
    o.folder = folder;
    o.count = 1;
    o.image = (image_settings){.size = SIZE, .fov = 60, .strata = 1, .paths = 1};
    o.quiet = true;
    assert_int_equal(render_samples(&o, &stats), OK);
    render_stats_free(&stats);
    const train_dataset_options options = {.size = SIZE, .memory_gib = 1, .lamps = true};
    assert_int_equal(train_dataset_open(folder, &options, &d), OK);
    assert_int_equal(train_dataset_get(d, 0, 0, &v), MERLIN_BAD_INPUT);
    assert_non_null(strstr(status_message(), "--lamps"));
    train_dataset_close(d);
    scratch_remove(folder);
}

/* A shift by whole pixels moves the photograph, and nothing else. */
static void a_hand_moves_the_photograph_and_not_the_maps(void **state)
{
    fixture *f = *state;
    train_view *v = &f->view;
    float *steady = malloc(3 * PIXELS * sizeof *steady);
    for (int moved = 0; moved < 2; moved++) {
        train_camera lens = train_camera_perfect();
        lens.white = 1000;
        assert_int_equal(train_dataset_get(f->data, 1, 0, v), OK);
        const train_mixture m = {.flash = {1, 1, 1}, .strongest = -1, .shift = {moved ? 2.0f : 0, moved ? -1.0f : 0}};
        prepare(f, &m, &lens);
        if (!moved) memcpy(steady, v->photo, 3 * PIXELS * sizeof *steady);
    }
    for (int y = 0; y < SIZE - 1; y++)
        for (int x = 2; x < SIZE; x++)
            assert_float_equal(v->photo[3 * (y * SIZE + x)], steady[3 * ((y + 1) * SIZE + x - 2)], 1e-6f);
    free(steady);
}

static void a_third_of_the_hands_is_steady(void **state)
{
    (void)state;
    int still = 0;
    float most = 0;
    for (uint64_t i = 0; i < 300; i++) {
        rng steady = rng_at(1, i, 0), r = rng_at(1, i, 1);
        train_mixture m = {.strongest = -1};
        train_mixture_move(128, &steady, &r, &m);
        still += m.shift[0] == 0 && m.shift[1] == 0;
        most = fmaxf(most, fmaxf(fabsf(m.shift[0]), fabsf(m.shift[1])));
    }
    assert_true(still > 70 && still < 130);
    assert_true(most > 0.9f && most <= 1);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_hand_moves_the_photograph_and_not_the_maps),
        cmocka_unit_test(a_third_of_the_hands_is_steady),
        cmocka_unit_test(a_photograph_is_the_sum_of_its_lights),
        cmocka_unit_test(the_truth_about_a_lamp_makes_the_photograph),
        cmocka_unit_test(kinds_come_as_often_as_they_should),
        cmocka_unit_test(kinds_come_as_often_as_configured),
        cmocka_unit_test(a_torch_lights_each_picture_from_elsewhere),
        cmocka_unit_test(further_pictures_are_mixed),
        cmocka_unit_test(exposure_leaves_neither_darkness_nor_white_alone),
        cmocka_unit_test(nobody_photographs_darkness),
        cmocka_unit_test(a_camera_exposes_for_what_is_lit),
        cmocka_unit_test(samples_without_lamps_are_refused),
    };
    return cmocka_run_group_tests(tests, set_up, tear_down);
}
