/* SPDX-License-Identifier: MIT */
/* Access control: pages of other sites have none, by whatever name they call this machine, and other machines need a
 * token.
 *
 * A browser sends two headers that a page cannot forge. Host is the name in the address: a name of another site's owner
 * that points here (DNS rebinding) is not one of this server. Origin and Sec-Fetch-Site identify the page that sends
 * the request: only those of this server are accepted. */
#ifndef MERLIN_SERVE_HTTP_GUARD_H
#define MERLIN_SERVE_HTTP_GUARD_H

#include <stdbool.h>

#include "base/status.h"

enum { GUARD_MOST_NAMES = 16, GUARD_LEAST_TOKEN = 16 };

typedef struct guard {
    int port;
    bool local;                          /* only this machine: Host is one of its own names, with the port */
    const char *names[GUARD_MOST_NAMES]; /* further names of the server, with any port; ended by NULL */
    const char *token;                   /* NULL: none is required */
} guard;

/* Headers of a request; each may be NULL. */
typedef struct guard_asked {
    const char *host, *origin, *fetch_site;
    const char *authorization, *cookie;
    bool is_page; /* whether it requests the page itself, to which any page may link */
} guard_asked;

typedef enum guard_answer {
    GUARD_PASSES,
    GUARD_NO_HOST,    /* missing, or another server's */
    GUARD_OTHER_SITE, /* sent by another site's page */
    GUARD_NO_TOKEN,   /* missing or wrong */
} guard_answer;

guard_answer guard_ask(const guard *g, const guard_asked *asked);

/* Tells whether a text is the token, in a time that does not depend on where they differ. */
bool guard_is_token(const guard *g, const char *text);
/* Length of the cookie's name, which contains the port, as the ports of a machine share their cookies. */
enum { GUARD_COOKIE = 32 };
void guard_cookie(const guard *g, char name[GUARD_COOKIE]);

#endif
