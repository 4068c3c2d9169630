/* SPDX-License-Identifier: MIT */
/* The files that came of a job, held open, so that they can be read after the job is gone. */
#ifndef MERLIN_SERVE_JOBS_JOB_FILES_H
#define MERLIN_SERVE_JOBS_JOB_FILES_H

#include "serve/jobs/archive.h"
#include "serve/jobs/job.h"

typedef struct job_files {
    job_file *names;
    archive_file *files;
    size_t count;
} job_files;

status job_files_open(const job *j, const store *s, job_files *out);
void job_files_close(job_files *f);
/* Writes them as a ZIP archive to a file without a name, and sets *descriptor to read it from its beginning. */
status job_files_archive(const job_files *f, const store *s, int *descriptor, uint64_t *bytes);

#endif
