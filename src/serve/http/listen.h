/* SPDX-License-Identifier: MIT */
/* The server's listening socket. */
#ifndef MERLIN_SERVE_HTTP_LISTEN_H
#define MERLIN_SERVE_HTTP_LISTEN_H

#include "base/status.h"

/* Opens it at a host's address; *port 0 means any free one, and becomes the actual one. */
status listen_at(const char *host, int *port, int *out);

#endif
