/* SPDX-License-Identifier: MIT */
#include "serve/serve.h"

#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/random.h>
#include <time.h>
#include <unistd.h>

#include "serve/http/addresses.h"
#include "serve/http/http_library.h"
#include "serve/http/listen.h"
#include "serve/http/requests.h"
#include "serve/serve_texts.h"

enum { TOKEN = 32, NONCE = 24, ADDRESS = 512 };

struct serve {
    request_site site;
    store *store;
    struct MHD_Daemon *daemon;
    int socket;
    char token[2 * TOKEN + 1], nonce[NONCE + 1];
    char policy[512], address[ADDRESSES_MOST][ADDRESS];
    int address_count;
    char *page, *openapi;
};

/* ---- texts ---- */

/* Joins lines, with `by` in the place of `what` (may be NULL); malloc'ed, NULL without memory. */
static char *join(const char *const *lines, const char *what, const char *by)
{
    char *text = NULL;
    size_t size;
    FILE *f = open_memstream(&text, &size);
    if (!f) return NULL;
    for (; *lines; lines++) {
        const char *at = what ? strstr(*lines, what) : NULL;
        if (at)
            fprintf(f, "%.*s%s%s\n", (int)(at - *lines), *lines, by, at + strlen(what));
        else
            fprintf(f, "%s\n", *lines);
    }
    const bool whole = !ferror(f);
    if (fclose(f) == 0 && whole) return text;
    free(text);
    return NULL;
}

static status random_hex(char *text, size_t digits)
{
    unsigned char bits[TOKEN];
    if (getrandom(bits, digits / 2, 0) != (ssize_t)(digits / 2))
        return fail_by_errno(MERLIN_DEVICE_FAILED, "the system gives no random numbers");
    for (size_t i = 0; i < digits / 2; i++)
        snprintf(text + 2 * i, 3, "%02x", bits[i]);
    return OK;
}

/* The page's script and style run because they carry a word that nobody else knows. */
static status make_texts(serve *s)
{
    status done = random_hex(s->nonce, NONCE);
    if (done != OK) return done;
    snprintf(s->policy, sizeof s->policy,
             "default-src 'none'; script-src 'nonce-%s'; style-src 'nonce-%s'; img-src 'self' data: blob:; "
             "connect-src 'self'; frame-src 'self'; base-uri 'none'; form-action 'none'; frame-ancestors 'none'",
             s->nonce, s->nonce);
    s->page = join(serve_page, "@nonce@", s->nonce);
    s->openapi = join(serve_openapi, NULL, NULL);
    s->site.page = s->page;
    s->site.page_policy = s->policy;
    s->site.openapi = s->openapi;
    return s->page && s->openapi ? OK : fail(MERLIN_NO_MEMORY, "no memory for the page");
}

/* ---- beginning ---- */

static status make_guard(const serve_params *p, serve *s)
{
    guard *g = &s->site.guard;
    memcpy(g->names, p->names, sizeof g->names);
    g->port = p->port;
    g->local = !p->host;
    g->token = p->token;
    if (p->token || !p->host) return OK;
    g->token = s->token;
    return random_hex(s->token, TOKEN);
}

static void make_addresses(const serve_params *p, serve *s)
{
    const char *token = s->site.guard.token;
    addresses hosts;
    addresses_list(p->host ? p->host : "127.0.0.1", p->names, &hosts);
    for (int i = 0; i < hosts.count; i++)
        snprintf(s->address[i], ADDRESS, "http://%s:%d/%s%s", hosts.at[i], s->site.guard.port, token ? "?token=" : "",
                 token ? token : "");
    s->address_count = hosts.count;
}

static status start_daemon(serve *s)
{
    enum { CONNECTIONS = 128, SECONDS_IDLE = 30, HEAD = 64 << 10 };
    s->daemon =
        http()->start_daemon(MHD_USE_AUTO_INTERNAL_THREAD, 0, NULL, NULL, requests_answer, &s->site,
                             MHD_OPTION_LISTEN_SOCKET, s->socket, MHD_OPTION_NOTIFY_COMPLETED, requests_end, &s->site,
                             MHD_OPTION_CONNECTION_LIMIT, (unsigned)CONNECTIONS, MHD_OPTION_CONNECTION_TIMEOUT,
                             (unsigned)SECONDS_IDLE, MHD_OPTION_CONNECTION_MEMORY_LIMIT, (size_t)HEAD, MHD_OPTION_END);
    return s->daemon ? OK : fail(MERLIN_DEVICE_FAILED, "the HTTP server does not start: is there memory for it?");
}

static status begin(const serve_params *p, serve *s)
{
    const upload_limits limits = {(uint64_t)p->upload_megabytes << 20, 1024, 15 * 60};
    s->site.limits = limits;
    s->site.work_limits = (work_limits){p->megapixels, 1024};
    s->site.model = merlin_model_name(p->model);
    s->site.keep = 60.0 * p->keep_minutes;
    status done = make_guard(p, s);
    if (done == OK) done = make_texts(s);
    if (done == OK) done = http_load();
    if (done == OK) done = listen_at(p->host ? p->host : "127.0.0.1", &s->site.guard.port, &s->socket);
    if (done == OK) done = store_open(&s->store);
    if (done != OK) return done;
    s->site.store = s->store;
    const jobs_params queue = {.model = p->model,
                               .near = p->near,
                               .store = s->store,
                               .limits = s->site.work_limits,
                               .most_waiting = (size_t)p->most_waiting,
                               .most_kept = (size_t)p->most_kept,
                               .most_bytes = (uint64_t)p->kept_megabytes << 20,
                               .keep = s->site.keep};
    done = jobs_open(&queue, &s->site.jobs);
    if (done == OK) done = start_daemon(s);
    if (done == OK) make_addresses(p, s);
    return done;
}

status serve_open(const serve_params *params, serve **out)
{
    *out = NULL;
    serve *s = calloc(1, sizeof *s);
    if (!s) return fail(MERLIN_NO_MEMORY, "no memory for a server");
    s->socket = -1;
    (void)signal(SIGPIPE, SIG_IGN); /* clients leave when they like */
    status done = begin(params, s);
    if (done == OK)
        *out = s;
    else
        serve_close(s);
    return done;
}

void serve_close(serve *s)
{
    if (!s) return;
    if (s->daemon) http()->stop_daemon(s->daemon); /* closes the socket, too */
    if (!s->daemon && s->socket >= 0) close(s->socket);
    jobs_close(s->site.jobs);
    store_close(s->store);
    free(s->page);
    free(s->openapi);
    free(s);
}

const char *serve_address(const serve *s, int index)
{
    return index < s->address_count ? s->address[index] : NULL;
}

void serve_run(serve *s, int (*stop)(void))
{
    const struct timespec pause = {0, 200 * 1000 * 1000};
    while (!stop()) {
        jobs_expire(s->site.jobs);
        (void)nanosleep(&pause, NULL);
    }
}
