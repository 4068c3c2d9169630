/* SPDX-License-Identifier: MIT */
#include "base/folder_batch.h"

#include <pthread.h>
#include <stdatomic.h>
#include <stdio.h>
#include <string.h>

#include "base/parallel.h"
#include "base/staging.h"

typedef struct running {
    const folder_batch *batch;
    staging *staging; /* NULL: into the folder itself */
    pthread_t owner;  /* thread that reports progress */
    atomic_size_t done;
} running;

static const char *path_of(const running *r, const char *name, char path[PATH_MAX])
{
    if (r->staging) return staging_path(r->staging, name, path);
    snprintf(path, PATH_MAX, "%s/%s", r->batch->folder, name);
    return path;
}

static status write_one(void *context, size_t i)
{
    running *r = context;
    const folder_batch *b = r->batch;
    char path[PATH_MAX];
    if (watch_stops(&b->watch)) return fail(MERLIN_STOPPED, "stopped");
    status s = b->files[i].write(b->job, path_of(r, b->files[i].name, path));
    const size_t done = atomic_fetch_add(&r->done, 1) + 1;
    if (pthread_equal(r->owner, pthread_self())) watch_tell(&b->watch, "writing", (double)done / (double)b->steps);
    return s;
}

static status begin(const folder_batch *b, staging **out)
{
    const size_t length = strlen(b->folder);
    *out = NULL;
    if (!b->in_place) return staging_begin(b->folder, NULL, out);
    if (length + 1 + NAME_MAX < PATH_MAX) return OK;
    return fail(MERLIN_CANNOT_WRITE, "a path of %zu bytes is too long", length);
}

status folder_batch_write(const folder_batch *batch)
{
    running r = {.batch = batch, .owner = pthread_self()};
    status s = begin(batch, &r.staging);
    if (s != OK) return s;
    s = parallel_try(batch->count, write_one, &r);
    if (s == OK && watch_stops(&batch->watch)) s = fail(MERLIN_STOPPED, "stopped");
    if (batch->in_place) return s;
    return s == OK ? staging_commit(r.staging, NULL) : staging_abort(r.staging, s);
}
