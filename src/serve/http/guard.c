/* SPDX-License-Identifier: MIT */
#include "serve/http/guard.h"

#include <arpa/inet.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

/* ---- names ---- */

enum { NAME = 256 };

/* Splits "name:port" or "[address]:port"; *port is 0 if there is none. Returns false for anything else. */
static bool split(const char *host, char name[NAME], int *port)
{
    const char *end = *host == '[' ? strchr(host, ']') : NULL;
    const char *from = *host == '[' ? host + 1 : host;
    if (*host == '[' && !end) return false;
    const size_t length = end ? (size_t)(end - from) : strcspn(from, ":");
    const char *rest = end ? end + 1 : from + length;
    if (length == 0 || length >= NAME) return false;
    memcpy(name, from, length);
    name[length] = 0;
    *port = 0;
    if (!*rest) return true;
    const size_t digits = strspn(rest + 1, "0123456789");
    if (*rest != ':' || digits == 0 || digits > 5 || rest[1 + digits]) return false;
    *port = atoi(rest + 1);
    return true;
}

static bool is_own_name(const char *name)
{
    return strcasecmp(name, "localhost") == 0 || strcmp(name, "127.0.0.1") == 0 || strcmp(name, "::1") == 0;
}

/* Tells whether a name is an address, which DNS rebinding cannot change. */
static bool is_address(const char *name)
{
    struct in6_addr room;
    return inet_pton(AF_INET, name, &room) == 1 || inet_pton(AF_INET6, name, &room) == 1;
}

static bool is_ours(const guard *g, const char *host)
{
    char name[NAME];
    int port;
    if (!host || !split(host, name, &port)) return false;
    for (const char *const *own = g->names; *own; own++)
        if (strcasecmp(*own, name) == 0) return true;
    const bool here = port == g->port || (port == 0 && g->port == 80);
    return here && (is_own_name(name) || (!g->local && is_address(name)));
}

/* Tells whether a page's origin is "http://" or, behind a proxy, "https://" and the requested name. */
static bool is_same_site(const char *origin, const char *host)
{
    const char *name = strstr(origin, "://");
    const bool known = strncmp(origin, "http://", 7) == 0 || strncmp(origin, "https://", 8) == 0;
    return known && strcasecmp(name + 3, host) == 0;
}

static bool is_own_page(const guard_asked *asked)
{
    const char *site = asked->fetch_site;
    if (asked->origin && !is_same_site(asked->origin, asked->host)) return false;
    return asked->is_page || !site || strcmp(site, "same-origin") == 0 || strcmp(site, "none") == 0;
}

/* ---- tokens ---- */

bool guard_is_token(const guard *g, const char *text)
{
    const size_t length = strlen(g->token), given = strlen(text);
    unsigned differ = length != given;
    for (size_t i = 0; i < given; i++)
        differ |= (unsigned char)text[i] ^ (unsigned char)g->token[i % length];
    return differ == 0;
}

void guard_cookie(const guard *g, char name[GUARD_COOKIE])
{
    snprintf(name, GUARD_COOKIE, "merlin-%d", g->port);
}

static bool has_token_header(const guard *g, const char *authorization)
{
    return authorization && strncasecmp(authorization, "Bearer ", 7) == 0 && guard_is_token(g, authorization + 7);
}

guard_answer guard_ask(const guard *g, const guard_asked *asked)
{
    if (!is_ours(g, asked->host)) return GUARD_NO_HOST;
    if (!is_own_page(asked)) return GUARD_OTHER_SITE;
    if (!g->token || has_token_header(g, asked->authorization)) return GUARD_PASSES;
    return asked->cookie && guard_is_token(g, asked->cookie) ? GUARD_PASSES : GUARD_NO_TOKEN;
}
