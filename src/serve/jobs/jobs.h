/* SPDX-License-Identifier: MIT */
/* The queue: jobs wait in the order of their arrival, one thread processes them, and their results are kept for some
 * time.
 *
 *     jobs *queue;
 *     char id[STORE_ID];
 *     if (jobs_open(&params, &queue) == OK && jobs_add(queue, work_find("estimate"), &form, id) == JOBS_TAKEN) ...
 *     cJSON *told = jobs_tell(queue, id);
 *     jobs_expire(queue);                regularly
 *     jobs_close(queue);                 stops the work
 *
 * All functions may be called from any thread. There is one queue in a process, since the library's stop callback has
 * no context. */
#ifndef MERLIN_SERVE_JOBS_JOBS_H
#define MERLIN_SERVE_JOBS_JOBS_H

#include "serve/jobs/work.h"

typedef struct jobs jobs;

typedef struct jobs_params {
    merlin_model *model;
    const merlin_near_network *near; /* NULL: none */
    const store *store;
    work_limits limits;
    size_t most_waiting;
    size_t most_kept;    /* number of ended jobs that are kept; the oldest are removed first */
    uint64_t most_bytes; /* size of all their results; likewise */
    double keep;         /* seconds for which an ended job is kept */
} jobs_params;

status jobs_open(const jobs_params *params, jobs **out);
void jobs_close(jobs *q);

typedef enum jobs_answer {
    JOBS_TAKEN,
    JOBS_REFUSED, /* the form is wrong: status_message() has the reason */
    JOBS_FULL,    /* too many jobs are waiting */
    JOBS_NONE,    /* the job named by its field "job" does not exist, or has no maps */
    JOBS_EARLY,   /* that job is not done */
    JOBS_BROKEN,  /* an error of the server: status_message() */
} jobs_answer;

/* Adds a job, and takes the form over if the result is JOBS_TAKEN; id is that of the form. */
jobs_answer jobs_add(jobs *q, const work_kind *kind, form *f, char id[STORE_ID]);
/* Tells whether another job would be accepted. */
bool jobs_have_room(jobs *q);
/* Returns the state of a job as JSON; NULL: there is none. */
cJSON *jobs_tell(jobs *q, const char *id);
/* Stops a job, and removes it with its files. Returns false if there is none. */
bool jobs_remove(jobs *q, const char *id);
/* Tells whether a job's results can be had. */
typedef enum jobs_results { JOBS_NO_JOB, JOBS_WAIT, JOBS_WITHOUT, JOBS_READY } jobs_results;
jobs_results jobs_look(jobs *q, const char *id);
/* Opens one of a job's results for reading; -1: there is none. */
int jobs_open_file(jobs *q, const char *id, const char *name, uint64_t *bytes);
/* Makes an archive of all of them, to be read from the descriptor. Returns false if there is no such job, or it is not
 * done; then, and if the archive cannot be made, *made is not OK. */
bool jobs_open_archive(jobs *q, const char *id, int *descriptor, uint64_t *bytes, status *made);
/* Removes jobs that have been kept long enough. */
void jobs_expire(jobs *q);
/* Adds the number of waiting jobs, and of those that are kept. */
void jobs_put(jobs *q, cJSON *to);

#endif
