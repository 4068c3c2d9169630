/* SPDX-License-Identifier: MIT */
#include "serve/jobs/job.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

#include "base/file.h"
#include "base/json/json_put.h"
#include "base/text/report.h"

job *job_new(const work_kind *kind, form *f, void *request)
{
    job *j = calloc(1, sizeof *j);
    if (!j) return NULL;
    j->form = *f;
    *f = (form){.bytes = 0};
    j->kind = kind;
    j->request = request;
    j->made = time(NULL);
    return j;
}

void job_free(job *j, const store *s)
{
    if (!j) return;
    store_remove(s, j->form.id);
    cJSON_Delete(j->report);
    form_free(&j->form);
    free(j->files);
    free(j->request);
    free(j);
}

bool job_has_ended(const job *j)
{
    return j->state >= JOB_DONE;
}

void job_tell(job *j, const char *stage, float share)
{
    float before = 0;
    for (const work_stage *s = j->kind->stages; s->name; s++) {
        if (strcmp(s->name, stage) == 0) {
            const float now = before + s->share * share;
            if (now > j->progress) j->progress = now; /* progress does not decrease */
            snprintf(j->stage, sizeof j->stage, "%s", stage);
            return;
        }
        before += s->share;
    }
}

/* ---- results ---- */

static status list_results(job *j, char **names, size_t count)
{
    j->files = calloc(count ? count : 1, sizeof *j->files);
    if (!j->files) return fail(MERLIN_NO_MEMORY, "no memory for the list of results");
    for (size_t i = 0; i < count; i++) {
        struct stat s;
        if (stat(names[i], &s) != 0) return fail_by_errno(MERLIN_CANNOT_WRITE, "the results are gone");
        job_file *file = &j->files[j->file_count++];
        snprintf(file->name, sizeof file->name, "%s", file_name_of(names[i]));
        file->bytes = (uint64_t)s.st_size;
        j->bytes += file->bytes;
    }
    return OK;
}

/* Adds the report that was written with the maps. */
static void take_report(job *j, const char *path)
{
    enum { MOST = 1 << 20 };
    char *text = NULL;
    size_t size;
    if (!j->report || !file_exists(path) || file_read(path, MOST, &text, &size) != OK) return;
    cJSON *written = cJSON_ParseWithLength(text, size);
    free(text);
    for (cJSON *item = written ? written->child : NULL; item;) {
        cJSON *next = item->next;
        cJSON_DetachItemViaPointer(written, item);
        cJSON_DeleteItemFromObject(j->report, item->string);
        cJSON_AddItemToObject(j->report, item->string, item);
        item = next;
    }
    cJSON_Delete(written);
}

status job_take_results(job *j, const store *s)
{
    char path[PATH_MAX], **names = NULL;
    size_t count = 0;
    status done = file_list(store_path(s, j->form.id, STORE_OUT, NULL, path), NULL, &names, &count);
    if (done == OK) done = list_results(j, names, count);
    file_list_free(names, count);
    if (done == OK) take_report(j, store_path(s, j->form.id, STORE_OUT, "report.json", path));
    return done;
}

const job_file *job_find_file(const job *j, const char *name)
{
    for (size_t i = 0; i < j->file_count; i++)
        if (strcmp(j->files[i].name, name) == 0) return &j->files[i];
    return NULL;
}

/* Replaces a folder's path by words that are not longer, or removes it. */
static void replace_all(char *text, const char *what, const char *words)
{
    const size_t length = strlen(what), kept = strlen(words) < length ? strlen(words) : 0;
    for (char *at; length && (at = strstr(text, what));) {
        memmove(at + kept, at + length, strlen(at + length) + 1);
        for (size_t i = 0; i < kept; i++)
            at[i] = words[i];
    }
}

void job_hide_folders(const job *j, const store *s, char *message)
{
    char path[PATH_MAX];
    replace_all(message, store_path(s, j->form.id, STORE_IN, "", path), "");
    replace_all(message, store_path(s, j->form.id, STORE_OUT, "", path), "");
    replace_all(message, store_path(s, j->form.id, STORE_IN, NULL, path), "what was sent");
    replace_all(message, store_path(s, j->form.id, STORE_OUT, NULL, path), "its result");
}

/* ---- JSON ---- */

static void put_files(const job *j, cJSON *to)
{
    cJSON *files = json_put_array(to, "files");
    char url[STORE_ID + SAFE_NAME + 32];
    for (size_t i = 0; i < j->file_count; i++) {
        cJSON *file = json_append_object(files);
        json_put_text(file, "name", j->files[i].name);
        json_put_number(file, "bytes", (double)j->files[i].bytes);
        snprintf(url, sizeof url, "/v1/jobs/%s/files/%s", j->form.id, j->files[i].name);
        json_put_text(file, "url", url);
    }
}

cJSON *job_json(const job *j, size_t position, double keep)
{
    static const char *const states[] = {"queued", "working", "done", "failed", "cancelled"};
    cJSON *o = cJSON_CreateObject();
    char url[STORE_ID + 16];
    snprintf(url, sizeof url, "/v1/jobs/%s", j->form.id);
    json_put_text(o, "version", merlin_version());
    json_put_number(o, "schema", REPORT_SCHEMA);
    json_put_text(o, "id", j->form.id);
    json_put_text(o, "url", url);
    json_put_text(o, "kind", j->kind->name);
    json_put_text(o, "state", states[j->state]);
    if (j->state == JOB_QUEUED) json_put_number(o, "position", (double)position);
    if (j->state == JOB_WORKING && *j->stage) json_put_text(o, "stage", j->stage);
    json_put_number(o, "progress", j->state == JOB_DONE ? 1 : j->progress);
    json_put_number(o, "created", (double)j->made);
    if (job_has_ended(j)) json_put_number(o, "ended", (double)j->ended);
    if (job_has_ended(j)) json_put_number(o, "expires", (double)j->ended + keep);
    if (j->state == JOB_FAILED) json_put_text(o, "error", j->error);
    if (j->state == JOB_DONE) {
        put_files(j, o);
        if (j->report) json_put_item(o, "report", cJSON_Duplicate(j->report, true));
    }
    return o;
}
