/* SPDX-License-Identifier: MIT */
#include "serve/http/requests.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/json/json_put.h"
#include "base/text/report.h"
#include "serve/http/answer.h"
#include "serve/jobs/work_find.h"

/* State of a request until its body has arrived. */
typedef struct request {
    const work_kind *kind; /* kind of a POST; NULL for others, whose body is not read */
    upload *upload;        /* NULL: it will be refused */
    uint64_t ignored;      /* bytes of a body that is not read */
    unsigned code;         /* status of a refusal after its body; 0: none */
    const char *fault, *words;
    const char *allow; /* methods of the resource, if another one was asked */
} request;

enum { LONGEST_IGNORED = 64 << 10 };

/* ---- resources ---- */

static const char PAGE[] = "/", DESCRIPTION[] = "/v1/openapi.json", STATUS[] = "/v1/status", JOBS[] = "/v1/jobs/";
/* The rest of a path behind a job's identifier. */
static const char FILES[] = "/files/", ARCHIVE[] = "/files.zip";

static const work_kind *kind_of(const char *url)
{
    return strncmp(url, "/v1/", 4) == 0 ? work_find(url + 4) : NULL;
}

static bool is_job(const char *url)
{
    return strncmp(url, JOBS, sizeof JOBS - 1) == 0;
}

/* Tells whether the rest of a job's path is that of results. */
static bool is_results(const char *rest)
{
    return strcmp(rest, ARCHIVE) == 0 || strncmp(rest, FILES, sizeof FILES - 1) == 0;
}

/* Returns the methods of a resource, as in the header Allow; NULL: there is no such resource. */
static const char *methods_of(const char *url)
{
    if (kind_of(url)) return "POST";
    if (is_job(url)) return strchr(url + sizeof JOBS - 1, '/') ? "GET, HEAD" : "GET, HEAD, DELETE";
    const bool known = strcmp(url, PAGE) == 0 || strcmp(url, DESCRIPTION) == 0 || strcmp(url, STATUS) == 0;
    return known ? "GET, HEAD" : NULL;
}

/* Tells whether a list with commas has this word. */
static bool has_word(const char *list, const char *word)
{
    const size_t length = strlen(word);
    for (const char *at = list; *at; at += strspn(at, ", ")) {
        const size_t next = strcspn(at, ",");
        if (next == length && strncmp(at, word, length) == 0) return true;
        at += next;
    }
    return false;
}

/* Refuses a request as soon as its body has been read. */
static void will_refuse(request *r, unsigned code, const char *fault, const char *words)
{
    r->code = code;
    r->fault = fault;
    r->words = words;
}

/* ---- access ---- */

static void refuse_asker(const request_site *site, request *r, guard_answer answer)
{
    if (answer == GUARD_NO_HOST && site->guard.local)
        will_refuse(r, MHD_HTTP_FORBIDDEN, "wrong_host", "this server answers to 127.0.0.1 and localhost alone");
    else if (answer == GUARD_NO_HOST)
        will_refuse(r, MHD_HTTP_FORBIDDEN, "wrong_host",
                    "this server does not answer to that name: merlin serve --name NAME");
    else if (answer == GUARD_OTHER_SITE)
        will_refuse(r, MHD_HTTP_FORBIDDEN, "other_site", "other sites' pages may not ask this server");
    else if (answer == GUARD_NO_TOKEN)
        will_refuse(r, MHD_HTTP_UNAUTHORIZED, "no_token",
                    "this server wants its token: Authorization: Bearer TOKEN, or /?token=TOKEN in a browser");
}

static guard_answer ask(const request_site *site, struct MHD_Connection *c, bool is_page)
{
    char cookie[GUARD_COOKIE];
    guard_cookie(&site->guard, cookie);
    const guard_asked asked = {
        .host = http_header(c, "Host"),
        .origin = http_header(c, "Origin"),
        .fetch_site = http_header(c, "Sec-Fetch-Site"),
        .authorization = http_header(c, "Authorization"),
        .cookie = http()->lookup_connection_value(c, MHD_COOKIE_KIND, cookie),
        .is_page = is_page,
    };
    return guard_ask(&site->guard, &asked);
}

/* Gives a browser that has the token in the page's address a cookie, which scripts cannot read. */
static bool signs_in(const request_site *site, struct MHD_Connection *c)
{
    const char *token = http()->lookup_connection_value(c, MHD_GET_ARGUMENT_KIND, "token");
    return site->guard.token && token && guard_is_token(&site->guard, token);
}

static enum MHD_Result sign_in(const request_site *site, struct MHD_Connection *c)
{
    char name[GUARD_COOKIE], cookie[512];
    guard_cookie(&site->guard, name);
    if (snprintf(cookie, sizeof cookie, "%s=%s; Path=/; HttpOnly; SameSite=Strict", name, site->guard.token) >=
        (int)sizeof cookie)
        return MHD_NO;
    return answer_signed_in(c, cookie);
}

/* ---- GET and DELETE ---- */

static enum MHD_Result not_found(struct MHD_Connection *c)
{
    return answer_error(c, MHD_HTTP_NOT_FOUND, "not_found", "there is no such thing here: see /v1/openapi.json");
}

static enum MHD_Result no_job(struct MHD_Connection *c)
{
    return answer_error(c, MHD_HTTP_NOT_FOUND, "no_job", "there is no such job, or it was removed");
}

static enum MHD_Result answer_status(const request_site *site, struct MHD_Connection *c)
{
    cJSON *o = cJSON_CreateObject(), *limits;
    json_put_text(o, "version", merlin_version());
    json_put_number(o, "schema", REPORT_SCHEMA);
    json_put_text(o, "model", site->model);
    json_put_number(o, "keep_seconds", site->keep);
    jobs_put(site->jobs, o);
    limits = json_put_object(o, "limits");
    json_put_number(limits, "bytes", (double)site->limits.bytes);
    json_put_number(limits, "files", (double)site->limits.files);
    json_put_number(limits, "megapixels", site->work_limits.megapixels);
    return answer_json(c, MHD_HTTP_OK, o, NULL);
}

static enum MHD_Result answer_archive(const request_site *site, struct MHD_Connection *c, const char *id)
{
    int descriptor;
    uint64_t bytes;
    status made;
    if (!jobs_open_archive(site->jobs, id, &descriptor, &bytes, &made)) return no_job(c);
    if (made != OK) return answer_error(c, MHD_HTTP_INSUFFICIENT_STORAGE, "no_room", status_message());
    return answer_file(c, descriptor, bytes, "merlin.zip");
}

static enum MHD_Result answer_file_of(const request_site *site, struct MHD_Connection *c, const char *id,
                                      const char *name)
{
    uint64_t bytes = 0;
    const int descriptor = jobs_open_file(site->jobs, id, name, &bytes);
    return descriptor < 0 ? not_found(c) : answer_file(c, descriptor, bytes, name);
}

/* Answers requests for results; rest: what follows the job's identifier. */
static enum MHD_Result answer_results(const request_site *site, struct MHD_Connection *c, const char *id,
                                      const char *rest)
{
    switch (jobs_look(site->jobs, id)) {
    case JOBS_NO_JOB:
        return no_job(c);
    case JOBS_WAIT:
        return answer_error(c, MHD_HTTP_CONFLICT, "not_done", "the job is not done: its files come when its state is");
    case JOBS_WITHOUT:
        return answer_error(c, MHD_HTTP_CONFLICT, "not_done", "the job failed or was cancelled, and has no files");
    case JOBS_READY:
        break;
    }
    if (strcmp(rest, ARCHIVE) == 0) return answer_archive(site, c, id);
    return answer_file_of(site, c, id, rest + sizeof FILES - 1);
}

/* Answers requests for a job; rest: what follows /v1/jobs/. */
static enum MHD_Result answer_job(const request_site *site, struct MHD_Connection *c, const char *rest, bool remove)
{
    char id[STORE_ID];
    snprintf(id, sizeof id, "%s", rest);
    if (!store_is_id(id)) return no_job(c);
    rest += STORE_ID - 1;
    if (!*rest && remove) return jobs_remove(site->jobs, id) ? answer_nothing(c) : no_job(c);
    if (*rest) return is_results(rest) ? answer_results(site, c, id, rest) : not_found(c);
    cJSON *told = jobs_tell(site->jobs, id);
    return told ? answer_json(c, MHD_HTTP_OK, told, NULL) : no_job(c);
}

static enum MHD_Result answer_get(const request_site *site, struct MHD_Connection *c, const char *url, bool remove)
{
    if (is_job(url)) return answer_job(site, c, url + sizeof JOBS - 1, remove);
    if (strcmp(url, PAGE) == 0) return answer_text(c, "text/html; charset=utf-8", site->page, site->page_policy);
    if (strcmp(url, DESCRIPTION) == 0) return answer_text(c, "application/json", site->openapi, NULL);
    if (strcmp(url, STATUS) == 0) return answer_status(site, c);
    return not_found(c);
}

/* ---- POST ---- */

/* Returns the announced length of a body; 0 if there is none. */
static uint64_t announced(struct MHD_Connection *c)
{
    const char *text = http_header(c, "Content-Length");
    return text ? strtoull(text, NULL, 10) : 0;
}

/* Prepares for the body, or for its refusal. */
static void begin_post(const request_site *site, struct MHD_Connection *c, request *r)
{
    if (!jobs_have_room(site->jobs)) {
        will_refuse(r, MHD_HTTP_SERVICE_UNAVAILABLE, "busy", "too many jobs wait already: try again later");
        return;
    }
    r->upload = upload_new(site->store, &site->limits, c);
    if (!r->upload)
        will_refuse(r, MHD_HTTP_SERVICE_UNAVAILABLE, "no_memory", "the server has no memory for this upload");
}

static enum MHD_Result refuse_upload(struct MHD_Connection *c, upload_fault fault)
{
    switch (fault) {
    case UPLOAD_TOO_LARGE:
        return answer_error(c, MHD_HTTP_CONTENT_TOO_LARGE, "too_large", status_message());
    case UPLOAD_NO_ROOM:
        return answer_error(c, MHD_HTTP_INSUFFICIENT_STORAGE, "no_room", status_message());
    default:
        return answer_error(c, MHD_HTTP_BAD_REQUEST, "wrong", status_message());
    }
}

static enum MHD_Result answer_taken(const request_site *site, struct MHD_Connection *c, const char *id)
{
    char location[STORE_ID + 16];
    snprintf(location, sizeof location, "/v1/jobs/%s", id);
    cJSON *told = jobs_tell(site->jobs, id);
    return told ? answer_json(c, MHD_HTTP_ACCEPTED, told, location) : no_job(c);
}

static enum MHD_Result end_post(const request_site *site, struct MHD_Connection *c, request *r)
{
    form f = {.bytes = 0};
    char id[STORE_ID];
    const upload_fault fault = upload_finish(r->upload, &f);
    if (fault != UPLOAD_FINE) return refuse_upload(c, fault);
    const jobs_answer answer = jobs_add(site->jobs, r->kind, &f, id);
    if (answer == JOBS_TAKEN) return answer_taken(site, c, id);
    store_remove(site->store, f.id);
    form_free(&f);
    switch (answer) {
    case JOBS_REFUSED:
        return answer_error(c, MHD_HTTP_BAD_REQUEST, "wrong", status_message());
    case JOBS_FULL:
        return answer_error(c, MHD_HTTP_SERVICE_UNAVAILABLE, "busy", "too many jobs wait already: try again later");
    case JOBS_NONE:
        return answer_error(c, MHD_HTTP_NOT_FOUND, "no_job", "the job that \"job\" names is not there, or has no maps");
    case JOBS_EARLY:
        return answer_error(c, MHD_HTTP_CONFLICT, "not_done", "the job that \"job\" names is not done");
    default:
        return answer_error(c, MHD_HTTP_INSUFFICIENT_STORAGE, "no_room", status_message());
    }
}

/* ---- the callbacks ---- */

static enum MHD_Result refuse(struct MHD_Connection *c, const request *r)
{
    return r->allow ? answer_no_method(c, r->allow) : answer_error(c, r->code, r->fault, r->words);
}

/* Refuses what can be refused by a request's head. */
static void check_head(const request_site *site, struct MHD_Connection *c, const char *url, const char *method,
                       request *r)
{
    const bool is_post = strcmp(method, "POST") == 0;
    const char *allow = methods_of(url);
    if (r->code) return;
    if (!allow)
        will_refuse(r, MHD_HTTP_NOT_FOUND, "not_found", "there is no such thing here: see /v1/openapi.json");
    else if (!has_word(allow, method)) {
        will_refuse(r, MHD_HTTP_METHOD_NOT_ALLOWED, "no_method", allow);
        r->allow = allow;
    } else if (announced(c) > (is_post ? site->limits.bytes : LONGEST_IGNORED))
        will_refuse(r, MHD_HTTP_CONTENT_TOO_LARGE, "too_large", "the request is larger than this server takes");
}

/* Tells whether a body is to be read although nobody wants it: a client that is still sending when its connection is
 * closed may not see the answer. */
static bool is_drained(const request_site *site, struct MHD_Connection *c, const char *method)
{
    const uint64_t length = announced(c);
    return strcmp(method, "POST") == 0 && length > 0 && length <= site->limits.bytes;
}

/* Starts a request by its head. Returns NULL if it was answered, or its connection is to be closed: *result. */
static request *begin(const request_site *site, struct MHD_Connection *c, const char *url, const char *method,
                      enum MHD_Result *result)
{
    const bool is_page = (strcmp(method, "GET") == 0 || strcmp(method, "HEAD") == 0) && strcmp(url, "/") == 0;
    const guard_answer answer = ask(site, c, is_page);
    request *r = calloc(1, sizeof *r);
    if (!r) return NULL;
    if (answer == GUARD_NO_TOKEN && is_page && signs_in(site, c)) {
        *result = sign_in(site, c);
        free(r);
        return NULL;
    }
    refuse_asker(site, r, answer);
    check_head(site, c, url, method, r);
    if (r->code && !is_drained(site, c, method)) {
        *result = refuse(c, r);
        free(r);
        return NULL;
    }
    if (!r->code && strcmp(method, "POST") == 0) {
        r->kind = kind_of(url);
        begin_post(site, c, r);
    }
    return r;
}

/* Returns false if no more of a body is to be read. */
static bool take(const request_site *site, request *r, const char *data, size_t size)
{
    if (r->upload) return upload_take(r->upload, data, size);
    r->ignored += size;
    return r->ignored <= (r->code ? site->limits.bytes : LONGEST_IGNORED);
}

enum MHD_Result requests_answer(void *context, struct MHD_Connection *c, const char *url, const char *method,
                                const char *version, const char *data, size_t *size, void **own)
{
    const request_site *site = context;
    enum MHD_Result result = MHD_NO;
    request *r = *own;
    (void)version;
    if (!r) {
        *own = r = begin(site, c, url, method, &result);
        return r ? MHD_YES : result;
    }
    if (*size) {
        const size_t taken = *size;
        *size = 0;
        return take(site, r, data, taken) ? MHD_YES : MHD_NO;
    }
    if (r->code) return refuse(c, r);
    return r->kind ? end_post(site, c, r) : answer_get(site, c, url, strcmp(method, "DELETE") == 0);
}

void requests_end(void *context, struct MHD_Connection *c, void **own, enum MHD_RequestTerminationCode code)
{
    request *r = *own;
    (void)context;
    (void)c;
    (void)code;
    if (r) upload_free(r->upload);
    free(r);
    *own = NULL;
}
