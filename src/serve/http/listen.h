/* SPDX-License-Identifier: MIT */
/* The socket that clients connect to. */
#ifndef MERLIN_SERVE_HTTP_LISTEN_H
#define MERLIN_SERVE_HTTP_LISTEN_H

#include "base/status.h"

/* Opens it at a host's address; *port is 0 for any that is free, and becomes the one it has. */
status listen_at(const char *host, int *port, int *out);

#endif
