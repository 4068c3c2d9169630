/* SPDX-License-Identifier: MIT */
#include "serve/jobs/job_files.h"

#include <fcntl.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

status job_files_open(const job *j, const store *s, job_files *out)
{
    char path[PATH_MAX];
    *out = (job_files){calloc(j->file_count + 1, sizeof(job_file)), calloc(j->file_count + 1, sizeof(archive_file)), 0};
    status done = out->names && out->files ? OK : fail(MERLIN_NO_MEMORY, "no memory for an archive");
    for (size_t i = 0; i < j->file_count && done == OK; i++) {
        job_file *file = &out->names[i];
        *file = j->files[i];
        const int descriptor =
            open(store_path(s, j->form.id, STORE_OUT, file->name, path), O_RDONLY | O_NOFOLLOW | O_CLOEXEC);
        if (descriptor < 0) done = fail_by_errno(MERLIN_BAD_INPUT, "cannot read %s", file->name);
        if (descriptor >= 0) out->files[out->count++] = (archive_file){file->name, descriptor, file->bytes};
    }
    if (done != OK) job_files_close(out);
    return done;
}

void job_files_close(job_files *f)
{
    for (size_t i = 0; i < f->count; i++)
        close(f->files[i].descriptor);
    free(f->names);
    free(f->files);
    *f = (job_files){.count = 0};
}

status job_files_archive(const job_files *f, const store *s, int *descriptor, uint64_t *bytes)
{
    status done = store_open_unnamed(s, descriptor);
    if (done != OK) return done;
    done = archive_write(*descriptor, f->files, f->count, bytes);
    if (done == OK && lseek(*descriptor, 0, SEEK_SET) == 0) return OK;
    if (done == OK) done = fail_by_errno(MERLIN_CANNOT_WRITE, "the server cannot make an archive");
    close(*descriptor);
    *descriptor = -1;
    return done;
}
