/* SPDX-License-Identifier: MIT */
#include "serve/http/listen.h"

#include <netdb.h>
#include <netinet/in.h>
#include <stdio.h>
#include <string.h>
#include <sys/socket.h>
#include <unistd.h>

/* Opens a socket; returns -1 and errno if the address is not available. */
static int open_socket(const struct addrinfo *at)
{
    enum { PENDING = 128 };
    const int yes = 1, fd = socket(at->ai_family, SOCK_STREAM | SOCK_CLOEXEC, 0);
    if (fd < 0) return -1;
    (void)setsockopt(fd, SOL_SOCKET, SO_REUSEADDR, &yes, sizeof yes);
    if (bind(fd, at->ai_addr, at->ai_addrlen) == 0 && listen(fd, PENDING) == 0) return fd;
    close(fd);
    return -1;
}

static void note_port(int fd, int *port)
{
    union {
        struct sockaddr any;
        struct sockaddr_in v4;
        struct sockaddr_in6 v6;
    } bound = {.v6 = {.sin6_port = 0}};
    socklen_t size = sizeof bound;
    if (getsockname(fd, &bound.any, &size) == 0)
        *port = ntohs(bound.any.sa_family == AF_INET6 ? bound.v6.sin6_port : bound.v4.sin_port);
}

status listen_at(const char *host, int *port, int *out)
{
    const struct addrinfo wanted = {.ai_socktype = SOCK_STREAM, .ai_flags = AI_PASSIVE | AI_NUMERICSERV};
    struct addrinfo *found = NULL;
    char service[16];
    snprintf(service, sizeof service, "%d", *port);
    const int failed = getaddrinfo(host, service, &wanted, &found);
    if (failed) return fail(MERLIN_BAD_INPUT, "there is no address %s: %s", host, gai_strerror(failed));
    *out = open_socket(found);
    status s = OK;
    if (*out < 0)
        s = fail_by_errno(MERLIN_CANNOT_WRITE, "cannot listen at %s, port %d (choose another by --port)", host, *port);
    if (s == OK) note_port(*out, port);
    freeaddrinfo(found);
    return s;
}
