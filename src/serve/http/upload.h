/* SPDX-License-Identifier: MIT */
/* A multipart form being received: files are written to the store as they arrive, and nothing beyond the limits is
 * kept.
 *
 *     upload *u = upload_new(store, &limits, connection);
 *     upload_take(u, data, size);                     for every piece
 *     status s = upload_finish(u, &form);             reports faults at the end
 *     upload_free(u);                                 removes everything that was not taken over */
#ifndef MERLIN_SERVE_HTTP_UPLOAD_H
#define MERLIN_SERVE_HTTP_UPLOAD_H

#include "serve/http/http_library.h"
#include "serve/jobs/form.h"

typedef struct upload_limits {
    uint64_t bytes; /* most bytes of a request */
    size_t files;   /* most files in it */
    double seconds; /* most seconds that it may take */
} upload_limits;

typedef struct upload upload;

/* Why an upload was refused, in addition to status_message(). */
typedef enum upload_fault { UPLOAD_FINE, UPLOAD_WRONG, UPLOAD_TOO_LARGE, UPLOAD_NO_ROOM } upload_fault;

/* Makes an upload; NULL without memory. */
upload *upload_new(const store *s, const upload_limits *limits, struct MHD_Connection *c);
/* Takes a piece; returns false to stop reading, for uploads that are far too large or too slow. */
bool upload_take(upload *u, const char *data, size_t size);
/* Takes the form over, or returns the fault with a message in status_message(). */
upload_fault upload_finish(upload *u, form *out);
void upload_free(upload *u);

#endif
