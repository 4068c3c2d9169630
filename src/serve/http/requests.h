/* SPDX-License-Identifier: MIT */
/* Requests and their responses:
 *
 *     GET    /                              the page
 *     GET    /v1/openapi.json               the description of this interface
 *     GET    /v1/status                     version, limits, number of waiting jobs
 *     POST   /v1/KIND                       an upload becomes a job (jobs/work.h lists the kinds)
 *     GET    /v1/jobs/ID                    its progress, and the names of its files
 *     DELETE /v1/jobs/ID                    stops it and removes its files
 *     GET    /v1/jobs/ID/files/NAME         one of these
 *     GET    /v1/jobs/ID/files.zip          all of them */
#ifndef MERLIN_SERVE_HTTP_REQUESTS_H
#define MERLIN_SERVE_HTTP_REQUESTS_H

#include "serve/http/guard.h"
#include "serve/http/upload.h"
#include "serve/jobs/jobs.h"

typedef struct request_site {
    guard guard;
    upload_limits limits;
    work_limits work_limits;
    const store *store;
    jobs *jobs;
    const char *page, *page_policy, *openapi; /* texts */
    const char *model;                        /* name of the model */
    double keep;                              /* seconds */
} request_site;

/* libmicrohttpd's callbacks; context is the request_site. */
enum MHD_Result requests_answer(void *context, struct MHD_Connection *c, const char *url, const char *method,
                                const char *version, const char *data, size_t *size, void **own);
void requests_end(void *context, struct MHD_Connection *c, void **own, enum MHD_RequestTerminationCode code);

#endif
