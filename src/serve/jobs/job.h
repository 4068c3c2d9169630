/* SPDX-License-Identifier: MIT */
/* One job: what it was asked for, how far it is, what came of it. The queue (jobs/jobs.h) guards it by a lock. */
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
    bool unwanted; /* its client has let go of it: it is removed as soon as nobody works on it */
    char stage[32];
    float progress; /* of all stages, in [0, 1] */
    time_t made, ended;
    status failure;
    char error[1024];
    cJSON *report;
    job_file *files;
    size_t file_count;
    uint64_t bytes;
} job;

/* Takes the form over, and what it asks for was checked. */
job *job_new(const work_kind *kind, form *f, void *request);
/* Frees it and removes its files. */
void job_free(job *j, const store *s);

bool job_has_ended(const job *j);
/* Notes a stage and the share of it that is done. */
void job_tell(job *j, const char *stage, float share);
/* Lists the files of its results; an ended job keeps none of its uploads. */
status job_take_results(job *j, const store *s);
/* The name as the job has it, or NULL: nothing of the client's is made a path. */
const job_file *job_find_file(const job *j, const char *name);
/* Replaces the folders of the store in a message by nothing: clients know the files' names alone. */
void job_hide_folders(const job *j, const store *s, char *message);
/* What its client is told. position: how many jobs come before it. keep: seconds for which it stays when it has ended.
 */
cJSON *job_json(const job *j, size_t position, double keep);

#endif
