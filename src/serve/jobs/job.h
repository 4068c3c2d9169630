/* SPDX-License-Identifier: MIT */
/* One job: its request, progress and results. The queue (jobs/jobs.h) protects it by a lock. */
#ifndef MERLIN_SERVE_JOBS_JOB_H
#define MERLIN_SERVE_JOBS_JOB_H

#include <time.h>

#include "serve/jobs/work.h"

typedef enum job_state { JOB_QUEUED, JOB_WORKING, JOB_DONE, JOB_FAILED, JOB_CANCELLED } job_state;

typedef struct job_file {
    char name[SAFE_NAME];
    uint64_t bytes;
} job_file;

typedef struct job {
    form form; /* its identifier is the job's */
    const work_kind *kind;
    void *request;
    job_state state;
    bool unwanted; /* its client has removed it: it is deleted as soon as nothing works on it */
    char stage[32];
    float progress; /* over all stages, in [0, 1] */
    time_t made, ended;
    status failure;
    char error[1024];
    cJSON *report;
    job_file *files;
    size_t file_count;
    uint64_t bytes;
} job;

/* Makes a job; takes over the form and the checked request. */
job *job_new(const work_kind *kind, form *f, void *request);
/* Frees it and removes its files. */
void job_free(job *j, const store *s);

bool job_has_ended(const job *j);
/* Records a stage and the share of it that is done. */
void job_tell(job *j, const char *stage, float share);
/* Lists the files of its results; an ended job keeps none of its uploads. */
status job_take_results(job *j, const store *s);
/* Returns the file of this name, or NULL: a path is never made from a client's text. */
const job_file *job_find_file(const job *j, const char *name);
/* Removes the store's folders from a message, as clients know only the files' names; a folder itself is called "what
 * was sent" or "its result". */
void job_hide_folders(const job *j, const store *s, char *message);
/* Returns the job's state for its client. position: number of jobs before it. keep: seconds for which it is kept after
 * its end. */
cJSON *job_json(const job *j, size_t position, double keep);

#endif
