/* SPDX-License-Identifier: MIT */
/* Memory runs out at any allocation between a model, a photograph, its maps and new light: that is said, what was to be
 * filled in is empty, no file is left, and the next call is as good as ever. */
#include "base/file.h"
#include "each_allocation.h"
#include "image/write/write.h"
#include "merlin/merlin.h"
#include "scratch.h"
#include "weights.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <unistd.h>

#include <cmocka.h>

/* SIZE: what the network sees. */
enum { SIDE = 32, PIXELS = SIDE * SIDE, SIZE = 64 };

/* All that the calls below take and give. */
typedef struct work {
    char any[256], point[256], room[256], list[256], folder[256], written[256];
    merlin_model *model;
    merlin_image photo, mask;
    bool with_mask;
    merlin_params params;
    merlin_maps maps;
    merlin_relighting how;
    merlin_model *opened;
    merlin_weights weights;
    merlin_maps made;
    merlin_mesh mesh;
    char *text; /* of their report */
    merlin_image picture;
    uint64_t first; /* sum of what the first run gave; 0: there was none */
} work;

static const float LAMP[3] = {0.5f, 0.5f, -0.2f};

/* FNV-1a */
static uint64_t sum_of(uint64_t sum, const void *data, size_t size)
{
    const unsigned char *bytes = data;
    for (size_t i = 0; i < size; i++)
        sum = (sum ^ bytes[i]) * 0x100000001b3;
    return sum;
}

static uint64_t sum_image(uint64_t sum, const merlin_image *m)
{
    size_t size = (size_t)m->width * (size_t)m->height * (size_t)m->channels * sizeof(float);
    return sum_of(sum, m->data, m->data ? size : 0);
}

static uint64_t sum_maps(uint64_t sum, const merlin_maps *m)
{
    const merlin_image *images[] = {&m->albedo, &m->normal, &m->roughness,     &m->depth,
                                    &m->mask,   &m->photo,  &m->reconstruction};
    for (size_t i = 0; i < sizeof images / sizeof *images; i++)
        sum = sum_image(sum, images[i]);
    sum = sum_of(sum, &m->light, sizeof m->light);
    return sum_of(sum, &m->doubts, sizeof m->doubts);
}

static const char *is_as_ever(work *w, uint64_t sum)
{
    bool other = w->first && sum != w->first;
    if (!w->first) w->first = sum;
    return other ? "another result than ever" : NULL;
}

static bool is_empty(const void *data, size_t size)
{
    for (size_t i = 0; i < size; i++)
        if (((const char *)data)[i]) return false;
    return true;
}

/* ---- the model ---- */

static int open_model(void *context)
{
    work *w = context;
    w->opened = (merlin_model *)1;
    int s = (int)merlin_model_open(w->any, &w->opened);
    if (s != MERLIN_OK) return s;
    s = merlin_model_add_flash(w->opened, w->point);
    if (s == MERLIN_OK) assert_string_equal(merlin_model_name(w->opened), "merlin-any");
    merlin_model_close(w->opened);
    w->opened = NULL;
    return s;
}

static const char *check_model(void *context, int result)
{
    const work *w = context;
    (void)result;
    return w->opened ? "a model" : NULL;
}

static int read_weights(void *context)
{
    work *w = context;
    memset(&w->weights, 1, sizeof w->weights);
    return merlin_weights_read(w->point, &w->weights);
}

static const char *check_weights(void *context, int result)
{
    work *w = context;
    const char *fault = NULL;
    if (result == MERLIN_OK)
        fault = is_as_ever(w, w->weights.parameters + w->weights.tensor_count);
    else if (!is_empty(&w->weights, sizeof w->weights))
        return "facts of weights";
    merlin_weights_free(&w->weights);
    return fault;
}

/* ---- maps ---- */

static int estimate(void *context)
{
    work *w = context;
    memset(&w->made, 1, sizeof w->made);
    return merlin_estimate(w->model, &w->photo, w->with_mask ? &w->mask : NULL, &w->params, &w->made);
}

/* The first run with a model compiles it. */
static int estimate_first(void *context)
{
    work *w = context;
    merlin_model *model = NULL;
    memset(&w->made, 0, sizeof w->made);
    int s = merlin_model_open(w->any, &model);
    if (s == MERLIN_OK) s = merlin_model_add_flash(model, w->point);
    if (s == MERLIN_OK) s = merlin_estimate(model, &w->photo, &w->mask, &w->params, &w->made);
    merlin_model_close(model);
    return s;
}

static const char *check_maps(void *context, int result)
{
    work *w = context;
    const char *fault = NULL;
    if (result == MERLIN_OK)
        fault = is_as_ever(w, sum_maps(1, &w->made));
    else if (!is_empty(&w->made, sizeof w->made))
        return "maps";
    merlin_maps_free(&w->made);
    return fault;
}

static int write_maps(void *context)
{
    const work *w = context;
    return merlin_maps_write(w->model, &w->maps, NULL, w->written);
}

static const char *check_folder(void *context, int result)
{
    work *w = context;
    char **names = NULL;
    size_t count = 0;
    uint64_t sum = 1;
    if (file_is_folder(w->written)) assert_int_equal(file_list(w->written, NULL, &names, &count), OK);
    for (size_t i = 0; i < count; i++) {
        char *data;
        size_t size;
        assert_int_equal(file_read(names[i], 1 << 24, &data, &size), OK);
        sum = sum_of(sum, names[i], strlen(names[i]));
        sum = sum_of(sum, data, size);
        free(data);
        assert_int_equal(unlink(names[i]), 0);
    }
    file_list_free(names, count);
    if (result == MERLIN_OK) return is_as_ever(w, sum);
    return count ? "files" : NULL;
}

static int report_maps(void *context)
{
    work *w = context;
    w->text = (char *)w;
    return merlin_maps_report(&w->maps, &w->text);
}

static const char *check_text(void *context, int result)
{
    work *w = context;
    const char *fault = NULL;
    if (result == MERLIN_OK)
        fault = is_as_ever(w, sum_of(1, w->text, strlen(w->text)));
    else if (w->text)
        return "a text";
    free(w->text);
    w->text = NULL;
    return fault;
}

static int read_maps(void *context)
{
    work *w = context;
    memset(&w->made, 1, sizeof w->made);
    return merlin_maps_read(w->folder, &w->made);
}

/* ---- new light ---- */

static int relight(void *context)
{
    work *w = context;
    memset(&w->picture, 1, sizeof w->picture);
    return merlin_relight(w->model, &w->maps, LAMP, w->how, &w->picture);
}

static int relight_found(void *context)
{
    work *w = context;
    memset(&w->picture, 1, sizeof w->picture);
    return merlin_relight_found(w->model, &w->maps, 40, w->how, &w->picture);
}

static int relight_environment(void *context)
{
    work *w = context;
    merlin_environment *room = NULL;
    memset(&w->picture, 0, sizeof w->picture);
    int s = merlin_environment_read(w->room, 30, 0, &room);
    if (s == MERLIN_OK) s = merlin_relight_environment(w->model, &w->maps, room, LAMP, w->how, &w->picture);
    merlin_environment_free(room);
    return s;
}

static int relight_many(void *context)
{
    work *w = context;
    merlin_relighter *relighter = (merlin_relighter *)1;
    memset(&w->picture, 0, sizeof w->picture);
    int s = merlin_relighter_new(w->model, &w->maps, 0, w->how, &relighter);
    if (s != MERLIN_OK) assert_null(relighter);
    if (s == MERLIN_OK) s = merlin_relighter_render(relighter, LAMP, NULL, &w->picture);
    merlin_relighter_free(relighter);
    return s;
}

/* The found light by its parts, metered, matte, and in the photograph's frame. */
static int relight_parts(void *context)
{
    work *w = context;
    merlin_relighter *relighter = NULL;
    merlin_found_lights found = {.count = 0};
    merlin_image square = {0};
    float white = 1;
    memset(&w->picture, 0, sizeof w->picture);
    int s = merlin_relighter_new(w->model, &w->maps, 0, MERLIN_BY_BRDF, &relighter);
    if (s == MERLIN_OK) s = merlin_relighter_make_matte(relighter);
    if (s == MERLIN_OK) s = merlin_found_lights_new(&w->maps.light, 30, &found);
    if (s == MERLIN_OK) s = merlin_relighter_meter(relighter, found.lamps, (size_t)found.count, found.rest, &white);
    if (s == MERLIN_OK) s = merlin_relighter_set_white(relighter, white);
    if (s == MERLIN_OK) s = merlin_relighter_render_lamps(relighter, found.lamps, found.count, found.rest, &square);
    if (s == MERLIN_OK) s = merlin_relighter_place(relighter, &square, &w->picture);
    merlin_image_free(&square);
    merlin_found_lights_free(&found);
    merlin_relighter_free(relighter);
    return s;
}

static int read_lamps(void *context)
{
    const work *w = context;
    merlin_lamps lamps;
    int s = merlin_lamps_read(w->list, 0, &lamps);
    if (s != MERLIN_OK) assert_null(lamps.at);
    merlin_lamps_free(&lamps);
    return s;
}

static const char *check_nothing(void *context, int result)
{
    (void)context;
    (void)result;
    return NULL;
}

static int make_mesh(void *context)
{
    work *w = context;
    memset(&w->mesh, 1, sizeof w->mesh);
    return merlin_mesh_from_maps(&w->maps, &(merlin_mesh_params){.side = 16}, &w->mesh);
}

static const char *check_mesh(void *context, int result)
{
    work *w = context;
    const merlin_mesh *m = &w->mesh;
    const char *fault = NULL;
    if (result == MERLIN_OK)
        fault = is_as_ever(w, sum_of(sum_image(1, &m->albedo), m->positions, 3 * m->vertex_count * sizeof(float)));
    else if (!is_empty(m, sizeof *m))
        return "a mesh";
    merlin_mesh_free(&w->mesh);
    return fault;
}

static const char *check_picture(void *context, int result)
{
    work *w = context;
    const char *fault = NULL;
    if (result == MERLIN_OK)
        fault = is_as_ever(w, sum_image(1, &w->picture));
    else if (!is_empty(&w->picture, sizeof w->picture))
        return "a picture";
    merlin_image_free(&w->picture);
    return fault;
}

/* ---- the tests ---- */

static void lack_of_memory_opens_no_model(void **state)
{
    each_allocation_fails(&(memory_trial){"model", open_model, check_model, *state});
}

static void lack_of_memory_reads_no_weights(void **state)
{
    each_allocation_fails(&(memory_trial){"weights_read", read_weights, check_weights, *state});
}

static void lack_of_memory_makes_no_maps(void **state)
{
    work *w = *state;
    w->with_mask = true;
    each_allocation_fails(&(memory_trial){"estimate", estimate, check_maps, w});
    w->with_mask = false;
    w->first = 0;
    each_allocation_fails(&(memory_trial){"estimate without a mask", estimate, check_maps, w});
    w->first = 0;
    each_allocation_fails(&(memory_trial){"estimate by a fresh model", estimate_first, check_maps, w});
}

static void lack_of_memory_writes_no_maps(void **state)
{
    each_allocation_fails(&(memory_trial){"maps_write", write_maps, check_folder, *state});
}

static void lack_of_memory_reports_no_maps(void **state)
{
    each_allocation_fails(&(memory_trial){"maps_report", report_maps, check_text, *state});
}

static void lack_of_memory_reads_no_maps(void **state)
{
    each_allocation_fails(&(memory_trial){"maps_read", read_maps, check_maps, *state});
}

static void lack_of_memory_relights_nothing(void **state)
{
    work *w = *state;
    static const char *const names[] = {"relight", "relight by the network", "relight without shadows"};
    for (int how = MERLIN_BY_BRDF; how <= MERLIN_BY_BRDF_UNSHADOWED; how++) {
        w->how = (merlin_relighting)how;
        w->first = 0;
        each_allocation_fails(&(memory_trial){names[how], relight, check_picture, w});
        w->first = 0;
        each_allocation_fails(&(memory_trial){names[how], relight_many, check_picture, w});
        if (how == MERLIN_BY_NETWORK) continue;
        w->first = 0;
        each_allocation_fails(&(memory_trial){"found light", relight_found, check_picture, w});
        w->first = 0;
        each_allocation_fails(&(memory_trial){"environment", relight_environment, check_picture, w});
    }
}

static void lack_of_memory_makes_no_mesh(void **state)
{
    work *w = *state;
    w->first = 0;
    each_allocation_fails(&(memory_trial){"mesh", make_mesh, check_mesh, w});
}

static void lack_of_memory_reads_no_lamps(void **state)
{
    work *w = *state;
    static const char lp[] = "2\na.png 0 0.6 0.8\nb.png 1 0 0\n";
    snprintf(w->list, sizeof w->list, "%s", scratch_path("dome.lp"));
    assert_int_equal(file_write(w->list, lp, sizeof lp - 1), OK);
    each_allocation_fails(&(memory_trial){"lamps_read", read_lamps, check_nothing, w});
}

static void lack_of_memory_relights_no_parts(void **state)
{
    each_allocation_fails(&(memory_trial){"relight by parts", relight_parts, check_picture, *state});
}

static void draw(work *w)
{
    w->photo = (merlin_image){SIDE, SIDE, 3, calloc(3 * PIXELS, sizeof(float))};
    w->mask = (merlin_image){SIDE, SIDE, 1, calloc(PIXELS, sizeof(float))};
    for (int i = 0; i < PIXELS; i++) {
        float x = ((float)(i % SIDE) - 16) / 13, y = ((float)(i / SIDE) - 16) / 13, d = x * x + y * y;
        w->mask.data[i] = d < 1;
        for (int c = 0; c < 3; c++)
            w->photo.data[3 * i + c] = d < 1 ? (0.3f + 0.2f * (float)c) * sqrtf(1 - d) : 0.02f;
    }
}

static int set_up(void **state)
{
    static work w;
    img room = {0};
    merlin_set_threads(1); /* so that the n-th allocation is the same one each time */
    *state = memset(&w, 0, sizeof w);
    scratch_open(state);
    *state = &w;
    snprintf(w.any, sizeof w.any, "%s", scratch_path("any.safetensors"));
    snprintf(w.point, sizeof w.point, "%s", scratch_path("point.safetensors"));
    snprintf(w.room, sizeof w.room, "%s", scratch_path("room.png"));
    snprintf(w.folder, sizeof w.folder, "%s", scratch_path("maps"));
    snprintf(w.written, sizeof w.written, "%s", scratch_path("written"));
    draw(&w);
    if (img_new(&room, 32, 16, 3) != OK) return -1;
    for (int i = 0; i < 32 * 16 * 3; i++)
        room.data[i] = i / 3 % 32 >= 16 ? 0.9f : 0.05f;
    w.params = merlin_params_default();
    w.params.size = SIZE;
    status s = img_write_png(w.room, &room, IMG_LINEAR8);
    img_free(&room);
    if (s == OK) s = write_random_weights_of("merlin-any", w.any);
    if (s == OK) s = write_random_weights(w.point);
    if (s == OK) s = merlin_model_open(w.any, &w.model);
    if (s == OK) s = merlin_model_add_flash(w.model, w.point);
    if (s == OK) s = merlin_estimate(w.model, &w.photo, &w.mask, &w.params, &w.maps);
    w.maps.timing = (merlin_timing){0}; /* stands in the report */
    if (s == OK) s = merlin_maps_write(w.model, &w.maps, NULL, w.folder);
    return s == OK ? 0 : -1;
}

static int tear_down(void **state)
{
    work *w = *state;
    merlin_maps_free(&w->maps);
    merlin_model_close(w->model);
    merlin_image_free(&w->photo);
    merlin_image_free(&w->mask);
    return scratch_close(state);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(lack_of_memory_opens_no_model, set_up, tear_down),
        cmocka_unit_test_setup_teardown(lack_of_memory_reads_no_weights, set_up, tear_down),
        cmocka_unit_test_setup_teardown(lack_of_memory_makes_no_maps, set_up, tear_down),
        cmocka_unit_test_setup_teardown(lack_of_memory_writes_no_maps, set_up, tear_down),
        cmocka_unit_test_setup_teardown(lack_of_memory_reports_no_maps, set_up, tear_down),
        cmocka_unit_test_setup_teardown(lack_of_memory_reads_no_maps, set_up, tear_down),
        cmocka_unit_test_setup_teardown(lack_of_memory_makes_no_mesh, set_up, tear_down),
        cmocka_unit_test_setup_teardown(lack_of_memory_relights_nothing, set_up, tear_down),
        cmocka_unit_test_setup_teardown(lack_of_memory_relights_no_parts, set_up, tear_down),
        cmocka_unit_test_setup_teardown(lack_of_memory_reads_no_lamps, set_up, tear_down),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
