/* SPDX-License-Identifier: MIT */
/* The queue: jobs wait in the order in which they came, one thread works on them, and what came of them stays for a
 * while.
 *
 *     jobs *queue;
 *     char id[STORE_ID];
 *     if (jobs_open(&params, &queue) == OK && jobs_add(queue, work_find("estimate"), &form, id) == JOBS_TAKEN) ...
 *     cJSON *told = jobs_tell(queue, id);
 *     jobs_expire(queue);                now and then
 *     jobs_close(queue);                 stops the work
 *
 * May be called from any thread. There is one queue in a process: the library asks whether to stop without a context.
 */
#ifndef MERLIN_SERVE_JOBS_JOBS_H
#define MERLIN_SERVE_JOBS_JOBS_H

#include "serve/jobs/work.h"

typedef struct jobs jobs;

typedef struct jobs_params {
    merlin_model *model;
    const store *store;
    work_limits limits;
    size_t most_waiting;
    size_t most_kept;    /* ended jobs; when there are more, the oldest go first */
    uint64_t most_bytes; /* of all their results; likewise */
    double keep;         /* seconds for which an ended job stays */
} jobs_params;

status jobs_open(const jobs_params *params, jobs **out);
void jobs_close(jobs *q);

typedef enum jobs_answer {
    JOBS_TAKEN,
    JOBS_REFUSED, /* what was sent is wrong: status_message() says how */
    JOBS_FULL,    /* too many wait */
    JOBS_NONE,    /* the job that its field "job" names is not there, or has not ended well */
    JOBS_BROKEN,  /* the server cannot: status_message() */
} jobs_answer;

/* Takes the form over where it answers JOBS_TAKEN; id is that of the form. */
jobs_answer jobs_add(jobs *q, const work_kind *kind, form *f, char id[STORE_ID]);
/* Tells whether another would be taken. */
bool jobs_have_room(jobs *q);
/* What is told of a job; NULL: there is none. */
cJSON *jobs_tell(jobs *q, const char *id);
/* Stops a job's work, and removes it with its files. Returns false where there is none. */
bool jobs_remove(jobs *q, const char *id);
/* Opens one of the files that came of a job for reading; -1: there is none. */
int jobs_open_file(jobs *q, const char *id, const char *name, uint64_t *bytes);
/* Removes what has been kept for long enough. */
void jobs_expire(jobs *q);
/* Adds how many wait, and what is kept. */
void jobs_put(jobs *q, cJSON *to);

#endif
