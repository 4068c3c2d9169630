/* SPDX-License-Identifier: MIT */
/* merlin as a server: a page and an HTTP interface (docs/serve.md).
 *
 *     const serve_params params = {.model = model, .port = 8712, .keep_minutes = 30, ...};
 *     serve *s;
 *     if (serve_open(&params, &s) == OK) {
 *         printf("%s\n", serve_address(s, 0));
 *         serve_run(s, stop);
 *     }
 *     serve_close(s);                     ends the work, removes all uploads and results
 *
 * It stands on the public library (include/merlin) and src/base alone. */
#ifndef MERLIN_SERVE_SERVE_H
#define MERLIN_SERVE_SERVE_H

#include "base/status.h"
#include "merlin/model.h"
#include "merlin/stereo.h"
#include "serve/http/guard.h"

typedef struct serve serve;

typedef struct serve_params {
    merlin_model *model;
    const merlin_near_network *near;      /* of near lights; NULL: none */
    const char *host;                     /* NULL: this machine alone, 127.0.0.1 */
    const char *names[GUARD_MOST_NAMES];  /* further ones by which clients call it; ended by NULL */
    const char *token;                    /* NULL: none, with `host` one is made up */
    int port;                             /* 0: one that is free */
    int keep_minutes;                     /* minutes for which results stay */
    int most_waiting;                     /* jobs in the queue */
    int most_kept;                        /* results */
    int upload_megabytes, kept_megabytes; /* size of a request, and of all results */
    int megapixels;                       /* size of a photograph */
} serve_params;

/* Binds the port and starts to answer. */
status serve_open(const serve_params *params, serve **out);
void serve_close(serve *s);

/* Returns an address for a browser, with the token if there is one. There is one, index 0, or, where it listens at all
 * of the machine's, one for each name and network; NULL: there are no more. */
const char *serve_address(const serve *s, int index);
/* Returns when stop does so. */
void serve_run(serve *s, int (*stop)(void));

#endif
