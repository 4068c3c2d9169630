/* SPDX-License-Identifier: MIT */
#include "serve/jobs/jobs.h"

#include <fcntl.h>
#include <malloc.h>
#include <pthread.h>
#include <stdatomic.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "base/json/json_put.h"
#include "base/text/report.h"
#include "serve/jobs/job_files.h"

struct jobs {
    jobs_params params;
    pthread_mutex_t lock;
    pthread_cond_t more;
    pthread_t worker;
    bool running, closing;
    job **at; /* jobs in the order of their arrival */
    size_t count, room;
};

/* Whether the current job must stop; a global, as the library's callback has no context. */
static atomic_bool stopping;

static int stops(void)
{
    return atomic_load(&stopping);
}

/* ---- lookup, with the lock held ---- */

static job *find(const jobs *q, const char *id)
{
    for (size_t i = 0; i < q->count; i++)
        if (!q->at[i]->unwanted && strcmp(q->at[i]->form.id, id) == 0) return q->at[i];
    return NULL;
}

static size_t waiting(const jobs *q)
{
    size_t count = 0;
    for (size_t i = 0; i < q->count; i++)
        count += q->at[i]->state == JOB_QUEUED;
    return count;
}

/* Returns the number of jobs before a queued one. */
static size_t position(const jobs *q, const job *j)
{
    size_t before = 0;
    for (size_t i = 0; i < q->count && q->at[i] != j; i++)
        before += !job_has_ended(q->at[i]);
    return before;
}

static void remove_at(jobs *q, size_t i)
{
    job_free(q->at[i], q->params.store);
    memmove(&q->at[i], &q->at[i + 1], (--q->count - i) * sizeof *q->at);
}

/* ---- retention ---- */

static void remove_oldest(jobs *q)
{
    size_t oldest = q->count;
    for (size_t i = 0; i < q->count; i++)
        if (job_has_ended(q->at[i]) && (oldest == q->count || q->at[i]->ended < q->at[oldest]->ended)) oldest = i;
    if (oldest < q->count) remove_at(q, oldest);
}

static bool is_too_much(const jobs *q)
{
    size_t ended = 0;
    uint64_t bytes = 0;
    for (size_t i = 0; i < q->count; i++) {
        ended += job_has_ended(q->at[i]);
        bytes += q->at[i]->bytes;
    }
    return ended > q->params.most_kept || (ended > 1 && bytes > q->params.most_bytes);
}

/* Removes expired jobs, with the lock held. */
static void tidy(jobs *q)
{
    const time_t now = time(NULL);
    for (size_t i = q->count; i-- > 0;) {
        const job *j = q->at[i];
        if (job_has_ended(j) && (j->unwanted || difftime(now, j->ended) >= q->params.keep)) remove_at(q, i);
    }
    while (is_too_much(q))
        remove_oldest(q);
}

void jobs_expire(jobs *q)
{
    pthread_mutex_lock(&q->lock);
    tidy(q);
    pthread_mutex_unlock(&q->lock);
}

/* ---- the worker ---- */

typedef struct listener {
    jobs *queue;
    job *job;
} listener;

static void hear(void *context, const char *stage, float share)
{
    const listener *t = context;
    pthread_mutex_lock(&t->queue->lock);
    job_tell(t->job, stage, share);
    pthread_mutex_unlock(&t->queue->lock);
}

/* Waits for a queued job; returns NULL when the queue closes. */
static job *next(jobs *q)
{
    job *found = NULL;
    pthread_mutex_lock(&q->lock);
    while (!q->closing && !found) {
        for (size_t i = 0; i < q->count && !found; i++)
            if (q->at[i]->state == JOB_QUEUED) found = q->at[i];
        if (!found) pthread_cond_wait(&q->more, &q->lock);
    }
    if (q->closing) found = NULL;
    if (found) found->state = JOB_WORKING;
    if (found) atomic_store(&stopping, false);
    pthread_mutex_unlock(&q->lock);
    return found;
}

static status work_on(jobs *q, job *j)
{
    listener t = {q, j};
    cJSON *report = report_begin(NULL);
    const work_context context = {.model = q->params.model,
                                  .near = q->params.near,
                                  .store = q->params.store,
                                  .form = &j->form,
                                  .limits = &q->params.limits,
                                  .progress = hear,
                                  .progress_context = &t,
                                  .stop = stops,
                                  .report = report};
    status s = j->kind->run(&context, j->request);
    pthread_mutex_lock(&q->lock);
    j->report = report;
    pthread_mutex_unlock(&q->lock);
    return s == OK && stops() ? fail(MERLIN_STOPPED, "stopped") : s;
}

/* Records the end of a job, and deletes its uploads and, if it failed, its results. */
static void end(jobs *q, job *j, status s)
{
    char words[sizeof j->error];
    if (s == OK) s = job_take_results(j, q->params.store);
    snprintf(words, sizeof words, "%s", s == OK ? "" : status_message());
    job_hide_folders(j, q->params.store, words);
    store_empty(q->params.store, j->form.id, STORE_IN);
    if (s != OK) store_empty(q->params.store, j->form.id, STORE_OUT);
    pthread_mutex_lock(&q->lock);
    memcpy(j->error, words, sizeof words);
    j->failure = s;
    j->ended = time(NULL);
    j->state = s == OK ? JOB_DONE : s == MERLIN_STOPPED ? JOB_CANCELLED : JOB_FAILED;
    tidy(q);
    const bool idle = waiting(q) == 0;
    pthread_mutex_unlock(&q->lock);
    if (idle) (void)malloc_trim(0); /* a server is idle most of the time, and large photographs are rare */
}

static void *work(void *context)
{
    jobs *q = context;
    for (job *j; (j = next(q));)
        end(q, j, work_on(q, j));
    return NULL;
}

/* ---- the queue ---- */

status jobs_open(const jobs_params *params, jobs **out)
{
    *out = NULL;
    jobs *q = calloc(1, sizeof *q);
    if (!q) return fail(MERLIN_NO_MEMORY, "no memory for the queue");
    q->params = *params;
    q->room = params->most_waiting + params->most_kept + 2;
    q->at = calloc(q->room, sizeof(job *));
    pthread_mutex_init(&q->lock, NULL);
    pthread_cond_init(&q->more, NULL);
    q->running = q->at && pthread_create(&q->worker, NULL, work, q) == 0;
    if (q->running)
        *out = q;
    else
        jobs_close(q);
    return *out ? OK : fail(MERLIN_NO_MEMORY, "no memory, or no thread, for the queue");
}

void jobs_close(jobs *q)
{
    if (!q) return;
    pthread_mutex_lock(&q->lock);
    q->closing = true;
    atomic_store(&stopping, true);
    pthread_cond_signal(&q->more);
    pthread_mutex_unlock(&q->lock);
    if (q->running) pthread_join(q->worker, NULL);
    while (q->count)
        remove_at(q, q->count - 1);
    pthread_cond_destroy(&q->more);
    pthread_mutex_destroy(&q->lock);
    free(q->at);
    free(q);
}

bool jobs_have_room(jobs *q)
{
    pthread_mutex_lock(&q->lock);
    const bool room = waiting(q) < q->params.most_waiting;
    pthread_mutex_unlock(&q->lock);
    return room;
}

/* Adds a file of an earlier job's results to the uploads of one that uses it, with the lock held. */
static jobs_answer borrow(jobs *q, const work_kind *kind, const form *f)
{
    const char *id = form_value(f, "job");
    if (!kind->uses || !id) return JOBS_TAKEN;
    const job *from = find(q, id);
    char have[PATH_MAX], want[PATH_MAX];
    if (from && from->state != JOB_DONE) return JOBS_EARLY;
    if (!from || !job_find_file(from, kind->uses)) return JOBS_NONE;
    store_path(q->params.store, from->form.id, STORE_OUT, kind->uses, have);
    store_path(q->params.store, f->id, STORE_IN, kind->uses, want);
    if (link(have, want) == 0) return JOBS_TAKEN;
    (void)fail_by_errno(MERLIN_CANNOT_WRITE, "the server cannot keep uploads");
    return JOBS_BROKEN;
}

/* Appends a job, with the lock held. */
static jobs_answer append(jobs *q, const work_kind *kind, form *f, void *request)
{
    if (waiting(q) >= q->params.most_waiting || q->count >= q->room) return JOBS_FULL;
    const jobs_answer borrowed = borrow(q, kind, f);
    if (borrowed != JOBS_TAKEN) return borrowed;
    job *j = job_new(kind, f, request);
    if (!j) (void)fail(MERLIN_NO_MEMORY, "no memory for another job");
    if (!j) return JOBS_BROKEN;
    q->at[q->count++] = j;
    pthread_cond_signal(&q->more);
    return JOBS_TAKEN;
}

jobs_answer jobs_add(jobs *q, const work_kind *kind, form *f, char id[STORE_ID])
{
    void *request = NULL;
    memcpy(id, f->id, STORE_ID);
    const status s = kind->check(f, &q->params.limits, &request);
    jobs_answer answer = s == OK ? JOBS_TAKEN : s == MERLIN_WRONG_USE ? JOBS_REFUSED : JOBS_BROKEN;
    if (s == OK) {
        pthread_mutex_lock(&q->lock);
        answer = append(q, kind, f, request);
        pthread_mutex_unlock(&q->lock);
    }
    if (answer != JOBS_TAKEN) free(request);
    return answer;
}

cJSON *jobs_tell(jobs *q, const char *id)
{
    pthread_mutex_lock(&q->lock);
    const job *j = find(q, id);
    cJSON *told = j ? job_json(j, position(q, j), q->params.keep) : NULL;
    pthread_mutex_unlock(&q->lock);
    return told;
}

bool jobs_remove(jobs *q, const char *id)
{
    pthread_mutex_lock(&q->lock);
    job *j = find(q, id);
    if (j) j->unwanted = true;
    if (j && j->state == JOB_WORKING) atomic_store(&stopping, true);
    if (j && j->state == JOB_QUEUED) j->state = JOB_CANCELLED;
    tidy(q);
    pthread_mutex_unlock(&q->lock);
    return j != NULL;
}

jobs_results jobs_look(jobs *q, const char *id)
{
    pthread_mutex_lock(&q->lock);
    const job *j = find(q, id);
    const jobs_results found = !j                     ? JOBS_NO_JOB
                               : !job_has_ended(j)    ? JOBS_WAIT
                               : j->state == JOB_DONE ? JOBS_READY
                                                      : JOBS_WITHOUT;
    pthread_mutex_unlock(&q->lock);
    return found;
}

int jobs_open_file(jobs *q, const char *id, const char *name, uint64_t *bytes)
{
    int descriptor = -1;
    char path[PATH_MAX];
    pthread_mutex_lock(&q->lock);
    const job *j = find(q, id);
    const job_file *file = j && j->state == JOB_DONE ? job_find_file(j, name) : NULL;
    if (file) {
        descriptor = open(store_path(q->params.store, j->form.id, STORE_OUT, file->name, path), O_RDONLY | O_CLOEXEC);
        *bytes = file->bytes;
    }
    pthread_mutex_unlock(&q->lock);
    return descriptor;
}

bool jobs_open_archive(jobs *q, const char *id, int *descriptor, uint64_t *bytes, status *made)
{
    job_files files = {.count = 0};
    pthread_mutex_lock(&q->lock);
    const job *j = find(q, id);
    const bool is_done = j && j->state == JOB_DONE;
    *made = is_done ? job_files_open(j, q->params.store, &files) : fail(MERLIN_BAD_INPUT, "there is no such job");
    pthread_mutex_unlock(&q->lock);
    if (*made == OK) *made = job_files_archive(&files, q->params.store, descriptor, bytes);
    job_files_close(&files);
    return is_done;
}

void jobs_put(jobs *q, cJSON *to)
{
    size_t ended = 0;
    uint64_t bytes = 0;
    pthread_mutex_lock(&q->lock);
    for (size_t i = 0; i < q->count; i++) {
        ended += job_has_ended(q->at[i]);
        bytes += q->at[i]->bytes;
    }
    json_put_number(to, "waiting", (double)waiting(q));
    json_put_bool(to, "working", waiting(q) + ended < q->count);
    json_put_number(to, "kept", (double)ended);
    json_put_number(to, "kept_bytes", (double)bytes);
    pthread_mutex_unlock(&q->lock);
}
