/* SPDX-License-Identifier: MIT */
/* The queue and what it keeps, with work that does nothing but what a test says. */
#include <stdatomic.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>
#include <unistd.h>

#include "base/file.h"
#include "scratch.h"
#include "serve/jobs/jobs.h"

/* last, as cmocka defines a macro named fail */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>
#undef fail

typedef struct fixture {
    char *folder;
    store *store;
    jobs *queue;
} fixture;

/* ---- work ---- */

static atomic_int at_work, going; /* jobs that have begun; whether they go on to their end */

static void nap(void)
{
    const struct timespec pause = {0, 2 * 1000 * 1000};
    (void)nanosleep(&pause, NULL);
}

static status check(const form *f, const work_limits *limits, void **request)
{
    (void)limits;
    *request = NULL;
    return form_value(f, "wrong") ? fail(MERLIN_WRONG_USE, "wrong was sent") : OK;
}

/* Waits until it may go on; writes a file, and fails if it is asked to. */
static status run(const work_context *w, const void *request)
{
    char path[PATH_MAX];
    (void)request;
    w->progress(w->progress_context, "waiting", 0.5f);
    atomic_fetch_add(&at_work, 1);
    while (!atomic_load(&going)) {
        if (w->stop()) return fail(MERLIN_STOPPED, "stopped");
        nap();
    }
    status s = file_write(store_path(w->store, w->form->id, STORE_OUT, "result.txt", path), "result", 6);
    if (s == OK && form_value(w->form, "fails"))
        s = fail(MERLIN_BAD_INPUT, "cannot read %s: no picture",
                 store_path(w->store, w->form->id, STORE_IN, "cup.png", path));
    return s;
}

static const work_stage stages[] = {{"waiting", 1}, {0}};
static const work_kind kind = {.name = "test", .stages = stages, .check = check, .run = run, .uses = "result.txt"};

/* ---- the fixture ---- */

static void open_queue(fixture *x, size_t most_waiting, size_t most_kept, double keep)
{
    const jobs_params params = {
        .store = x->store, .most_waiting = most_waiting, .most_kept = most_kept, .most_bytes = 1 << 20, .keep = keep};
    assert_int_equal(jobs_open(&params, &x->queue), OK);
}

static int set_up(void **state)
{
    fixture *x = calloc(1, sizeof *x);
    x->folder = scratch_new();
    char *before = getenv("TMPDIR") ? strdup(getenv("TMPDIR")) : NULL;
    setenv("TMPDIR", x->folder, 1);
    const status s = store_open(&x->store);
    if (before)
        setenv("TMPDIR", before, 1);
    else
        unsetenv("TMPDIR");
    free(before);
    atomic_store(&at_work, 0);
    atomic_store(&going, 1);
    *state = x;
    return s;
}

static int tear_down(void **state)
{
    fixture *x = *state;
    jobs_close(x->queue);
    store_close(x->store);
    scratch_remove(x->folder);
    free(x);
    return 0;
}

static jobs_answer add(const fixture *x, const char *key, const char *value, char id[STORE_ID])
{
    form f = {.bytes = 0};
    assert_int_equal(store_add(x->store, f.id), OK);
    if (key) snprintf(form_add_field(&f, key)->value, FORM_MOST_VALUE, "%s", value);
    const jobs_answer answer = jobs_add(x->queue, &kind, &f, id);
    if (answer != JOBS_TAKEN) store_remove(x->store, f.id);
    form_free(&f);
    return answer;
}

/* A job's state, or its position in the queue; "none" if there is none. */
static const char *told(const fixture *x, const char *id, const char *key, char words[256])
{
    cJSON *j = jobs_tell(x->queue, id), *item = cJSON_GetObjectItem(j, key);
    snprintf(words, 256, "none");
    if (cJSON_IsString(item)) snprintf(words, 256, "%s", item->valuestring);
    if (cJSON_IsNumber(item)) snprintf(words, 256, "%g", item->valuedouble);
    cJSON_Delete(j);
    return words;
}

static void await_state(const fixture *x, const char *id, const char *wanted)
{
    char words[256] = "";
    for (int i = 0; i < 5000 && strcmp(told(x, id, "state", words), wanted) != 0; i++)
        nap();
    assert_string_equal(words, wanted);
}

/* ---- tests ---- */

static void jobs_work_one_at_a_time_in_their_order(void **state)
{
    fixture *x = *state;
    char id[3][STORE_ID], words[256];
    open_queue(x, 8, 8, 60);
    atomic_store(&going, 0);
    for (int i = 0; i < 3; i++)
        assert_int_equal(add(x, NULL, NULL, id[i]), JOBS_TAKEN);
    await_state(x, id[0], "working");
    assert_string_equal(told(x, id[1], "position", words), "1");
    assert_string_equal(told(x, id[2], "position", words), "2");
    while (!atomic_load(&at_work))
        nap();
    assert_string_equal(told(x, id[0], "progress", words), "0.5");
    atomic_store(&going, 1);
    for (int i = 0; i < 3; i++)
        await_state(x, id[i], "done");
    assert_int_equal(atomic_load(&at_work), 3);
}

static void a_job_at_work_is_stopped_and_one_that_waits_is_taken_out(void **state)
{
    fixture *x = *state;
    char first[STORE_ID], second[STORE_ID], third[STORE_ID], path[PATH_MAX], words[256];
    open_queue(x, 8, 8, 60);
    atomic_store(&going, 0);
    assert_int_equal(add(x, NULL, NULL, first), JOBS_TAKEN);
    await_state(x, first, "working");
    assert_int_equal(add(x, NULL, NULL, second), JOBS_TAKEN);
    assert_true(jobs_remove(x->queue, second));
    assert_true(jobs_remove(x->queue, first));
    assert_false(jobs_remove(x->queue, first));
    assert_string_equal(told(x, first, "state", words), "none");
    assert_string_equal(told(x, second, "state", words), "none");
    atomic_store(&going, 1);
    assert_int_equal(add(x, NULL, NULL, third), JOBS_TAKEN);
    await_state(x, third, "done");
    assert_false(file_exists(store_path(x->store, first, STORE_IN, NULL, path)));
    assert_false(file_exists(store_path(x->store, second, STORE_IN, NULL, path)));
}

static void a_queue_takes_no_more_than_it_says(void **state)
{
    fixture *x = *state;
    char id[STORE_ID], words[256];
    open_queue(x, 2, 2, 60);
    atomic_store(&going, 0);
    assert_int_equal(add(x, NULL, NULL, id), JOBS_TAKEN);
    await_state(x, id, "working");
    assert_int_equal(add(x, NULL, NULL, id), JOBS_TAKEN);
    assert_true(jobs_have_room(x->queue));
    assert_int_equal(add(x, NULL, NULL, id), JOBS_TAKEN);
    assert_false(jobs_have_room(x->queue));
    assert_int_equal(add(x, NULL, NULL, id), JOBS_FULL);
    assert_string_equal(told(x, id, "state", words), "none");
    assert_int_equal(add(x, "wrong", "1", id), JOBS_REFUSED);
}

static void results_stay_for_their_time_and_the_oldest_go_first(void **state)
{
    fixture *x = *state;
    char id[4][STORE_ID], path[PATH_MAX], words[256];
    open_queue(x, 8, 2, 1.5);
    for (int i = 0; i < 4; i++) {
        assert_int_equal(add(x, NULL, NULL, id[i]), JOBS_TAKEN);
        await_state(x, id[i], "done");
    }
    assert_string_equal(told(x, id[0], "state", words), "none");
    assert_string_equal(told(x, id[1], "state", words), "none");
    assert_string_equal(told(x, id[2], "state", words), "done");
    assert_true(file_exists(store_path(x->store, id[3], STORE_OUT, "result.txt", path)));
    for (int i = 0; i < 2000 && strcmp(told(x, id[3], "state", words), "none") != 0; i++) {
        jobs_expire(x->queue);
        nap();
    }
    assert_string_equal(words, "none");
    assert_false(file_exists(store_path(x->store, id[3], STORE_OUT, "result.txt", path)));
}

static void what_fails_keeps_nothing_and_hides_the_folder(void **state)
{
    fixture *x = *state;
    char id[STORE_ID], path[PATH_MAX], words[256];
    uint64_t bytes;
    open_queue(x, 8, 8, 60);
    assert_int_equal(add(x, "fails", "1", id), JOBS_TAKEN);
    await_state(x, id, "failed");
    assert_string_equal(told(x, id, "error", words), "cannot read cup.png: no picture");
    assert_false(file_exists(store_path(x->store, id, STORE_OUT, "result.txt", path)));
    assert_int_equal(jobs_open_file(x->queue, id, "result.txt", &bytes), -1);
    assert_int_equal(jobs_look(x->queue, id), JOBS_WITHOUT);
}

static void files_are_had_by_the_names_that_were_listed(void **state)
{
    static const char *const others[] = {
        "", ".", "..", "../in", "./result.txt", "result.txt/", "../out/result.txt", "/etc/passwd"};
    fixture *x = *state;
    char id[STORE_ID], next[STORE_ID];
    uint64_t bytes = 0;
    open_queue(x, 8, 8, 60);
    assert_int_equal(add(x, NULL, NULL, id), JOBS_TAKEN);
    await_state(x, id, "done");
    for (size_t i = 0; i < sizeof others / sizeof *others; i++)
        assert_int_equal(jobs_open_file(x->queue, id, others[i], &bytes), -1);
    const int file = jobs_open_file(x->queue, id, "result.txt", &bytes);
    assert_true(file >= 0);
    assert_int_equal(bytes, 6);
    close(file);
    assert_int_equal(add(x, "job", id, next), JOBS_TAKEN);
    await_state(x, next, "done");
    assert_int_equal(jobs_look(x->queue, next), JOBS_READY);
    assert_int_equal(jobs_look(x->queue, "../.."), JOBS_NO_JOB);
    assert_int_equal(add(x, "job", "../..", next), JOBS_NONE);
    atomic_store(&going, 0);
    assert_int_equal(add(x, NULL, NULL, id), JOBS_TAKEN);
    assert_int_equal(jobs_look(x->queue, id), JOBS_WAIT);
    assert_int_equal(add(x, "job", id, next), JOBS_EARLY);
}

static void a_queue_that_closes_stops_its_work_and_removes_all(void **state)
{
    fixture *x = *state;
    char id[STORE_ID], path[PATH_MAX];
    open_queue(x, 8, 8, 60);
    atomic_store(&going, 0);
    assert_int_equal(add(x, NULL, NULL, id), JOBS_TAKEN);
    await_state(x, id, "working");
    jobs_close(x->queue);
    x->queue = NULL;
    assert_false(file_exists(store_path(x->store, id, STORE_IN, NULL, path)));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(jobs_work_one_at_a_time_in_their_order, set_up, tear_down),
        cmocka_unit_test_setup_teardown(a_job_at_work_is_stopped_and_one_that_waits_is_taken_out, set_up, tear_down),
        cmocka_unit_test_setup_teardown(a_queue_takes_no_more_than_it_says, set_up, tear_down),
        cmocka_unit_test_setup_teardown(results_stay_for_their_time_and_the_oldest_go_first, set_up, tear_down),
        cmocka_unit_test_setup_teardown(what_fails_keeps_nothing_and_hides_the_folder, set_up, tear_down),
        cmocka_unit_test_setup_teardown(files_are_had_by_the_names_that_were_listed, set_up, tear_down),
        cmocka_unit_test_setup_teardown(a_queue_that_closes_stops_its_work_and_removes_all, set_up, tear_down),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
