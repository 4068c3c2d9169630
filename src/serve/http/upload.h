/* SPDX-License-Identifier: MIT */
/* A multipart form on its way in: files go to the store as they come, and nothing is kept beyond the limits.
 *
 *     upload *u = upload_new(store, &limits, connection);
 *     upload_take(u, data, size);                     for every piece
 *     status s = upload_finish(u, &form);             what was wrong with it is told at the end
 *     upload_free(u);                                 removes what nobody has taken over */
#ifndef MERLIN_SERVE_HTTP_UPLOAD_H
#define MERLIN_SERVE_HTTP_UPLOAD_H

#include "serve/http/http_library.h"
#include "serve/jobs/form.h"

typedef struct upload_limits {
    uint64_t bytes; /* of a request */
    size_t files;   /* in it */
    double seconds; /* that it may take */
} upload_limits;

typedef struct upload upload;

/* Why an upload was refused, beside what status_message() says. */
typedef enum upload_fault { UPLOAD_FINE, UPLOAD_WRONG, UPLOAD_TOO_LARGE, UPLOAD_NO_ROOM } upload_fault;

/* NULL: no memory. */
upload *upload_new(const store *s, const upload_limits *limits, struct MHD_Connection *c);
/* Returns false where no more of it is to be read: far too much of it, or too slow. */
bool upload_take(upload *u, const char *data, size_t size);
/* The form is taken over; status_message() says what is wrong with it otherwise. */
upload_fault upload_finish(upload *u, form *out);
void upload_free(upload *u);

#endif
