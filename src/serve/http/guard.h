/* SPDX-License-Identifier: MIT */
/* Who may ask: pages of other sites may not, by whatever name they call this machine, and other machines need a token.
 *
 * A browser tells two things that a page cannot forge. Host is the name in the address: a name that another site's
 * owner made point here (DNS rebinding) is none of ours. Origin, and Sec-Fetch-Site, tell which page has asked: only
 * those of this server may. */
#ifndef MERLIN_SERVE_HTTP_GUARD_H
#define MERLIN_SERVE_HTTP_GUARD_H

#include <stdbool.h>

#include "base/status.h"

enum { GUARD_MOST_NAMES = 16, GUARD_LEAST_TOKEN = 16 };

typedef struct guard {
    int port;
    bool local;                          /* this machine alone: Host is one of its own names, with the port */
    const char *names[GUARD_MOST_NAMES]; /* others by which it may be called, with any port; ended by NULL */
    const char *token;                   /* NULL: none is asked for */
} guard;

/* What a request says of itself; each may be NULL. */
typedef struct guard_asked {
    const char *host, *origin, *fetch_site;
    const char *authorization, *cookie;
    bool is_page; /* asks for the page itself, which may be followed to from anywhere */
} guard_asked;

typedef enum guard_answer {
    GUARD_PASSES,
    GUARD_NO_HOST,    /* none is named, or another's */
    GUARD_OTHER_SITE, /* another page asks */
    GUARD_NO_TOKEN,   /* none, or a wrong one */
} guard_answer;

guard_answer guard_ask(const guard *g, const guard_asked *asked);

/* Tells whether a text is the token, in a time that does not depend on where they differ. */
bool guard_is_token(const guard *g, const char *text);
/* The cookie's name, which has the port in it: ports of a machine share their cookies. */
enum { GUARD_COOKIE = 32 };
void guard_cookie(const guard *g, char name[GUARD_COOKIE]);

#endif
