/* SPDX-License-Identifier: MIT */
/* The names and numbers by which clients reach a server that listens at a host's address, or at all of its machine. */
#ifndef MERLIN_SERVE_HTTP_ADDRESSES_H
#define MERLIN_SERVE_HTTP_ADDRESSES_H

enum { ADDRESSES_MOST = 8, ADDRESSES_HOST = 256 };

typedef struct addresses {
    char at[ADDRESSES_MOST][ADDRESSES_HOST]; /* as in a URL: IPv6 in brackets */
    int count;
} addresses;

/* Lists the host itself; for 0.0.0.0 and ::, which no client can call, the names (ended by NULL) and the addresses of
 * the machine's networks, or 127.0.0.1 if it has neither. */
void addresses_list(const char *host, const char *const *names, addresses *out);

#endif
