/* SPDX-License-Identifier: MIT */
#include "serve/http/upload.h"

#include <errno.h>
#include <fcntl.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "base/progress.h"

struct upload {
    const store *store;
    const upload_limits *limits;
    struct MHD_PostProcessor *parser;
    form form;
    int file;       /* descriptor of the file being received; -1: none */
    char *value;    /* value of the field being received; NULL: none */
    size_t length;  /* length of the value */
    uint64_t taken; /* bytes of the request */
    double began;
    upload_fault fault;
    char words[512]; /* message of the fault */
};

/* Records the first fault; further ones are its consequences. */
static enum MHD_Result refuse(upload *u, upload_fault fault, const char *format, ...)
    __attribute__((format(printf, 3, 4)));
static enum MHD_Result refuse(upload *u, upload_fault fault, const char *format, ...)
{
    va_list args;
    va_start(args, format);
    if (u->fault == UPLOAD_FINE) vsnprintf(u->words, sizeof u->words, format, args);
    if (u->fault == UPLOAD_FINE) u->fault = fault;
    va_end(args);
    return MHD_NO;
}

static enum MHD_Result no_memory(upload *u)
{
    return refuse(u, UPLOAD_NO_ROOM, "the server has no memory for this upload");
}

/* ---- parts ---- */

static bool is_key(const char *key)
{
    const size_t length = strspn(key, "abcdefghijklmnopqrstuvwxyz_");
    return length > 0 && length < FORM_KEY && !key[length];
}

static void close_file(upload *u)
{
    if (u->file >= 0 && close(u->file) != 0)
        refuse(u, UPLOAD_NO_ROOM, "the server cannot keep uploads: %s", strerror(errno));
    u->file = -1;
}

static enum MHD_Result begin_file(upload *u, const char *key, const char *name)
{
    char path[PATH_MAX];
    if (u->form.file_count >= u->limits->files)
        return refuse(u, UPLOAD_WRONG, "more than %zu files in one request", u->limits->files);
    const form_file *file = form_add_file(&u->form, key, name);
    if (!file) return no_memory(u);
    store_path(u->store, u->form.id, STORE_IN, file->name, path);
    u->file = open(path, O_WRONLY | O_CREAT | O_EXCL | O_NOFOLLOW | O_CLOEXEC, 0600);
    if (u->file >= 0) return MHD_YES;
    return refuse(u, UPLOAD_NO_ROOM, "the server cannot keep uploads: %s", strerror(errno));
}

static enum MHD_Result begin_field(upload *u, const char *key)
{
    if (u->form.field_count >= FORM_MOST_FIELDS)
        return refuse(u, UPLOAD_WRONG, "more than %d fields in one request", FORM_MOST_FIELDS);
    form_field *field = form_add_field(&u->form, key);
    if (!field) return no_memory(u);
    u->value = field->value;
    u->length = 0;
    return MHD_YES;
}

/* Appends to the open file or value. */
static enum MHD_Result continue_part(upload *u, const char *key, const char *data, size_t size)
{
    if (u->file < 0) {
        if (u->length + size > FORM_MOST_VALUE || memchr(data, 0, size))
            return refuse(u, UPLOAD_WRONG, "%s is too long, or no text", key);
        memcpy(u->value + u->length, data, size);
        u->length += size;
        u->value[u->length] = 0;
        return MHD_YES;
    }
    form_file *file = &u->form.files[u->form.file_count - 1];
    file->bytes += size;
    u->form.bytes += size;
    while (size) {
        ssize_t put = write(u->file, data, size);
        if (put < 0 && errno == EINTR) continue;
        if (put <= 0) return refuse(u, UPLOAD_NO_ROOM, "the server cannot keep uploads: %s", strerror(errno));
        data += put;
        size -= (size_t)put;
    }
    return MHD_YES;
}

/* Receives each piece of each part; a part begins at 0. A file field without a chosen file has no name, and is ignored.
 */
static enum MHD_Result hear(void *context, enum MHD_ValueKind kind, const char *key, const char *name, const char *type,
                            const char *encoding, const char *data, uint64_t at, size_t size)
{
    upload *u = context;
    (void)kind;
    (void)type;
    (void)encoding;
    if (!key || !is_key(key)) return refuse(u, UPLOAD_WRONG, "a part without a name, or with one that is no word");
    if (at == 0) {
        close_file(u);
        u->value = NULL;
        if (name && !*name && size == 0) return MHD_YES;
        if ((name ? begin_file(u, key, name) : begin_field(u, key)) == MHD_NO) return MHD_NO;
    }
    return u->file >= 0 || u->value ? continue_part(u, key, data, size) : MHD_YES;
}

/* ---- the whole ---- */

upload *upload_new(const store *s, const upload_limits *limits, struct MHD_Connection *c)
{
    enum { BUFFER = 64 << 10 };
    upload *u = calloc(1, sizeof *u);
    if (!u) return NULL;
    u->store = s;
    u->limits = limits;
    u->file = -1;
    u->began = clock_seconds();
    u->parser = http()->create_post_processor(c, BUFFER, hear, u);
    if (!u->parser) refuse(u, UPLOAD_WRONG, "the request is no multipart/form-data");
    if (u->parser && store_add(s, u->form.id) != OK) {
        refuse(u, UPLOAD_NO_ROOM, "%s", status_message());
        *u->form.id = 0;
    }
    return u;
}

bool upload_take(upload *u, const char *data, size_t size)
{
    u->taken += size;
    if (clock_seconds() - u->began > u->limits->seconds) return false;
    if (u->taken > 2 * u->limits->bytes) return false;
    if (u->taken > u->limits->bytes)
        refuse(u, UPLOAD_TOO_LARGE, "the request has more than %.0f million bytes", 1e-6 * (double)u->limits->bytes);
    if (u->fault == UPLOAD_FINE && http()->post_process(u->parser, data, size) == MHD_NO)
        refuse(u, UPLOAD_WRONG, "the request's body is no proper multipart/form-data");
    return true;
}

upload_fault upload_finish(upload *u, form *out)
{
    close_file(u);
    if (u->parser && http()->destroy_post_processor(u->parser) == MHD_NO)
        refuse(u, UPLOAD_WRONG, "the request's body ends too early, or is no proper multipart/form-data");
    u->parser = NULL;
    if (u->fault != UPLOAD_FINE) (void)fail(MERLIN_WRONG_USE, "%s", u->words);
    if (u->fault != UPLOAD_FINE) return u->fault;
    *out = u->form;
    u->form = (form){.bytes = 0};
    return UPLOAD_FINE;
}

void upload_free(upload *u)
{
    if (!u) return;
    if (u->file >= 0) close(u->file);
    if (u->parser) (void)http()->destroy_post_processor(u->parser);
    if (*u->form.id) store_remove(u->store, u->form.id);
    form_free(&u->form);
    free(u);
}
